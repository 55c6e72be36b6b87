// SPDX-License-Identifier: MIT
// How a host's camera and entities move during the exposure, for methods that look up where
// surfaces are at its instants (Method::readsInstantMotions).
#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace shutter::shader {
struct ResponseTable;
} // namespace shutter::shader

namespace shutter::motion_blur {

inline constexpr double kMostKeyTime = 1.0e6; ///< of HostCameraKey::time

/// The camera at one shutter time. Matrices are column by column and take columns: clip =
/// clipFromView * viewFromWorld * world.
struct HostCameraKey {
    /// Shutter time: 0 open, 1 close. One outside of [0, 1] counts for what lies between it and the
    /// next key, as that of the frame before does (timeOfFrameBefore()). Within kMostKeyTime of 0.
    double time = 0.0;
    /// Affine and not singular. Ahead is -Z, or +Z with HostMotion::aheadIsPlusZ. The view's unit
    /// is that of the depth in HostInputs::motionDepth: metres.
    glm::dmat4 viewFromWorld{1.0};
    /// Perspective or orthographic, the same in all keys. Clip space is Vulkan's: x = -1 is the
    /// picture's left side, y = -1 its top, so a host that flips its viewport negates the second
    /// row. Lenses may be shifted, and depth may have any range and direction. Temporal jitter:
    /// that of HostInputs::color, in all keys: this frame's raster's, or none where temporal
    /// anti-aliasing has taken it out before the blur.
    glm::dmat4 clipFromView{1.0};
};

/// An entity that may not stand still in the world, or did not in the frame before.
struct HostMover {
    uint32_t row = 0; ///< its value in HostInputs::entityId, below HostMotion::rowCount
    /// World from the entity's own space, one for each camera key: affine, with any scale. Where it
    /// is singular, the entity is not to be seen. Empty: the entity changes its shape, or its way
    /// is not known. Its motion vectors are followed then, taken as straight, and it has no
    /// history.
    std::span<const glm::dmat4> worldFromObject;
};

/// Spans and pointers are read during the call only.
///
/// Between keys, translation is straight, rotation takes the shorter arc, and scale, shear and
/// projection are linear. Before the first key and after the last one all stands still. Three keys
/// (open, raster, close) are enough for what turns evenly, by less than half a turn from key to
/// key. A host that knows the frame before and this one alone gives two: that frame's matrices at
/// timeOfFrameBefore(), and this one's at HostInputs::rasterTime. Keys alone say how long the
/// exposure is; HostScales::exposureShare scales vectors.
struct HostMotion {
    /// [1, 64], their times rising; one is at HostInputs::rasterTime, to 1e-6.
    std::span<const HostCameraKey> keys;
    bool aheadIsPlusZ = false; ///< of view space; false: ahead is -Z
    /// [1, 2^24 - 1]. Values of the image are rows below it, and 0xFFFFFFFF is the sky. A pixel of
    /// any other value counts as unresolved. Without HostInputs::entityId it does not count.
    uint32_t rowCount = 0;
    /// In any order, each row once. A row without an entry stands still in the world: where it is,
    /// and in the frame before. One that is listed but does not move costs next to nothing.
    std::span<const HostMover> movers;
    /// By row, an id that its entity has in every frame, so that history finds it in whatever row
    /// it is; an id that occurs twice is not found. A new id takes history from an entity, such as
    /// one that was teleported. Empty: the row is the id, so no entity may come, go or change its
    /// row.
    std::span<const uint64_t> rowIds;
    /// The table in main memory that HostInputs::response is the address of; null where that is 0.
    const shader::ResponseTable* response = nullptr;
    /// Number of the view, below HostDevice::framesInFlight: each has a history of its own. A
    /// method that keeps no raster drops the history of its view.
    uint32_t view = 0;
    /// The recording before of this view was submitted before this one, to the same queue, and
    /// shows the frame before in the same world space: no cut, and no frame in between but those in
    /// which all stood still as it was recorded. Its raster is looked up, too, unless it had
    /// another size or kind of projection. Counts with MotionBlurSettings::history.
    bool followsLast = false;
};

} // namespace shutter::motion_blur
