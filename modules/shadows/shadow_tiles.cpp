// SPDX-License-Identifier: MIT
#include "modules/shadows/shadow_tiles.h"

#include "shaders/shadows/shadow_shared.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace shutter::shadows {

namespace {

using math::dvec2;
using math::dvec3;
using math::dvec4;

/// Margin around a box for rounding errors of the shader's single precision.
constexpr double kMarginPx = 1.0;

/// How far along `way` a sphere may go before it has left a box.
double findExit(const Sphere& sphere, const dvec3& way, const math::Bounds& box) {
    double exit = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (way[axis] == 0.0)
            continue;
        const double side =
            way[axis] > 0.0 ? box.max[axis] + sphere.radius : box.min[axis] - sphere.radius;
        exit = std::min(exit, (side - sphere.centre[axis]) / way[axis]);
    }
    return std::max(exit, 0.0);
}

double findFarthest(const dvec3& point, const math::Bounds& box) {
    return glm::length(glm::max(glm::abs(box.min - point), glm::abs(box.max - point)));
}

/// The sphere that the caster's shadow ends in: all of the shadow lies between the two.
/// \return nothing: the light is in the caster
std::optional<Sphere>
findEnd(const Sphere& caster, const LightPlace& light, const math::Bounds& scene) {
    if (light.w == 0.0) {
        const dvec3 way = -dvec3(light);
        return Sphere{caster.centre + way * findExit(caster, way, scene), caster.radius};
    }
    const dvec3 place(light);
    const dvec3 offset = caster.centre - place;
    // The tangent's length. A ray leaves the caster no nearer than that, so that the caster,
    // grown by this factor away from the light, holds the farthest receiver of each ray.
    const double tangent2 = glm::dot(offset, offset) - caster.radius * caster.radius;
    if (!(tangent2 > 0.0))
        return std::nullopt;
    const double growth = std::max(findFarthest(place, scene) / std::sqrt(tangent2), 1.0);
    return Sphere{place + offset * growth, caster.radius * growth};
}

/// Grows a box by the picture of the cube around a sphere. False: some of it is not before the
/// camera.
bool addCube(PixelBox& box, const ShadowPicture& picture, const Sphere& sphere) {
    for (int corner = 0; corner < 8; ++corner) {
        const dvec3 offset(
            corner & 1 ? sphere.radius : -sphere.radius,
            corner & 2 ? sphere.radius : -sphere.radius,
            corner & 4 ? sphere.radius : -sphere.radius
        );
        const dvec4 clip = picture.clipFromWorld * dvec4(sphere.centre + offset, 1.0);
        if (!(clip.w > 1.0e-6)) // NaN too
            return false;
        const dvec2 at = (dvec2(clip) / clip.w * 0.5 + 0.5) * dvec2(picture.sizePx);
        if (!std::isfinite(at.x) || !std::isfinite(at.y))
            return false;
        box.min = glm::min(box.min, at - kMarginPx);
        box.max = glm::max(box.max, at + kMarginPx);
    }
    return true;
}

} // namespace

std::optional<PixelBox>
boundShadow(const ShadowPicture& picture, const Sphere& caster, const LightPlace& light) {
    const std::optional<Sphere> end = findEnd(caster, light, picture.scene);
    PixelBox box{
        dvec2(std::numeric_limits<double>::infinity()),
        dvec2(-std::numeric_limits<double>::infinity())};
    if (!end || !addCube(box, picture, caster) || !addCube(box, picture, *end))
        return std::nullopt;
    return box;
}

double findShadowWidth(const ShadowPicture& picture, const Sphere& caster, const dvec3& toLight) {
    const double reach = findExit(caster, -toLight, picture.scene);
    const double along = glm::dot(caster.centre - picture.eye, toLight);
    const dvec3 nearest = caster.centre - toLight * std::clamp(along, 0.0, reach);
    const double distance = std::max(glm::length(nearest - picture.eye) - caster.radius, 0.0);
    const double pixel = picture.pixelFootprint.x * distance + picture.pixelFootprint.y;
    return 2.0 * caster.radius / pixel;
}

ShadowTiles::ShadowTiles(const math::uvec2& sizePx)
    : mAcross((sizePx.x + shader::kChangingTilePx - 1) / shader::kChangingTilePx),
      mDown((sizePx.y + shader::kChangingTilePx - 1) / shader::kChangingTilePx),
      mMovers(size_t{mAcross} * mDown, 0) {}

void ShadowTiles::mark(uint32_t mover, const std::optional<PixelBox>& box) {
    const auto tilesOf = [&](int axis, uint32_t count) {
        if (!box)
            return std::pair(0u, count);
        const double tile = shader::kChangingTilePx;
        const auto clampTile = [&](double at) {
            return uint32_t(std::clamp(at, 0.0, double(count)));
        };
        return std::pair(
            clampTile(std::floor(box->min[axis] / tile)),
            clampTile(std::floor(box->max[axis] / tile) + 1.0)
        );
    };
    const auto [left, right] = tilesOf(0, mAcross);
    const auto [top, bottom] = tilesOf(1, mDown);
    for (uint32_t y = top; y < bottom; ++y)
        for (uint32_t x = left; x < right; ++x)
            mMovers[size_t{y} * mAcross + x] |= 1u << mover;
}

} // namespace shutter::shadows
