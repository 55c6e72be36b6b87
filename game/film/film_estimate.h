// SPDX-License-Identifier: MIT
// What the frames of a film cost, from some of them drawn small.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "game/output/render_options.h"
#include "game/shot/shot.h"

#include <vector>

namespace shutter::film {

/// Milliseconds of each frame at a low resolution: only how they compare means anything.
/// \param options its frames are planned
/// Error: the device cannot draw the film, which is told by its own size.
[[nodiscard]] core::Result<std::vector<double>>
estimateCosts(const game::RenderOptions& options, const game::Shot& shot, gpu::Device& device);

} // namespace shutter::film
