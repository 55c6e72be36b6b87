// SPDX-License-Identifier: MIT
// Interface of overlays: what is blended is drawn into the raster's colour at its instant or, where
// an effect's picture shows the whole exposure (Needs::exposure), over that with its motion.
#pragma once

#include "engine/core/result.h"
#include "engine/extract/frame_view.h"
#include "engine/render/contexts.h"
#include "engine/render/explainer.h"
#include "engine/render/overlay_surfaces.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace shutter::render {

/// The world for what an overlay draws in one frame.
struct OverlayExtract {
    const scene::World& world;
    const extract::SceneLayout& layout;
    const extract::ViewRequest& view;
    const extract::FrameView& frameView; ///< of `view`
    const extract::ExtractedFrame& frame;
    std::span<const uint32_t> takenRows; ///< ExtractContext::takenRows
    /// Drawn over an effect's picture of the exposure; else into the raster's colour or, what draws
    /// taken rows, over the picture of an effect without an exposure.
    bool isOverExposure = false;
    math::dvec2 jitterPx{0.0}; ///< of the colour that it is drawn on (ViewRequest::jitterPx)
    OverlayLimits limits;      ///< of the effect
    uint32_t slot = 0;         ///< of the frames in flight
};

struct OverlayPlan {
    bool draws = false;
    /// At which it is drawn, in a rectangle; no instants: as a whole.
    shader::InstantSurfaces instants{};
    bool readsSurfaces = false; ///< those visible at `instants`
    uint64_t imageBytes = 0;    ///< of what it is drawn into
    std::string label;          ///< of "... instants" and "... bytes" in statistics
    std::vector<Explanation> explanations;
};

/// The graph for the passes of an overlay.
struct OverlayContext {
    graph::Graph& graph;
    const extract::ViewRequest& view;
    const extract::ExtractedFrame& frame;
    const gpu_scene::DeformedMeshes& shapes;      ///< of `frame`
    graph::ImageHandle motionDepth;               ///< GBuffer::motionDepth
    std::span<const graph::BufferHandle> shading; ///< PictureContext::shading
    VkDeviceAddress frameConstants = 0;           ///< shader::FrameConstants
    VkDeviceAddress response = 0;                 ///< shader::ResponseTable; 0: a box
    graph::ImageHandle color{};                   ///< linear HDR, that it is drawn on
    math::dvec2 jitterPx{0.0};                    ///< of `color`
    /// OverlayPlan::instants; nothing: it does not read them.
    std::optional<OverlaySurfaces> surfaces{};
    const CompositeParts* composite = nullptr; ///< the effect's; null: it has none
    uint32_t slot = 0;                         ///< OverlayExtract's
};

/// Motion of an overlay over an exposure.
struct OverlayMotion {
    double longestPx = 0.0;  ///< of any visible point
    bool isFleeting = false; ///< something visible appears, disappears or changes its colour
};

class Overlay {
  public:
    virtual ~Overlay() = default;

    /// Of the intermediate that shows it alone, over black.
    [[nodiscard]] virtual std::string name() const = 0;

    /// Rows whose blended surfaces it draws in place of the raster, over the picture of an effect
    /// with Needs::movingBlended, rising; its passes then count as the effect's.
    [[nodiscard]] virtual std::vector<uint32_t>
    findRows(const DecideContext&, bool /*usesLens*/) const {
        return {};
    }

    /// Plans a frame, whose slot's last one is finished. Error: something cannot be drawn.
    [[nodiscard]] virtual core::Result<OverlayPlan> extract(const OverlayExtract& source) = 0;

    /// Declares its passes; called after extract() where that draws, and once more for the
    /// intermediate.
    /// \return the picture with it
    [[nodiscard]] virtual graph::ImageHandle declare(const OverlayContext& context) = 0;

    /// Error: as extract().
    [[nodiscard]] virtual core::Result<OverlayMotion>
    measureMotion(const scene::World&, const extract::ViewRequest&) const {
        return OverlayMotion{};
    }
};

} // namespace shutter::render
