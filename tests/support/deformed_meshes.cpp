// SPDX-License-Identifier: MIT
#include "tests/support/deformed_meshes.h"

#include "engine/math/transform.h"

namespace shutter::test {

using math::dmat4;
using math::vec2;
using math::vec3;
using scene::Primitive;

namespace {

math::Transform transformOf(const Placement& placement) {
    math::Transform transform;
    transform.translation = placement.position;
    transform.rotation = placement.rotation;
    transform.scale = placement.scale;
    return transform;
}

bool isMoving(const Placement& placement) {
    return placement.velocity != math::dvec3(0.0) || placement.angularVelocity != math::dvec3(0.0);
}

} // namespace

Primitive makeStrip(double width, double height, uint32_t rows, scene::AssetIndex material) {
    Primitive strip;
    strip.material = material;
    strip.influenceCount = 4;
    for (uint32_t row = 0; row <= rows; ++row)
        for (const double side : {-0.5, 0.5}) {
            const double share = double(row) / rows;
            strip.positions.push_back(vec3(side * width, share * height, 0.0));
            strip.normals.push_back(vec3(0, 0, 1));
            strip.uv0.push_back(vec2(side + 0.5, 1.0 - share));
            strip.joints.insert(strip.joints.end(), {0, 1, 0, 0});
            strip.weights.insert(
                strip.weights.end(), {float(1.0 - share), float(share), 0.0f, 0.0f}
            );
        }
    for (uint32_t row = 0; row < rows; ++row)
        for (const uint32_t index : {0u, 1u, 3u, 0u, 3u, 2u})
            strip.indices.push_back(2 * row + index);
    return strip;
}

void bindEqually(Primitive& primitive, uint32_t count) {
    primitive.influenceCount = (count + 3) / 4 * 4;
    primitive.joints.clear();
    primitive.weights.clear();
    for (size_t vertex = 0; vertex < primitive.positions.size(); ++vertex)
        for (uint32_t i = 0; i < primitive.influenceCount; ++i) {
            primitive.joints.push_back(static_cast<uint16_t>(i < count ? i : 0));
            primitive.weights.push_back(i < count ? 1.0f / static_cast<float>(count) : 0.0f);
        }
}

SkinnedEntity
addSkinned(SceneBuilder& scene, Primitive primitive, std::span<const Placement> joints) {
    ecs::Registry& registry = scene.world.registry;
    SkinnedEntity result;
    scene::Skin skin;
    dmat4 bindFromJoint(1.0);
    for (size_t i = 0; i < joints.size(); ++i) {
        const ecs::Entity joint = registry.create();
        registry.add(joint, scene::LocalTransform{transformOf(joints[i])});
        if (isMoving(joints[i])) {
            registry.add(joint, scene::LinearVelocity{joints[i].velocity});
            registry.add(joint, scene::AngularVelocity{joints[i].angularVelocity});
        }
        if (i > 0) {
            registry.add(joint, scene::Parent{result.joints.back()});
            bindFromJoint = bindFromJoint * math::computeMatrix(transformOf(joints[i]));
        }
        skin.jointFromBind.push_back(glm::inverse(bindFromJoint));
        result.joints.push_back(joint);
    }
    scene::Assets& assets = scene.world.assets;
    assets.skins.push_back(std::move(skin));
    std::vector<Primitive> primitives;
    primitives.push_back(std::move(primitive));
    result.entity = registry.create();
    registry.add(result.entity, scene::MeshInstance{scene.addMesh(std::move(primitives))});
    registry.add(
        result.entity,
        scene::Skinned{static_cast<scene::AssetIndex>(assets.skins.size() - 1), result.joints}
    );
    return result;
}

ecs::Entity addMorphed(
    SceneBuilder& scene, Primitive primitive, const Placement& placement, const MorphWay& way
) {
    const ecs::Entity entity = scene.add(std::move(primitive), placement);
    scene::World& world = scene.world;
    scene::WeightChannel channel;
    channel.targetCount = static_cast<uint32_t>(way.from.size());
    channel.times = {way.begin, way.end};
    channel.values = way.from;
    channel.values.insert(channel.values.end(), way.to.begin(), way.to.end());
    scene::AnimationClip clip;
    clip.duration = double(way.end);
    clip.weightChannels.push_back(std::move(channel));
    const auto index = static_cast<uint32_t>(world.assets.clips.size());
    world.assets.clips.push_back(std::move(clip));
    world.registry.add(entity, scene::MorphWeights{way.from, {{index, 0}}});
    return entity;
}

} // namespace shutter::test
