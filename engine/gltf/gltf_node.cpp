// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/gltf/gltf_parts.h"
#include "engine/gltf/gltf_values.h"

#include <algorithm>
#include <cmath>

namespace shutter::gltf {

namespace {

using math::dmat3;
using math::dmat4;
using math::dquat;
using math::dvec3;

constexpr int kNoParent = -1;

double checkMagnitude(double value, const std::string& path) {
    if (!(std::abs(value) <= kMaxMagnitude))
        failGltf("{} holds {}, above 1e30", path, value);
    return value;
}

dvec3 readVec3(const std::vector<double>& values, const dvec3& fallback, const std::string& path) {
    if (values.empty())
        return fallback;
    return dvec3(
        checkMagnitude(values[0], path),
        checkMagnitude(values[1], path),
        checkMagnitude(values[2], path)
    );
}

dquat readRotation(const std::vector<double>& values, const std::string& path) {
    if (values.empty())
        return dquat(1.0, 0.0, 0.0, 0.0);
    for (const double value : values)
        checkMagnitude(value, path);
    const dquat rotation(values[3], values[0], values[1], values[2]);
    const double length = glm::length(rotation);
    if (!(length > 1e-12))
        failGltf("{} has no length", path);
    return rotation / length;
}

dmat4 readMatrix(const std::vector<double>& values, const std::string& path) {
    dmat4 matrix(1.0);
    for (int i = 0; i < 16; ++i) {
        matrix[i / 4][i % 4] = checkMagnitude(values[size_t(i)], path);
    }
    const bool isAffine =
        matrix[0][3] == 0.0 && matrix[1][3] == 0.0 && matrix[2][3] == 0.0 && matrix[3][3] == 1.0;
    if (!isAffine)
        failGltf("{} does not have 0 0 0 1 as its last row", path);
    return matrix;
}

/// The rotation of a sheared matrix by Gram-Schmidt orthogonalization, which keeps the x axis.
dquat orthonormalRotation(const dmat4& matrix) {
    const dvec3 x(matrix[0]);
    const dvec3 y(matrix[1]);
    const dvec3 z = glm::cross(x, y);
    if (!(glm::length(x) > 0.0) || !(glm::length(z) > 0.0))
        return dquat(1.0, 0.0, 0.0, 0.0);
    const dvec3 unitX = glm::normalize(x);
    const dvec3 unitZ = glm::normalize(z);
    return glm::normalize(glm::quat_cast(dmat3(unitX, glm::cross(unitZ, unitX), unitZ)));
}

/// The parent of every node. Throws GltfError for a node with two parents and for cycles.
std::vector<int> findParents(const tinygltf::Model& model) {
    std::vector<int> parents(model.nodes.size(), kNoParent);
    for (size_t n = 0; n < model.nodes.size(); ++n) {
        for (const int child : model.nodes[n].children) {
            int& parent = parents[size_t(child)];
            if (parent != kNoParent) {
                failGltf("nodes[{}] is a child of nodes[{}] and of nodes[{}]", child, parent, n);
            }
            parent = int(n);
        }
    }
    // As every node has at most one parent, a walk upwards ends at a root or runs in a cycle. Nodes
    // known to end at a root are marked, so that a chain of 20000 nodes is walked only once.
    std::vector<uint8_t> isRooted(model.nodes.size(), 0);
    std::vector<size_t> chain;
    for (size_t n = 0; n < model.nodes.size(); ++n) {
        chain.clear();
        int at = int(n);
        while (at != kNoParent && !isRooted[size_t(at)]) {
            if (chain.size() > model.nodes.size())
                failGltf("nodes[{}] is its own ancestor", n);
            chain.push_back(size_t(at));
            at = parents[size_t(at)];
        }
        for (const size_t node : chain)
            isRooted[node] = 1;
    }
    return parents;
}

enum class NodeUse : uint8_t {
    None,
    Joint, ///< outside the scene, but a joint of a mesh in it, or the ancestor of such a joint
    Scene,
};

/// Marks the nodes of the default scene.
std::vector<NodeUse> findSceneNodes(GltfContext& context, const std::vector<int>& parents) {
    const tinygltf::Model& model = context.model;
    std::vector<NodeUse> uses(model.nodes.size(), NodeUse::None);
    if (model.scenes.empty()) {
        if (!model.nodes.empty())
            context.warnings.add("the file holds no scene: nothing is drawn");
        return uses;
    }
    const size_t sceneIndex = model.defaultScene < 0 ? 0 : size_t(model.defaultScene);
    std::vector<size_t> open;
    for (const int root : model.scenes[sceneIndex].nodes) {
        if (parents[size_t(root)] != kNoParent) {
            failGltf(
                "scenes[{}] lists nodes[{}], which is a child of nodes[{}]",
                sceneIndex,
                root,
                parents[size_t(root)]
            );
        }
        if (uses[size_t(root)] == NodeUse::Scene)
            failGltf("scenes[{}] lists nodes[{}] twice", sceneIndex, root);
        uses[size_t(root)] = NodeUse::Scene;
        open.push_back(size_t(root));
    }
    while (!open.empty()) {
        const size_t node = open.back();
        open.pop_back();
        for (const int child : model.nodes[node].children) {
            uses[size_t(child)] = NodeUse::Scene;
            open.push_back(size_t(child));
        }
    }
    return uses;
}

/// Marks nodes outside the scene that move joints of the scene's meshes.
void addJointNodes(
    const tinygltf::Model& model, const std::vector<int>& parents, std::vector<NodeUse>& uses
) {
    std::vector<uint8_t> isDone(model.skins.size(), 0); // many nodes may share one skin
    for (size_t n = 0; n < model.nodes.size(); ++n) {
        const tinygltf::Node& node = model.nodes[n];
        if (uses[n] != NodeUse::Scene || node.mesh < 0 || node.skin < 0 ||
            isDone[size_t(node.skin)])
            continue;
        isDone[size_t(node.skin)] = 1;
        for (int at : model.skins[size_t(node.skin)].joints) {
            for (; at != kNoParent && uses[size_t(at)] == NodeUse::None; at = parents[size_t(at)])
                uses[size_t(at)] = NodeUse::Joint;
        }
    }
}

class NodeLoader {
  public:
    NodeLoader(GltfContext& context, scene::World& world, size_t index, ecs::Entity entity)
        : mContext(context), mRegistry(world.registry), mWorld(world), mIndex(index),
          mNode(context.model.nodes[index]), mPath(fmt::format("nodes[{}]", index)),
          mEntity(entity) {}

