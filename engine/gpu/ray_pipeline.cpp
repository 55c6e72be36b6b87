// SPDX-License-Identifier: MIT
#include "engine/gpu/ray_pipeline.h"

#include "engine/core/check.h"
#include "engine/gpu/acceleration_structure.h"

#include <utility>
#include <vector>

namespace shutter::gpu {

BindingTableLayout computeTableLayout(const ShaderGroupLimits& limits) {
    BindingTableLayout layout;
    layout.stride = alignUp(limits.handleBytes, limits.handleAlignment);
    for (VkDeviceSize& offset : layout.offsets) {
        offset = layout.bytes;
        layout.bytes += alignUp(layout.stride, limits.baseAlignment);
    }
    return layout;
}

namespace {

const RayPipelineDesc& checkTier(const Device& device, const RayPipelineDesc& desc) {
    SHUTTER_CHECK(
        device.info().rayTier == RayTier::Pipeline, "'{}' needs ray-tracing pipelines", desc.name
    );
    return desc;
}

} // namespace

RayPipeline::RayPipeline(Device& device, const RayPipelineDesc& desc)
    : RayPipeline(device, Pipeline(device, checkTier(device, desc))) {}

RayPipeline::RayPipeline(Device& device, Pipeline made)
    : mDevice(&device), mPipeline(std::move(made)) {
    const ShaderGroupLimits& limits = device.shaderGroupLimits();
    const BindingTableLayout layout = computeTableLayout(limits);
    const auto count = static_cast<uint32_t>(layout.offsets.size());
    std::vector<std::byte> handles(size_t(count) * limits.handleBytes);
    require(
        device.functions().getRayTracingShaderGroupHandles(
            device.handle(), mPipeline.handle(), 0, count, handles.size(), handles.data()
        ),
        fmt::format("reading the shader groups of '{}'", mPipeline.name())
    );
    mTable = Buffer(
        device,
        mPipeline.name() + " binding table",
        layout.bytes + limits.baseAlignment,
        VK_BUFFER_USAGE_SHADER_BINDING_TABLE_BIT_KHR,
        MemoryUse::Stream
    );
    const VkDeviceAddress base = alignUp(mTable.address(), limits.baseAlignment);
    for (uint32_t i = 0; i < count; ++i) {
        mTable.writeBytes(
            handles.data() + size_t(i) * limits.handleBytes,
            limits.handleBytes,
            base - mTable.address() + layout.offsets[i]
        );
        mRegions[i] = {base + layout.offsets[i], layout.stride, layout.stride};
    }
}

void RayPipeline::trace(VkCommandBuffer commands, uint32_t width, uint32_t height) const {
    const VkStridedDeviceAddressRegionKHR none{};
    mDevice->functions().cmdTraceRays(
        commands, &mRegions[0], &mRegions[1], &mRegions[2], &none, width, height, 1
    );
}

void RayPipeline::traceIndirect(VkCommandBuffer commands, VkBuffer arguments) const {
    SHUTTER_CHECK(mDevice->info().tracesIndirect, "the device launches no rays from memory");
    VkBufferDeviceAddressInfo info{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    info.buffer = arguments;
    const VkStridedDeviceAddressRegionKHR none{};
    mDevice->functions().cmdTraceRaysIndirect(
        commands,
        &mRegions[0],
        &mRegions[1],
        &mRegions[2],
        &none,
        vkGetBufferDeviceAddress(mDevice->handle(), &info)
    );
}

} // namespace shutter::gpu
