// SPDX-License-Identifier: MIT
// What may come into sight behind what moves: rays are traced only where there are surfaces to
// find.
#pragma once

#include "engine/render/demand.h"
#include "engine/render/extraction.h"
#include "engine/render/gpu_scene.h"

namespace shutter::render {

/// Whether a surface of one entity may lie behind another one that moves in the picture, as seen at
/// the raster instant. Conservative: boxes on the screen decide, and blended surfaces always count.
/// Skipped only where a ray past any mover would find nothing but the sky. Looks from far to near,
/// where most pictures have their background, and stops at the first that is found.
[[nodiscard]] Decision decideReveal(const ExtractedFrame& frame, const SceneLayout& layout);

} // namespace shutter::render
