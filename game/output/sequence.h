// SPDX-License-Identifier: MIT
// Frames one after the other, each on disk before the next, those that are there already left out.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/io/video.h"
#include "game/output/render_options.h"

#include <optional>

namespace shutter::game {

/// Draws every frame of `options`, which may become a film, and writes what was asked for.
/// \param encoder of the film, where there is to be one
[[nodiscard]] core::Status renderSequence(
    RenderOptions options, const std::optional<io::VideoEncoder>& encoder, gpu::Device& device
);

} // namespace shutter::game
