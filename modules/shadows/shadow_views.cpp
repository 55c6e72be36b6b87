// SPDX-License-Identifier: MIT
#include "modules/shadows/shadow_views.h"

#include "shaders/shadows/shadow_shared.h"

#include <algorithm>
#include <cmath>

namespace shutter::shadows {

namespace {

using math::dmat3;
using math::dmat4;
using math::dvec2;
using math::dvec3;
using math::dvec4;

/// Least share of the farthest distance that the first cascade begins at.
constexpr double kMinNearShare = 1.0 / 256.0;

/// Steps of a cascade's place, in its width.
constexpr double kStep = 1.0 / 8.0;

/// Texels at each edge that lookups stay away from: the filter's, and the offset along the normal.
constexpr double kMarginTexels = 6.0;

/// The next of the numbers 2^(n / steps) that is not less.
double roundUp(double value, double steps) {
    return std::exp2(std::ceil(std::log2(value) * steps - 1.0e-9) / steps);
}

/// From the light's axes, which turn the world only.
dmat4 makeOrthographic(
    const dmat3& axes, const dvec2& centre, double half, double farDepth, double nearDepth
) {
    const double depth = nearDepth - farDepth;
    dmat4 clip(1.0);
    clip[0][0] = clip[1][1] = 1.0 / half;
    clip[2][2] = 1.0 / depth;
    clip[3] = dvec4(-centre / half, -farDepth / depth, 1.0);
    return clip * dmat4(axes);
}

/// \param forward, up orthogonal, unit
dmat4 makePerspective(
    const dvec3& position, const dvec3& forward, const dvec3& up, double tangent, double near
) {
    const dmat3 axes = glm::transpose(dmat3(glm::cross(forward, up), up, forward));
    dmat4 clip(0.0);
    clip[0][0] = clip[1][1] = 1.0 / tangent;
    clip[3][2] = near; // depth near / distance
    clip[2][3] = 1.0;
    return clip * dmat4(axes) * glm::translate(dmat4(1.0), -position);
}

dvec3 findUp(const dvec3& forward) {
    const dmat3 axes = makeLightAxes(forward);
    return {axes[0].y, axes[1].y, axes[2].y};
}

/// Tangent of a view's half angle, widened by the texels that lookups stay away from.
double widen(double tangent, uint32_t sizePx) {
    return tangent / (1.0 - 2.0 * kMarginTexels / double(sizePx));
}

/// The scene as a light sees it.
struct SceneInLight {
    dmat3 axes{1.0};
    math::Bounds box;
    double farDepth = 0.0; ///< along the axis towards the light
    double nearDepth = 0.0;
};

SceneInLight lookFromLight(const dvec3& toLight, const math::Bounds& scene) {
    SceneInLight seen;
    seen.axes = makeLightAxes(toLight);
    seen.box = math::transformBounds(dmat4(seen.axes), scene);
    // Rounded outwards, so that movers in the scene do not change the depth range of all maps.
    const double extent = std::max(seen.box.max.z - seen.box.min.z, 1.0e-6);
    const double grid = roundUp(extent, 1.0) / 8.0;
    seen.farDepth = (std::floor(seen.box.min.z / grid) - 0.5) * grid;
    seen.nearDepth = (std::ceil(seen.box.max.z / grid) + 0.5) * grid;
    return seen;
}

/// Share of a cascade's half width that has to be left for its steps and its margin.
double usableShare(uint32_t sizePx) {
    return 1.0 - kStep - 2.0 * kMarginTexels / double(sizePx);
}

LightView makeCascade(const SceneInLight& seen, const dvec2& wanted, double half, uint32_t sizePx) {
    const double grid = 2.0 * half * kStep;
    const dvec2 centre = glm::floor(wanted / grid + 0.5) * grid;
    LightView view;
    view.clipFromWorld = makeOrthographic(seen.axes, centre, half, seen.farDepth, seen.nearDepth);
    view.texelMetres = 2.0 * half / double(sizePx);
    return view;
}

} // namespace

dmat3 makeLightAxes(const dvec3& toLight) {
    const dvec3 helper = std::abs(toLight.y) < 0.99 ? dvec3(0.0, 1.0, 0.0) : dvec3(1.0, 0.0, 0.0);
    const dvec3 right = glm::normalize(glm::cross(helper, toLight));
    return glm::transpose(dmat3(right, glm::cross(toLight, right), toLight));
}

Sphere boundSlice(const CameraSlice& camera, double from, double to) {
    const double reach2 = camera.cornerReach * camera.cornerReach;
    double centre = (from + to) / 2.0;
    double radius2 = 0.0;
    if (camera.isPerspective) {
        // As far from the corners in front as from those behind, unless these alone are enough.
        centre = std::min(centre * (1.0 + reach2), to);
        radius2 = (to - centre) * (to - centre) + to * to * reach2;
    } else {
        radius2 = (to - centre) * (to - centre) + reach2;
    }
    return {camera.eye + camera.forward * centre, std::sqrt(radius2)};
}

std::vector<LightView> fitCascades(
    const CameraSlice& camera,
    const dvec3& toLight,
    const math::Bounds& scene,
    double farthest,
    uint32_t sizePx
) {
    const SceneInLight seen = lookFromLight(toLight, scene);
    const dvec2 sceneSize = dvec2(seen.box.size());
    const double sceneHalf = std::max({sceneSize.x, sceneSize.y, 1.0e-6}) / 2.0;
    const double whole = roundUp(sceneHalf / usableShare(sizePx), 8.0);
    const double last = roundUp(farthest, 2.0);
    const double first = std::min(std::max(camera.near, last * kMinNearShare), last / 2.0);
    std::vector<LightView> views;
    double from = first;
    for (uint32_t i = 1; i <= kMaxCascades; ++i) {
        const double share = double(i) / kMaxCascades;
        // Equal ratios: a texel is as wide in the picture everywhere (Zhang et al. 2006,
        // "Parallel-Split Shadow Maps").
        const double to = first * std::pow(last / first, share);
        const Sphere slice = boundSlice(camera, from, to);
        const double half = roundUp(slice.radius / usableShare(sizePx), 4.0);
        if (half >= whole) {
            views.push_back(makeCascade(seen, dvec2(seen.box.centre()), whole, sizePx));
            break;
        }
        views.push_back(makeCascade(seen, dvec2(seen.axes * slice.centre), half, sizePx));
        from = to;
    }
    return views;
}

LightView fitSpot(
    const dvec3& position, const dvec3& direction, double halfAngle, double near, uint32_t sizePx
) {
    const double tangent = widen(std::tan(std::clamp(halfAngle, 1.0e-3, kWidestSpot)), sizePx);
    return {
        makePerspective(position, direction, findUp(direction), tangent, near),
        2.0 * tangent / double(sizePx)};
}

std::array<LightView, 6> fitCube(const dvec3& position, double near, uint32_t sizePx) {
    const double tangent = widen(1.0, sizePx);
    std::array<LightView, 6> views;
    for (int face = 0; face < 6; ++face) {
        dvec3 forward(0.0);
        forward[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
        views[size_t(face)] = {
            makePerspective(position, forward, findUp(forward), tangent, near),
            2.0 * tangent / double(sizePx)};
    }
    return views;
}

LightView fitLayer(const dvec3& toLight, const Sphere& mover, uint32_t sizePx) {
    const dmat3 axes = makeLightAxes(toLight);
    const dvec3 centre = axes * mover.centre;
    const double half = widen(mover.radius, sizePx);
    return {
        makeOrthographic(
            axes,
            dvec2(centre),
            half,
            centre.z - 1.01 * mover.radius,
            centre.z + 1.01 * mover.radius
        ),
        2.0 * half / double(sizePx)};
}

bool fitsPointLayer(const dvec3& position, const Sphere& mover) {
    return glm::length(mover.centre - position) > 1.5 * mover.radius;
}

LightView fitPointLayer(const dvec3& position, const Sphere& mover, uint32_t sizePx) {
    const dvec3 offset = mover.centre - position;
    const double distance = glm::length(offset);
    const dvec3 forward = offset / distance;
    const double tangent =
        widen(mover.radius / std::sqrt(distance * distance - mover.radius * mover.radius), sizePx);
    const double near = 0.5 * (distance - mover.radius);
    return {
        makePerspective(position, forward, findUp(forward), tangent, near),
        2.0 * tangent / double(sizePx)};
}

} // namespace shutter::shadows
