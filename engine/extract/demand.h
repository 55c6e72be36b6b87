// SPDX-License-Identifier: MIT
// Decides which work a frame needs, each with its reason: work runs because something in the
// extracted frame wants it. Pure functions.
#pragma once

#include "engine/core/result.h"
#include "engine/extract/extracted_frame.h"

namespace shutter::extract {

/// Requirements beyond opaque meshes that do not deform.
struct SurfaceDemand {
    core::Decision deformation; ///< "deform meshes": a skin, morph target or wave that is drawn
    core::Decision alphaMask;   ///< draws that test alpha
    core::Decision blending;    ///< draws that blend
};

[[nodiscard]] SurfaceDemand decideSurfaces(const ExtractedFrame& frame);

/// Whether a surface of one entity may lie behind another one that moves in the picture, as seen at
/// the raster instant. Conservative: boxes on the screen decide, and blended surfaces always count.
/// Skipped only where a ray past any mover would find nothing but the sky. Searches from far to
/// near, since most backgrounds are far, and stops at the first hit.
[[nodiscard]] core::Decision decideReveal(const ExtractedFrame& frame, const SceneLayout& layout);

} // namespace shutter::extract
