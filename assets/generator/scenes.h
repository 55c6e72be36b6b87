// SPDX-License-Identifier: MIT
// The scenes themselves and the little they share: how a shot is framed.
#pragma once

#include "assets/generator/gltf_writer.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <string>

namespace shutter::generator {

/// Motions are laid out for this exposure, which ends at time 0, and this picture.
inline constexpr float kExposureSeconds = 1.0f / 60.0f;
inline constexpr glm::vec2 kPictureSizePx{1280.0f, 720.0f};

/// A pinhole camera, with -Z of its rotation forward.
struct Shot {
    glm::vec3 position{0.0f};                 ///< metres
    float yaw = 0.0f;                         ///< radians about +Y, applied after pitch
    float pitch = 0.0f;                       ///< radians about +X, negative: downwards
    float yFov = 0.6f;                        ///< radians
    glm::vec2 pictureSizePx = kPictureSizePx; ///< in whose pixels places and motions are given

    [[nodiscard]] glm::quat rotation() const;
    [[nodiscard]] float focalLengthPx() const;
    /// The point at `depth` metres along the view axis seen at `pixel` (y downwards).
    [[nodiscard]] glm::vec3 pointAt(glm::vec2 pixel, float depth) const;
    /// Metres a second, parallel to the picture, that cross `pixels` (y downwards) in one exposure
    /// at `depth` metres along the view axis.
    [[nodiscard]] glm::vec3 velocityFor(glm::vec2 pixels, float depth) const;
};

/// Rotation of a directional light's node so that the light travels along `direction`.
[[nodiscard]] glm::quat rotationTowards(glm::vec3 direction);

/// Adds a node with a mesh of a single material. \return the node
Index addObject(GltfWriter& writer, NodeDesc node, const Shape& shape, Index material);

/// Adds a texture and a material of the same name. \return the material
Index addTextured(GltfWriter& writer, const char* name, const Picture& picture, float roughness);

/// The still part of the vase scene: wall, floor, white sofa with a pink cushion at its left, lamp,
/// table, picture. The sofa faces +Z; none of it reaches beyond z = -0.5 m.
void addRoom(GltfWriter& writer);

/// `sun` and `fill_lamp`.
void addRoomLights(GltfWriter& writer);

/// A material of one colour without a texture. \param color linear
Index addPlainMaterial(GltfWriter& writer, const char* name, glm::vec3 color, float roughness);

[[nodiscard]] GltfWriter buildVaseScene();
[[nodiscard]] GltfWriter buildCourtyardScene();

} // namespace shutter::generator
