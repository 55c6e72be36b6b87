// SPDX-License-Identifier: MIT
#include "engine/extract/deformation_keys.h"

#include "engine/core/check.h"
#include "engine/extract/deformed_entity.h"
#include "engine/math/transform.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace shutter::extract {

namespace {

using math::Bounds;
using math::dmat4;
using math::dvec3;
using scene::Deformation;
using scene::PoseReach;

dmat4 mix(const dmat4& a, const dmat4& b, double t) {
    return a * (1.0 - t) + b * t;
}

/// Upper bound of how much longer the matrix's linear part makes a vector: the root of its largest
/// sums of columns and of rows; 1 for the identity.
double measureStretch(const dmat4& matrix) {
    double columns = 0.0;
    double rows = 0.0;
    for (int i = 0; i < 3; ++i) {
        double column = 0.0;
        double row = 0.0;
        for (int j = 0; j < 3; ++j) {
            column += std::abs(matrix[i][j]);
            row += std::abs(matrix[j][i]);
        }
        columns = std::max(columns, column);
        rows = std::max(rows, row);
    }
    return std::sqrt(columns * rows);
}

/// Length of the longest vector in the box; 0 for an empty one.
double measureLongest(const Bounds& bounds) {
    if (bounds.isEmpty())
        return 0.0;
    return glm::length(glm::max(glm::abs(bounds.min), glm::abs(bounds.max)));
}

double weightOf(const Deformation& pose, size_t target) {
    return target < pose.morphWeights.size() ? pose.morphWeights[target] : 0.0;
}

/// What morph targets and waves do between two keys, metres before skinning.
struct DisplacementDeviation {
    double off = 0.0;   ///< of the displacement from its straight way
    double way = 0.0;   ///< from one key to the other
    double reach = 0.0; ///< farthest that it moves a vertex from rest
};

/// A wave as what sine and cosine of the place's phase are multiplied with: the displacement of
/// each vertex is linear in them.
struct Phasor {
    dvec3 sine;
    dvec3 cosine;

    explicit Phasor(const scene::WavePose::Wave& wave)
        : sine(wave.displacement * std::sin(wave.phase)),
          cosine(wave.displacement * std::cos(wave.phase)) {}

    Phasor(const dvec3& s, const dvec3& c) : sine(s), cosine(c) {}

    [[nodiscard]] double length() const {
        return std::hypot(glm::length(sine), glm::length(cosine));
    }
};

Phasor operator-(const Phasor& a, const Phasor& b) {
    return {a.sine - b.sine, a.cosine - b.cosine};
}

Phasor mix(const Phasor& a, const Phasor& b, double t) {
    return {glm::mix(a.sine, b.sine, t), glm::mix(a.cosine, b.cosine, t)};
}

/// \param farthest of a vertex from the object's origin before the waves, metres
void addWaves(
    const Deformation& exact,
    const Deformation& a,
    const Deformation& b,
    double t,
    double farthest,
    DisplacementDeviation& sum
) {
    for (size_t i = 0; i < exact.waves.waves.size(); ++i) {
        const scene::WavePose::Wave& at = exact.waves.waves[i];
        const scene::WavePose::Wave& from = a.waves.waves.at(i);
        const scene::WavePose::Wave& to = b.waves.waves.at(i);
        const double change = (Phasor(to) - Phasor(from)).length();
        const double longest =
            std::max({Phasor(at).length(), Phasor(from).length(), Phasor(to).length()});
        // Where the wave turns, the phase of a vertex at p changes by the turn times p. From
        // exp(-ix) = 1 - ix within x^2 / 2, on either side of the straight way.
        const double turn = farthest * glm::length(to.waveVector - from.waveVector);
        const double offTurn =
            farthest * glm::length(at.waveVector - glm::mix(from.waveVector, to.waveVector, t));
        sum.off += (Phasor(at) - mix(Phasor(from), Phasor(to), t)).length() + longest * offTurn +
                   t * (1.0 - t) * turn * (change + longest * turn / 2.0);
        sum.way += change + longest * turn;
        sum.reach += longest;
    }
}

DisplacementDeviation measureDisplacement(
    const Deformation& exact,
    const Deformation& a,
    const Deformation& b,
    double t,
    const PoseReach& reach
) {
    DisplacementDeviation result;
    for (size_t target = 0; target < reach.targets.size(); ++target) {
        const double longest = measureLongest(reach.targets[target]);
        const double from = weightOf(a, target);
        const double to = weightOf(b, target);
        const double at = weightOf(exact, target);
        result.off += longest * std::abs(at - std::lerp(from, to, t));
        result.way += longest * std::abs(to - from);
        result.reach += longest * std::max({std::abs(from), std::abs(to), std::abs(at)});
    }
    addWaves(exact, a, b, t, measureLongest(reach.rest) + result.reach, result);
    return result;
}

std::vector<Deformation> sampleShapes(const DeformationAt& deformAt, uint32_t intervals) {
    std::vector<Deformation> keys;
    keys.reserve(intervals + 1);
    for (uint32_t i = 0; i <= intervals; ++i)
        keys.push_back(deformAt(double(i) / intervals));
    return keys;
}

bool follows(
    std::span<const Deformation> keys,
    const DeformationAt& deformAt,
    const PoseReach& reach,
    double tolerance
) {
    const auto intervals = static_cast<uint32_t>(keys.size() - 1);
    const uint32_t parts = std::max(4u, kProbeIntervals / intervals);
    for (uint32_t i = 0; i < intervals; ++i)
        for (uint32_t part = 0; part < parts; ++part) {
            const double t = part == 0 ? kOddPlace : double(part) / parts;
            const Deformation exact = deformAt((i + t) / intervals);
            // Written so that NaN does not follow.
            if (!(measureDeformationDeviation(exact, keys[i], keys[i + 1], t, reach) <= tolerance))
                return false;
        }
    return true;
}

/// Evaluates the shape at the probe times. Nothing where it is not finite at one of them.
struct Sweep {
    Bounds bounds;
    bool changes = false;
};

std::optional<Sweep> sweep(const DeformationAt& deformAt, const PoseReach& reach) {
    Sweep result;
    const Deformation first = deformAt(0.0);
    const double rounding = measureRounding(scene::computeDeformedBounds(reach, first));
    for (uint32_t i = 0; i <= kProbeIntervals; ++i) {
        const double odd = std::min((i + kOddPlace) / kProbeIntervals, 1.0);
        for (const double s : {double(i) / kProbeIntervals, odd}) {
            const Deformation probe = deformAt(s);
            if (!isFinite(probe, reach))
                return std::nullopt;
            result.changes = result.changes || !isNear(probe, first, reach, rounding);
            result.bounds.add(scene::computeDeformedBounds(reach, probe));
        }
    }
    return result;
}

/// Adds what `extra` (object space) sweeps on the object's way.
void growSwept(MotionKeys& object, const Bounds& extra) {
    for (const shader::MotionKey& key : object.keys)
        object.swept.add(math::transformBounds(expandKey(key), extra));
}

} // namespace

