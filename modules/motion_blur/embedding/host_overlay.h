// SPDX-License-Identifier: MIT
// Panels over a host's picture that show the effect's inputs (HostInputs::showsInputs).
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/embedding/host_inputs.h"
#include "modules/motion_blur/frame_io.h"
#include "shaders/motion_blur/overlay_shared.h"

namespace shutter::motion_blur {

/// Layout and contents of the panels. Pure function.
/// \param inputs as checkInputs() accepts them
/// \param own of which the handles that are valid count
[[nodiscard]] shader::OverlayTable
makeOverlayTable(const HostInputs& inputs, const MotionBlurInputs& own);

class HostOverlay {
  public:
    explicit HostOverlay(gpu::Device& device);

    /// Writes the panels over `picture` (RGBA16F, storage), and returns it.
    /// \param table where a shader::OverlayTable is; it stays until the GPU is done with the frame
    [[nodiscard]] graph::ImageHandle
    add(graph::Graph& graph,
        const MotionBlurInputs& own,
        graph::ImageHandle picture,
        VkDeviceAddress table) const;

  private:
    VkSampler mSampler;
    gpu::LazyPipeline mPanels;
    gpu::LazyPipeline mIds;
};

} // namespace shutter::motion_blur
