// SPDX-License-Identifier: MIT
#include "tests/kit/scene_builder.h"

#include <cmath>
#include <numbers>

namespace shutter::test {

using math::dvec3;
using math::vec2;
using math::vec3;
using scene::AssetIndex;
using scene::Primitive;

namespace {

constexpr double kPi = std::numbers::pi;

/// Two triangles from the corners top left, top right, bottom right, bottom left.
void appendFace(Primitive& primitive, const dvec3 (&corners)[4]) {
    const auto first = static_cast<uint32_t>(primitive.positions.size());
    const dvec3 normal =
        glm::normalize(glm::cross(corners[3] - corners[0], corners[1] - corners[0]));
    const vec2 uvs[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    for (int i = 0; i < 4; ++i) {
        primitive.positions.push_back(vec3(corners[i]));
        primitive.normals.push_back(vec3(normal));
        primitive.uv0.push_back(uvs[i]);
    }
    for (uint32_t index : {0u, 3u, 2u, 0u, 2u, 1u})
        primitive.indices.push_back(first + index);
}

uint8_t toByte(double value) {
    return static_cast<uint8_t>(std::lround(value * 255.0));
}

} // namespace

Primitive makeQuad(double width, double height, AssetIndex material) {
    Primitive quad;
    quad.material = material;
    const double x = width / 2.0;
    const double y = height / 2.0;
    appendFace(quad, {{-x, y, 0}, {x, y, 0}, {x, -y, 0}, {-x, -y, 0}});
    return quad;
}

Primitive makeBox(const dvec3& size, AssetIndex material) {
    Primitive box;
    box.material = material;
    const dvec3 h = size / 2.0;
    appendFace(box, {{-h.x, h.y, h.z}, {h.x, h.y, h.z}, {h.x, -h.y, h.z}, {-h.x, -h.y, h.z}});
    appendFace(box, {{h.x, h.y, -h.z}, {-h.x, h.y, -h.z}, {-h.x, -h.y, -h.z}, {h.x, -h.y, -h.z}});
    appendFace(box, {{h.x, h.y, h.z}, {h.x, h.y, -h.z}, {h.x, -h.y, -h.z}, {h.x, -h.y, h.z}});
    appendFace(box, {{-h.x, h.y, -h.z}, {-h.x, h.y, h.z}, {-h.x, -h.y, h.z}, {-h.x, -h.y, -h.z}});
    appendFace(box, {{-h.x, h.y, -h.z}, {h.x, h.y, -h.z}, {h.x, h.y, h.z}, {-h.x, h.y, h.z}});
    appendFace(box, {{-h.x, -h.y, h.z}, {h.x, -h.y, h.z}, {h.x, -h.y, -h.z}, {-h.x, -h.y, -h.z}});
    return box;
}

Primitive makeSphere(double radius, AssetIndex material) {
    constexpr uint32_t kColumns = 24;
    constexpr uint32_t kRows = 12;
    Primitive sphere;
    sphere.material = material;
    for (uint32_t row = 0; row <= kRows; ++row)
        for (uint32_t column = 0; column <= kColumns; ++column) {
            const double u = double(column) / kColumns;
            const double v = double(row) / kRows;
            const dvec3 normal(
                std::sin(kPi * v) * std::sin(2.0 * kPi * u),
                std::cos(kPi * v),
                std::sin(kPi * v) * std::cos(2.0 * kPi * u)
            );
            sphere.positions.push_back(vec3(radius * normal));
            sphere.normals.push_back(vec3(normal));
            sphere.uv0.push_back(vec2(u, v));
        }
    for (uint32_t row = 0; row < kRows; ++row)
        for (uint32_t column = 0; column < kColumns; ++column) {
            const uint32_t a = row * (kColumns + 1) + column;
            const uint32_t below = a + kColumns + 1;
            for (uint32_t index : {a, below, below + 1, a, below + 1, a + 1})
                sphere.indices.push_back(index);
        }
    return sphere;
}

Primitive transformed(Primitive primitive, const math::dmat4& matrix) {
    for (vec3& position : primitive.positions)
        position = vec3(matrix * math::dvec4(dvec3(position), 1.0));
    for (vec3& normal : primitive.normals)
        normal = vec3(math::dmat3(matrix) * dvec3(normal));
    return primitive;
}

SceneBuilder::SceneBuilder() : camera(world.registry.create()) {
    world.registry.add(camera, scene::Camera{});
    world.registry.add(camera, scene::LocalTransform{});
    world.cameras.push_back(camera);
}

void SceneBuilder::setPerspective(double yFov, double near) {
    scene::Camera& settings = cameraSettings();
    settings.kind = scene::CameraKind::Perspective;
    settings.yFov = yFov;
    settings.near = near;
}

void SceneBuilder::setPixelView(uint32_t heightPx) {
    scene::Camera& settings = cameraSettings();
    settings.kind = scene::CameraKind::Orthographic;
    settings.yMag = heightPx / 2.0;
    settings.near = 0.1;
    settings.far = 100.0;
}

void SceneBuilder::place(ecs::Entity entity, const Placement& placement) {
    math::Transform transform;
    transform.translation = placement.position;
    transform.rotation = placement.rotation;
    transform.scale = placement.scale;
    world.registry.add(entity, scene::LocalTransform{transform});
    world.registry.add(entity, scene::LinearVelocity{placement.velocity});
    world.registry.add(entity, scene::AngularVelocity{placement.angularVelocity});
}

void SceneBuilder::moveAll(const dvec3& offset) {
    for (auto [entity, local] : world.registry.view<scene::LocalTransform>())
        local.transform.translation += offset;
    for (auto [entity, local] : world.registry.view<scene::LocalMatrix>())
        local.matrix[3] += math::dvec4(offset, 0.0);
}

AssetIndex SceneBuilder::addMaterial(scene::Material material) {
    world.assets.materials.push_back(std::move(material));
    return static_cast<AssetIndex>(world.assets.materials.size() - 1);
}

AssetIndex SceneBuilder::addColor(const vec3& color) {
    scene::Material material;
    material.baseColorFactor = math::vec4(color, 1.0f);
    material.unlit = true;
    return addMaterial(std::move(material));
}

AssetIndex SceneBuilder::addTextured(AssetIndex texture, bool doubleSided) {
    scene::Material material;
    material.unlit = true;
    material.doubleSided = doubleSided;
    material.baseColor.texture = texture;
    return addMaterial(std::move(material));
}

AssetIndex SceneBuilder::addWaveTexture(uint32_t sizePx, bool alphaHoles) {
    scene::TextureImage image;
    image.width = image.height = sizePx;
    for (uint32_t y = 0; y < sizePx; ++y)
        for (uint32_t x = 0; x < sizePx; ++x) {
            const double u = (x + 0.5) / sizePx;
            const double v = (y + 0.5) / sizePx;
            const bool hole = alphaHoles && (x * 8 / sizePx + y * 8 / sizePx) % 2 == 1;
            image.rgba.push_back(toByte(0.5 + 0.45 * std::sin(2.0 * kPi * u)));
            image.rgba.push_back(toByte(0.5 + 0.45 * std::sin(2.0 * kPi * v)));
            image.rgba.push_back(toByte(0.5 + 0.45 * std::cos(2.0 * kPi * (u + 2.0 * v))));
            image.rgba.push_back(hole ? 0 : 255);
        }
    scene::Texture texture;
    texture.image = static_cast<AssetIndex>(world.assets.images.size());
    world.assets.images.push_back(std::move(image));
    world.assets.textures.push_back(texture);
    return static_cast<AssetIndex>(world.assets.textures.size() - 1);
}

AssetIndex SceneBuilder::addWaves(bool alphaHoles) {
    scene::Material material;
    material.unlit = true;
    material.baseColor.texture = addWaveTexture(64, alphaHoles);
    if (alphaHoles)
        material.alphaMode = scene::AlphaMode::Mask;
    return addMaterial(std::move(material));
}

AssetIndex SceneBuilder::addLitWaves() {
    scene::Material material;
    material.roughnessFactor = 0.4f;
    material.metallicFactor = 0.0f;
    material.baseColor.texture = addWaveTexture();
    return addMaterial(std::move(material));
}

AssetIndex SceneBuilder::addMesh(std::vector<Primitive> primitives) {
    scene::Mesh mesh;
    mesh.primitives = std::move(primitives);
    for (const Primitive& primitive : mesh.primitives)
        for (const vec3& position : primitive.positions)
            mesh.bounds.add(dvec3(position));
    world.assets.meshes.push_back(std::move(mesh));
    return static_cast<AssetIndex>(world.assets.meshes.size() - 1);
}

ecs::Entity SceneBuilder::add(Primitive primitive, const Placement& placement) {
    std::vector<Primitive> primitives;
    primitives.push_back(std::move(primitive));
    return add(addMesh(std::move(primitives)), placement);
}

ecs::Entity SceneBuilder::add(AssetIndex mesh, const Placement& placement) {
    const ecs::Entity entity = world.registry.create();
    world.registry.add(entity, scene::MeshInstance{mesh});
    place(entity, placement);
    return entity;
}

ecs::Entity SceneBuilder::add(AssetIndex mesh, const math::dmat4& matrix) {
    const ecs::Entity entity = world.registry.create();
    world.registry.add(entity, scene::MeshInstance{mesh});
    world.registry.add(entity, scene::LocalMatrix{matrix});
    return entity;
}

void SceneBuilder::addSun(const dvec3& direction, float lux) {
    const ecs::Entity sun = world.registry.create();
    scene::Light light;
    light.kind = scene::LightKind::Directional;
    light.intensity = lux;
    world.registry.add(sun, light);
    Placement placement;
    // The rotation that takes -Z to the direction.
    placement.rotation = glm::normalize(math::dquat(
        1.0 + glm::dot(dvec3(0, 0, -1), direction), glm::cross(dvec3(0, 0, -1), direction)
    ));
    place(sun, placement);
}

} // namespace shutter::test