    void load(NodeUse use) {
        addTransform();
        addMotion();
        addName();
        if (const auto blur = readMotionBlur(mContext, mNode, mPath))
            mRegistry.add<scene::MotionBlur>(mEntity, *blur);
        if (use != NodeUse::Scene)
            return;
        addMesh();
        addWaves();
        addCamera();
        addLight();
        for (const ExtraReader& reader : mContext.readers) {
            const std::string name(reader.name);
            if (const tinygltf::Value* object = findExtra(mNode.extras, name, mPath))
                reader.read({mContext, *object, mPath + ".extras." + name}, mRegistry, mEntity);
        }
    }

  private:
    void addTransform() {
        if (mNode.matrix.empty()) {
            math::Transform transform;
            transform.translation =
                readVec3(mNode.translation, transform.translation, mPath + ".translation");
            transform.rotation = readRotation(mNode.rotation, mPath + ".rotation");
            transform.scale = readVec3(mNode.scale, transform.scale, mPath + ".scale");
            mRotation = transform.rotation;
            mRegistry.add<scene::LocalTransform>(mEntity, {transform});
            return;
        }
        const dmat4 matrix = readMatrix(mNode.matrix, mPath + ".matrix");
        if (const std::optional<math::Transform> transform = decomposeMatrix(matrix)) {
            mRotation = transform->rotation;
            mRegistry.add<scene::LocalTransform>(mEntity, {*transform});
        } else {
            mRotation = orthonormalRotation(matrix);
            mRegistry.add<scene::LocalMatrix>(mEntity, {matrix});
        }
    }

    /// Converts the velocities of KHR_physics_rigid_bodies from node space to the parent's space.
    void addMotion() {
        const auto* extension = findExtension(mNode.extensions, "KHR_physics_rigid_bodies");
        if (!extension || !extension->Has("motion"))
            return;
        const tinygltf::Value& motion = extension->Get("motion");
        const std::string at = mPath + ".extensions.KHR_physics_rigid_bodies.motion";
        if (!motion.IsObject())
            failGltf("{} is not an object", at);
        if (const std::optional<dvec3> linear = findVec3(motion, "linearVelocity", at)) {
            mRegistry.add<scene::LinearVelocity>(mEntity, {mRotation * *linear});
        }
        if (const std::optional<dvec3> angular = findVec3(motion, "angularVelocity", at)) {
            mRegistry.add<scene::AngularVelocity>(mEntity, {mRotation * *angular});
        }
    }

    void addMesh() {
        if (mNode.mesh < 0)
            return;
        mRegistry.add<scene::MeshInstance>(mEntity, {scene::AssetIndex(mNode.mesh)});
        const std::vector<float>& atRest = mWorld.assets.meshes[size_t(mNode.mesh)].morphWeights;
        mContext.spendVertexBytes(atRest.size() * sizeof(float));
        scene::MorphWeights morph;
        morph.weights = readMorphWeights(mNode.weights, atRest, mPath + ".weights");
        if (!morph.weights.empty())
            mRegistry.add(mEntity, std::move(morph));
    }

