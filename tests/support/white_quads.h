// SPDX-License-Identifier: MIT
// White quads to measure by: a small one, the marker, is a point whose way across the picture can
// be measured; what a wide one covers over time is known exactly.
#pragma once

#include "engine/gpu/device.h"
#include "engine/math/math.h"
#include "tests/support/stage.h"

#include <cstdint>
#include <string_view>

namespace shutter::test {

/// Adds the marker, a white square of `sizeMetres` that faces +Z, tilted so that its edges meet the
/// pixels everywhere. Nothing else in the scene may be as bright.
[[nodiscard]] ecs::Entity
addMarker(SceneBuilder& scene, double sizeMetres, const Placement& placement);

/// Expects the motion that the raster image has in the marker's middle to be its displacement from
/// a picture of the exposure's first instant to one of its last, to 0.05 px, and longer than
/// `longerThanPx`. \param shot of a picture in which the marker is some 5 to 8 pixels wide
void expectMotionOfMarker(Stage& stage, Shot shot, double longerThanPx);

/// Expects a white quad that moves at constant speed before black to be the exact trapezoid of its
/// coverage in each shutter phase.
/// \param method, samples as Shot::method and Shot::instants
/// \param tolerance of a pixel's coverage, which lies in [0, 1]
void expectTrapezoidInEachPhase(
    gpu::Device& device, std::string_view method, uint32_t samples, double tolerance
);

} // namespace shutter::test
