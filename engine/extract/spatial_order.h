// SPDX-License-Identifier: MIT
// The order in which instances and triangles are passed to builders of acceleration structures:
// neighbours in space are adjacent in the list. It depends on the boxes alone, not on the machine.
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

/// Computes an order of `boxes` in which recursive halving of the list (the left half gets (n - 1)
/// / 2 + 1) splits space well: top down, each split on the axis with the least surface area of the
/// two halves. Builders that preserve the input order (lavapipe's) make a good tree of it; others
/// are unaffected.
/// \return for each new place the old index: a permutation of 0 ... n-1
[[nodiscard]] std::vector<uint32_t> computeSpatialOrder(std::span<const Box> boxes);

/// Reorders the triangles (3 indices each) by computeSpatialOrder of their boxes; the order of each
/// triangle's corners and the vertices do not change.
/// \param indices three per triangle, each below positions.size()
void sortTriangles(std::span<const math::vec3> positions, std::vector<uint32_t>& indices);

} // namespace shutter::extract
