// SPDX-License-Identifier: MIT
#include "engine/extract/instance_masks.h"

#include "engine/math/bounds.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

namespace shutter::extract {

namespace {

constexpr int kBitsPerMask = 3; // of seven: 35 masks, the most there can be

static_assert(std::popcount(kSharedInstanceMask) == kBitsPerMask);
static_assert((kSharedInstanceMask & ~shader::kSolidMask) == 0);

std::vector<uint32_t> makeInstanceMasks() {
    std::vector<uint32_t> masks;
    for (uint32_t mask = 1; mask <= shader::kSolidMask; ++mask)
        if ((mask & ~shader::kSolidMask) == 0 && std::popcount(mask) == kBitsPerMask &&
            mask != kSharedInstanceMask)
            masks.push_back(mask);
    return masks;
}

/// Rows a masked pixel may show: those in the picture whose motion can be longer than nothing.
std::vector<uint32_t> listMoving(const ExtractedFrame& frame) {
    std::vector<uint32_t> rows;
    const auto consider = [&](const std::vector<DrawItem>& draws) {
        for (const DrawItem& draw : draws)
            if (frame.entities[draw.entity].motion != shader::kNoMotion)
                rows.push_back(draw.entity);
    };
    consider(frame.opaque.moving);
    if (!frame.staticMotions.empty()) // the camera moves
        consider(frame.opaque.still);
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    return rows;
}

/// Size of the bounds as a share of their distance; any monotonic measure would do.
double computeApparentSize(const shader::EntityRow& row, const math::Bounds& bounds) {
    math::dmat4 matrix(1.0);
    for (int r = 0; r < 3; ++r)
        for (int column = 0; column < 4; ++column)
            matrix[column][r] = double(row.relWorldFromObject[r][column]);
    const math::Bounds placed = math::transformBounds(matrix, bounds);
    const double size = glm::length(placed.max - placed.min);
    const double share = size / std::max(glm::length(placed.centre()), 1.0e-9);
    return std::isfinite(share) ? share : 0.0; // NaN has no order
}

} // namespace

std::span<const uint32_t> listInstanceMasks() {
    static const std::vector<uint32_t> kMasks = makeInstanceMasks();
    return kMasks;
}

std::vector<RowMask> assignInstanceMasks(const ExtractedFrame& frame, const SceneLayout& layout) {
    std::vector<uint32_t> rows = listMoving(frame);
    const std::span<const uint32_t> masks = listInstanceMasks();
    if (rows.size() > masks.size()) {
        std::vector<std::pair<double, uint32_t>> sizes;
        for (const uint32_t row : rows)
            sizes.emplace_back(
                -computeApparentSize(
                    frame.entities[row], layout.bounds.at(frame.entityMeshes[row])
                ),
                row
            );
        std::nth_element(
            sizes.begin(), sizes.begin() + static_cast<ptrdiff_t>(masks.size()), sizes.end()
        );
        rows.clear();
        for (size_t i = 0; i < masks.size(); ++i)
            rows.push_back(sizes[i].second);
        std::sort(rows.begin(), rows.end()); // who keeps a mask keeps the same, if it can
    }
    std::vector<RowMask> assigned;
    for (size_t i = 0; i < rows.size(); ++i)
        assigned.push_back({rows[i], masks[i]});
    return assigned;
}

} // namespace shutter::extract
