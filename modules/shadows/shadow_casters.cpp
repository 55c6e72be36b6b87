// SPDX-License-Identifier: MIT
#include "modules/shadows/shadow_casters.h"

#include "engine/extract/extracted_frame.h"

#include <algorithm>
#include <cmath>

namespace shutter::shadows {

namespace {

using math::dmat3;
using math::dmat4;
using math::dvec3;
using math::dvec4;

/// Least extent of a caster's box, of its largest: planes have a form too.
constexpr double kThinnest = 0.02;

/// Angle in radians by which a caster as thick as it is wide turns relative to a light before its
/// outline is drawn again. Drawn for the middle of such a turn, points in front of or behind its
/// centre are off by a sixteenth of their distance from it. Flat casters may turn farther: within
/// their plane the lookup is exact.
constexpr double kTurnOfPart = 0.125;
constexpr double kMaxTurnOfPart = 0.25; ///< however flat it is

Sphere boundSphere(const dmat4& worldFromObject, const math::Bounds& bounds) {
    const math::Bounds box = math::transformBounds(worldFromObject, bounds);
    Sphere sphere{dvec3(worldFromObject * dvec4(bounds.centre(), 1.0)), 0.0};
    for (int corner = 0; corner < 8; ++corner) {
        const dvec3 point(
            corner & 1 ? bounds.max.x : bounds.min.x,
            corner & 2 ? bounds.max.y : bounds.min.y,
            corner & 4 ? bounds.max.z : bounds.min.z
        );
        const dvec3 placed(worldFromObject * dvec4(point, 1.0));
        sphere.radius = std::max(sphere.radius, glm::length(placed - sphere.centre));
    }
    // A plane seen from its edge has a sphere too.
    sphere.radius = std::max(sphere.radius, 1.0e-6 * (1.0 + glm::length(box.size())));
    return sphere;
}

double findThinness(const dmat4& worldFromObject, const math::Bounds& bounds) {
    dvec3 size = bounds.size();
    for (int axis = 0; axis < 3; ++axis)
        size[axis] *= glm::length(dvec3(worldFromObject[axis]));
    const double largest = std::max({size.x, size.y, size.z});
    if (!(largest > 0.0))
        return 1.0;
    return std::max(std::min({size.x, size.y, size.z}) / largest, kThinnest);
}

dmat3 makeShape(const dmat4& worldFromObject, const math::Bounds& bounds) {
    const dvec3 size = bounds.size();
    const double largest = std::max({size.x, size.y, size.z});
    if (!(largest > 0.0))
        return dmat3(1.0);
    const dmat3 objectFromWorld = glm::inverse(dmat3(worldFromObject));
    dmat3 squares(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const double share = std::max(size[axis] / largest, kThinnest);
        squares[axis][axis] = 1.0 / (share * share);
    }
    const dmat3 shape = glm::transpose(objectFromWorld) * squares * objectFromWorld;
    // Only its proportions count, and single precision has to hold it.
    const double trace = shape[0][0] + shape[1][1] + shape[2][2];
    return std::isfinite(trace) && trace > 0.0 ? shape / trace : dmat3(1.0);
}

/// Blend factor among the shapes at open, raster instant and close (ShadowDraw::shapeShift).
float findShapeShift(const extract::ShutterTimes& times, double s) {
    const double end = s < times.raster ? times.open : times.close;
    if (end == times.raster)
        return 0.0f;
    const double share = std::clamp((s - times.raster) / (end - times.raster), 0.0, 1.0);
    return float(s < times.raster ? -share : share);
}

} // namespace

ShadowCaster makeShadowCaster(
    const extract::ExtractedFrame& frame,
    const extract::SceneLayout& layout,
    uint32_t row,
    const dvec3& eye
) {
    const dmat4& worldFromObject = frame.worldFromObject[row];
    math::Bounds bounds = extract::findRowBounds(frame, layout, row);
    ShadowCaster caster;
    caster.row = row;
    if (const extract::DeformedEntity* deformed = extract::findDeformed(frame, row);
        deformed && deformed->changes) {
        caster.deforms = true;
        const scene::PoseReach& reach = layout.reaches[deformed->mesh];
        bounds.add(scene::computeDeformedBounds(reach, deformed->open));
        bounds.add(scene::computeDeformedBounds(reach, deformed->close));
    }
    caster.sphere = boundSphere(worldFromObject, bounds);
    caster.shape = makeShape(worldFromObject, bounds);
    caster.thinness = findThinness(worldFromObject, bounds);
    const double distance = glm::length(caster.sphere.centre - eye);
    caster.seenSize = caster.sphere.radius / std::max(distance, caster.sphere.radius);
    return caster;
}

CasterPath followCaster(
    const ShadowCaster& caster,
    const extract::FrameView& view,
    const extract::ExtractedFrame& frame,
    uint32_t count
) {
    const dmat4 objectFromRaster = glm::inverse(frame.worldFromObject[caster.row]);
    CasterPath path;
    math::Bounds centres;
    bool moves = caster.deforms;
    for (const double s : scene::middlesOfLight(view.motion().exposure(), count)) {
        const dmat4 instant = view.motion().worldFromObject(frame.entityHandles[caster.row], s);
        const dmat4 motion = extract::isDrawable(instant) ? instant * objectFromRaster : dmat4(1.0);
        moves = moves || motion != dmat4(1.0);
        centres.add(dvec3(motion * dvec4(caster.sphere.centre, 1.0)));
        path.instants.push_back(
            {glm::inverse(motion), caster.deforms ? findShapeShift(view.times(), s) : 0.0f}
        );
    }
    if (!moves)
        return {{}, caster.sphere};
    path.swept = {
        centres.centre(), 1.01 * caster.sphere.radius + 0.5 * glm::length(centres.size())};
    return path;
}

LightPlace seeLight(const dmat4& rasterFromInstant, const LightPlace& light) {
    const dvec4 seen = rasterFromInstant * light;
    return light.w == 0.0 ? dvec4(glm::normalize(dvec3(seen)), 0.0) : dvec4(dvec3(seen), 1.0);
}

uint32_t
countParts(const ShadowCaster& caster, const CasterPath& path, std::span<const LightPlace> lights) {
    const auto count = static_cast<uint32_t>(path.instants.size());
    if (count < 2)
        return 0;
    double turned = 0.0;
    for (const LightPlace& light : lights) {
        double own = 0.0;
        dvec3 last(0.0);
        for (const CasterInstant& instant : path.instants) {
            const LightPlace seen = seeLight(instant.rasterFromInstant, light);
            const dvec3 way =
                seen.w == 0.0 ? dvec3(seen) : glm::normalize(dvec3(seen) - caster.sphere.centre);
            if (&instant != path.instants.data())
                own += std::acos(std::clamp(glm::dot(way, last), -1.0, 1.0));
            last = way;
        }
        turned = std::max(turned, own);
    }
    const double turn = std::min(kTurnOfPart / caster.thinness, kMaxTurnOfPart);
    const double wanted = caster.deforms ? kMaxCasterParts : std::ceil(turned / turn);
    const auto parts =
        static_cast<uint32_t>(std::clamp(wanted, 0.0, double(std::min(kMaxCasterParts, count))));
    return parts < 2 ? 0 : parts;
}

} // namespace shutter::shadows
