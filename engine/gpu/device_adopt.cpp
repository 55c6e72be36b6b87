// SPDX-License-Identifier: MIT
// Adopts a device that a host created and to whose queue the host submits.
#include "engine/core/check.h"
#include "engine/gpu/device.h"

namespace shutter::gpu {

core::Result<std::unique_ptr<Device>> Device::adopt(const HostDevice& host) {
    std::unique_ptr<Device> device(new Device(0));
    try {
        SHUTTER_TRY(device->adoptHost(host));
    } catch (const DeviceError& error) {
        return core::Error{error.what()};
    }
    return device;
}

core::Status Device::adoptHost(const HostDevice& host) {
    mControlsSubgroupSize = host.controlsSubgroupSize;
    mIsAdopted = true; // first: whatever fails below must not destroy the host's device
    if (!host.physical || !host.device)
        return core::makeError("host device: {} is null", host.physical ? "device" : "physical");
    SHUTTER_TRY(loadVulkan());
    // A driver hides the functions of versions that the instance was not made for.
    if (!vkGetDeviceProcAddr(host.device, "vkCmdPipelineBarrier2"))
        return core::makeError("host device: the instance is not made for Vulkan 1.3 "
                               "(VkApplicationInfo::apiVersion)");
    mInfo = describeDevice(host.physical);
    const bool hasTier = host.rayTier == RayTier::None ||
                         (host.rayTier == RayTier::RayQuery && mInfo.hasRayQuery) ||
                         (host.rayTier == RayTier::Pipeline && mInfo.hasRayPipeline);
    if (!hasTier)
        return core::makeError(
            "host device: rayTier is {}, which {} does not have", describe(host.rayTier), mInfo.name
        );
    mInfo.rayTier = host.rayTier;
    // A separate feature, which the host need not have enabled.
    mInfo.tracesIndirect = mInfo.tracesIndirect && host.tracesIndirect;
    mInfo.interpolatesAnywhere = false;
    mDevice = host.device;
    mHasDebugUtils = host.hasDebugUtils;
    loadFunctions();
    if (host.rayTier != RayTier::None && !mFunctions.createAccelerationStructure)
        return core::makeError(
            "host device: rayTier is {}, but the device is made without "
            "VK_KHR_acceleration_structure",
            describe(host.rayTier)
        );
    if (host.rayTier == RayTier::Pipeline && !mFunctions.createRayTracingPipelines)
        return core::makeError(
            "host device: rayTier is {}, but the device is made without "
            "VK_KHR_ray_tracing_pipeline",
            describe(host.rayTier)
        );
    loadLimits();
    createSamplers();
    mOwnsPipelineCache = host.pipelineCache == VK_NULL_HANDLE;
    mPipelineCache = host.pipelineCache;
    if (mOwnsPipelineCache)
        loadPipelineCache();
    return {};
}

uint64_t Device::handOver() {
    SHUTTER_CHECK(mIsAdopted, "only a host's device takes work that is submitted elsewhere");
    mHandedOver.insert(++mLastSubmitted);
    return mLastSubmitted;
}

void Device::markDone(uint64_t value) {
    mHandedOver.erase(value);
    collect();
}

} // namespace shutter::gpu
