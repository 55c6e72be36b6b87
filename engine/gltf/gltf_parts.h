// SPDX-License-Identifier: MIT
// Private to engine/gltf: the readers of a file's parts, in the order in which loadGltf calls them.
// All of them throw GltfError for what cannot be drawn.
#pragma once

#include "engine/gltf/gltf_context.h"
#include "engine/math/transform.h"
#include "engine/scene/assets.h"
#include "engine/scene/components.h"
#include "engine/scene/world.h"

#include <optional>
#include <string>
#include <vector>

namespace shutter::gltf {

// --- Assets: materials, meshes, skins

/// Fills Assets::materials (same indices as in the file), textures and images, those of
/// GltfContext::readers too. Clamps factors outside the range that glTF gives them, with a warning.
void loadMaterials(GltfContext& context, scene::Assets& assets);

/// images[index], decoded. Throws GltfError when it cannot be.
[[nodiscard]] scene::TextureImage decodeImage(const GltfContext& context, size_t index);

/// Fills Assets::environment where the default scene names a light of EXT_lights_image_based. Its
/// sharpest cube alone is read: what surfaces mirror and the irradiance are computed from it, as
/// those of every other environment are.
void loadEnvironment(GltfContext& context, scene::Assets& assets);

/// Fills Assets::meshes (same indices as in the file). Requires the materials: tangents are needed
/// where one has a normal map.
void loadMeshes(GltfContext& context, scene::Assets& assets);

/// Fills Assets::skins (same indices as in the file).
void loadSkins(GltfContext& context, scene::Assets& assets);

/// Checks the joints of every mesh that a node draws with a skin against that skin. Binds
/// primitives of such meshes that have no influences to the first joint, with a warning. Requires
/// meshes and skins.
void bindMeshes(GltfContext& context, scene::Assets& assets);

// --- Parts of a mesh

/// Fills the influences of `primitive` from JOINTS_0, WEIGHTS_0, JOINTS_1 and WEIGHTS_1 of
/// `source`; the weights of each vertex sum to 1. Weights that are negative or not finite become 0,
/// and a vertex without any weight follows the first joint it names; both with a warning.
/// \param path of the primitive, for messages
void readInfluences(
    GltfContext& context,
    const tinygltf::Primitive& source,
    const std::string& path,
    scene::Primitive& primitive
);

/// The number of morph targets, which every primitive of the mesh must share.
[[nodiscard]] size_t countMorphTargets(const tinygltf::Mesh& mesh, const std::string& path);

/// Fills `primitive.morphTargets` from `source`. Requires the primitive's attributes, its vertices
/// still being those of the file. Leaves out deltas of normals and tangents that the primitive does
/// not have, and of texture coordinates and colours.
void readMorphTargets(
    GltfContext& context,
    const tinygltf::Primitive& source,
    const std::string& path,
    scene::Primitive& primitive
);

/// The `weights` of a mesh or a node, or `fallback` where it has none. Throws GltfError unless
/// there is one weight per morph target.
/// \param fallback one weight per morph target
[[nodiscard]] std::vector<float> readMorphWeights(
    const std::vector<double>& given, const std::vector<float>& fallback, const std::string& path
);

// --- Nodes

/// Makes an entity for every node of the default scene, in the order of the file, and fills
/// World::cameras. Joints outside the scene, and their ancestors, become entities that draw
/// nothing. Returns one entity per node of the file, null for the nodes without one. Requires the
/// meshes, whose morph weights apply to nodes that give none. Throws GltfError for graphs that are
/// not forests and for values that nothing can be drawn with.
[[nodiscard]] std::vector<ecs::Entity> loadNodes(GltfContext& context, scene::World& world);

/// cameras[index] as a component.
[[nodiscard]] scene::Camera readCamera(const GltfContext& context, size_t index);

/// `extras.lens` of cameras[index], with the fields of scene::CameraLens, all optional, and those
/// of addAutoFocus(). Nothing where the camera has none. Throws GltfError, naming the member, for
/// values that scene::validate() refuses.
[[nodiscard]] std::optional<scene::CameraLens> readLens(GltfContext& context, size_t index);

/// lights[index] of KHR_lights_punctual as a component.
[[nodiscard]] scene::Light readLight(const GltfContext& context, size_t index);

/// `extras.motionBlur` of a node: {"scale": number in [0, 2], "exclude": true or false}, both
/// optional. Nothing where the node has none. Throws GltfError, naming the member, for values of
/// another type or range. \param path of the node
[[nodiscard]] std::optional<scene::MotionBlur>
readMotionBlur(GltfContext& context, const tinygltf::Node& node, const std::string& path);

/// `extras.vertexWaves` of a node (README.md). Nothing where the node has none. Throws GltfError,
/// naming the member, for values of another type or range. \param path of the node
[[nodiscard]] std::optional<scene::VertexWaves>
readVertexWaves(GltfContext& context, const tinygltf::Node& node, const std::string& path);

/// Translation, rotation and scale whose product is `matrix` to 1e-5 of its size, or nothing where
/// the matrix shears or flattens an axis. A mirror becomes a negative x scale. Requires finite
/// elements and 0 0 0 1 in the last row.
[[nodiscard]] std::optional<math::Transform> decomposeMatrix(const math::dmat4& matrix);

// --- Components added to the entities that loadNodes returns

/// Adds scene::Skinned to entities that draw a mesh with a skin.
void addSkins(GltfContext& context, scene::World& world, const std::vector<ecs::Entity>& entities);

/// Adds scene::AutoFocus to cameras whose `extras.lens` has a `focusNode`, the name of exactly one
/// node that has an entity, and perhaps a `focusHalfLife`, seconds. Throws GltfError, naming the
/// member, for other names and values.
void addAutoFocus(
    GltfContext& context, scene::World& world, const std::vector<ecs::Entity>& entities
);

/// Fills Assets::clips with the translation, rotation, scale and weights channels, adds Animated to
/// the entities they drive, adds to their MorphWeights, and makes every clip active. Requires the
/// meshes, which determine the number of weights per node.
void loadAnimations(
    GltfContext& context, scene::World& world, const std::vector<ecs::Entity>& entities
);

/// Expands EXT_mesh_gpu_instancing: creates an entity for each instance of a node as a child of the
/// node's entity, with the node's mesh and morph weights and the instance's transform. The node
/// itself then draws nothing. Must be called last: nodes must have all their components.
void expandInstances(
    GltfContext& context, scene::World& world, const std::vector<ecs::Entity>& entities
);

} // namespace shutter::gltf
