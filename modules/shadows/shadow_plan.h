// SPDX-License-Identifier: MIT
// Plans a frame's shadows: which lights have maps and from which views, which casters are in them,
// and which movers have separate layers. Pure functions, independent of the device.
#pragma once

#include "engine/core/result.h"
#include "engine/extract/extracted_frame.h"
#include "engine/render/shading_feature.h"
#include "modules/shadows/shadow_settings.h"
#include "modules/shadows/shadow_views.h"
#include "shaders/shadows/shadow_shared.h"

#include <cstdint>
#include <vector>

namespace shutter::shadows {

/// Maximum number of movers with separate layers; the apparently largest come first. The others are
/// drawn into the lights' maps, which are then redrawn each frame, and their shadows stay sharp.
inline constexpr uint32_t kMaxShadowMovers = 32;
/// Most layers of the raster instant, of all lights together.
inline constexpr uint32_t kMaxShadowLayers = 64;
/// Most layers of parts of the exposure (ShadowMover::partCount), of all movers and lights
/// together.
inline constexpr uint32_t kMaxPartLayers = 64;

/// A map and its casters.
struct PlannedMap {
    LightView view;
    uint32_t sizePx = 0;
    uint32_t firstTexel = 0; ///< in the frame's texels
    /// Row of the mover whose layer this is; shader::kNoEntity: casters of ShadowPlan::mapCasters.
    uint32_t mover = shader::kNoEntity;
    float shapeShift = 0.0f; ///< shader::ShadowDraw's
};

struct ShadowPlan {
    core::Decision shadows;           ///< whether any light casts shadows in this frame
    core::Decision blur;              ///< whether shadows of movers are averaged over the exposure
    std::vector<PlannedMap> maps;     ///< those of lights, then movers' layers
    uint32_t lightMapCount = 0;       ///< of `maps`: those of lights
    std::vector<uint32_t> mapCasters; ///< rows of the entity table
    /// Changes whenever one of mapCasters may have changed.
    uint64_t casterRevision = 0;
    std::vector<shader::ShadowLight> lights; ///< one per light
    std::vector<shader::ShadowMover> movers;
    std::vector<shader::ShadowInstant> instants; ///< all of a mover's, then the next one's
    std::vector<shader::CasterSpan> runs;        ///< by light that is far away, then by mover
    uint32_t instantCount = 1;
    std::vector<uint32_t> tiles; ///< shader::kSlotChanging: bits of movers
    uint64_t texelCount = 0;
    math::dvec3 eye{0.0}; ///< origin of the frame's camera-relative space, in the world
};

/// \param raster with an instant, shadows of RasterKind::Own are those of that instant alone
[[nodiscard]] ShadowPlan
planShadows(const render::RasterExtract& raster, const ShadowSettings& settings);

} // namespace shutter::shadows
