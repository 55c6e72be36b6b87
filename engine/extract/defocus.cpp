// SPDX-License-Identifier: MIT
#include "engine/extract/defocus.h"

#include "engine/extract/frame_view.h"
#include "engine/scene/lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace shutter::extract {

namespace {

using math::dvec3;
using math::dvec4;

using Polygon = std::vector<dvec4>; ///< its corners, clip space

constexpr double kFarthestDepth = std::numeric_limits<double>::infinity();

/// The part of a convex polygon on the side of a plane where its product with points is not
/// negative.
Polygon clip(const Polygon& polygon, const dvec4& plane) {
    Polygon inside;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const dvec4& from = polygon[i];
        const dvec4& to = polygon[(i + 1) % polygon.size()];
        const double a = glm::dot(plane, from);
        const double b = glm::dot(plane, to);
        if (a >= 0.0)
            inside.push_back(from);
        if ((a >= 0.0) != (b >= 0.0))
            inside.push_back(glm::mix(from, to, a / (a - b)));
    }
    return inside;
}

/// Least depth of the part of a face that is in sight; infinity: none is.
double nearestInSight(Polygon face) {
    // A perspective camera's clip w is the depth.
    for (const int axis : {0, 1})
        for (const double side : {-1.0, 1.0}) {
            dvec4 plane(0.0, 0.0, 0.0, 1.0);
            plane[axis] = side;
            face = clip(face, plane);
        }
    double nearest = kFarthestDepth;
    for (const dvec4& corner : face)
        nearest = std::min(nearest, corner.w);
    return nearest;
}

/// Where the camera is, in the space that is projected.
dvec3 findEye(const math::dmat4& clipFromObject) {
    const dvec4 eye = glm::inverse(clipFromObject) * dvec4(0.0, 0.0, 1.0, 0.0);
    return dvec3(eye) / eye.w;
}

bool contains(const math::Bounds& bounds, const dvec3& point) {
    return glm::all(glm::greaterThanEqual(point, bounds.min)) &&
           glm::all(glm::lessThanEqual(point, bounds.max));
}

/// \return infinity: no part of the box is in sight; 0: the camera is in it
double nearestInSight(const math::dmat4& clipFromObject, const math::Bounds& bounds) {
    std::array<dvec4, 8> corners;
    for (size_t i = 0; i < corners.size(); ++i)
        corners[i] = clipFromObject * dvec4(
                                          i & 1 ? bounds.max.x : bounds.min.x,
                                          i & 2 ? bounds.max.y : bounds.min.y,
                                          i & 4 ? bounds.max.z : bounds.min.z,
                                          1.0
                                      );
    if (contains(bounds, findEye(clipFromObject)))
        return 0.0;
    double nearest = kFarthestDepth;
    constexpr std::array<std::array<size_t, 4>, 6> kFaces{
        {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
    for (const auto& face : kFaces)
        nearest = std::min(
            nearest,
            nearestInSight({corners[face[0]], corners[face[1]], corners[face[2]], corners[face[3]]})
        );
    return nearest;
}

/// What the lens is to the picture at a shutter time.
struct Lens {
    scene::CameraLens lens;
    double radius = 0.0; ///< of its longer half axis, metres
    double pixelsPerUnit = 0.0;
    math::dmat4 clipFromWorld{1.0};

    [[nodiscard]] bool spreads(double depth) const {
        return !(
            scene::computeConfusionDiameter(lens, radius, depth, pixelsPerUnit) <= kLeastDefocusPx
        );
    }
};

Lens makeLens(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    double s
) {
    const auto& camera = world.registry.get<scene::Camera>(view.camera);
    const double yFov = motion.cameraYFov(s);
    Lens lens;
    lens.lens = motion.cameraLens(s);
    lens.radius = scene::computeLensRadius(lens.lens, yFov) * std::max(lens.lens.squeeze, 1.0);
    lens.pixelsPerUnit = view.height / (2.0 * std::abs(computeHalfExtents(camera, yFov, view).y));
    lens.clipFromWorld =
        makeProjection(camera, yFov, view) * glm::inverse(motion.worldFromCamera(s));
    return lens;
}

} // namespace

bool isDefocused(
    const scene::World& world,
    const ViewRequest& view,
    const scene::ExposureMotion& motion,
    const ExtractedFrame& frame,
    const SceneLayout& layout
) {
    if (!view.usesLens)
        return false;
    for (const double s : {0.0, 0.5, 1.0}) {
        const Lens lens = makeLens(world, view, motion, s);
        if (lens.radius == 0.0)
            continue;
        if (lens.spreads(kFarthestDepth))
            return true;
        for (uint32_t row = 0; row < frame.entityHandles.size(); ++row) {
            const math::dmat4 worldFromObject = motion.worldFromObject(frame.entityHandles[row], s);
            const math::Bounds& bounds = findRowBounds(frame, layout, row);
            const double nearest = nearestInSight(lens.clipFromWorld * worldFromObject, bounds);
            if (nearest < kFarthestDepth && lens.spreads(nearest))
                return true;
        }
    }
    return false;
}

} // namespace shutter::extract
