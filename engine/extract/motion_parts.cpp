// SPDX-License-Identifier: MIT
#include "engine/extract/motion_parts.h"

#include "engine/extract/motion_keys.h"
#include "engine/extract/row_bounds.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/motion.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace shutter::extract {

namespace {

using math::dmat4;
using math::dvec3;

constexpr uint32_t kProbes = 64;
constexpr double kStraight = 0.9;
/// What bends moves along arcs that its box does not tell.
constexpr uint32_t kDeformedParts = 4;

/// A box's way through the exposure, metres.
struct Way {
    double length = 0.0;
    uint32_t parts = 0; ///< whose chords are nearly as long; 0: it stands still
};

template <class MatrixAt> Way measureWay(const math::Bounds& bounds, const MatrixAt& matrixAt) {
    std::array<dmat4, kProbes + 1> matrices;
    for (uint32_t i = 0; i <= kProbes; ++i)
        matrices[i] = matrixAt(double(i) / kProbes);
    const auto sumChords = [&](uint32_t parts) {
        double sum = 0.0;
        for (uint32_t i = 0, step = kProbes / parts; i < kProbes; i += step)
            sum += measureDeviation(matrices[i], matrices[i + step], bounds);
        return sum;
    };
    Way way;
    way.length = sumChords(kProbes);
    if (!(way.length > 0.0) || !std::isfinite(way.length))
        return {};
    way.parts = 1;
    while (way.parts < kMaxMotionParts && sumChords(way.parts) < kStraight * way.length)
        way.parts *= 2;
    return way;
}

/// How many parts the corners of the view take, `distance` metres ahead of the camera.
uint32_t countCameraParts(const scene::ExposureMotion& motion, double distance) {
    math::Bounds ahead;
    ahead.add(dvec3(-distance, -distance, -distance));
    ahead.add(dvec3(distance, distance, -distance));
    return measureWay(ahead, [&](double s) { return motion.worldFromCamera(s); }).parts;
}

bool movesAnyLight(const scene::World& world) {
    for (auto [entity, light] : world.registry.view<scene::Light>()) {
        (void)light;
        if (scene::mayMove(world, entity))
            return true;
    }
    return false;
}

} // namespace

MotionParts planMotionParts(
    const scene::World& world,
    const SceneLayout& layout,
    const ExtractedFrame& frame,
    const ViewRequest& view
) {
    const scene::ExposureMotion motion(world, view.camera, view.exposure);
    MotionParts plan;
    // Near things show how the camera travels, far ones how it turns.
    for (const double distance : {1.0, 1000.0})
        plan.count = std::max(plan.count, countCameraParts(motion, distance));
    if (motion.mayCameraZoom())
        plan.count = std::max(plan.count, 1u);
    const bool castsShadows = view.shadows.mode != ShadowMode::None && !view.unlit;
    const dvec3 eye(motion.worldFromCamera(view.exposure.rasterTime)[3]);
    for (const uint32_t row : frame.movingRows) {
        const ecs::Entity entity = frame.entityHandles[row];
        const math::Bounds& bounds = findRowBounds(frame, layout, row);
        const auto worldAt = [&](double s) { return motion.worldFromObject(entity, s); };
        const Way way = measureWay(bounds, worldAt);
        plan.count = std::max(plan.count, way.parts);
        if (motion.mayDeform(entity))
            plan.count = std::max(plan.count, kDeformedParts);
        if (!castsShadows || !(way.length > 0.0))
            continue;
        const dvec3 centre(worldAt(view.exposure.rasterTime) * math::dvec4(bounds.centre(), 1.0));
        const math::vec2 footprint = frame.constants.pixelFootprint;
        const double pixel = footprint.x * glm::length(centre - eye) + footprint.y;
        if (pixel > 0.0)
            plan.casterPx = std::max(plan.casterPx, way.length / pixel);
    }
    plan.movesLight = !view.unlit && movesAnyLight(world);
    return plan;
}

} // namespace shutter::extract
