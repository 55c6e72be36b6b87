// SPDX-License-Identifier: MIT
// The order in which instances and triangles are handed to builders of acceleration structures:
// neighbours in space stand together. It depends on the boxes alone, not on the machine.
#pragma once

#include "engine/math/math.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::extract {

/// A box and nothing else; single precision is enough to sort by.
struct Box {
    math::vec3 min{0.0f};
    math::vec3 max{0.0f};
};

/// Order in which `boxes` shall stand so that halving the list again and again (the left half gets
/// (n - 1) / 2 + 1) splits space well: top down, each split on the axis with the least surface area
/// of the two halves. Builders that keep the order they are given (lavapipe's) make a good tree of
/// it; others do not care.
/// \return for each new place the old index: a permutation of 0 ... n-1
[[nodiscard]] std::vector<uint32_t> computeSpatialOrder(std::span<const Box> boxes);

/// Reorders the triangles (3 indices each) by computeSpatialOrder of their boxes; each keeps its
/// three corners in their order, and vertices stay where they are.
/// \param indices three a triangle, each below positions.size()
void sortTriangles(std::span<const math::vec3> positions, std::vector<uint32_t>& indices);

} // namespace shutter::extract
