// SPDX-License-Identifier: MIT
// Motion blur as a post effect on a render graph. frame_io.h defines inputs, outputs and
// conventions.
#pragma once

#include "engine/gpu/device.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/frame_io.h"
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/settings.h"

#include <memory>

namespace shutter::motion_blur {

/// Holds the pipelines, which are made when a frame first needs them; images belong to the graph.
class MotionBlur {
  public:
    /// \param sceneLayout layout of the descriptor set in graph::RayScene::textures; null: no rays,
    /// then no method that needs any can run
    MotionBlur(gpu::Device& device, VkDescriptorSetLayout sceneLayout);
    ~MotionBlur();
    MotionBlur(const MotionBlur&) = delete;
    MotionBlur& operator=(const MotionBlur&) = delete;

    /// Declares the passes. Settings must be valid, and the device able to run their method
    /// (CHECKed).
    [[nodiscard]] MotionBlurOutputs
    add(graph::Graph& graph, const MotionBlurInputs& inputs, const MotionBlurSettings& settings);

    /// Whether a frame by the method waits for none of the pipelines that take long to make. The
    /// first call starts to make them where the device makes pipelines ahead.
    [[nodiscard]] bool isReady(const Method& method);

    /// Returns the counters of the frame declared last for the slot, once the GPU has finished it:
    /// "blocks still", "blocks uniform", "blocks mixed" and "blocks masked" (of 8 x 8 pixels), and
    /// the method's own, with MotionBlurInputs::wantsMethodCounters. Empty before the first, and
    /// without MotionBlurInputs::wantsCounters.
    [[nodiscard]] Counters counters(uint32_t slot = 0) const;

  private:
    struct Parts;

    std::unique_ptr<Parts> mParts;
};

} // namespace shutter::motion_blur
