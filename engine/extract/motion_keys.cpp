// SPDX-License-Identifier: MIT
#include "engine/extract/motion_keys.h"

#include "engine/core/check.h"
#include "engine/math/transform.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace shutter::extract {

namespace {

using math::Bounds;
using math::dmat4;
using math::dvec3;
using math::dvec4;

/// Relative noise of single precision: a few roundings of a matrix product.
constexpr double kFloatNoise = 4.0 * std::numeric_limits<float>::epsilon();

double findLargestCoordinate(const Bounds& bounds) {
    double largest = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        largest = std::max({largest, std::abs(bounds.min[axis]), std::abs(bounds.max[axis])});
    return largest;
}

double measureDistance(const dvec3& point, const Bounds& bounds) {
    return glm::length(glm::max(glm::max(bounds.min - point, point - bounds.max), dvec3(0.0)));
}

dmat4 mix(const dmat4& a, const dmat4& b, double t) {
    return a * (1.0 - t) + b * t;
}

std::vector<shader::MotionKey> sampleKeys(const MatrixAt& matrixAt, uint32_t intervals) {
    std::vector<shader::MotionKey> keys;
    keys.reserve(intervals + 1);
    for (uint32_t i = 0; i <= intervals; ++i)
        keys.push_back(makeKey(matrixAt(double(i) / intervals)));
    return keys;
}

/// Compares between the keys: at the middle, the quarters and the odd place of each interval, and
/// at no fewer places than the probes.
bool follows(
    std::span<const shader::MotionKey> keys,
    const MatrixAt& matrixAt,
    const Bounds& bounds,
    double tolerance
) {
    const auto intervals = static_cast<uint32_t>(keys.size() - 1);
    const uint32_t parts = std::max(4u, kProbeIntervals / intervals);
    for (uint32_t i = 0; i < intervals; ++i) {
        const dmat4 a = expandKey(keys[i]);
        const dmat4 b = expandKey(keys[i + 1]);
        for (uint32_t part = 0; part < parts; ++part) {
            const double t = part == 0 ? kOddPlace : double(part) / parts;
            const dmat4 exact = matrixAt((i + t) / intervals);
            // Written so that NaN does not follow.
            if (!(measureDeviation(exact, mix(a, b, t), bounds) <= tolerance))
                return false;
        }
    }
    return true;
}

} // namespace

double measureDeviation(const dmat4& a, const dmat4& b, const Bounds& bounds) {
    const dmat4 difference = a - b; // w is 0: the maps are affine
    double largest = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const dvec4 point(
            corner & 1 ? bounds.max.x : bounds.min.x,
            corner & 2 ? bounds.max.y : bounds.min.y,
            corner & 4 ? bounds.max.z : bounds.min.z,
            1.0
        );
        largest = std::max(largest, glm::length(dvec3(difference * point)));
    }
    return largest;
}

shader::MotionKey makeKey(const dmat4& matrix) {
    shader::MotionKey key;
    for (int i = 0; i < 3; ++i)
        key.rows[i] = math::vec4(matrix[0][i], matrix[1][i], matrix[2][i], matrix[3][i]);
    return key;
}

dmat4 expandKey(const shader::MotionKey& key) {
    dmat4 matrix(1.0);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            matrix[column][row] = double(key.rows[row][column]);
    return matrix;
}

dmat4 interpolateKeys(std::span<const shader::MotionKey> keys, double s) {
    SHUTTER_CHECK(!keys.empty(), "keys of nothing");
    if (keys.size() == 1)
        return expandKey(keys[0]);
    const double at = std::clamp(s, 0.0, 1.0) * double(keys.size() - 1);
    const size_t first = std::min(static_cast<size_t>(at), keys.size() - 2);
    return mix(expandKey(keys[first]), expandKey(keys[first + 1]), at - double(first));
}

double KeyTolerance::of(const Bounds& swept) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const dvec3& place : cameraPath)
        nearest = std::min(nearest, measureDistance(place, swept));
    const double distance = std::max(std::isfinite(nearest) ? nearest : 0.0, near);
    const double visible = kKeyTolerancePx * (pixelAtOne * distance + pixelAnywhere);
    return std::max(visible, kFloatNoise * findLargestCoordinate(swept));
}

std::optional<MotionKeys>
computeMotionKeys(const MatrixAt& matrixAt, const Bounds& bounds, const KeyTolerance& tolerance) {
    SHUTTER_CHECK(!bounds.isEmpty(), "the motion of nothing");
    Bounds swept;
    bool moves = false;
    const dmat4 first = matrixAt(0.0);
    for (uint32_t i = 0; i <= kProbeIntervals; ++i) {
        const double odd = std::min((i + kOddPlace) / kProbeIntervals, 1.0);
        for (const double s : {double(i) / kProbeIntervals, odd}) {
            const dmat4 probe = matrixAt(s);
            if (!math::isFinite(probe))
                return std::nullopt;
            moves = moves || probe != first;
            swept.add(math::transformBounds(probe, bounds));
        }
    }
    MotionKeys result;
    if (!moves) {
        result.keys = {makeKey(first)};
        result.swept = math::transformBounds(expandKey(result.keys[0]), bounds);
        return result;
    }
    const double allowed = tolerance.of(swept);
    for (uint32_t intervals = 1;; intervals *= 2) {
        result.keys = sampleKeys(matrixAt, intervals);
        result.followsExactly = follows(result.keys, matrixAt, bounds, allowed);
        if (result.followsExactly || intervals == kMaxKeyIntervals)
            break;
    }
    // Between two keys each point goes straight, so the boxes at the keys hold it.
    for (const shader::MotionKey& key : result.keys) {
        const dmat4 matrix = expandKey(key);
        if (!math::isFinite(matrix))
            return std::nullopt;
        result.swept.add(math::transformBounds(matrix, bounds));
    }
    return result;
}

std::optional<MotionKeys> computeCameraKeys(
    const MatrixAt& relWorldFromView, const math::dvec2& halfExtents, const KeyTolerance& tolerance
) {
    // At the near plane the camera's translation has its largest effect on the picture, and its
    // rotation the same as anywhere.
    const bool perspective = tolerance.pixelAtOne > 0.0;
    const dvec3 corner =
        perspective ? dvec3(halfExtents, 1.0) * tolerance.near : dvec3(halfExtents, tolerance.near);
    Bounds view;
    view.add(-corner);
    view.add(dvec3(corner.x, corner.y, 0.0));
    KeyTolerance own = tolerance;
    own.cameraPath = {};
    return computeMotionKeys(relWorldFromView, view, own);
}

} // namespace shutter::extract
