// SPDX-License-Identifier: MIT
// Scenes of the suites: shapes of the asset generator, put into a scene made in code.
#pragma once

#include "assets/generator/mesh_shapes.h"
#include "tests/kit/scene_builder.h"

#include <span>

namespace shutter::stability {

using test::Placement;
using test::SceneBuilder;

/// One camera at the origin that looks down -Z, perspective, 0.9 rad high; its velocities are 0.
[[nodiscard]] SceneBuilder makeEmptyScene();

ecs::Entity addShape(
    SceneBuilder& scene,
    const generator::Shape& shape,
    scene::AssetIndex material,
    const Placement& placement
);

/// \param matrix may be anything, even singular or not finite
ecs::Entity addShape(
    SceneBuilder& scene,
    const generator::Shape& shape,
    scene::AssetIndex material,
    const math::dmat4& matrix
);

/// One mesh of several shapes with one material.
ecs::Entity addShapes(
    SceneBuilder& scene,
    std::span<const generator::Shape> shapes,
    scene::AssetIndex material,
    const Placement& placement
);

/// A textured wall that fills the picture (the first entity) and a lit sphere before it that moves.
/// \return the sphere
ecs::Entity addWallAndSphere(SceneBuilder& scene);

/// A sheet in the xy plane that faces +Z. \param width, height metres
[[nodiscard]] generator::Shape makeSheetShape(double width, double height);
/// \param width, height, depth metres
[[nodiscard]] generator::Shape makeBoxShape(double width, double height, double depth);

} // namespace shutter::stability
