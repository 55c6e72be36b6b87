// SPDX-License-Identifier: MIT
// Motion during one exposure of one camera: the single source of placements at shutter times for
// motion vectors, rays and ground truth. Applies the artist's scales (CameraShutter, MotionBlur)
// and entities without a past (history.h).
//
// A scale k (a cap's share is one) scales time around the raster instant r: a scaled entity is at
// time t where it would be at r + k (t - r). At the raster instant nothing changes.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/math/math.h"
#include "engine/scene/deformation.h"
#include "engine/scene/history.h"
#include "engine/scene/motion.h"
#include "engine/scene/shutter.h"
#include "engine/scene/world.h"

#include <array>
#include <vector>

namespace shutter::scene {

/// Scale of the nearest MotionBlur upwards, [0, 2]; 1 if there is none.
[[nodiscard]] double findBlurScale(const World& world, ecs::Entity entity);

class ExposureMotion {
  public:
    /// \param camera alive, with a Camera; `world` must outlive this and must not change
    ExposureMotion(const World& world, ecs::Entity camera, const ExposureInterval& exposure);

    [[nodiscard]] const ExposureInterval& exposure() const { return mExposure; }

    /// Nothing has a past in this frame: everything is static, as at the raster instant.
    [[nodiscard]] bool isCut() const { return mIsCut; }

    /// Whether the entity is hidden for the exposure: tested at the beginning of a part, and at the
    /// raster instant of a whole exposure, which shows an entity throughout or never.
    [[nodiscard]] bool isHidden(ecs::Entity entity) const;
    /// Whether it is at shutter time s.
    [[nodiscard]] bool isHiddenAt(ecs::Entity entity, double s) const;

    /// Something appears or is hidden during the frame's exposure, of which this is a part.
    [[nodiscard]] bool hasComings() const { return mHasComings; }

    /// When this entity does in the exposure itself, seconds. What appears as the exposure ends
    /// (kMinLight) is there for all of it.
    [[nodiscard]] std::vector<double> comingsOf(ecs::Entity entity) const;

    /// Times of the world that the frame's whole exposure shows, scales included.
    [[nodiscard]] const TimeSpan& reach() const { return mReach; }

    /// How many times as fast as the exposure an entity's own motion runs away from the frame's
    /// raster instant; 0: it has none.
    [[nodiscard]] double speedOf(ecs::Entity entity) const;
    /// The same of the camera's turning and of its displacement.
    [[nodiscard]] std::array<double, 2> cameraSpeeds() const;

    /// Shutter time s in [0, 1] below; `entity` and its parents are alive.
    [[nodiscard]] math::dmat4 worldFromEntity(ecs::Entity entity, double s) const;
    /// The same of a light (motion.h, worldFromLight).
    [[nodiscard]] math::dmat4 worldFromLight(ecs::Entity entity, double s) const;
    /// From the space of deformed vertices (deformation.h), as seen in the picture: an entity with
    /// a MotionBlur scale follows the camera for the remaining share of the motion. In a part of an
    /// exposure (takePart()) it is singular while the entity is hidden.
    [[nodiscard]] math::dmat4 worldFromObject(ecs::Entity entity, double s) const;
    [[nodiscard]] Deformation deformationAt(ecs::Entity entity, double s) const;
    /// Deformation::objectFromBind of one joint of a skinned entity.
    [[nodiscard]] math::dmat4 objectFromBind(ecs::Entity entity, size_t joint, double s) const;
    /// Rigid (motion.h, worldFromRigid), from the space of the camera's entity.
    [[nodiscard]] math::dmat4 worldFromCamera(double s) const;
    /// Vertical field of view of the camera, radians; orthographic cameras have none.
    [[nodiscard]] double cameraYFov(double s) const;

    /// The camera's lens at the time from which cameraYFov() takes the zoom.
    [[nodiscard]] CameraLens cameraLens(double s) const;

    /// False when cameraYFov answers the same at every shutter time.
    [[nodiscard]] bool mayCameraZoom() const;

    /// False when worldFromEntity answers the same at every shutter time.
    [[nodiscard]] bool mayMove(ecs::Entity entity) const;
    /// False when worldFromObject answers the same at every shutter time.
    [[nodiscard]] bool mayObjectMove(ecs::Entity entity) const;
    /// False when deformationAt answers the same at every shutter time.
    [[nodiscard]] bool mayDeform(ecs::Entity entity) const;

  private:
    [[nodiscard]] double secondsAt(double s) const;
    /// World time whose pose an entity has at s.
    [[nodiscard]] double entitySeconds(ecs::Entity entity, double s) const;
    void findCut();
    void noteComings();
    [[nodiscard]] bool isThere(ecs::Entity entity, double seconds) const;
    /// `seconds` run `scale` times as fast away from the frame's raster instant.
    [[nodiscard]] double scaleTime(double seconds, double scale) const;
    [[nodiscard]] math::dmat4 cameraAt(double seconds) const;
    [[nodiscard]] double yFovAt(double seconds) const;
    /// Time at which the lens is evaluated for `seconds`.
    [[nodiscard]] double lensSeconds(double seconds) const;
    [[nodiscard]] bool mayCameraMove() const;
    /// findBlurScale() times the frame's cap: the scale of the entity's motion on the screen.
    [[nodiscard]] double screenScaleOf(ecs::Entity entity) const;
    /// True where the entity's own motion is none in this frame.
    [[nodiscard]] bool isHeld(ecs::Entity entity) const;
    /// The same, of a mesh: its joints count.
    [[nodiscard]] bool isObjectHeld(ecs::Entity entity) const;
    /// World time whose pose a mesh shows at `seconds` once `screenScale` is applied.
    [[nodiscard]] double
    objectSeconds(ecs::Entity entity, double seconds, double screenScale) const;

    const World& mWorld;
    ecs::Entity mCamera;
    ExposureInterval mExposure;
    ExposureTimes mFrame; ///< of the frame, of whose exposure mExposure may be a part
    TimeSpan mReach;
    TimeSpan mSpan;             ///< the frame and all times that scales reach
    bool mAnyEvents = false;    ///< false: isHeld() needs no search
    bool mAnyBlurScale = false; ///< false: no entity has a MotionBlur
    bool mAnyHidden = false;    ///< false: isHidden() needs no search
    bool mIsCut = false;
    bool mHasComings = false;
    double mLastComing = 0.0; ///< entities that appear after it are static for the whole exposure
};

} // namespace shutter::scene
