// SPDX-License-Identifier: MIT
// Movers of a frame's shadows in the form that shading reads: their kind, their place at each
// instant, and the mapping into their layers. Pure functions.
#pragma once

#include "engine/scene/components.h"
#include "modules/shadows/shadow_casters.h"
#include "modules/shadows/shadow_plan.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::shadows {

/// A light that casts shadows, in the world.
struct PlacedLight {
    uint32_t index = 0; ///< of the table of lights
    scene::Light light;
    math::dvec3 position{0.0};
    math::dvec3 direction{0.0, 0.0, -1.0}; ///< unit

    [[nodiscard]] bool isDirectional() const { return light.kind == scene::LightKind::Directional; }

    [[nodiscard]] LightPlace place() const {
        return isDirectional() ? LightPlace(-direction, 0.0) : LightPlace(position, 1.0);
    }
};

/// A caster with separate layers.
struct PlannedMover {
    ShadowCaster caster;
    CasterPath path;
    std::vector<CasterInstant> parts; ///< of the exposure, that have layers
};

/// Adds the rows of movers, of their instants and of their runs to a plan.
/// \param plan has all maps: of each light a layer for each mover, and for each of its parts
/// \param instantCount of the exposure
/// \return how many of them move during the exposure
uint32_t addMovers(
    ShadowPlan& plan,
    std::span<const PlannedMover> movers,
    std::span<const PlacedLight> lights,
    uint32_t instantCount
);

} // namespace shutter::shadows
