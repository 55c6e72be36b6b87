// SPDX-License-Identifier: MIT
// The pipelines of one filter: one for all settings, and faster ones for a number of taps and a
// kind of response.
#pragma once

#include "engine/gpu/pipeline.h"
#include "modules/motion_blur/params.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace shutter::motion_blur {

/// Whether a filter has a separate pipeline for each number of taps.
enum class TapVariants : uint8_t {
    None, ///< one pipeline serves all
    Made, ///< each is made when it is first needed; where the device makes pipelines ahead, the
          ///< one that serves all does so meanwhile
};

/// None on software devices: theirs are compiled when they first run, and so in the time of a pass.
/// A budget that goes through numbers of taps would measure the compiler.
[[nodiscard]] TapVariants chooseTapVariants(const gpu::Device& device);

class TapPipelines {
  public:
    /// \param desc without tap constants, which come behind the other specialization constants
    TapPipelines(gpu::Device& device, gpu::ComputePipelineDesc desc, TapVariants variants);

    /// For immediate recording: a later call may destroy it once the GPU has finished its work.
    [[nodiscard]] const gpu::Pipeline& find(const PassParams& params) const;

    /// How many are kept for certain taps, kMaxVariants at most.
    [[nodiscard]] size_t variantCount() const { return mVariants.size(); }

    /// Budgets and sliders go through many numbers of taps.
    static constexpr size_t kMaxVariants = 8;

  private:
    struct Variant {
        uint32_t tapCount = 0;
        uint32_t response = 0;
        std::unique_ptr<gpu::LazyPipeline> pipeline;
    };

    gpu::Device* mDevice;
    gpu::ComputePipelineDesc mDesc;
    TapVariants mWanted;
    gpu::LazyPipeline mGeneral;
    mutable std::vector<Variant> mVariants; ///< the one used last comes last
};

} // namespace shutter::motion_blur
