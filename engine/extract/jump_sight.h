// SPDX-License-Identifier: MIT
// Whether a view sees what jumps during its exposure: two places of the same surface with no way
// between them that anything takes.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/extract/motion_keys.h"
#include "engine/math/math.h"
#include "engine/scene/clip_jumps.h"
#include "engine/scene/exposure_motion.h"

#include <cstdint>
#include <optional>

namespace shutter::extract {

class JumpSight {
  public:
    /// All must outlive this. \param motion of the view's exposure
    JumpSight(
        const scene::World& world,
        const SceneLayout& layout,
        const ViewRequest& view,
        const scene::ExposureMotion& motion
    );

    /// Whether the picture of an entity that is drawn jumps by a quarter of a pixel or more, or it
    /// is there on one side only.
    /// \param jump in the exposure's time
    [[nodiscard]] bool sees(ecs::Entity entity, uint32_t mesh, const scene::Jump& jump) const;

    /// The same of what the camera shows, however near.
    [[nodiscard]] bool seesCamera(const scene::Jump& jump) const;

  private:
    /// An entity where it can be drawn.
    struct Posed {
        math::dmat4 eyeFromObject{1.0};
        scene::Deformation shape;
        math::Bounds bounds; ///< object space
    };

    /// Nothing: it cannot be drawn then.
    [[nodiscard]] std::optional<Posed>
    poseAt(ecs::Entity entity, uint32_t mesh, double seconds) const;
    [[nodiscard]] bool isInView(const std::optional<Posed>& posed, double seconds) const;
    /// Metres; an upper bound.
    [[nodiscard]] double measureWay(const Posed& from, const Posed& to, uint32_t mesh) const;
    [[nodiscard]] math::dmat4 eyeFromCameraAt(double seconds) const;
    [[nodiscard]] double shutterTimeOf(double seconds) const;

    const scene::World& mWorld;
    const SceneLayout& mLayout;
    const ViewRequest& mView;
    const scene::ExposureMotion& mMotion;
    const scene::Camera& mCamera;
    KeyTolerance mTolerance;
    math::Bounds mNearView; ///< what the camera sees from the near plane, its own space
    math::dvec3 mEye{0.0};  ///< world space: origin of eye space
};

} // namespace shutter::extract
