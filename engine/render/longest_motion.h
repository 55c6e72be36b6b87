// SPDX-License-Identifier: MIT
// How far each entity moves in the picture, by a look at all of its pixels on the device: a number
// an entity comes back, not the pictures.
#pragma once

#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/render/post_effect.h"

#include <cstdint>
#include <vector>

namespace shutter::render {

/// Runs in frames of its own (FrameRequest::isLook), one at a time.
class LongestMotion : public PostEffect {
  public:
    explicit LongestMotion(gpu::Device& device);

    [[nodiscard]] std::string name() const override { return "longest motion"; }

    [[nodiscard]] core::Decision ask(const ViewFacts&) const override {
        return {true, "it is measured for the picture to come"};
    }

    void declare(PostContext& context) override;

    /// Pixels from open to close, one number a row of the frame declared last, the sky's behind
    /// them. The GPU must be done with it.
    [[nodiscard]] std::vector<float> take() const;

  private:
    gpu::Device& mDevice;
    VkSampler mSampler;
    gpu::LazyPipeline mPipeline;
    gpu::Buffer mResult; ///< grows
    uint32_t mRowCount = 0;
};

} // namespace shutter::render
