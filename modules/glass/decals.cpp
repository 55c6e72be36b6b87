// SPDX-License-Identifier: MIT
#include "modules/glass/decals.h"

#include "engine/extract/raster_record.h"
#include "shaders/glass/blended_layer_shared.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shutter::glass {

namespace {

using math::dmat4;
using math::dvec3;
using math::dvec4;

constexpr double kNoParallaxPx = 0.5;
/// Triangles of a row that are looked at, spread over it, and those whose middles are tested.
constexpr size_t kMaxMiddles = 256;
constexpr size_t kMaxPoints = 8;
/// Triangles that all rows of a frame are tested against: a few milliseconds at most.
constexpr size_t kMaxTestedTriangles = size_t{1} << 18;

/// Null: the world has no triangles of the row's mesh.
const scene::Mesh* findMesh(const extract::SweptScene& scene, uint32_t row) {
    const uint32_t mesh = scene.frame.entityMeshes[row];
    const auto& meshes = scene.world.assets.meshes;
    const size_t geometries =
        scene.layout.firstGeometry[mesh + 1] - scene.layout.firstGeometry[mesh];
    return mesh < meshes.size() && meshes[mesh].primitives.size() == geometries ? &meshes[mesh]
                                                                                : nullptr;
}

/// The row's primitives that are blended, or else the others.
std::vector<const scene::Primitive*>
listPrimitives(const extract::SweptScene& scene, uint32_t row, bool areBlended) {
    std::vector<const scene::Primitive*> primitives;
    const scene::Mesh* const mesh = findMesh(scene, row);
    if (!mesh)
        return primitives;
    const uint32_t first = scene.layout.firstGeometry[scene.frame.entityMeshes[row]];
    for (uint32_t i = 0; i < mesh->primitives.size(); ++i) {
        const auto alphaMode = scene.layout.geometries[first + i].alphaMode;
        if ((alphaMode == scene::AlphaMode::Blend) == areBlended)
            primitives.push_back(&mesh->primitives[i]);
    }
    return primitives;
}

/// Möller and Trumbore's, from both sides.
bool meetsTriangle(const dvec3& from, const dvec3& way, const dvec3 (&corners)[3]) {
    const dvec3 along = corners[1] - corners[0];
    const dvec3 across = corners[2] - corners[0];
    const dvec3 p = glm::cross(way, across);
    const double det = glm::dot(along, p);
    const dvec3 apart = from - corners[0];
    const double u = glm::dot(apart, p) / det;
    const dvec3 q = glm::cross(apart, along);
    const double v = glm::dot(way, q) / det;
    const double at = glm::dot(across, q) / det;
    // Written so that NaN fails.
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && at >= 0.0 && at <= 1.0;
}

double distanceToSegment(const dvec3& point, const dvec3& from, const dvec3& to) {
    const dvec3 way = to - from;
    const double share = glm::dot(point - from, way) / glm::dot(way, way);
    return glm::distance(point, from + std::clamp(share, 0.0, 1.0) * way);
}

/// At most so many of them, spread evenly.
std::vector<dvec3> thin(const std::vector<dvec3>& points, size_t most) {
    std::vector<dvec3> some;
    const size_t count = std::min(points.size(), most);
    for (size_t i = 0; i < count; ++i)
        some.push_back(points[(2 * i + 1) * points.size() / (2 * count)]);
    return some;
}

} // namespace

DecalSearch::DecalSearch(const extract::SweptScene& scene)
    : mScene(scene), mPicture(extract::pictureFromWorldAt(
                         scene.world, scene.view, scene.motion, scene.view.exposure.rasterTime
                     )) {
    const dmat4 worldFromCamera = scene.motion.worldFromCamera(scene.view.exposure.rasterTime);
    mEye = dvec3(worldFromCamera[3]);
    mForward = -glm::normalize(dvec3(worldFromCamera[2]));
}

std::vector<dvec3> DecalSearch::listPoints(uint32_t row) const {
    const auto primitives = listPrimitives(mScene, row, true);
    size_t count = 0;
    for (const scene::Primitive* primitive : primitives)
        count += primitive->indices.size() / 3;
    const size_t step = std::max<size_t>((count + kMaxMiddles - 1) / kMaxMiddles, 1);
    std::vector<dvec3> middles;
    std::vector<dvec3> inPicture;
    size_t index = step / 2;
    for (const scene::Primitive* primitive : primitives) {
        const size_t own = primitive->indices.size() / 3;
        for (; index < own; index += step) {
            dvec3 sum(0.0);
            for (size_t k = 0; k < 3; ++k)
                sum += dvec3(primitive->positions[primitive->indices[3 * index + k]]);
            middles.emplace_back(mScene.frame.worldFromObject[row] * dvec4(sum / 3.0, 1.0));
            const dvec4 at = mPicture * dvec4(middles.back(), 1.0);
            const double q = mScene.isPerspective ? at.z : 1.0;
            if (q > 0.0 && at.x >= 0.0 && at.y >= 0.0 && at.x <= q * mScene.view.width &&
                at.y <= q * mScene.view.height)
                inPicture.push_back(middles.back());
        }
        index -= own;
    }
    return thin(inPicture.empty() ? middles : inPicture, kMaxPoints);
}

