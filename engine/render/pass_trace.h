// SPDX-License-Identifier: MIT
// Outputs of each pass of a frame, to find the first that differs between two runs, drivers or
// devices.
#pragma once

#include "engine/graph/compile.h"
#include "engine/render/readback.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace shutter::render {

/// An image as a pass left it.
struct WrittenImage {
    uint32_t frame = 0; ///< of the picture: some methods draw several
    std::string pass;
    std::string image;
    std::vector<std::byte> bytes; ///< texels row by row, as they are stored
};

class PassTrace {
  public:
    /// Declares copies of every image that the graph's passes write, as each leaves it. Buffers are
    /// not among them: the order of what threads append to a list is not the same in every run. Nor
    /// are images of several samples per pixel, and imported ones that cannot be copied. To be
    /// called once all else is declared. Error: the graph's mistakes, as from compile().
    [[nodiscard]] core::Status
    declare(graph::Graph& graph, Readback& readback, const graph::RequirementFunction& requirement);

    /// In the order in which the passes ran; once the GPU is done.
    [[nodiscard]] std::vector<WrittenImage> take(const Readback& readback) const;

  private:
    struct Entry {
        std::string pass;
        std::string image;
        size_t ticket = 0;
    };

    std::vector<Entry> mEntries;
};

} // namespace shutter::render
