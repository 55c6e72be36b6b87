// SPDX-License-Identifier: MIT
#include "tests/conformance/stability/scene_draft.h"

#include <array>
#include <cmath>
#include <numbers>

namespace shutter::stability {

using math::dvec3;
using scene::AssetIndex;

SceneDraft::SceneDraft() {
    shot.camera = shot.world.registry.create();
    scene::Camera camera;
    camera.yFov = 0.9;
    shot.world.registry.add(shot.camera, camera);
    shot.world.cameras.push_back(shot.camera);
    place(shot.camera, {});
}

scene::Camera& SceneDraft::camera() {
    return shot.world.registry.get<scene::Camera>(shot.camera);
}

void SceneDraft::setPixelView(uint32_t heightPx) {
    camera().kind = scene::CameraKind::Orthographic;
    camera().yMag = heightPx / 2.0;
    camera().near = 0.1;
    camera().far = 100.0;
}

void SceneDraft::place(ecs::Entity entity, const Stand& stand) {
    math::Transform transform;
    transform.translation = stand.position;
    transform.rotation = stand.rotation;
    transform.scale = stand.scale;
    ecs::Registry& registry = shot.world.registry;
    registry.add(entity, scene::LocalTransform{transform});
    registry.add(entity, scene::LinearVelocity{stand.velocity});
    registry.add(entity, scene::AngularVelocity{stand.angularVelocity});
}

AssetIndex SceneDraft::addMaterial(scene::Material material) {
    shot.world.assets.materials.push_back(std::move(material));
    return static_cast<AssetIndex>(shot.world.assets.materials.size() - 1);
}

AssetIndex SceneDraft::addColor(const math::vec3& color) {
    scene::Material material;
    material.baseColorFactor = math::vec4(color, 1.0f);
    material.unlit = true;
    return addMaterial(std::move(material));
}

AssetIndex SceneDraft::addWaveTexture(bool alphaHoles) {
    constexpr uint32_t kSizePx = 64;
    constexpr double kTurn = 2.0 * std::numbers::pi;
    const auto toByte = [](double wave) {
        return static_cast<uint8_t>(std::lround(255.0 * (0.5 + 0.45 * wave)));
    };
    scene::TextureImage picture;
    picture.width = picture.height = kSizePx;
    for (uint32_t y = 0; y < kSizePx; ++y)
        for (uint32_t x = 0; x < kSizePx; ++x) {
            const double u = kTurn * (x + 0.5) / kSizePx;
            const double v = kTurn * (y + 0.5) / kSizePx;
            const bool hole = alphaHoles && (x / 8 + y / 8) % 2 == 1;
            const std::array<uint8_t, 4> texel{
                toByte(std::sin(u)),
                toByte(std::sin(v)),
                toByte(std::cos(u + 2.0 * v)),
                static_cast<uint8_t>(hole ? 0 : 255)};
            picture.rgba.insert(picture.rgba.end(), texel.begin(), texel.end());
        }
    scene::Assets& assets = shot.world.assets;
    scene::Texture texture;
    texture.image = static_cast<AssetIndex>(assets.images.size());
    assets.images.push_back(std::move(picture));
    assets.textures.push_back(texture);
    return static_cast<AssetIndex>(assets.textures.size() - 1);
}

AssetIndex SceneDraft::addWaves(bool alphaHoles) {
    scene::Material material;
    material.unlit = true;
    material.baseColor.texture = addWaveTexture(alphaHoles);
    if (alphaHoles)
        material.alphaMode = scene::AlphaMode::Mask;
    return addMaterial(std::move(material));
}

AssetIndex SceneDraft::addLitWaves() {
    scene::Material material;
    material.roughnessFactor = 0.4f;
    material.metallicFactor = 0.0f;
    material.baseColor.texture = addWaveTexture(false);
    return addMaterial(std::move(material));
}

void SceneDraft::addSun(const dvec3& direction, float lux) {
    const ecs::Entity sun = shot.world.registry.create();
    scene::Light light;
    light.kind = scene::LightKind::Directional;
    light.intensity = lux;
    shot.world.registry.add(sun, light);
    const dvec3 down(0.0, 0.0, -1.0);
    Stand stand;
    stand.rotation =
        glm::normalize(math::dquat(1.0 + glm::dot(down, direction), glm::cross(down, direction)));
    place(sun, stand);
}

AssetIndex SceneDraft::addMesh(std::span<const generator::Shape> shapes, AssetIndex material) {
    scene::Mesh mesh;
    for (const generator::Shape& shape : shapes) {
        scene::Primitive primitive;
        primitive.positions = shape.positions;
        primitive.normals = shape.normals;
        primitive.uv0 = shape.uvs;
        primitive.indices = shape.indices;
        primitive.material = material;
        for (const math::vec3& position : primitive.positions)
            mesh.bounds.add(dvec3(position));
        mesh.primitives.push_back(std::move(primitive));
    }
    shot.world.assets.meshes.push_back(std::move(mesh));
    return static_cast<AssetIndex>(shot.world.assets.meshes.size() - 1);
}

ecs::Entity
SceneDraft::add(const generator::Shape& shape, AssetIndex material, const Stand& stand) {
    return add(std::span(&shape, 1), material, stand);
}

ecs::Entity
SceneDraft::add(std::span<const generator::Shape> shapes, AssetIndex material, const Stand& stand) {
    const ecs::Entity entity = shot.world.registry.create();
    shot.world.registry.add(entity, scene::MeshInstance{addMesh(shapes, material)});
    place(entity, stand);
    return entity;
}

ecs::Entity
SceneDraft::add(const generator::Shape& shape, AssetIndex material, const math::dmat4& matrix) {
    const ecs::Entity entity = shot.world.registry.create();
    shot.world.registry.add(entity, scene::MeshInstance{addMesh(std::span(&shape, 1), material)});
    shot.world.registry.add(entity, scene::LocalMatrix{matrix});
    return entity;
}

void SceneDraft::moveAll(const dvec3& offset) {
    for (auto [entity, local] : shot.world.registry.view<scene::LocalTransform>())
        local.transform.translation += offset;
    for (auto [entity, local] : shot.world.registry.view<scene::LocalMatrix>())
        local.matrix[3] += math::dvec4(offset, 0.0);
}

ecs::Entity buildStage(SceneDraft& draft) {
    const auto lit = draft.addLitWaves();
    draft.add(makeSheet(12, 6), lit, Stand{.position = {0, 0, -5}});
    const ecs::Entity sphere = draft.add(
        generator::sphere(0.5f, 24, 12),
        lit,
        Stand{.position = {0.1, 0, -2.5}, .velocity = {0.5, 0.2, 0.1}}
    );
    draft.addSun(glm::normalize(dvec3(-0.4, -0.7, -0.6)), 3.0f);
    return sphere;
}

generator::Shape makeSheet(double width, double height) {
    return generator::sheet(
        {float(width / 2.0), float(height / 2.0)}, float(std::max(width, height))
    );
}

generator::Shape makeBox(double width, double height, double depth) {
    const glm::vec3 half(float(width / 2.0), float(height / 2.0), float(depth / 2.0));
    return generator::box(half, float(std::max({width, height, depth})));
}

} // namespace shutter::stability
