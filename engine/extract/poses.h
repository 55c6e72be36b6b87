// SPDX-License-Identifier: MIT
// Where entities, the camera and lights are at an instant, as rendering needs it.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/math/math.h"
#include "engine/scene/components.h"
#include "engine/scene/world.h"
#include "shaders/render/scene_shared.h"

namespace shutter::extract {

/// Finite and not singular: its triangles have an area, and there is a way back.
[[nodiscard]] bool isDrawable(const math::dmat4& matrix);

/// Scale in a camera's node has no meaning for the view: only where it stands and looks counts. One
/// that is scaled to nothing looks along the world's axes.
[[nodiscard]] math::dmat4 computeWorldFromView(const math::dmat4& worldFromCamera);

/// \param world of the light's entity, finite
/// \param origin of eye space in the world
[[nodiscard]] shader::LightRow
makeLight(const scene::Light& light, const math::dmat4& world, const math::dvec3& origin);

} // namespace shutter::extract
