// SPDX-License-Identifier: MIT
// The camera of one frame, and entities and lights as it sees them. Pure.
#pragma once

#include "engine/extract/deformed_entity.h"
#include "engine/extract/extracted_frame.h"
#include "engine/math/bounds.h"
#include "engine/math/lens_tables.h"
#include "engine/math/math.h"
#include "engine/scene/components.h"
#include "engine/scene/exposure_motion.h"
#include "shaders/render/scene_shared.h"

#include <optional>

namespace shutter::extract {

/// Finite and not singular: triangles keep an area, and the matrix has an inverse.
[[nodiscard]] bool isDrawable(const math::dmat4& matrix);

/// \param world transform of the light's entity, finite
/// \param origin of camera-relative space, in the world
[[nodiscard]] shader::LightRow
makeLight(const scene::Light& light, const math::dmat4& world, const math::dvec3& origin);

/// The view with every entity sampled at the pixel's centre where only static ones would be
/// jittered.
[[nodiscard]] ViewRequest withoutStaticSamples(const ViewRequest& view);

/// Half the extent of the picture, to the right and up: at distance 1 (perspective), or metres at
/// any distance (orthographic), where it is below 0 if the camera mirrors.
/// \param yFov of the camera's frame, radians (ExposureMotion::cameraYFov)
[[nodiscard]] math::dvec2
computeHalfExtents(const scene::Camera& camera, double yFov, const ViewRequest& view);

/// Vertical field of view of the picture, radians. \param yFov of the camera's frame
[[nodiscard]] double
computePictureYFov(const scene::Camera& camera, double yFov, const ViewRequest& view);

/// Clip space from view space. \param yFov of the camera's frame
[[nodiscard]] math::dmat4
makeProjection(const scene::Camera& camera, double yFov, const ViewRequest& view);

/// The lens of a perspective camera at one shutter time, and the picture that it draws.
[[nodiscard]] math::ThinLens describeLens(
    const scene::ExposureMotion& motion,
    const scene::Camera& camera,
    const ViewRequest& view,
    double s
);

/// A camera at one shutter time.
struct CameraPose {
    math::dmat4 worldFromView{1.0};
    math::dmat4 clipFromView{1.0};
};

/// Returns the camera at ViewRequest::lensPlace: moved to a point of its lens, parallel to the
/// axis, with a sheared projection that leaves the focus plane in place.
[[nodiscard]] CameraPose placeCamera(
    const scene::ExposureMotion& motion,
    const scene::Camera& camera,
    const ViewRequest& view,
    double s
);

/// All that the rows of things that are static in the world depend on. Doubles only, no padding:
/// equal bytes give equal rows.
struct ViewMatrices {
    math::dmat4 clipFromWorldOpen{1.0};
    math::dmat4 clipFromWorldRaster{1.0};
    math::dmat4 clipFromWorldJittered{1.0}; ///< the same, for the raster image's samples
    math::dmat4 clipFromWorldClose{1.0};
    math::dvec3 eye{0.0}; ///< of the camera at the raster instant, world space, metres
};

/// Bit by bit: NaN equals itself, and the two zeros differ.
[[nodiscard]] bool isIdentical(const ViewMatrices& a, const ViewMatrices& b);

class FrameView {
  public:
    /// `world` must outlive this.
    FrameView(const scene::World& world, const ViewRequest& request);

    [[nodiscard]] const scene::ExposureMotion& motion() const { return mMotion; }

    [[nodiscard]] const ShutterTimes& times() const { return mTimes; }

    [[nodiscard]] const ViewMatrices& matrices() const { return mMatrices; }

    /// Without lights and the tables' addresses.
    [[nodiscard]] const shader::FrameConstants& constants() const { return mConstants; }

    /// Within the exposure.
    [[nodiscard]] bool moves() const { return mMoves; }

    /// Motion of the previous frame's exposure; null unless ViewRequest::jittered is Static.
    [[nodiscard]] const scene::ExposureMotion* before() const {
        return mBefore ? &*mBefore : nullptr;
    }

    /// ExtractedFrame::isCameraAtRest.
    [[nodiscard]] bool isCameraAtRest() const { return mIsCameraAtRest; }

    /// Left and right, or up and down, change places: windings turn round.
    [[nodiscard]] bool mirrors() const { return mMirrors; }

  private:
    void fillConstants(const scene::Camera& camera, const ViewRequest& request);

    [[nodiscard]] bool findCameraAtRest(const ViewRequest& request) const;

    scene::ExposureMotion mMotion;
    std::optional<scene::ExposureMotion> mBefore;
    bool mIsCameraAtRest = false;
    ShutterTimes mTimes;
    math::dmat4 mClipFromView[3];  ///< open, raster instant, close
    math::dmat4 mViewFromWorld[3]; ///< open, raster instant, close
    math::dvec3 mEye[3];
    math::dvec3 mForward{0.0}; ///< at the raster instant
    ViewMatrices mMatrices;
    shader::FrameConstants mConstants{};
    bool mMoves = false;
    bool mMirrors = false;
};

/// worldFromObject of one entity at the three instants of a frame.
struct ObjectPoses {
    math::dmat4 open{1.0};
    math::dmat4 raster{1.0};
    math::dmat4 close{1.0};
    bool still = false;  ///< the three are one
    bool jitters = true; ///< the raster's jitter moves its samples

    explicit ObjectPoses(const math::dmat4& always)
        : open(always), raster(always), close(always), still(true) {}

    ObjectPoses(const math::dmat4& o, const math::dmat4& r, const math::dmat4& c)
        : open(o), raster(r), close(c) {}
};

/// Finite at all three, and not singular at the raster instant.
[[nodiscard]] bool isDrawable(const ObjectPoses& poses);

/// An entity as a frame's view has it.
struct PlacedEntity {
    shader::EntityRow row{}; ///< without firstGeometry and handedness; `motion` is kNoMotion
    shader::EntityMotion motion{};
    bool moves = false;    ///< in the picture: `motion` counts
    bool visible = false;  ///< its bounds reach into the picture
    float distance = 0.0f; ///< of the bounds' centre from the camera, metres
};

/// \param bounds object space, raster instant
/// \param shapeChanges during the exposure
[[nodiscard]] PlacedEntity placeEntity(
    const ViewMatrices& view,
    const ObjectPoses& poses,
    const math::Bounds& bounds,
    bool shapeChanges
);

} // namespace shutter::extract
