// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/graph/graph.h"
#include "engine/image/image.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace shutter::render {

/// Copies images of a frame to main memory. Add passes while declaring, take the pictures once the
/// GPU is done.
class Readback {
  public:
    explicit Readback(gpu::Device& device) : mDevice(device) {}

    /// Declares the copy. \return the ticket for take()
    size_t add(graph::Graph& graph, const std::string& name, graph::ImageHandle image);

    /// The picture as floats: halves and 8-bit values converted, unsigned integers rounded to the
    /// nearest float except the all-ones id, which becomes -1.
    [[nodiscard]] image::Image take(size_t ticket) const;

    /// The picture's texels row by row, as they are stored; valid until the next frame.
    [[nodiscard]] std::span<const std::byte> bytes(size_t ticket) const;

    /// Discards all tickets; buffers are reused by the next frame.
    void reset() { mEntries.clear(); }

  private:
    struct Entry {
        size_t buffer = 0;
        graph::TransientImageDesc desc;
    };

    gpu::Device& mDevice;
    std::vector<gpu::Buffer> mBuffers;
    std::vector<Entry> mEntries;
};

} // namespace shutter::render
