// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/tap_pipelines.h"

#include "modules/motion_blur/passes/dispatch.h"
#include "shaders/motion_blur/gather_shared.h"

#include <algorithm>
#include <utility>

namespace shutter::motion_blur {

TapVariants chooseTapVariants(const gpu::Device& device) {
    return isSoftware(device) ? TapVariants::None : TapVariants::Made;
}

TapPipelines::TapPipelines(gpu::Device& device, gpu::ComputePipelineDesc desc, TapVariants variants)
    : mDevice(&device), mDesc(std::move(desc)), mWanted(variants), mGeneral(device, mDesc) {}

const gpu::Pipeline& TapPipelines::find(const PassParams& params) const {
    if (mWanted == TapVariants::None)
        return mGeneral.get();
    const uint32_t response =
        params.response == glm::uvec2(0u) ? shader::kBoxResponse : shader::kTableResponse;
    const auto known =
        std::find_if(mVariants.begin(), mVariants.end(), [&](const Variant& variant) {
            return variant.tapCount == params.sampleCount && variant.response == response;
        });
    if (known != mVariants.end()) {
        std::rotate(known, known + 1, mVariants.end());
    } else {
        if (mVariants.size() == kMaxVariants)
            mVariants.erase(mVariants.begin());
        gpu::ComputePipelineDesc desc = mDesc;
        desc.specialization.insert(desc.specialization.end(), {params.sampleCount, response});
        mVariants.push_back(
            {params.sampleCount, response, std::make_unique<gpu::LazyPipeline>(*mDevice, desc)}
        );
    }
    const gpu::LazyPipeline& pipeline = *mVariants.back().pipeline;
    const bool isUnderWay = mDevice->makesPipelinesAhead() && !pipeline.isReady();
    return isUnderWay ? mGeneral.get() : pipeline.get();
}

} // namespace shutter::motion_blur
