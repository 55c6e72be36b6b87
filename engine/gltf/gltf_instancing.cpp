// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/gltf/gltf_parts.h"
#include "engine/gltf/gltf_values.h"
#include "engine/math/transform.h"

#include <cmath>
#include <optional>

namespace shutter::gltf {

namespace {

using math::dquat;
using math::dvec3;

/// Bytes of an instance in the registry, rounded up: its components and their index entries.
constexpr uint64_t kInstanceBytes = sizeof(scene::LocalTransform) + sizeof(scene::Parent) +
                                    sizeof(scene::MeshInstance) + 8 * sizeof(ecs::Entity);

class InstanceReader {
  public:
    InstanceReader(GltfContext& context, const tinygltf::Value& extension, std::string path)
        : mContext(context), mPath(std::move(path)) {
        mPath += ".attributes";
        // tinygltf does not distinguish an empty object from a missing one.
        mAttributes = extension.Has("attributes") ? &extension.Get("attributes") : nullptr;
        if (!mAttributes || !mAttributes->IsObject() || mAttributes->Keys().empty())
            failGltf("{} is missing or empty", mPath);
    }

    std::vector<math::Transform> read() {
        const size_t count = countInstances();
        mContext.spendVertexBytes(count * kInstanceBytes);
        std::vector<math::Transform> transforms(count);
        const std::vector<float> translations =
            readAttribute("TRANSLATION", TINYGLTF_TYPE_VEC3, {kFloat32});
        const std::vector<float> rotations =
            readAttribute("ROTATION", TINYGLTF_TYPE_VEC4, {kFloat32, kInt8, kInt16});
        const std::vector<float> scales = readAttribute("SCALE", TINYGLTF_TYPE_VEC3, {kFloat32});
        const auto rotationAccessor = findIndex(*mAttributes, "ROTATION", mPath);
        const bool mayBeZero = rotationAccessor && lacksView(mContext.model, *rotationAccessor);
        for (size_t i = 0; i < count; ++i) {
            if (!translations.empty())
                transforms[i].translation = toVec3(&translations[i * 3]);
            if (!rotations.empty())
                transforms[i].rotation = toRotation(&rotations[i * 4], mayBeZero, i);
            if (!scales.empty())
                transforms[i].scale = toVec3(&scales[i * 3]);
        }
        return transforms;
    }

  private:
    /// The number of instances, on which all attributes must agree, including those that are
    /// ignored.
    size_t countInstances() const {
        std::optional<size_t> count;
        for (const std::string& name : mAttributes->Keys()) {
            const std::optional<uint32_t> accessor = findIndex(*mAttributes, name, mPath);
            const size_t accessorCount = mContext.model.accessors.size();
            if (*accessor >= accessorCount) {
                failGltf(
                    "{}.{} is {}, but {}",
                    mPath,
                    name,
                    *accessor,
                    core::thereAre(accessorCount, "accessor")
                );
            }
            const size_t found = mContext.model.accessors[*accessor].count;
            if (count && *count != found) {
                failGltf(
                    "{}.{} has {}, others have {}",
                    mPath,
                    name,
                    core::countOf(found, "instance"),
                    *count
                );
            }
            count = found;
        }
        return *count;
    }

    std::vector<float>
    readAttribute(const std::string& name, int type, std::vector<int> componentTypes) {
        const std::optional<uint32_t> accessor = findIndex(*mAttributes, name, mPath);
        if (!accessor)
            return {};
        const std::string path = fmt::format("{}.{}", mPath, name);
        std::vector<float> values =
            readFloats(mContext, *accessor, {path, {type}, std::move(componentTypes), true});
        for (const float value : values) {
            if (!(std::abs(value) <= float(kMaxMagnitude)))
                failGltf("{} holds {}", path, value);
        }
        return values;
    }

    static dvec3 toVec3(const float* values) { return dvec3(values[0], values[1], values[2]); }

    /// \param mayBeZero zeros turn nothing, with a warning
    dquat toRotation(const float* values, bool mayBeZero, size_t instance) const {
        const dquat rotation(
            double{values[3]}, double{values[0]}, double{values[1]}, double{values[2]}
        );
        const double length = glm::length(rotation);
        if (mayBeZero && length == 0.0) {
            mContext.warnings.add(mPath + ".ROTATION has no bufferView: its zeros turn nothing");
            return dquat(1.0, 0.0, 0.0, 0.0);
        }
        if (!(length > 1e-6))
            failGltf("{}.ROTATION: rotation {} has no length", mPath, instance);
        return rotation / length;
    }

    GltfContext& mContext;
    std::string mPath;
    const tinygltf::Value* mAttributes = nullptr;
};

void expand(
    GltfContext& context,
    scene::World& world,
    ecs::Entity node,
    const std::vector<math::Transform>& transforms
) {
    ecs::Registry& registry = world.registry;
    const auto mesh = registry.get<scene::MeshInstance>(node);
    std::optional<scene::MorphWeights> morph;
    if (const auto* found = registry.find<scene::MorphWeights>(node)) {
        morph = *found;
        const size_t bytes = found->weights.size() * sizeof(float) +
                             found->channels.size() * sizeof(scene::Animated::Channel) +
                             sizeof(scene::MorphWeights);
        context.spendVertexBytes(transforms.size() * bytes);
    }
    std::optional<scene::VertexWaves> waves;
    if (const auto* found = registry.find<scene::VertexWaves>(node)) {
        waves = *found;
        const size_t bytes =
            found->waves.size() * sizeof(scene::VertexWave) + sizeof(scene::VertexWaves);
        context.spendVertexBytes(transforms.size() * bytes);
    }
    // Removed before the instances are added, which keeps those in the order of the file.
    registry.remove<scene::MeshInstance>(node);
    registry.remove<scene::MorphWeights>(node);
    registry.remove<scene::VertexWaves>(node);
    for (const math::Transform& transform : transforms) {
        const ecs::Entity instance = registry.create();
        registry.add<scene::Parent>(instance, {node});
        registry.add<scene::LocalTransform>(instance, {transform});
        registry.add<scene::MeshInstance>(instance, mesh);
        if (morph)
            registry.add<scene::MorphWeights>(instance, *morph);
        if (waves)
            registry.add<scene::VertexWaves>(instance, *waves);
    }
}

} // namespace

void expandInstances(
    GltfContext& context, scene::World& world, const std::vector<ecs::Entity>& entities
) {
    const std::vector<tinygltf::Node>& nodes = context.model.nodes;
    for (size_t n = 0; n < nodes.size(); ++n) {
        const auto* extension = findExtension(nodes[n].extensions, "EXT_mesh_gpu_instancing");
        const bool isDrawn =
            entities[n] != ecs::kNullEntity && world.registry.has<scene::MeshInstance>(entities[n]);
        if (!extension || !isDrawn)
            continue;
        if (world.registry.has<scene::Skinned>(entities[n])) {
            context.warnings.add(fmt::format(
                "nodes[{}] has a skin, which places it: its EXT_mesh_gpu_instancing is ignored", n
            ));
            continue;
        }
        const std::string path = fmt::format("nodes[{}].extensions.EXT_mesh_gpu_instancing", n);
        expand(context, world, entities[n], InstanceReader(context, *extension, path).read());
    }
}

} // namespace shutter::gltf
