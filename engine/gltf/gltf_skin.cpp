// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/gltf/gltf_parts.h"
#include "engine/gltf/gltf_values.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

namespace shutter::gltf {

namespace {

constexpr uint32_t kSetSize = 4; ///< influences per vertex of one JOINTS_n and WEIGHTS_n
constexpr int kSetCount = 2;     ///< sets that are read

/// One JOINTS_n with its WEIGHTS_n, four per vertex.
struct InfluenceSet {
    std::vector<uint32_t> joints;
    std::vector<float> weights;
};

class InfluenceReader {
  public:
    InfluenceReader(
        GltfContext& context,
        const tinygltf::Primitive& source,
        const std::string& path,
        scene::Primitive& primitive
    )
        : mContext(context), mSource(source), mPath(path), mPrimitive(primitive) {}

    void read() {
        for (int n = 0; n < kSetCount; ++n)
            readSet(n);
        if (mSource.attributes.contains(fmt::format("JOINTS_{}", kSetCount)))
            mContext.warnings.add(
                mPath + " has more than eight joints a vertex: the rest is left out"
            );
        if (mSets.empty())
            return;
        interleave();
        normalize();
    }

  private:
    size_t findAttribute(const std::string& name) const {
        const auto accessor = size_t(mSource.attributes.at(name));
        const size_t count = mContext.model.accessors[accessor].count;
        const size_t expected = mPrimitive.positions.size();
        if (count != expected)
            failGltf(
                "{} {} has {}, POSITION has {}",
                mPath,
                name,
                core::countOf(count, "element"),
                expected
            );
        return accessor;
    }

    void readSet(int n) {
        const std::string joints = fmt::format("JOINTS_{}", n);
        const std::string weights = fmt::format("WEIGHTS_{}", n);
        const bool hasJoints = mSource.attributes.contains(joints);
        const bool hasWeights = mSource.attributes.contains(weights);
        if (hasJoints != hasWeights) {
            mContext.warnings.add(fmt::format(
                "{} has {} without {}: not used",
                mPath,
                hasJoints ? joints : weights,
                hasJoints ? weights : joints
            ));
        }
        if (!hasJoints || !hasWeights)
            return;
        InfluenceSet set;
        const std::string jointsPath = mPath + " " + joints;
        const std::string weightsPath = mPath + " " + weights;
        set.joints = readUnsigned(
            mContext, findAttribute(joints), {jointsPath, {TINYGLTF_TYPE_VEC4}, {kUint8, kUint16}}
        );
        set.weights = readFloats(
            mContext,
            findAttribute(weights),
            {weightsPath, {TINYGLTF_TYPE_VEC4}, {kFloat32, kUint8, kUint16}, true}
        );
        repairWeights(set.weights, weightsPath);
        mSets.push_back(std::move(set));
    }

    void repairWeights(std::vector<float>& weights, const std::string& path) {
        bool isRepaired = false;
        for (float& weight : weights) {
            if (weight >= 0.0f && std::isfinite(weight))
                continue;
            weight = 0.0f;
            isRepaired = true;
        }
        if (isRepaired)
            mContext.warnings.add(path + " holds values that are below 0 or not finite: set to 0");
    }

    /// Reorders the influences from one set after the other to one vertex after the other.
    void interleave() {
        const size_t vertexCount = mPrimitive.positions.size();
        mPrimitive.influenceCount = kSetSize * uint32_t(mSets.size());
        const size_t total = vertexCount * mPrimitive.influenceCount;
        mContext.spendVertexBytes(total * (sizeof(uint16_t) + sizeof(float)));
        mPrimitive.joints.reserve(total);
        mPrimitive.weights.reserve(total);
        for (size_t v = 0; v < vertexCount; ++v) {
            for (const InfluenceSet& set : mSets) {
                for (size_t i = v * kSetSize; i < (v + 1) * kSetSize; ++i) {
                    mPrimitive.joints.push_back(uint16_t(set.joints[i]));
                    mPrimitive.weights.push_back(set.weights[i]);
                }
            }
        }
    }

    void normalize() {
        const size_t count = mPrimitive.influenceCount;
        size_t unbound = 0;
        for (size_t begin = 0; begin < mPrimitive.weights.size(); begin += count) {
            const std::span<float> weights(&mPrimitive.weights[begin], count);
            double sum = 0.0; // holds eight of the largest floats without overflow
            for (const float weight : weights)
                sum += double(weight);
            if (!(sum > 0.0)) {
                weights[0] = 1.0f;
                ++unbound;
                continue;
            }
            for (float& weight : weights)
                weight = float(double(weight) / sum);
        }
        if (unbound > 0) {
            mContext.warnings.add(fmt::format(
                "{} has {} without weight: the first joint that is named moves {}",
                mPath,
                core::countOf(unbound, "vertex", "vertices"),
                unbound == 1 ? "it" : "them"
            ));
        }
    }