void DecalSearch::listGrounds() {
    mIsListed = true;
    uint32_t last = std::numeric_limits<uint32_t>::max();
    for (const extract::DrawItem& item : mScene.frame.opaque.still) {
        if (item.entity == last || extract::findDeformed(mScene.frame, item.entity))
            continue;
        last = item.entity;
        const math::Bounds& bounds = extract::findRowBounds(mScene.frame, mScene.layout, last);
        const dmat4& world = mScene.frame.worldFromObject[last];
        const double scale = std::sqrt(
            glm::dot(dvec3(world[0]), dvec3(world[0])) +
            glm::dot(dvec3(world[1]), dvec3(world[1])) + glm::dot(dvec3(world[2]), dvec3(world[2]))
        );
        mGrounds.push_back(
            {last,
             dvec3(world * dvec4(bounds.centre(), 1.0)),
             scale * 0.5 * glm::distance(bounds.min, bounds.max)}
        );
    }
}

bool DecalSearch::meets(uint32_t row, const dvec3& from, const dvec3& to) {
    const dmat4 objectFromWorld = glm::inverse(mScene.frame.worldFromObject[row]);
    const dvec3 start(objectFromWorld * dvec4(from, 1.0));
    const dvec3 end(objectFromWorld * dvec4(to, 1.0));
    const dvec3 least = glm::min(start, end);
    const dvec3 most = glm::max(start, end);
    for (const scene::Primitive* primitive : listPrimitives(mScene, row, false)) {
        const std::vector<uint32_t>& indices = primitive->indices;
        mTested += indices.size() / 3;
        if (mTested > kMaxTestedTriangles)
            return false;
        for (size_t i = 0; i + 2 < indices.size(); i += 3) {
            const dvec3 corners[3] = {
                dvec3(primitive->positions[indices[i]]),
                dvec3(primitive->positions[indices[i + 1]]),
                dvec3(primitive->positions[indices[i + 2]])};
            const dvec3 low = glm::min(glm::min(corners[0], corners[1]), corners[2]);
            const dvec3 high = glm::max(glm::max(corners[0], corners[1]), corners[2]);
            const bool isNear = glm::all(glm::lessThanEqual(low, most)) &&
                                glm::all(glm::lessThanEqual(least, high));
            if (isNear && meetsTriangle(start, end - start, corners))
                return true;
        }
    }
    return false;
}

bool DecalSearch::isOnGround(const dvec3& point) {
    const auto& camera = mScene.world.registry.get<scene::Camera>(mScene.view.camera);
    dvec3 sight = point - mEye;
    dvec4 farthest(sight, 0.0);
    if (!mScene.isPerspective) {
        sight = mForward * glm::dot(point - mEye, mForward);
        farthest = dvec4(point + mForward * camera.far, 1.0);
    }
    const double parallax = mScene.measureParallax(dvec4(point, 1.0), farthest);
    if (parallax <= kNoParallaxPx)
        return true;
    if (!std::isfinite(parallax) || mTested > kMaxTestedTriangles)
        return false;
    // Parallax grows with the difference of inverse depths, or of depths before an orthographic
    // camera.
    const double share = kNoParallaxPx / parallax;
    const dvec3 to = point + (mScene.isPerspective ? sight * (share / (1.0 - share))
                                                   : mForward * (share * camera.far));
    const dvec3 from = point - sight * double(shader::kLayerDepthSlack);
    if (!mIsListed)
        listGrounds();
    return std::any_of(mGrounds.begin(), mGrounds.end(), [&](const Ground& ground) {
        return distanceToSegment(ground.centre, from, to) <= ground.radius &&
               meets(ground.row, from, to);
    });
}

bool DecalSearch::movesWithBackground(uint32_t row) {
    if (extract::findDeformed(mScene.frame, row))
        return false;
    const std::vector<dvec3> points = listPoints(row);
    return !points.empty() && std::all_of(points.begin(), points.end(), [&](const dvec3& point) {
        return isOnGround(point);
    });
}

} // namespace shutter::glass
