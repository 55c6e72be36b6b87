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
    glm::vec3 emissive{0.0f}; ///< linear, [0, 1]
};

struct MeshPart {
    Shape shape;
    Index material = kNothing;
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
    Index camera = kNothing;
    Index light = kNothing;
    std::optional<glm::vec3> linearVelocity{};  ///< m/s, node space
    std::optional<glm::vec3> angularVelocity{}; ///< rad/s, node space, about the node's origin
};

/// Collects one scene and writes it as a single binary glTF 2.0 file.
class GltfWriter {
  public:
    explicit GltfWriter(std::string title);

    /// Repeats, with mip maps.
    Index addTexture(const std::string& name, const Picture& picture);
    Index addMaterial(const MaterialDesc& material);
    Index addMesh(const std::string& name, std::span<const MeshPart> parts);
    /// Perspective, 16:9, far plane at infinity. \param yFov radians
    Index addCamera(const std::string& name, float yFov, float nearMetres);
    Index addLight(const std::string& name, const LightDesc& light);
    /// The parent must have been added before.
    Index addNode(const NodeDesc& node);

    /// Clips of one channel with LINEAR interpolation; one value a time. \param times seconds
    void addTranslationClip(
        const std::string& name,
        Index node,
        std::span<const float> times,
        std::span<const glm::vec3> translations
    );
    void addRotationClip(
        const std::string& name,
        Index node,
        std::span<const float> times,
        std::span<const glm::quat> rotations
    );

    /// Empty when written; else one sentence that names the file or the texture at fault.
    [[nodiscard]] std::string write(const std::filesystem::path& path) const;

  private:
    Index addView(const void* data, size_t byteCount, int target);
    Index addFloats(std::span<const float> values, int componentCount, int target, bool withBounds);
    Index addIndices(std::span<const uint32_t> indices);
    void addClip(
        const std::string& name,
        Index node,
        const char* path,
        std::span<const float> times,
        Index output
    );

    nlohmann::json mRoot;
    std::vector<uint8_t> mBuffer;
    std::string mError; ///< what went wrong while collecting; empty when nothing did
};

} // namespace shutter::generator
