// SPDX-License-Identifier: MIT
// Interface of features that take part in shading: they fill tables of FrameConstants::slots, which
// the raster and rays read.
#pragma once

#include "engine/core/result.h"
#include "engine/extract/extracted_frame.h"
#include "engine/extract/frame_view.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/graph.h"
#include "engine/render/explainer.h"
#include "engine/scene/world.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace shutter::render {

/// The rasters of a frame.
enum class RasterKind : uint8_t {
    Own,
    Second, ///< PictureContext::secondRaster
    Last,   ///< PictureContext::lastRaster
};
inline constexpr size_t kRasterKinds = 3;

/// The world as one raster shows it.
struct RasterExtract {
    const scene::World& world;
    const extract::SceneLayout& layout;
    const extract::ViewRequest& view;
    const extract::FrameView& frameView; ///< of `view`
    const extract::ExtractedFrame& frame;
    /// Views of Second and Last have an instant, and are shaded over the exposure as Own is.
    RasterKind kind = RasterKind::Own;
    uint32_t slot = 0; ///< of the frames in flight
};

/// Addresses of shader::FrameConstants::slots; 0: there is no such table.
using ShadingSlots = std::array<VkDeviceAddress, shader::kShadingSlots>;

/// What a feature adds to the shading of one raster.
struct Shading {
    core::Decision run;
    std::vector<Explanation> explanations; ///< `run` among them
    std::string passReason;                ///< why its passes run
    /// Changes whenever what a static surface shows may change, except as kSlotChanging has it.
    uint64_t revision = 0;
    ShadingSlots slots{}; ///< 0 but for the feature's own
};

/// The graph for the passes of one raster's shading.
struct RasterContext {
    graph::Graph& graph;
    const extract::ExtractedFrame& frame; ///< lives until the passes have been recorded
    graph::BufferHandle shapes;           ///< vertices of deformed meshes; invalid: there are none
    VkDeviceAddress frameConstants = 0;
    RasterKind kind = RasterKind::Own;
    uint32_t slot = 0; ///< RasterExtract's
};

class ShadingFeature {
  public:
    virtual ~ShadingFeature() = default;

    /// Writes the tables of one raster, whose slot's last frame is finished.
    /// Error: the device cannot hold them.
    [[nodiscard]] virtual core::Result<Shading> extract(const RasterExtract& raster) = 0;

    /// Declares passes before the raster; called after extract() where that decided to run.
    /// \return what shading reads with Access::ShaderRead
    [[nodiscard]] virtual graph::BufferHandle declare(const RasterContext& context) = 0;

    /// Called once per submitted frame that effects draw, whether or not it ran.
    virtual void endFrame() {}
};

/// What all features add to the shading of one raster.
struct RasterShading {
    struct Running {
        ShadingFeature* feature = nullptr;
        std::string passReason;
    };

    std::vector<Running> running;
    std::vector<Explanation> explanations;
    uint64_t revision = 0; ///< Shading's
    ShadingSlots slots{};
};

/// Calls extract() of all. Error: the first of theirs.
[[nodiscard]] core::Result<RasterShading>
extractShading(std::span<ShadingFeature* const> features, const RasterExtract& raster);

/// A bit for each slot that has a table.
[[nodiscard]] uint32_t listSlots(const ShadingSlots& slots);

} // namespace shutter::render
