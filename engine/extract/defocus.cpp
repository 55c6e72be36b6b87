// SPDX-License-Identifier: MIT
#include "engine/extract/defocus.h"

#include "engine/extract/frame_view.h"
#include "engine/extract/swept_scene.h"
#include "engine/scene/lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace shutter::extract {

namespace {

using math::dvec3;
using math::dvec4;

constexpr double kFarthestDepth = std::numeric_limits<double>::infinity();
/// Shutter times at which the picture is examined.
constexpr std::array kTimes{0.0, 0.25, 0.5, 0.75, 1.0};

/// Convex, in clip space. A face of a box gains a corner at each of the picture's four sides.
struct Polygon {
    std::array<dvec4, 8> corners;
    size_t count = 0;

    void add(const dvec4& corner) { corners[count++] = corner; }
};

/// The part of a polygon on the side of a plane where its product with points is not negative.
Polygon clip(const Polygon& polygon, const dvec4& plane) {
    Polygon inside;
    for (size_t i = 0; i < polygon.count; ++i) {
        const dvec4& from = polygon.corners[i];
        const dvec4& to = polygon.corners[(i + 1) % polygon.count];
        const double a = glm::dot(plane, from);
        const double b = glm::dot(plane, to);
        // What lies flat on the plane may round to more crossings than two.
        if (a >= 0.0 && inside.count < inside.corners.size())
            inside.add(from);
        if ((a >= 0.0) != (b >= 0.0) && inside.count < inside.corners.size())
            inside.add(glm::mix(from, to, a / (a - b)));
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
    for (size_t i = 0; i < face.count; ++i)
        nearest = std::min(nearest, face.corners[i].w);
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

/// Whether the picture shows a part of the box that is nearer than a depth above 0, or the camera
/// is in the box.
bool isInSightBefore(const math::dmat4& clipFromObject, const math::Bounds& bounds, double depth) {
    std::array<dvec4, 8> corners;
    bool isDirectional = true;
    for (size_t i = 0; i < corners.size(); ++i) {
        corners[i] = clipFromObject * dvec4(
                                          i & 1 ? bounds.max.x : bounds.min.x,
                                          i & 2 ? bounds.max.y : bounds.min.y,
                                          i & 4 ? bounds.max.z : bounds.min.z,
                                          1.0
                                      );
        isDirectional = isDirectional && corners[i].w >= depth;
    }
    if (isDirectional)
        return false;
    if (contains(bounds, findEye(clipFromObject)))
        return true;
    constexpr std::array<std::array<size_t, 4>, 6> kFaces{
        {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
    for (const auto& face : kFaces) {
        Polygon polygon;
        for (const size_t corner : face)
            polygon.add(corners[corner]);
        if (nearestInSight(polygon) < depth)
            return true;
    }
    return false;
}

/// What the lens is to the picture at a shutter time.
struct Lens {
    math::dmat4 clipFromWorld{1.0};
    bool spreadsFar = false;   ///< what is infinitely far away
    double nearestSharp = 0.0; ///< what is nearer it spreads over more than kMinDefocusPx, metres
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
    lens.clipFromWorld =
        makeProjection(camera, yFov, view) * glm::inverse(motion.worldFromCamera(s));
    const scene::CameraLens& opened = motion.cameraLens(s);
    const double radius = scene::computeLensRadius(opened, yFov) * std::max(opened.squeeze, 1.0);
    if (radius == 0.0)
        return lens;
    const double pixelsPerUnit =
        view.height / (2.0 * std::abs(computeHalfExtents(camera, yFov, view).y));
    lens.spreadsFar =
        !(scene::computeConfusionDiameter(opened, radius, kFarthestDepth, pixelsPerUnit) <=
          kMinDefocusPx);
    lens.nearestSharp =
        1.0 / (1.0 / opened.focusDistance + kMinDefocusPx / (2.0 * pixelsPerUnit * radius));
    return lens;
}

/// The view at kTimes.
struct Views {
    std::array<Lens, kTimes.size()> lenses;
    bool areOne = true; ///< the camera is static

    /// The lens that leaves least in focus, of a static camera.
    [[nodiscard]] const Lens& widest() const {
        return *std::max_element(lenses.begin(), lenses.end(), [](const Lens& a, const Lens& b) {
            return a.nearestSharp < b.nearestSharp;
        });
    }
};

bool isInSight(const Lens& lens, const math::dmat4& worldFromObject, const math::Bounds& bounds) {
    return lens.nearestSharp > 0.0 &&
           isInSightBefore(lens.clipFromWorld * worldFromObject, bounds, lens.nearestSharp);
}

/// Whether a row is spread that is nearer than what is in focus.
bool isSpread(
    const Views& views,
    const scene::ExposureMotion& motion,
    const ExtractedFrame& frame,
    const SceneLayout& layout,
    uint32_t row
) {
    const math::Bounds bounds = findExposureBounds(frame, layout, row);
    const ecs::Entity entity = frame.entityHandles[row];
    if (!motion.mayObjectMove(entity)) {
        const math::dmat4& place = frame.worldFromObject[row];
        if (views.areOne)
            return isInSight(views.widest(), place, bounds);
        return std::any_of(views.lenses.begin(), views.lenses.end(), [&](const Lens& lens) {
            return isInSight(lens, place, bounds);
        });
    }
    for (size_t i = 0; i < kTimes.size(); ++i)
        if (isInSight(views.lenses[i], motion.worldFromObject(entity, kTimes[i]), bounds))
            return true;
    return false;
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
    Views views;
    for (size_t i = 0; i < kTimes.size(); ++i) {
        const Lens lens = makeLens(world, view, motion, kTimes[i]);
        if (lens.spreadsFar)
            return true;
        views.lenses[i] = lens;
        views.areOne = views.areOne && lens.clipFromWorld == views.lenses[0].clipFromWorld;
    }
    for (uint32_t row = 0; row < frame.worldFromObject.size(); ++row)
        if (isSpread(views, motion, frame, layout, row))
            return true;
    return false;
}

} // namespace shutter::extract
