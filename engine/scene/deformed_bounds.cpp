// SPDX-License-Identifier: MIT
#include "engine/scene/deformed_bounds.h"

#include "engine/core/check.h"
#include "engine/math/transform.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace shutter::scene {

using math::Bounds;
using math::dvec3;

namespace {

constexpr double kRoundingMargin =
    1e-6; // of the largest coordinate; eight rounded weights miss 1 by less

void addVertex(std::vector<Bounds>& joints, size_t joint, const dvec3& position) {
    if (joint >= joints.size())
        joints.resize(joint + 1);
    joints[joint].add(position);
}

void addJoints(const Primitive& primitive, std::vector<Bounds>& joints) {
    const size_t influences = primitive.influenceCount;
    for (size_t vertex = 0; vertex < primitive.positions.size(); ++vertex) {
        const dvec3 position(primitive.positions[vertex]);
        if (influences == 0)
            addVertex(joints, 0, position);
        for (size_t i = vertex * influences; i < (vertex + 1) * influences; ++i) {
            if (primitive.weights[i] > 0.0f)
                addVertex(joints, primitive.joints[i], position);
        }
    }
}

void addTargets(const Primitive& primitive, std::vector<Bounds>& targets) {
    targets.resize(std::max(targets.size(), primitive.morphTargets.size()));
    for (size_t i = 0; i < primitive.morphTargets.size(); ++i) {
        // A target without positions moves none.
        if (primitive.morphTargets[i].positions.empty())
            targets[i].add(dvec3(0.0));
        for (const math::vec3& delta : primitive.morphTargets[i].positions)
            targets[i].add(dvec3(delta));
    }
}

/// Bounds of the waves' displacement of any vertex, which follows a share of them, [0, 1].
Bounds boundWaves(const WavePose& pose) {
    Bounds result;
    result.add(dvec3(0.0));
    for (const WavePose::Wave& wave : pose.waves) {
        const dvec3 crest = glm::abs(wave.displacement);
        result.min -= crest;
        result.max += crest;
    }
    return result;
}

/// Bounds of the displacement of any vertex by morph targets and waves.
Bounds boundDeltas(const PoseReach& reach, const Deformation& pose) {
    Bounds result = boundWaves(pose.waves);
    const std::vector<double>& weights = pose.morphWeights;
    if (weights.empty())
        return result;
    SHUTTER_CHECK(
        reach.targets.size() <= weights.size(),
        "{} weights for {} morph targets",
        weights.size(),
        reach.targets.size()
    );
    for (size_t i = 0; i < reach.targets.size(); ++i) {
        const dvec3 a = reach.targets[i].min * weights[i];
        const dvec3 b = reach.targets[i].max * weights[i];
        result.min += glm::min(a, b);
        result.max += glm::max(a, b);
    }
    return result;
}

Bounds growBy(const Bounds& bounds, const Bounds& deltas) {
    Bounds result = bounds;
    if (!bounds.isEmpty()) {
        result.min += deltas.min;
        result.max += deltas.max;
    }
    return result;
}

} // namespace

PoseReach computePoseReach(std::span<const Primitive> primitives) {
    PoseReach reach;
    for (const Primitive& primitive : primitives) {
        for (const math::vec3& position : primitive.positions)
            reach.rest.add(dvec3(position));
        addJoints(primitive, reach.joints);
        addTargets(primitive, reach.targets);
    }
    return reach;
}

Bounds computeDeformedBounds(const PoseReach& reach, const Deformation& deformation) {
    for (const double weight : deformation.morphWeights) {
        if (!std::isfinite(weight))
            return {};
    }
    const bool isSkinned = !deformation.objectFromBind.empty();
    if (reach.rest.isEmpty() || deformation.isRest())
        return reach.rest;

    const Bounds deltas = boundDeltas(reach, deformation);
    Bounds result;
    if (isSkinned) {
        SHUTTER_CHECK(
            reach.joints.size() <= deformation.objectFromBind.size(),
            "vertices deformed by joint {} of {}",
            reach.joints.size() - 1,
            deformation.objectFromBind.size()
        );
        // A vertex lies between the places that each of its joints alone would move it to.
        for (size_t i = 0; i < reach.joints.size(); ++i) {
            const math::dmat4& objectFromBind = deformation.objectFromBind[i];
            if (math::isFinite(objectFromBind))
                result.add(math::transformBounds(objectFromBind, growBy(reach.joints[i], deltas)));
        }
    } else {
        result = growBy(reach.rest, deltas);
    }
    if (result.isEmpty())
        return result;
    const dvec3 margin = kRoundingMargin * glm::max(glm::abs(result.min), glm::abs(result.max));
    return {result.min - margin, result.max + margin};
}

} // namespace shutter::scene
