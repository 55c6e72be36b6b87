// SPDX-License-Identifier: MIT
// Contents of a scene besides entities: meshes, materials, textures, clips. Plain data in main
// memory, independent of Vulkan and file formats.
#pragma once

#include "engine/math/bounds.h"
#include "engine/math/math.h"
#include "engine/scene/environment.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace shutter::scene {

/// Index into one of the vectors of Assets; kNone where there is none.
using AssetIndex = uint32_t;
inline constexpr AssetIndex kNone = 0xFFFFFFFFu;

/// What one morph target adds to a primitive at weight 1. Each array is either empty or as long as
/// the primitive's `positions`.
struct MorphTarget {
    std::vector<math::vec3> positions; ///< metres
    std::vector<math::vec3> normals;   ///< added before normalising
    std::vector<math::vec3> tangents;  ///< added to xyz; handedness stays
};

/// Triangles with one material. All attribute arrays are either empty or as long as `positions`.
struct Primitive {
    std::vector<math::vec3> positions; ///< metres, object space; every value finite
    std::vector<math::vec3> normals;   ///< unit length; never empty (flat normals where none given)
    std::vector<math::vec4>
        tangents; ///< xyz unit length, w = +1 or -1; empty: no normal map is used
    std::vector<math::vec2> uv0;
    std::vector<math::vec2> uv1;
    std::vector<math::vec4> colors;        ///< linear RGBA factor
    std::vector<uint32_t> indices;         ///< three per triangle, each below positions.size()
    uint32_t influenceCount = 0;           ///< joints a vertex: 0 (no skin), or a multiple of 4
    std::vector<uint16_t> joints;          ///< influenceCount a vertex: index into Skinned::joints
    std::vector<float> weights;            ///< as many; [0, 1], the sum of a vertex's is 1
    std::vector<MorphTarget> morphTargets; ///< as many in every primitive of a mesh
    AssetIndex material = kNone;           ///< kNone: the default material
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives; ///< may be empty (a mesh of points or lines only)
    math::Bounds bounds;               ///< of all positions, object space, undeformed
    std::vector<float> morphWeights;   ///< at rest, one per morph target
};

/// 8-bit RGBA, row 0 at the top.
struct TextureImage {
    std::string name;
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<uint8_t> rgba; ///< width * height * 4 bytes as stored in the file (no conversion)
};

enum class Wrap : uint8_t { Repeat, MirroredRepeat, ClampToEdge };

struct Texture {
    AssetIndex image = kNone;
    Wrap wrapU = Wrap::Repeat;
    Wrap wrapV = Wrap::Repeat;
    bool nearest = false; ///< magnification filter is NEAREST; otherwise linear with mip maps
    /// It may be shown whether a material does or not.
    bool isLoose = false;
};

/// A texture as a material refers to it, with KHR_texture_transform folded in.
struct TextureSlot {
    AssetIndex texture = kNone;
    uint32_t uvSet = 0;      ///< 0 or 1
    math::vec2 offset{0.0f}; ///< uv' = offset + rotate(rotation) * (scale * uv)
    float rotation = 0.0f;   ///< radians, as KHR_texture_transform defines its sign
    math::vec2 scale{1.0f};
};

enum class AlphaMode : uint8_t { Opaque, Mask, Blend };

/// How a surface of AlphaMode::Blend is combined with its background.
enum class BlendMode : uint8_t {
    Over,
    Add,           ///< adds colour times alpha, hides nothing
    Premultiplied, ///< over, with a colour that was multiplied by alpha
};

/// glTF metallic-roughness, KHR_materials_unlit, KHR_materials_emissive_strength.
struct Material {
    std::string name;
    math::vec4 baseColorFactor{1.0f}; ///< linear RGBA
    float metallicFactor = 1.0f;      ///< [0, 1]
    float roughnessFactor = 1.0f;     ///< [0, 1], perceptual
    float normalScale = 1.0f;
    float occlusionStrength = 1.0f; ///< [0, 1]
    math::vec3 emissive{0.0f};      ///< factor times strength, linear
    float alphaCutoff = 0.5f;       ///< Mask only: covered where alpha >= cutoff
    AlphaMode alphaMode = AlphaMode::Opaque;
    BlendMode blendMode = BlendMode::Over;
    bool doubleSided = false;
    bool unlit = false;
    TextureSlot baseColor;         ///< sRGB
    TextureSlot metallicRoughness; ///< linear: g roughness, b metallic
    TextureSlot normal;            ///< linear
    TextureSlot occlusion;         ///< linear: r
    TextureSlot emissiveTexture;   ///< sRGB
};

enum class Interpolation : uint8_t { Step, Linear, CubicSpline };
enum class AnimationPath : uint8_t { Translation, Rotation, Scale };

/// One animated property of one node.
struct AnimationChannel {
    uint32_t node =
        0; ///< node index of the file; the loader puts an Animated component on its entity
    AnimationPath path = AnimationPath::Translation;
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times; ///< seconds, strictly increasing, at least one
    /// One value per key; three (in-tangent, value, out-tangent) for CubicSpline. Rotations are
    /// quaternions x, y, z, w; the others use x, y, z.
    std::vector<math::vec4> values;
};

/// The animated morph weights of one node.
struct WeightChannel {
    uint32_t node = 0; ///< node index of the file
    Interpolation interpolation = Interpolation::Linear;
    uint32_t targetCount = 0; ///< above 0
    std::vector<float> times; ///< seconds, strictly increasing, at least one
    /// targetCount a key; 3 * targetCount for CubicSpline (in-tangents, values, out-tangents).
    std::vector<float> values;
};

struct AnimationClip {
    std::string name;
    double duration = 0.0; ///< seconds: the last key of any channel
    std::vector<AnimationChannel> channels;
    std::vector<WeightChannel> weightChannels;
};

/// Joints that deform a mesh; Skinned lists the joints' entities.
struct Skin {
    std::string name;
    std::vector<math::dmat4> jointFromBind; ///< inverse bind matrices, one per joint; at least one
};

struct Assets {
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<TextureImage> images;
    std::vector<AnimationClip> clips;
    std::vector<Skin> skins;
    std::optional<Environment> environment; ///< nothing: --background and --ambient alone
};

} // namespace shutter::scene
