// SPDX-License-Identifier: MIT
// Scenes made in code: a few shapes, unlit or lit, static or moving.
#pragma once

#include "engine/math/math.h"
#include "engine/scene/world.h"

#include <cstdint>
#include <vector>

namespace shutter::test {

/// Where an entity is at time 0 and how it moves from there.
struct Placement {
    math::dvec3 position{0.0}; ///< metres
    math::dquat rotation{1.0, 0.0, 0.0, 0.0};
    math::dvec3 scale{1.0};
    math::dvec3 velocity{0.0};        ///< m/s
    math::dvec3 angularVelocity{0.0}; ///< rad/s, about the entity's own origin
};

/// Rectangle in the xy plane that faces +Z, centred on the origin; uv (0, 0) at its top left
/// corner, (1, 1) at its bottom right one.
[[nodiscard]] scene::Primitive makeQuad(double width, double height, scene::AssetIndex material);
/// Faces outwards; each face has the quad's uv.
[[nodiscard]] scene::Primitive makeBox(const math::dvec3& size, scene::AssetIndex material);
[[nodiscard]] scene::Primitive makeSphere(double radius, scene::AssetIndex material);
/// The primitive moved by `matrix`, which must be a rotation and a translation.
[[nodiscard]] scene::Primitive transformed(scene::Primitive primitive, const math::dmat4& matrix);

class SceneBuilder {
  public:
    /// A camera at the origin with -Z forward.
    SceneBuilder();

    scene::World world;
    ecs::Entity camera;

    [[nodiscard]] scene::Camera& cameraSettings() {
        return world.registry.get<scene::Camera>(camera);
    }

    /// \param yFov radians
    void setPerspective(double yFov, double near = 0.05);
    /// One metre is one pixel; the picture's centre is the origin. From 0.1 m to 100 m.
    void setPixelView(uint32_t heightPx);

    /// Gives the entity the transform and the velocities, in place of those it has.
    void place(ecs::Entity entity, const Placement& placement);

    void moveCamera(const Placement& placement) { place(camera, placement); }

    /// Moves every entity without a parent, the camera too. \param offset metres
    void moveAll(const math::dvec3& offset);

    scene::AssetIndex addMaterial(scene::Material material);
    /// Unlit, one colour.
    scene::AssetIndex addColor(const math::vec3& color);
    /// Unlit, double-sided or not, with `texture`.
    scene::AssetIndex addTextured(scene::AssetIndex texture, bool doubleSided = false);
    /// A texture of smooth waves of hue, no two places of a tile alike. Linear filter, repeats.
    /// \param alphaHoles every other cell of an 8 x 8 board is transparent
    scene::AssetIndex addWaveTexture(uint32_t sizePx = 64, bool alphaHoles = false);
    /// Unlit, with waves of 64 pixels. \param alphaHoles the transparent cells are cut out
    scene::AssetIndex addWaves(bool alphaHoles = false);
    /// Lit, smooth and not metallic, with waves of 64 pixels.
    scene::AssetIndex addLitWaves();

    scene::AssetIndex addMesh(std::vector<scene::Primitive> primitives);
    ecs::Entity add(scene::Primitive primitive, const Placement& placement);
    ecs::Entity add(scene::AssetIndex mesh, const Placement& placement);
    /// \param matrix may be anything, even singular or not finite
    ecs::Entity add(scene::AssetIndex mesh, const math::dmat4& matrix);
    void addSun(const math::dvec3& direction, float lux);
};

} // namespace shutter::test
