// SPDX-License-Identifier: MIT
// Interface of effects: an effect decides whether a frame needs it, and what it needs itself, then
// declares its passes. The renderer knows no effect by name.
#pragma once

#include "engine/core/result.h"
#include "engine/render/contexts.h"
#include "engine/render/explainer.h"

#include <string>

namespace shutter::render {

/// What an effect needs of a frame. Where a decision has a reason but does not `run`, that is why
/// not in this frame; without a reason, never.
struct Needs {
    core::Decision run{};          ///< its passes; without them only `exposure` counts
    core::Decision rays{};         ///< against the TLAS of the raster instant
    core::Decision timedRays{};    ///< at any time of the exposure
    core::Decision secondRaster{}; ///< PictureContext::secondRaster
    /// PictureContext::lastRaster, for effects without stored history. Only if
    /// extract::makeViewBefore() finds that frame.
    core::Decision lastRaster{};
    /// Blended surfaces that move against what is around them leave the raster
    /// (DecideContext::findTakenRows); it draws them after its own passes.
    core::Decision movingBlended{};
    /// Its picture shows the whole exposure: overlays are drawn over it, with their motion, and not
    /// into the raster; also where it does not run.
    core::Decision exposure{};
    OverlayLimits overlays{}; ///< instants and findsInstants, with `exposure` or `movingBlended`
    bool usesLens = false;    ///< it draws all from many places of the camera's lens
    /// GBuffer::edgeSurface: colours are then those of one surface, otherwise the mean of all
    /// samples.
    bool edges = false;
    bool normals = false; ///< GBuffer::normal of the frame's own raster
};

class Effect {
  public:
    virtual ~Effect() = default;

    [[nodiscard]] virtual std::string name() const = 0;

    /// Owner of its passes in statistics: PassOwner::Display for effects that show or store the
    /// picture, PassOwner::Blur only for motion blur and lens blur.
    [[nodiscard]] virtual PassOwner owner() const { return PassOwner::Other; }

    /// Pure: depends on the context and the effect's settings and history only.
    [[nodiscard]] virtual Needs decide(const DecideContext& context) const = 0;

    /// Reads the data for the effect's passes from the world; only called if decide() decided to
    /// run, for all effects of the frame in order, before any declares passes.
    virtual void extract(ExtractContext&) {}

    /// Declares passes; called after extract().
    virtual void declare(PictureContext& context) = 0;

    /// Called for each frame for which decide() was called, in order, once the GPU has finished it.
    virtual void finish(FinishedFrame&) {}
};

} // namespace shutter::render
