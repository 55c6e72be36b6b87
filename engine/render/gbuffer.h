// SPDX-License-Identifier: MIT
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/render/gbuffer_images.h"
#include "engine/render/sample_split.h"

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>

namespace shutter::render {

/// The pipelines of the G-buffer; one per scene (they know its texture table).
class GBufferPass {
  public:
    enum class Variant : uint8_t { Opaque, Masked, Blended, Premultiplied };

    /// Specialisation of the pipelines.
    struct Targets {
        uint32_t slots = 0;   ///< that shading reads (listSlots())
        uint32_t samples = 1; ///< per pixel, 1 or shader::kSampleCount
        bool writesNormals = false;

        auto operator<=>(const Targets&) const = default;
    };

    /// The pipelines of one variant.
    struct Pipelines {
        Pipelines(
            gpu::Device& device,
            const gpu_scene::GpuScene& scene,
            Variant variant,
            const Targets& targets
        );

        gpu::Pipeline still;  ///< for entities without motion: writes 0
        gpu::Pipeline moving; ///< of the others
    };

    /// By Variant: those of the scene's surfaces.
    using Variants = std::array<std::optional<Pipelines>, 4>;

    GBufferPass(gpu::Device& device, const gpu_scene::GpuScene& scene);

    /// Inputs of a frame's draws.
    struct Source {
        const extract::ExtractedFrame& frame;
        const gpu_scene::GpuScene& scene;
        std::span<const uint32_t> taken; ///< rows whose blended surfaces are left out, rising
        std::span<const graph::BufferHandle> reads; ///< by addresses; invalid ones are passed over
        VkDeviceAddress frameConstants = 0;
        uint32_t slots = 0;         ///< that the frame has (listSlots())
        bool samplesEdges = false;  ///< ViewRequest::samplesEdges
        bool keepsEdges = false;    ///< GBuffer::edgeSurface is read
        bool writesNormals = false; ///< GBuffer::normal is read
        math::vec2 confusion{0.0f}; ///< InstantMotions::confusion; 0: a pinhole
    };

    /// Declares the pass; the first frame of each Targets makes pipelines. What `source` refers to
    /// must live until it has been recorded.
    /// \param name of the pass
    [[nodiscard]] GBuffer
    declare(graph::Graph& graph, const std::string& name, const Source& source);

  private:
    /// The pipelines of one kind of target.
    struct Drawers {
        Variants variants;
        gpu::Pipeline sky;
    };

    const Drawers& findDrawers(const Targets& targets);

    gpu::Device& mDevice;
    const gpu_scene::GpuScene& mScene;
    std::map<Targets, Drawers> mDrawers;
    SampleSplit mSplit;
    bool mMaySample; ///< the device can draw several samples per pixel
};

} // namespace shutter::render