double measureDeformationDeviation(
    const Deformation& exact,
    const Deformation& a,
    const Deformation& b,
    double t,
    const PoseReach& reach
) {
    // For v(s) = M(s) (p + d(s)), with M and d a vertex's blended matrix and its displacement,
    // the straight way from key to key is M' (p + d') + t (1 - t) (M_b - M_a) (d_b - d_a), with M'
    // and d' on their own straight ways.
    const DisplacementDeviation displacement = measureDisplacement(exact, a, b, t, reach);
    const size_t jointCount = std::min(reach.joints.size(), exact.objectFromBind.size());
    if (exact.objectFromBind.empty())
        return displacement.off;
    double largest = 0.0;
    for (size_t i = 0; i < jointCount; ++i) {
        if (reach.joints[i].isEmpty())
            continue;
        const dmat4& from = a.objectFromBind[i];
        const dmat4& to = b.objectFromBind[i];
        const dmat4& at = exact.objectFromBind[i];
        const dmat4 straight = mix(from, to, t);
        const double deviation = measureDeviation(at, straight, reach.joints[i]) +
                                 measureStretch(at - straight) * displacement.reach +
                                 measureStretch(straight) * displacement.off +
                                 t * (1.0 - t) * measureStretch(to - from) * displacement.way;
        // Written so that NaN comes through.
        largest = deviation <= largest ? largest : deviation;
    }
    return largest;
}

std::optional<DeformedMotion> computeDeformedMotion(
    const MatrixAt& objectAt,
    const DeformationAt& deformAt,
    const PoseReach& reach,
    const KeyTolerance& tolerance
) {
    const std::optional<Sweep> swept = sweep(deformAt, reach);
    if (!swept || swept->bounds.isEmpty())
        return std::nullopt;
    auto object = computeMotionKeys(objectAt, swept->bounds, tolerance);
    if (!object)
        return std::nullopt;
    DeformedMotion result{std::move(*object), {}};
    result.shape.swept = swept->bounds;
    if (!swept->changes) {
        result.shape.keys = {deformAt(0.0)};
        return result;
    }
    double stretch = 0.0;
    for (const shader::MotionKey& key : result.object.keys)
        stretch = std::max(stretch, measureStretch(expandKey(key)));
    // An object scaled to nothing shows no shape.
    const double allowed = stretch > 0.0 ? tolerance.of(result.object.swept) / stretch
                                         : std::numeric_limits<double>::infinity();
    for (uint32_t intervals = 1;; intervals *= 2) {
        result.shape.keys = sampleShapes(deformAt, intervals);
        result.shape.followsExactly = follows(result.shape.keys, deformAt, reach, allowed);
        if (result.shape.followsExactly || intervals == kMaxDeformationIntervals)
            break;
    }
    // Between two keys each vertex goes straight, so the boxes at the keys hold it.
    for (const Deformation& key : result.shape.keys) {
        if (!isFinite(key, reach))
            return std::nullopt;
        result.shape.swept.add(scene::computeDeformedBounds(reach, key));
    }
    growSwept(result.object, result.shape.swept);
    return result;
}

} // namespace shutter::extract
