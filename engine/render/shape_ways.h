// SPDX-License-Identifier: MIT
// Per-pixel motion images of deforming entities of a raster over the exposure
// (common/pixel_way.glsl), for effects with lookups in rasters.
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/extract/raster_record.h"
#include "engine/extract/shape_ways.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu_scene/deformation_pass.h"
#include "engine/gpu_scene/deformer.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/graph/graph.h"

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::render {

/// A frame with its deformed meshes, as they were declared.
struct ShapedFrame {
    const extract::ExtractedFrame* frame = nullptr;
    const gpu_scene::DeformedMeshes* shapes = nullptr;
};

/// Deforming entities of one raster. Must live until the frame is recorded.
struct ShapeWayLayer {
    std::span<const extract::ShapeWay> ways;
    ShapedFrame raster; ///< drawn in this frame; null: the one in `record`
    const extract::RasterRecord* record = nullptr;
};

/// One for each frame in flight: the GPU must have finished the frame that it was last declared
/// for.
class ShapeWays {
  public:
    explicit ShapeWays(gpu::Device& device);

    /// Declares missing shapes: those halfway, and those of stored rasters.
    /// \param now the frame whose exposure it is
    /// \param middles by index into ExtractedFrame::deformed of `now`: the shape halfway, empty
    /// where nothing changes
    void declareShapes(
        graph::Graph& graph,
        const ShapedFrame& now,
        const std::vector<scene::Deformation>& middles,
        std::span<const ShapeWayLayer> layers,
        const gpu_scene::GpuScene& scene
    );

    /// Draws a layer's image, RG32UI: packWay(), or kNoWay where nothing deforms.
    /// \param layer index into those of declareShapes()
    /// \param surface of the raster, RG32UI: bits of the depth, and a word of which `keyMask` has
    /// the row of its entity table
    [[nodiscard]] graph::ImageHandle declareLayer(
        graph::Graph& graph,
        size_t layer,
        graph::ImageHandle surface,
        uint32_t keyMask,
        const gpu_scene::GpuScene& scene
    );

  private:
    /// A draw of one geometry.
    struct Draw {
        uint32_t geometry = 0; ///< index into SceneLayout::geometries
        shader::ShapeWayDraw push{};
    };

    struct Layer {
        std::vector<Draw> draws;
        graph::BufferHandle rasterShapes; ///< invalid: in mShapes
    };

    class Planner;

    gpu::Device& mDevice;
    gpu_scene::Deformer mDeformer;
    gpu::Pipeline mPipeline; ///< made when it is first used
    gpu::Buffer mPositions;  ///< vec4[]
    gpu::Buffer mPoses;
    gpu::Buffer mJobs;
    gpu::Buffer mRows; ///< shader::ShapeWayRow[]
    std::vector<Layer> mLayers;
    graph::BufferHandle mShapes;        ///< of this frame: mPositions
    graph::BufferHandle mExposedShapes; ///< of this frame: its own deformed meshes
};

} // namespace shutter::render
