// SPDX-License-Identifier: MIT
// The motion of a matrix over the exposure, for time-sampled rays: keys at uniform shutter times
// between which shaders interpolate linearly. Enough of them for the error to be invisible for any
// motion.
#pragma once

#include "engine/math/bounds.h"
#include "engine/math/math.h"
#include "shaders/render/timed_scene_shared.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace shutter::extract {

/// Maximum number of intervals between keys. A jump (step interpolation) and any faster change are
/// spread over one interval, 1/1024 of the exposure.
inline constexpr uint32_t kMaxKeyIntervals = 1024;

/// Maximum error of the keys, in pixels.
inline constexpr double kKeyTolerancePx = 1.0 / 64.0;

/// Number of intervals at whose ends, and at an odd place of each, motion is probed.
inline constexpr uint32_t kProbeIntervals = 16;
/// Share of an interval (the golden section); an irrational offset detects periodic motion that
/// aliases with the other probes.
inline constexpr double kOddPlace = 0.381966011250105;

/// relWorldFromObject at shutter time s in [0, 1].
using MatrixAt = std::function<math::dmat4(double s)>;

struct MotionKeys {
    /// One: it is static. Else 2^n + 1 at uniform shutter times, both ends included.
    std::vector<shader::MotionKey> keys;
    math::Bounds swept;         ///< camera-relative space: holds the box at every shutter time
    bool followsExactly = true; ///< false: kMaxKeyIntervals were not enough
};

/// How far apart two places may be that a picture shows as one.
struct KeyTolerance {
    std::vector<math::dvec3>
        cameraPath;             ///< camera-relative space: where the camera is during the exposure
    double near = 0.0;          ///< metres: nothing is seen from closer
    double pixelAtOne = 0.0;    ///< width of a pixel per metre of distance (perspective)
    double pixelAnywhere = 0.0; ///< width of a pixel at any distance (orthographic)

    /// Tolerance in metres for a point inside `swept` (camera-relative space): kKeyTolerancePx at
    /// the point nearest to the camera, but not below the resolution of single precision there.
    [[nodiscard]] double of(const math::Bounds& swept) const;
};

/// Computes keys for points in `bounds` (object space, not empty). Motion is probed at 33 instants
/// or more, so that motion that begins or ends within the exposure is found; changes between two
/// probes are missed.
/// \return nothing where the matrix is not finite at one of the instants
[[nodiscard]] std::optional<MotionKeys> computeMotionKeys(
    const MatrixAt& matrixAt, const math::Bounds& bounds, const KeyTolerance& tolerance
);

/// Keys of the camera's rigid relWorldFromView.
/// \param halfExtents of the view at distance 1 (perspective) or anywhere (orthographic)
[[nodiscard]] std::optional<MotionKeys> computeCameraKeys(
    const MatrixAt& relWorldFromView, const math::dvec2& halfExtents, const KeyTolerance& tolerance
);

/// The matrix a shader interpolates at s in [0, 1].
[[nodiscard]] math::dmat4 interpolateKeys(std::span<const shader::MotionKey> keys, double s);

/// Largest distance between the corners of `bounds` under two affine maps.
[[nodiscard]] double
measureDeviation(const math::dmat4& a, const math::dmat4& b, const math::Bounds& bounds);

[[nodiscard]] shader::MotionKey makeKey(const math::dmat4& matrix);
[[nodiscard]] math::dmat4 expandKey(const shader::MotionKey& key);

} // namespace shutter::extract
