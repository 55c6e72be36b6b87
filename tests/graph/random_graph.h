// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/memory.h"
#include "engine/graph/graph.h"

#include <array>
#include <cstdint>
#include <memory>

namespace shutter::graph {

/// A frame nobody would think of. The images it imports live as long as it does.
struct RandomFrame {
    Graph graph;
    std::array<gpu::Image, 3> imported;
};

/// The same seed gives the same frame everywhere. Every frame is well declared, but now and then a
/// pass reads an old version, and then the order may be impossible.
[[nodiscard]] std::unique_ptr<RandomFrame> makeRandomFrame(uint32_t seed);

} // namespace shutter::graph
