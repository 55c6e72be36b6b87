// SPDX-License-Identifier: MIT
// Instance masks by which a ray excludes one chosen entity. Each mask has as many bits as the
// others, so that none lies within another (Sperner 1928): a ray with all bits but one entity's
// misses that entity and hits every other, at no cost in the traversal.
#pragma once

#include "engine/extract/extracted_frame.h"

#include <cstdint>
#include <span>

namespace shutter::extract {

/// Masks for one entity each: parts of kSolidMask, all different, none of them kSharedInstanceMask.
[[nodiscard]] std::span<const uint32_t> listInstanceMasks();

/// What entities have that no ray leaves out by its mask: as many bits as the others.
inline constexpr uint32_t kSharedInstanceMask = 0x70u;

/// Assigns masks (EntityRow::instanceMask) to entities that move in the picture, since rays may
/// have to exclude them; to the apparently largest if there are more entities than masks. The
/// others get 0.
void assignInstanceMasks(ExtractedFrame& frame, const SceneLayout& layout);

/// Solid bits of the entity's instance.
[[nodiscard]] inline uint32_t solidMaskOf(const shader::EntityRow& row) {
    return row.instanceMask != 0 ? row.instanceMask : kSharedInstanceMask;
}

} // namespace shutter::extract
