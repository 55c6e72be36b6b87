// SPDX-License-Identifier: MIT
// Instance masks by which a ray excludes one chosen entity. Each mask has as many bits as the
// others, so that none lies within another (Sperner 1928): a ray with all bits but one entity's
// misses that entity and hits every other, at no cost in the traversal.
#pragma once

#include "engine/extract/extracted_frame.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace shutter::extract {

/// Masks for one entity each: parts of kSolidMask, all different, none of them kSharedInstanceMask.
[[nodiscard]] std::span<const uint32_t> listInstanceMasks();

/// What entities have that no ray leaves out by its mask: as many bits as the others.
inline constexpr uint32_t kSharedInstanceMask = 0x70u;

/// EntityRow::instanceMask of a row.
struct RowMask {
    uint32_t row = 0;
    uint32_t mask = 0;
};

/// Assigns masks to entities that move in the picture, since rays may have to exclude them; to the
/// apparently largest if there are more entities than masks. \return by rising row; the others have
/// none, 0
[[nodiscard]] std::vector<RowMask>
assignInstanceMasks(const ExtractedFrame& frame, const SceneLayout& layout);

/// The row's mask among those of assignInstanceMasks(), 0: none.
[[nodiscard]] inline uint32_t maskOf(std::span<const RowMask> masks, uint32_t row) {
    const auto found =
        std::lower_bound(masks.begin(), masks.end(), row, [](const RowMask& mask, uint32_t of) {
            return mask.row < of;
        });
    return found != masks.end() && found->row == row ? found->mask : 0;
}

/// Solid bits of the row's instance.
[[nodiscard]] inline uint32_t solidMaskOf(std::span<const RowMask> masks, uint32_t row) {
    const uint32_t own = maskOf(masks, row);
    return own != 0 ? own : kSharedInstanceMask;
}

} // namespace shutter::extract
