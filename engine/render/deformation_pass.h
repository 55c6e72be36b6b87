// SPDX-License-Identifier: MIT
#pragma once

#include "engine/graph/graph.h"
#include "engine/render/deformer.h"
#include "engine/render/extraction.h"
#include "engine/render/gpu_scene.h"

#include <vector>

namespace shutter::render {

/// A frame's bent meshes.
struct DeformedShapes {
    /// Vertices and positions; read it with Access::ShaderRead. Invalid: nothing is bent.
    graph::BufferHandle buffer;
    /// The geometries of ExtractedFrame::deformed, one entity's behind the other's: what the
    /// frame's geometry table holds behind the scene's own rows.
    std::vector<shader::Geometry> rows;
};

/// Bends the meshes of a frame: whole vertices at the raster instant, positions at shutter open and
/// close.
class DeformationPass {
  public:
    explicit DeformationPass(gpu::Device& device) : mDevice(device), mDeformer(device) {}

    /// Declares the pass; none for a frame without bent meshes. The GPU must be done with the last
    /// frame's.
    [[nodiscard]] DeformedShapes
    declare(graph::Graph& graph, const ExtractedFrame& frame, const GpuScene& scene);

  private:
    /// A dispatch.
    struct Work {
        shader::DeformJob job;
        uint32_t instantCount = 1;
    };

    [[nodiscard]] std::vector<Work>
    plan(const ExtractedFrame& frame, const GpuScene& scene, std::vector<shader::Geometry>& rows);

    gpu::Device& mDevice;
    Deformer mDeformer;
    gpu::Buffer mShapes; ///< Vertex[] of all, and behind them vec4[] of those that change
    gpu::Buffer mPoses;
};

} // namespace shutter::render
