// SPDX-License-Identifier: MIT
#pragma once

#include "assets/generator/mesh_shapes.h"
#include "assets/generator/picture.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace shutter::generator {

/// Index of something added before; kNothing where there is none.
using Index = int;
inline constexpr Index kNothing = -1;

struct MaterialDesc {
    std::string name{};
    glm::vec3 color{1.0f};    ///< linear base colour factor
    Index texture = kNothing; ///< base colour, sRGB
    float metallic = 0.0f;    ///< [0, 1]
    float roughness = 0.8f;   ///< [0, 1]
    glm::vec3 emissive{0.0f}; ///< linear, 0 or more; above 1 by KHR_materials_emissive_strength
    bool doubleSided = false;
    float alpha = 1.0f; ///< [0, 1]; below 1 it blends
};

struct MeshPart {
    Shape shape;
    Index material = kNothing;
    /// Morph targets, as many in every part of a mesh: what each adds to each vertex, metres.
    std::vector<std::vector<glm::vec3>> targets{};
};

/// Exactly one of the two kinds of KHR_lights_punctual we use.
struct LightDesc {
    bool directional = false;
    glm::vec3 color{1.0f};  ///< linear
    float intensity = 1.0f; ///< lux when directional, else candela
};

struct NodeDesc {
    std::string name{};
    Index parent = kNothing;
    glm::vec3 translation{0.0f};                ///< metres
    glm::quat rotation{1.0f, 0.0f, 0.0f, 0.0f}; ///< unit; identity for nodes that have a velocity
    Index mesh = kNothing;
    Index skin = kNothing; ///< places the node: its own transform has no meaning then
    Index camera = kNothing;
    Index light = kNothing;
    std::optional<glm::vec3> linearVelocity{};  ///< m/s, node space
    std::optional<glm::vec3> angularVelocity{}; ///< rad/s, node space, about the node's origin
    nlohmann::json waves{};     ///< extras.vertexWaves (engine/gltf/README.md); null: none
    nlohmann::json particles{}; ///< extras.particles, likewise
};

/// Collects one scene and writes it as a single binary glTF 2.0 file.
class GltfWriter {
  public:
    explicit GltfWriter(std::string title);

    /// Opens a binary glTF file with one scene and one buffer, for additions. write() returns
    /// errors of the file.
    [[nodiscard]] static GltfWriter open(const std::filesystem::path& path);

    /// Repeats, with mip maps.
    Index addTexture(const std::string& name, const Picture& picture);
    Index addMaterial(const MaterialDesc& material);
    Index addMesh(const std::string& name, std::span<const MeshPart> parts);
    /// Perspective, 16:9, far plane at infinity. \param yFov radians
    /// \param lens extras.lens (docs/lens.md); null: a pinhole
    Index addCamera(
        const std::string& name, float yFov, float nearMetres, const nlohmann::json& lens = {}
    );
    Index addLight(const std::string& name, const LightDesc& light);
    /// The parent must have been added before.
    Index addNode(const NodeDesc& node);
    /// Gives the first node of that name a velocity, m/s in its own space. write() returns an error
    /// if there is none.
    void moveNode(const std::string& name, glm::vec3 linearVelocity);

    /// \param joints nodes, added before \param jointFromBind inverse bind matrices, one per joint
    Index addSkin(
        const std::string& name,
        std::span<const Index> joints,
        std::span<const glm::mat4> jointFromBind
    );

    /// An animation without channels yet.
    Index addClip(const std::string& name);
    // Channels with LINEAR interpolation; one value per time, of weights one per morph target too.
    // Times are in seconds and rise.
    void addTranslations(
        Index clip, Index node, std::span<const float> times, std::span<const glm::vec3> values
    );
    void addRotations(
        Index clip, Index node, std::span<const float> times, std::span<const glm::quat> values
    );
    void addScales(
        Index clip, Index node, std::span<const float> times, std::span<const glm::vec3> values
    );
    void
    addWeights(Index clip, Index node, std::span<const float> times, std::span<const float> values);

    /// Empty when written; else one sentence that names the file or the texture at fault.
    [[nodiscard]] std::string write(const std::filesystem::path& path) const;

  private:
    GltfWriter() = default;

    [[nodiscard]] std::string read(const std::filesystem::path& path);
    void useExtension(const char* name);
    Index addView(const void* data, size_t byteCount, int target);
    Index addFloats(std::span<const float> values, int componentCount, int target, bool withBounds);
    Index addIndices(std::span<const uint32_t> indices);
    void addChannel(
        Index clip, Index node, const char* path, std::span<const float> times, Index output
    );
    /// POSITION, NORMAL, TEXCOORD_0 and what deforms.
    nlohmann::json addAttributes(const Shape& shape);

    nlohmann::json mRoot;
    std::vector<uint8_t> mBuffer;
    std::string mError; ///< what went wrong while collecting; empty when nothing did
};

} // namespace shutter::generator
