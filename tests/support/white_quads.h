// SPDX-License-Identifier: MIT
// A small white quad, the marker: a point whose way across the picture can be measured.
#pragma once

#include "engine/math/math.h"
#include "tests/support/stage.h"

namespace shutter::test {

/// Adds the marker, a white square of `sizeMetres` that faces +Z, tilted so that its edges meet the
/// pixels everywhere. Nothing else in the scene may be as bright.
[[nodiscard]] ecs::Entity
addMarker(SceneBuilder& scene, double sizeMetres, const Placement& placement);

/// Expects the motion that the raster image has in the marker's middle to be its displacement from
/// a picture of the exposure's first instant to one of its last, to 0.05 px, and longer than
/// `longerThanPx`. \param shot of a picture in which the marker is some 5 to 8 pixels wide
void expectMotionOfMarker(Stage& stage, Shot shot, double longerThanPx);

} // namespace shutter::test
