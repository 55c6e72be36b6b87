// SPDX-License-Identifier: MIT
#pragma once

#include "engine/extract/extracted_frame.h"
#include "engine/gpu_scene/deformer.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/graph/graph.h"

#include <vector>

namespace shutter::gpu_scene {

/// A frame's deformed meshes.
struct DeformedMeshes {
    /// Vertices and positions; read it with Access::ShaderRead. Invalid: nothing is deformed.
    graph::BufferHandle buffer;
    /// The geometries of ExtractedFrame::deformed, entity after entity: the rows of the frame's
    /// geometry table after the scene's own.
    std::vector<shader::Geometry> rows;
};

/// Deforms the meshes of a frame: whole vertices at the raster instant, positions at shutter open
/// and close.
class DeformationPass {
  public:
    explicit DeformationPass(gpu::Device& device) : mDevice(device), mDeformer(device) {}

    /// Declares the pass; none for a frame without deformed meshes. The GPU must have finished with
    /// the last frame's.
    [[nodiscard]] DeformedMeshes
    declare(graph::Graph& graph, const extract::ExtractedFrame& frame, const GpuScene& scene);

  private:
    [[nodiscard]] DeformJobs plan(
        const extract::ExtractedFrame& frame,
        const GpuScene& scene,
        std::vector<shader::Geometry>& rows
    );

    gpu::Device& mDevice;
    Deformer mDeformer;
    gpu::Buffer mShapes; ///< Vertex[] of all, followed by vec4[] of those that change
    gpu::Buffer mPoses;
    gpu::Buffer mJobs;
};

} // namespace shutter::gpu_scene
