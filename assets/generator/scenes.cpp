// SPDX-License-Identifier: MIT
#include "assets/generator/scenes.h"

#include <cmath>

namespace shutter::generator {

glm::quat Shot::rotation() const {
    return glm::angleAxis(yaw, glm::vec3(0, 1, 0)) * glm::angleAxis(pitch, glm::vec3(1, 0, 0));
}

float Shot::focalLengthPx() const {
    return pictureSizePx.y / 2.0f / std::tan(yFov / 2.0f);
}

glm::vec3 Shot::pointAt(glm::vec2 pixel, float depth) const {
    const glm::vec2 offset = (pixel - pictureSizePx / 2.0f) / focalLengthPx() * depth;
    return position + rotation() * glm::vec3(offset.x, -offset.y, -depth);
}

glm::vec3 Shot::velocityFor(glm::vec2 pixels, float depth) const {
    const glm::vec2 metres = pixels / focalLengthPx() * depth;
    return rotation() * glm::vec3(metres.x, -metres.y, 0.0f) / kExposureSeconds;
}

glm::quat rotationTowards(glm::vec3 direction) {
    return glm::quatLookAt(glm::normalize(direction), glm::vec3(0, 1, 0));
}

Index addObject(GltfWriter& writer, NodeDesc node, const Shape& shape, Index material) {
    const MeshPart part{.shape = shape, .material = material};
    node.mesh = writer.addMesh(node.name, {&part, 1});
    return writer.addNode(node);
}

Index addTextured(GltfWriter& writer, const char* name, const Picture& picture, float roughness) {
    return writer.addMaterial(
        {.name = name, .texture = writer.addTexture(name, picture), .roughness = roughness}
    );
}

Index addPlainMaterial(GltfWriter& writer, const char* name, glm::vec3 color, float roughness) {
    return writer.addMaterial({.name = name, .color = color, .roughness = roughness});
}

} // namespace shutter::generator
