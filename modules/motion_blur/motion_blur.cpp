// SPDX-License-Identifier: MIT
#include "modules/motion_blur/motion_blur.h"

#include "engine/core/check.h"
#include "modules/motion_blur/shared_passes.h"

#include <array>
#include <map>

namespace shutter::motion_blur {

struct MotionBlur::Parts {
    explicit Parts(gpu::Device& own, VkDescriptorSetLayout layout)
        : device(own), sceneLayout(layout), shared(own) {}

    MethodPasses& find(const Method& method) {
        std::unique_ptr<MethodPasses>& own = passes[&method];
        if (!own)
            own = method.makePasses(device, sceneLayout);
        return *own;
    }

    gpu::Device& device;
    VkDescriptorSetLayout sceneLayout;
    SharedPasses shared;
    std::map<const Method*, std::unique_ptr<MethodPasses>> passes;

    /// A frame that counts something.
    struct Declared {
        const Method* method = nullptr;     ///< null: nothing
        bool methodCountersEnabled = false; ///< the method's own, too
    };

    std::array<Declared, kMaxSlots> declared{}; ///< by slot
};

MotionBlur::MotionBlur(gpu::Device& device, VkDescriptorSetLayout sceneLayout)
    : mParts(std::make_unique<Parts>(device, sceneLayout)) {}

MotionBlur::~MotionBlur() = default;

MotionBlurOutputs MotionBlur::add(
    graph::Graph& graph, const MotionBlurInputs& inputs, const MotionBlurSettings& wanted
) {
    const core::Status valid = validate(wanted);
    SHUTTER_CHECK(valid.ok(), "{}", valid.error().message);
    const MotionBlurSettings settings = complete(wanted, inputs.instantMotions.has_value());
    const Method& method = *settings.method;
    const bool hasRays = mParts->sceneLayout && mParts->device.hasRays();
    SHUTTER_CHECK(
        method.rays != RayNeed::Any || inputs.reveal || (hasRays && inputs.rays),
        "the method {} needs rays",
        method.name
    );
    SHUTTER_CHECK(
        method.rays != RayNeed::Query || !inputs.wantsPicture || inputs.samples ||
            (hasRays && mParts->device.hasRayQuery() && inputs.timedRays),
        "the method {} needs timed rays, by ray queries",
        method.name
    );
    SHUTTER_CHECK(
        !method.readsCamera || inputs.motionIsCameras ||
            (inputs.rays && inputs.rays->frameConstants != 0),
        "the method {} needs frame constants, or the camera's motion",
        method.name
    );
    SHUTTER_CHECK(
        !method.readsInstantMotions || inputs.instantMotions,
        "the method {} needs the motion to each instant",
        method.name
    );
    const graph::TransientImageDesc& size = graph.describeImage(inputs.color);
    PassParams params = resolve(settings, size.width, size.height, inputs.rasterTime);
    params.response = inputs.response;
    mParts->shared.chooseStillPixelsBy(inputs);
    const Method* const counted = inputs.wantsCounters ? &method : nullptr;
    mParts->declared.at(inputs.slot) = {counted, inputs.methodCountersEnabled()};
    return mParts->find(method).add(graph, inputs, settings, params, mParts->shared);
}

bool MotionBlur::isReady(const Method& method) {
    return mParts->find(method).isReady();
}

Counters MotionBlur::counters(uint32_t slot) const {
    Counters counters;
    const auto& [method, methodCountersEnabled] = mParts->declared.at(slot);
    if (!method)
        return counters;
    if (method->countsBlocks) {
        const BlockCounters blocks = mParts->shared.sorter.counters(slot);
        counters["blocks still"] = blocks.still;
        counters["blocks uniform"] = blocks.uniform;
        counters["blocks mixed"] = blocks.mixed;
        counters["blocks masked"] = blocks.masked;
    }
    if (methodCountersEnabled)
        mParts->passes.at(method)->count(slot, counters);
    return counters;
}

} // namespace shutter::motion_blur
