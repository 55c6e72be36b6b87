// SPDX-License-Identifier: MIT
// What the effects of one frame need, joined.
#pragma once

#include "engine/render/effect.h"
#include "engine/render/overlay_surfaces.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace shutter::render {

struct RunningEffect {
    Effect* effect = nullptr;
    bool readsSecondRaster = false;
    bool readsLastRaster = false;
    bool isBelowOverlays = false; ///< overlays are drawn over its picture
};

/// Decisions are those of the first effect that needs it, or else the last reason to skip.
struct FrameNeeds {
    std::vector<RunningEffect> running;
    core::Decision rays;
    core::Decision timedRays;
    core::Decision secondRaster;
    core::Decision lastRaster;
    core::Decision layer;
    DecideContext::TakenRows taken;
    bool mayTrace = false;     ///< in another frame, if not in this
    bool samplesEdges = false; ///< the frame is drawn with several samples per pixel
    bool readsEdges = false;   ///< Needs::edges of one of them
    bool readsNormals = false; ///< Needs::normals likewise
    /// Needs::exposure; run: overlays are drawn after as many of the effects as overlaysAt.
    core::Decision exposure;
    size_t overlaysAt = 0;
    OverlayLimits limits; ///< of the effect below overlays, if one runs
};

[[nodiscard]] FrameNeeds
joinNeeds(const DecideContext& context, std::span<Effect* const> effects, Explainer& explainer);

} // namespace shutter::render