    void addCamera() {
        if (mNode.camera < 0)
            return;
        const auto index = size_t(mNode.camera);
        const scene::Camera camera = readCamera(mContext, index);
        const auto lens = readLens(mContext, index);
        if (lens && camera.kind == scene::CameraKind::Orthographic)
            mContext.warnings.add(fmt::format(
                "cameras[{}].extras.lens: an orthographic camera has no lens, it is not used", index
            ));
        else if (lens)
            mRegistry.add<scene::CameraLens>(mEntity, *lens);
        mRegistry.add<scene::Camera>(mEntity, camera);
        mWorld.cameras.push_back(mEntity);
    }

    void addWaves() {
        auto waves = readVertexWaves(mContext, mNode, mPath);
        if (!waves)
            return;
        if (waves->inWorld && mNode.skin >= 0)
            mContext.warnings.add(fmt::format(
                "{}.extras.vertexWaves.space is 'world', but a skin places the node: not used",
                mPath
            ));
        mRegistry.add(mEntity, std::move(*waves));
    }

    void addLight() {
        const auto* extension = findExtension(mNode.extensions, "KHR_lights_punctual");
        if (!extension)
            return;
        const std::string at = mPath + ".extensions.KHR_lights_punctual";
        const std::optional<uint32_t> light = findIndex(*extension, "light", at);
        if (!light)
            failGltf("{}.light is missing", at);
        const size_t count = mContext.model.lights.size();
        if (*light >= count)
            failGltf("{}.light is {}, but {}", at, *light, core::thereAre(count, "light"));
        mRegistry.add<scene::Light>(mEntity, readLight(mContext, *light));
    }

    /// The node's name or, for a camera on a node without one, the camera's.
    void addName() {
        std::string name = mNode.name;
        if (name.empty() && mNode.camera >= 0) {
            name = mContext.model.cameras[size_t(mNode.camera)].name;
        }
        if (!name.empty())
            mRegistry.add<scene::Name>(mEntity, {std::move(name)});
    }

    GltfContext& mContext;
    ecs::Registry& mRegistry;
    scene::World& mWorld;
    size_t mIndex;
    const tinygltf::Node& mNode;
    std::string mPath;
    ecs::Entity mEntity;
    dquat mRotation{1.0, 0.0, 0.0, 0.0};
};

} // namespace

std::optional<math::Transform> decomposeMatrix(const dmat4& matrix) {
    math::Transform transform;
    transform.translation = dvec3(matrix[3]);
    dmat3 axes(matrix);
    transform.scale = dvec3(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
    // The direction of a flattened axis, and so the rotation, is lost.
    const double largest = std::max({transform.scale.x, transform.scale.y, transform.scale.z});
    const double smallest = std::min({transform.scale.x, transform.scale.y, transform.scale.z});
    if (!(smallest > 1e-12 * largest))
        return std::nullopt;
    for (int i = 0; i < 3; ++i)
        axes[i] /= transform.scale[i];
    if (glm::determinant(axes) < 0.0) {
        transform.scale.x = -transform.scale.x;
        axes[0] = -axes[0];
    }
    transform.rotation = glm::normalize(glm::quat_cast(axes));
    const dmat3 rebuilt = glm::mat3_cast(transform.rotation);
    for (int column = 0; column < 3; ++column) {
        if (!(glm::length(rebuilt[column] - axes[column]) < 1e-5))
            return std::nullopt;
    }
    return transform;
}

std::vector<ecs::Entity> loadNodes(GltfContext& context, scene::World& world) {
    const std::vector<tinygltf::Node>& nodes = context.model.nodes;
    const std::vector<int> parents = findParents(context.model);
    std::vector<NodeUse> uses = findSceneNodes(context, parents);
    addJointNodes(context.model, parents, uses);
    std::vector<ecs::Entity> entities(nodes.size(), ecs::kNullEntity);
    for (size_t n = 0; n < nodes.size(); ++n) {
        if (uses[n] != NodeUse::None)
            entities[n] = world.registry.create();
    }
    for (size_t n = 0; n < nodes.size(); ++n) {
        if (uses[n] == NodeUse::None)
            continue;
        NodeLoader(context, world, n, entities[n]).load(uses[n]);
        if (parents[n] != kNoParent) {
            world.registry.add<scene::Parent>(entities[n], {entities[size_t(parents[n])]});
        }
    }
    return entities;
}

} // namespace shutter::gltf