    GltfContext& mContext;
    const tinygltf::Primitive& mSource;
    const std::string& mPath;
    scene::Primitive& mPrimitive;
    std::vector<InfluenceSet> mSets;
};

/// \param mayBeZero all zeros are taken for a matrix that puts every vertex on its joint
math::dmat4 readBindMatrix(std::span<const float> values, bool mayBeZero, const std::string& path) {
    constexpr double kRowTolerance = 1e-3; // exporters compute inverses in single precision
    math::dmat4 matrix(1.0);
    for (size_t i = 0; i < 16; ++i) {
        if (!(std::abs(values[i]) <= float(kMaxMagnitude)))
            failGltf("{} holds {}", path, values[i]);
        matrix[glm::length_t(i / 4)][glm::length_t(i % 4)] = double(values[i]);
    }
    if (mayBeZero && matrix == math::dmat4(0.0))
        matrix[3][3] = 1.0;
    for (glm::length_t column = 0; column < 4; ++column) {
        const double expected = column == 3 ? 1.0 : 0.0;
        if (!(std::abs(matrix[column][3] - expected) <= kRowTolerance))
            failGltf("{} does not have 0 0 0 1 as its last row", path);
        matrix[column][3] = expected;
    }
    return matrix;
}

scene::Skin readSkin(GltfContext& context, size_t index) {
    const tinygltf::Skin& source = context.model.skins[index];
    const std::string path = fmt::format("skins[{}]", index);
    const size_t jointCount = source.joints.size();
    if (jointCount == 0)
        failGltf("{}.joints is empty", path);
    context.spendVertexBytes(jointCount * sizeof(math::dmat4));
    scene::Skin skin;
    skin.name = source.name;
    if (source.inverseBindMatrices < 0) {
        skin.jointFromBind.assign(jointCount, math::dmat4(1.0));
        return skin;
    }
    const std::string at = path + ".inverseBindMatrices";
    const std::vector<float> values = readFloats(
        context, size_t(source.inverseBindMatrices), {at, {TINYGLTF_TYPE_MAT4}, {kFloat32}}
    );
    if (values.size() / 16 < jointCount)
        failGltf(
            "{} has {} for {}",
            at,
            core::countOf(values.size() / 16, "element"),
            core::countOf(jointCount, "joint")
        );
    const bool mayBeZero = lacksView(context.model, size_t(source.inverseBindMatrices));
    if (mayBeZero)
        context.warnings.add(at + " has no bufferView: its zeros put vertices on their joints");
    for (size_t joint = 0; joint < jointCount; ++joint) {
        const std::span<const float> matrix(&values[joint * 16], 16);
        skin.jointFromBind.push_back(
            readBindMatrix(matrix, mayBeZero, fmt::format("{}[{}]", at, joint))
        );
    }
    return skin;
}

void bindToFirstJoint(GltfContext& context, scene::Primitive& primitive) {
    const size_t total = primitive.positions.size() * kSetSize;
    context.spendVertexBytes(total * (sizeof(uint16_t) + sizeof(float)));
    primitive.influenceCount = kSetSize;
    primitive.joints.assign(total, 0);
    primitive.weights.assign(total, 0.0f);
    for (size_t i = 0; i < total; i += kSetSize)
        primitive.weights[i] = 1.0f;
}

/// Binds primitives without joints to the first one. Returns the largest joint index in the mesh.
uint32_t bindMesh(GltfContext& context, scene::Mesh& mesh, int index) {
    uint32_t largest = 0;
    for (scene::Primitive& primitive : mesh.primitives) {
        if (primitive.influenceCount == 0) {
            context.warnings.add(fmt::format(
                "meshes[{}] is drawn with a skin, but not all of it has joints: that follows the "
                "first joint",
                index
            ));
            bindToFirstJoint(context, primitive);
        }
        for (const uint16_t joint : primitive.joints)
            largest = std::max(largest, uint32_t{joint});
    }
    return largest;
}

} // namespace

void readInfluences(
    GltfContext& context,
    const tinygltf::Primitive& source,
    const std::string& path,
    scene::Primitive& primitive
) {
    InfluenceReader(context, source, path, primitive).read();
}

void loadSkins(GltfContext& context, scene::Assets& assets) {
    for (size_t s = 0; s < context.model.skins.size(); ++s)
        assets.skins.push_back(readSkin(context, s));
}

void bindMeshes(GltfContext& context, scene::Assets& assets) {
    const std::vector<tinygltf::Node>& nodes = context.model.nodes;
    // Many nodes may share one mesh, whose vertices are inspected only once.
    std::map<int, uint32_t> largestOfMesh;
    for (size_t n = 0; n < nodes.size(); ++n) {
        const tinygltf::Node& node = nodes[n];
        if (node.skin < 0 || node.mesh < 0)
            continue;
        const auto [entry, isNew] = largestOfMesh.try_emplace(node.mesh, 0u);
        if (isNew)
            entry->second = bindMesh(context, assets.meshes[size_t(node.mesh)], node.mesh);
        const size_t jointCount = assets.skins[size_t(node.skin)].jointFromBind.size();
        if (entry->second >= jointCount) {
            failGltf(
                "nodes[{}]: meshes[{}] names joint {}, but skins[{}] has {}",
                n,
                node.mesh,
                entry->second,
                node.skin,
                core::countOf(jointCount, "joint")
            );
        }
    }
}

void addSkins(GltfContext& context, scene::World& world, const std::vector<ecs::Entity>& entities) {
    const tinygltf::Model& model = context.model;
    const auto isSkinned = [&](size_t node) {
        return model.nodes[node].skin >= 0 && entities[node] != ecs::kNullEntity &&
               world.registry.has<scene::MeshInstance>(entities[node]);
    };
    // Charged to the budget before any is allocated: many nodes may share one large skin.
    for (size_t n = 0; n < model.nodes.size(); ++n) {
        if (isSkinned(n)) {
            const size_t jointCount = model.skins[size_t(model.nodes[n].skin)].joints.size();
            context.spendVertexBytes(jointCount * sizeof(ecs::Entity));
        }
    }
    for (size_t n = 0; n < model.nodes.size(); ++n) {
        if (!isSkinned(n))
            continue;
        scene::Skinned skinned;
        skinned.skin = scene::AssetIndex(model.nodes[n].skin);
        for (const int joint : model.skins[skinned.skin].joints)
            skinned.joints.push_back(entities[size_t(joint)]);
        world.registry.add(entities[n], std::move(skinned));
    }
}

} // namespace shutter::gltf
