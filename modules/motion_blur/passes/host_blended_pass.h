// SPDX-License-Identifier: MIT
// What a host draws over the blurred picture, part by part of the exposure.
#pragma once

#include "engine/graph/graph.h"
#include "modules/motion_blur/host_answers.h"
#include "modules/motion_blur/passes/composite.h"
#include "shaders/common/instant_surfaces.glsl"

#include <vector>

namespace shutter::motion_blur {

/// At which instants a host draws.
struct BlendedDraws {
    shader::InstantSurfaces rectangle{}; ///< with the number of instants and of parts
    std::vector<double> times;           ///< shutter times of the instants, rising
};

/// Declares one pass for each part, in which the host records its draws.
/// \param own must live until the passes have been recorded
/// \param surfaces MotionBlurOutputs::surfaces of the rectangle; invalid: there are none
[[nodiscard]] std::vector<BlendedSums> addHostBlended(
    graph::Graph& graph,
    const HostBlended& own,
    const BlendedDraws& draws,
    graph::BufferHandle surfaces
);

} // namespace shutter::motion_blur
