// SPDX-License-Identifier: MIT
// Measures on the device how far each entity moves in the picture, over all of its pixels; reads
// back one number per entity, not the pictures.
#pragma once

#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/render/effect.h"

#include <cstdint>
#include <vector>

namespace shutter::render {

/// Runs in separate frames (FrameRequest::measuresMotion), one at a time.
class LongestMotion : public Effect {
  public:
    explicit LongestMotion(gpu::Device& device);

    [[nodiscard]] std::string name() const override { return "longest motion"; }

    [[nodiscard]] Needs decide(const DecideContext&) const override {
        return {.run = {true, "it is measured for the picture to come"}};
    }

    void declare(PictureContext& context) override;

    /// Returns pixels from open to close, one number per row of the frame declared last, then the
    /// sky's. The GPU must have finished it.
    [[nodiscard]] std::vector<float> take() const;

  private:
    gpu::Device& mDevice;
    VkSampler mSampler;
    gpu::LazyPipeline mPipeline;
    gpu::Buffer mResult; ///< grows
    uint32_t mRowCount = 0;
};

} // namespace shutter::render
