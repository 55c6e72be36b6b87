// SPDX-License-Identifier: MIT
// What the passes of a frame must find empty: one pass clears it for all of them.
#pragma once

#include "engine/graph/graph.h"

#include <cstdint>
#include <vector>

namespace shutter::motion_blur {

/// Serves one frame. Passes first add their resources; then the clearing pass is declared; then the
/// passes are declared with the handles from get().
class Clears {
  public:
    /// To 0.
    void add(graph::ImageHandle image);
    /// Every word of the buffer.
    void add(graph::BufferHandle buffer, uint32_t word);
    /// Clears the first bytes of a list. \param bytes a multiple of 4
    void addHead(graph::BufferHandle list, uint32_t bytes);
    /// Dispatches of no groups. \param listCount at most kListCount
    void addArguments(graph::BufferHandle arguments, uint32_t listCount);

    void declare(graph::Graph& graph);

    /// Returns the cleared version, after declare() (CHECKed).
    [[nodiscard]] graph::ImageHandle get(graph::ImageHandle image) const;
    [[nodiscard]] graph::BufferHandle get(graph::BufferHandle buffer) const;

  private:
    enum class Kind : uint8_t { Whole, Head, Arguments };

    struct Buffer {
        graph::BufferHandle handle;
        Kind kind = Kind::Whole;
        uint32_t number = 0; ///< the word, the bytes or the lists
    };

    /// Handles, before or after the pass.
    struct Resources {
        std::vector<graph::ImageHandle> images;
        std::vector<Buffer> buffers;
    };

    static void record(const Resources& resources, graph::PassContext& context);

    Resources mAdded;
    Resources mCleared; ///< in the same order
};

} // namespace shutter::motion_blur
