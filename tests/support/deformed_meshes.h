// SPDX-License-Identifier: MIT
// Skinned and morphed meshes made in code.
#pragma once

#include "tests/kit/scene_builder.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::test {

/// Rectangle in the xy plane that faces +Z, its foot's middle at the origin, of `rows` quads one
/// above the other. Deformed by joints 0 and 1: the share of joint 1 grows from 0 at the foot to 1
/// at the top.
[[nodiscard]] scene::Primitive
makeStrip(double width, double height, uint32_t rows, scene::AssetIndex material);

/// Binds each vertex to joints 0 ... count - 1 in equal shares.
/// \param count a multiple of 4 or less than 4
void bindEqually(scene::Primitive& primitive, uint32_t count);

struct SkinnedEntity {
    ecs::Entity entity;
    std::vector<ecs::Entity> joints;
};

/// \param joints the first is a root, each other one a child of the one before. The mesh is bound
/// to their pose at time 0 with the first at the origin, unrotated. One that neither moves nor
/// turns has no velocity components.
SkinnedEntity
addSkinned(SceneBuilder& scene, scene::Primitive primitive, std::span<const Placement> joints);

/// Morph targets' weights go from `from` to `to` in a straight line over the seconds [begin, end].
struct MorphWay {
    std::vector<float> from;
    std::vector<float> to;
    float begin = -1.0f;
    float end = 1.0f;
};

ecs::Entity addMorphed(
    SceneBuilder& scene, scene::Primitive primitive, const Placement& placement, const MorphWay& way
);

} // namespace shutter::test
