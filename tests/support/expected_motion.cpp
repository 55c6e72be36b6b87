// SPDX-License-Identifier: MIT
#include "tests/support/expected_motion.h"

#include "engine/math/transform.h"
#include "engine/scene/camera.h"
#include "engine/scene/components.h"
#include "engine/scene/deformation.h"

#include <algorithm>
#include <cmath>

namespace shutter::test {

using math::dmat4;
using math::dvec2;
using math::dvec3;
using math::dvec4;

namespace {

/// glTF 2.0, 3.7.2.2 and 3.7.3.3: morphed first, then skinned.
dvec4 deform(const scene::Primitive& primitive, const scene::Deformation& shape, size_t vertex) {
    dvec3 position(primitive.positions[vertex]);
    for (size_t t = 0; t < shape.morphWeights.size(); ++t)
        if (t < primitive.morphTargets.size() && !primitive.morphTargets[t].positions.empty())
            position += shape.morphWeights[t] * dvec3(primitive.morphTargets[t].positions[vertex]);
    const dvec4 morphed(position, 1.0);
    if (shape.objectFromBind.empty() || primitive.influenceCount == 0)
        return morphed;
    dvec4 skinned(0.0);
    for (size_t i = 0; i < primitive.influenceCount; ++i) {
        const size_t influence = vertex * primitive.influenceCount + i;
        skinned += double{primitive.weights[influence]} *
                   (shape.objectFromBind[primitive.joints[influence]] * morphed);
    }
    return skinned;
}

double cross2(const dvec2& a, const dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

} // namespace

ExpectedMotion::ExpectedMotion(
    const scene::World& world,
    ecs::Entity camera,
    const scene::ExposureInterval& exposure,
    uint32_t width,
    uint32_t height
)
    : mWidth(width), mHeight(height), mSeconds{exposure.open, exposure.raster, exposure.close},
      mPixels(size_t{width} * height) {
    const auto& lens = world.registry.get<scene::Camera>(camera);
    for (int i = 0; i < 3; ++i)
        mClipFromWorld[i] =
            math::clipFromViewPerspective(
                scene::yFovAt(world, camera, mSeconds[i]), double(width) / height, lens.near
            ) *
            glm::inverse(scene::worldFromEntity(world, camera, mSeconds[i]));
    for (auto [entity, instance] : world.registry.view<scene::MeshInstance>())
        drawEntity(world, entity, world.assets.meshes[instance.mesh]);
}

void ExpectedMotion::drawEntity(
    const scene::World& world, ecs::Entity entity, const scene::Mesh& mesh
) {
    dmat4 clipFromObject[3];
    scene::Deformation shapes[3];
    for (int i = 0; i < 3; ++i) {
        clipFromObject[i] = mClipFromWorld[i] * scene::worldFromObject(world, entity, mSeconds[i]);
        shapes[i] = scene::deformationAt(world, entity, mSeconds[i]);
    }
    for (const scene::Primitive& primitive : mesh.primitives) {
        std::vector<Corner> corners(primitive.positions.size());
        for (size_t v = 0; v < corners.size(); ++v)
            corners[v] = {
                clipFromObject[0] * deform(primitive, shapes[0], v),
                clipFromObject[1] * deform(primitive, shapes[1], v),
                clipFromObject[2] * deform(primitive, shapes[2], v)};
        for (size_t i = 0; i + 2 < primitive.indices.size(); i += 3)
            drawTriangle(
                corners[primitive.indices[i]],
                corners[primitive.indices[i + 1]],
                corners[primitive.indices[i + 2]]
            );
    }
}

void ExpectedMotion::drawTriangle(const Corner& a, const Corner& b, const Corner& c) {
    for (const Corner* corner : {&a, &b, &c})
        if (corner->open.w <= 0.0 || corner->raster.w <= 0.0 || corner->close.w <= 0.0)
            return;
    const auto toScreen = [&](const dvec4& clip) {
        return (dvec2(clip) / clip.w * 0.5 + 0.5) * dvec2(mWidth, mHeight);
    };
    const dvec2 p[3] = {toScreen(a.raster), toScreen(b.raster), toScreen(c.raster)};
    const double area = cross2(p[1] - p[0], p[2] - p[0]);
    if (area == 0.0)
        return;
    const dvec2 low = glm::min(p[0], glm::min(p[1], p[2]));
    const dvec2 high = glm::max(p[0], glm::max(p[1], p[2]));
    const auto firstPixel = [](double edge) { return std::max(std::ceil(edge - 0.5), 0.0); };
    for (double y = firstPixel(low.y); y + 0.5 <= high.y && y < mHeight; ++y)
        for (double x = firstPixel(low.x); x + 0.5 <= high.x && x < mWidth; ++x) {
            const dvec2 centre(x + 0.5, y + 0.5);
            dvec3 share(
                cross2(p[1] - centre, p[2] - centre),
                cross2(p[2] - centre, p[0] - centre),
                cross2(p[0] - centre, p[1] - centre)
            );
            share /= area;
            if (share.x < 0.0 || share.y < 0.0 || share.z < 0.0)
                continue;
            // From shares of the picture's area to shares of the triangle's.
            share /= dvec3(a.raster.w, b.raster.w, c.raster.w);
            const double depth = 1.0 / (share.x + share.y + share.z);
            share *= depth;
            auto& pixel = mPixels[size_t(y) * mWidth + size_t(x)];
            if (pixel && pixel->depth <= depth)
                continue;
            const dvec4 open = share.x * a.open + share.y * b.open + share.z * c.open;
            const dvec4 close = share.x * a.close + share.y * b.close + share.z * c.close;
            pixel = {depth, toScreen(close) - toScreen(open)};
        }
}

} // namespace shutter::test
