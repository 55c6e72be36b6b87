// SPDX-License-Identifier: MIT
#include "tests/conformance/stability/shapes.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace shutter::stability {

using math::dvec3;
using scene::AssetIndex;

namespace {

scene::Primitive makePrimitive(const generator::Shape& shape, AssetIndex material) {
    scene::Primitive primitive;
    primitive.positions = shape.positions;
    primitive.normals = shape.normals;
    primitive.uv0 = shape.uvs;
    primitive.indices = shape.indices;
    primitive.material = material;
    return primitive;
}

} // namespace

SceneBuilder makeEmptyScene() {
    SceneBuilder scene;
    scene.cameraSettings().yFov = 0.9;
    scene.moveCamera({});
    return scene;
}

ecs::Entity addShape(
    SceneBuilder& scene,
    const generator::Shape& shape,
    AssetIndex material,
    const Placement& placement
) {
    return scene.add(makePrimitive(shape, material), placement);
}

ecs::Entity addShape(
    SceneBuilder& scene,
    const generator::Shape& shape,
    AssetIndex material,
    const math::dmat4& matrix
) {
    return scene.add(scene.addMesh({makePrimitive(shape, material)}), matrix);
}

ecs::Entity addShapes(
    SceneBuilder& scene,
    std::span<const generator::Shape> shapes,
    AssetIndex material,
    const Placement& placement
) {
    std::vector<scene::Primitive> primitives;
    for (const generator::Shape& shape : shapes)
        primitives.push_back(makePrimitive(shape, material));
    return scene.add(scene.addMesh(std::move(primitives)), placement);
}

ecs::Entity addWallAndSphere(SceneBuilder& scene) {
    const auto lit = scene.addLitWaves();
    addShape(scene, makeSheetShape(12, 6), lit, {.position = {0, 0, -5}});
    const ecs::Entity sphere = addShape(
        scene,
        generator::sphere(0.5f, 24, 12),
        lit,
        {.position = {0.1, 0, -2.5}, .velocity = {0.5, 0.2, 0.1}}
    );
    scene.addSun(glm::normalize(dvec3(-0.4, -0.7, -0.6)), 3.0f);
    return sphere;
}

generator::Shape makeSheetShape(double width, double height) {
    return generator::sheet(
        {float(width / 2.0), float(height / 2.0)}, float(std::max(width, height))
    );
}

generator::Shape makeBoxShape(double width, double height, double depth) {
    const glm::vec3 half(float(width / 2.0), float(height / 2.0), float(depth / 2.0));
    return generator::box(half, float(std::max({width, height, depth})));
}

} // namespace shutter::stability
