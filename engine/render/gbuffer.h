// SPDX-License-Identifier: MIT
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/graph/graph.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace shutter::render {

/// What the raster pass leaves. Formats are chosen for one nearest fetch a tap (lavapipe) and for
/// motion to a hundredth of a pixel.
struct GBuffer {
    graph::ImageHandle color;  ///< RGBA16F, linear HDR, at most kMaxColor
    graph::ImageHandle normal; ///< RGBA16F, xyz unit, world axes; 0 where nothing is
    graph::ImageHandle
        motionDepth; ///< RGBA32F: motion.xy pixels open to close, depth metres along the view
    graph::ImageHandle entityId; ///< R32_UINT: row of the entity table, or kNoEntity
};

/// The pipelines of the G-buffer; one per scene (they know its texture table).
class GBufferPass {
  public:
    enum class Variant : uint8_t { Opaque, Masked, Blended, Premultiplied };

    /// The pipelines of one variant.
    struct Pipelines {
        /// \param mayHaveShadows false: for frames in which no light casts any
        Pipelines(
            gpu::Device& device,
            const gpu_scene::GpuScene& scene,
            Variant variant,
            bool mayHaveShadows
        );

        gpu::Pipeline still;  ///< of entities that have no motion: works out none and writes 0
        gpu::Pipeline moving; ///< of the others
    };

    /// By Variant: of those that the scene has surfaces of.
    using Variants = std::array<std::optional<Pipelines>, 4>;

    GBufferPass(gpu::Device& device, const gpu_scene::GpuScene& scene);

    /// Declares the pass; the first frame with shadows, and the first without, makes pipelines.
    /// `frame` and `scene` must live until it has been recorded.
    /// \param name of the pass
    /// \param reads what its shaders reach by addresses; invalid ones are passed over
    [[nodiscard]] GBuffer declare(
        graph::Graph& graph,
        const std::string& name,
        const extract::ExtractedFrame& frame,
        const gpu_scene::GpuScene& scene,
        std::span<const graph::BufferHandle> reads,
        VkDeviceAddress frameConstants
    );

  private:
    const Variants& findVariants(bool mayHaveShadows);

    gpu::Device& mDevice;
    const gpu_scene::GpuScene& mScene;
    std::array<std::optional<Variants>, 2> mVariants; ///< by whether lights may cast shadows
    gpu::Pipeline mSky;
};

} // namespace shutter::render
