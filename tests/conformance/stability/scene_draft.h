// SPDX-License-Identifier: MIT
// Scenes made in code, ready to be drawn by any method of the program.
#pragma once

#include "assets/generator/mesh_shapes.h"
#include "engine/math/math.h"
#include "game/shot/shot.h"

#include <span>
#include <vector>

namespace shutter::stability {

/// Where an entity is at time 0 and how it moves from there.
struct Stand {
    math::dvec3 position{0.0}; ///< metres
    math::dquat rotation{1.0, 0.0, 0.0, 0.0};
    math::dvec3 scale{1.0};
    math::dvec3 velocity{0.0};        ///< m/s
    math::dvec3 angularVelocity{0.0}; ///< rad/s, about the entity's own origin
};

/// A world with one camera at the origin that looks down -Z: perspective, 0.9 rad high.
class SceneDraft {
  public:
    SceneDraft();

    game::Shot shot;

    [[nodiscard]] scene::Camera& camera();
    /// Orthographic: one metre is one pixel, the picture's centre is the origin.
    void setPixelView(uint32_t heightPx);
    void place(ecs::Entity entity, const Stand& stand);

    [[nodiscard]] scene::AssetIndex addMaterial(scene::Material material);
    /// Unlit, one colour.
    [[nodiscard]] scene::AssetIndex addColor(const math::vec3& color);
    /// Unlit, smooth waves of hue. \param alphaHoles every other cell of an 8 x 8 board is cut out
    [[nodiscard]] scene::AssetIndex addWaves(bool alphaHoles = false);
    /// Lit, smooth waves of hue.
    [[nodiscard]] scene::AssetIndex addLitWaves();
    void addSun(const math::dvec3& direction, float lux);

    ecs::Entity add(const generator::Shape& shape, scene::AssetIndex material, const Stand& stand);
    /// One mesh of several shapes with one material.
    ecs::Entity
    add(std::span<const generator::Shape> shapes, scene::AssetIndex material, const Stand& stand);
    /// With a matrix, which may be anything.
    ecs::Entity
    add(const generator::Shape& shape, scene::AssetIndex material, const math::dmat4& matrix);

    /// Moves every entity without a parent, the camera too.
    void moveAll(const math::dvec3& offset);

  private:
    [[nodiscard]] scene::AssetIndex addWaveTexture(bool alphaHoles);
    [[nodiscard]] scene::AssetIndex
    addMesh(std::span<const generator::Shape> shapes, scene::AssetIndex material);
};

/// A textured wall that fills the picture (the first entity) and a lit sphere before it that moves.
/// \return the sphere
ecs::Entity buildStage(SceneDraft& draft);

/// A sheet in the xy plane that faces +Z. \param width, height metres
[[nodiscard]] generator::Shape makeSheet(double width, double height);
[[nodiscard]] generator::Shape makeBox(double width, double height, double depth);

} // namespace shutter::stability
