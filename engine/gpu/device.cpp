// SPDX-License-Identifier: MIT
#include "engine/gpu/device.h"

#include "engine/core/check.h"
#include "engine/core/log.h"
#include "engine/core/whole_file.h"
#include "engine/gpu/device_features.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline_cache.h"

#include <algorithm>
#include <array>
#include <span>
#include <system_error>
#include <thread>
#include <type_traits>

namespace shutter::gpu {

namespace {

void destroy(VkDevice device, const PipelineObjects& objects) {
    vkDestroyPipeline(device, objects.pipeline, nullptr);
    vkDestroyPipelineLayout(device, objects.layout, nullptr);
    vkDestroyDescriptorSetLayout(device, objects.setLayout, nullptr);
}

} // namespace

std::string describe(VkResult result) {
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "out of main memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "out of device memory";
    case VK_ERROR_DEVICE_LOST:
        return "the device was lost";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "initialisation failed";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "a layer is not installed";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "an extension is not there";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "a feature is not there";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "no usable Vulkan driver (Mesa's is the package mesa-vulkan-drivers)";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "too many objects";
    default:
        return fmt::format("Vulkan error {}", static_cast<int>(result));
    }
}

void require(VkResult result, std::string_view doing) {
    if (result < 0)
        throw DeviceError(fmt::format("{} failed: {}", doing, describe(result)));
}

core::Result<std::unique_ptr<Device>> Device::create(const DeviceOptions& options) {
    std::unique_ptr<Device> device(new Device(options.keptPipelines));
    try {
        SHUTTER_TRY(device->createInstance(options));
        SHUTTER_TRY(device->choosePhysicalDevice(options));
        device->mBounds =
            options.bounds.value_or(options.validate ? Bounds::Checked : Bounds::Trusted);
        device->createLogicalDevice();
        device->loadFunctions();
        device->loadLimits();
        device->createSamplers();
        if (!options.cacheFolder.empty())
            device->mCacheFile = options.cacheFolder / device->cacheFileName();
        device->loadPipelineCache();
        device->mMakesPipelinesAhead =
            options.pipelinesAhead == PipelinesAhead::Always ||
            (options.pipelinesAhead == PipelinesAhead::OnGpus && device->mInfo.kind != "software");
    } catch (const DeviceError& error) {
        return core::Error{error.what()};
    }
    core::logInfo(
        "device {} ({}), ray tracing: {}",
        device->mInfo.name,
        device->mInfo.driver,
        describe(device->mInfo.rayTier)
    );
    return device;
}

core::TaskQueue& Device::pipelineQueue() {
    // One core draws. Drivers have threads of their own, and a search takes much memory to compile.
    constexpr unsigned kMostThreads = 4;
    if (!mPipelineQueue)
        mPipelineQueue.emplace(
            std::clamp(std::max(std::thread::hardware_concurrency(), 1u) - 1, 1u, kMostThreads)
        );
    return *mPipelineQueue;
}

Device::~Device() {
    mPipelineQueue.reset();
    if (mDevice) {
        if (!mIsAdopted)
            vkDeviceWaitIdle(mDevice);
        destroyRetired();
        destroyKept();
        savePipelineCache();
        if (mOwnsPipelineCache)
            vkDestroyPipelineCache(mDevice, mPipelineCache, nullptr);
        vkDestroySampler(mDevice, mNearestSampler, nullptr);
        vkDestroySampler(mDevice, mLinearSampler, nullptr);
        vkDestroySemaphore(mDevice, mTimeline, nullptr);
        if (!mIsAdopted)
            vkDestroyDevice(mDevice, nullptr);
    }
    if (mMessenger) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(mInstance, "vkDestroyDebugUtilsMessengerEXT")
        );
        destroy(mInstance, mMessenger, nullptr);
    }
    if (mSurface)
        vkDestroySurfaceKHR(mInstance, mSurface, nullptr);
    if (mInstance)
        vkDestroyInstance(mInstance, nullptr);
}

core::Status Device::choosePhysicalDevice(const DeviceOptions& options) {
    if (options.makeSurface) {
        auto surface = options.makeSurface(mInstance);
        if (!surface)
            return surface.error();
        mSurface = surface.value();
    }
    std::vector<DeviceInfo> devices = listDevices(mInstance, mSurface);
    for (DeviceInfo& info : devices)
        info.rayTier = chooseTier(info, options.bestTier);
    auto chosen = chooseDevice(devices, options.wanted);
    if (!chosen)
        return chosen.error();
    mInfo = std::move(chosen).value();
    if (options.wanted.empty())
        for (const std::string& sentence : describePassedOver(devices, mInfo))
            core::logWarning("{}", sentence);
    return {};
}

void Device::createLogicalDevice() {
    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = mInfo.queueFamily;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;

    VkPhysicalDeviceRayQueryFeaturesKHR query{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR};
    query.rayQuery = VK_TRUE;
    VkPhysicalDeviceRayTracingPipelineFeaturesKHR pipeline{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_FEATURES_KHR};
    pipeline.rayTracingPipeline = VK_TRUE;
    pipeline.rayTracingPipelineTraceRaysIndirect = mInfo.tracesIndirect;
    VkPhysicalDeviceAccelerationStructureFeaturesKHR structure{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR};
    structure.pNext = hasRayQuery() ? static_cast<void*>(&query) : &pipeline;
    structure.accelerationStructure = VK_TRUE;
    DeviceFeatures features;
    features.enableNeeded();
    features.core.features.sampleRateShading = mInfo.interpolatesAnywhere;
    if (hasRays())
        features.v13.pNext = &structure;

    VkPhysicalDeviceRobustness2FeaturesEXT robust{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ROBUSTNESS_2_FEATURES_EXT};
    robust.robustBufferAccess2 = VK_TRUE;
    robust.robustImageAccess2 = VK_TRUE;
    if (checksBounds()) {
        features.core.features.robustBufferAccess = VK_TRUE; // which every device has
        if (mInfo.hasRobustness2) {
            robust.pNext = features.v13.pNext;
            features.v13.pNext = &robust;
        }
    }

    const std::vector<const char*> extensions =
        listDeviceExtensions(mInfo, mSurface != VK_NULL_HANDLE, mBounds);
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features.core};
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    require(
        vkCreateDevice(mInfo.handle, &info, nullptr, &mDevice),
        fmt::format("opening the device {}", mInfo.name)
    );
    vkGetDeviceQueue(mDevice, mInfo.queueFamily, 0, &mQueue);

    VkSemaphoreTypeCreateInfo timeline{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
    timeline.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &timeline};
    require(vkCreateSemaphore(mDevice, &semaphore, nullptr, &mTimeline), "creating the timeline");
}

void Device::loadFunctions() {
    const auto load = [&](auto& function, const char* name) {
        function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(
            vkGetDeviceProcAddr(mDevice, name)
        );
    };
    if (hasRays()) {
        load(mFunctions.createAccelerationStructure, "vkCreateAccelerationStructureKHR");
        load(mFunctions.destroyAccelerationStructure, "vkDestroyAccelerationStructureKHR");
        load(
            mFunctions.getAccelerationStructureBuildSizes, "vkGetAccelerationStructureBuildSizesKHR"
        );
        load(
            mFunctions.getAccelerationStructureDeviceAddress,
            "vkGetAccelerationStructureDeviceAddressKHR"
        );
        load(mFunctions.cmdBuildAccelerationStructures, "vkCmdBuildAccelerationStructuresKHR");
        load(
            mFunctions.cmdWriteAccelerationStructuresProperties,
            "vkCmdWriteAccelerationStructuresPropertiesKHR"
        );
        load(mFunctions.cmdCopyAccelerationStructure, "vkCmdCopyAccelerationStructureKHR");
    }
    if (mInfo.rayTier == RayTier::Pipeline) {
        load(mFunctions.createRayTracingPipelines, "vkCreateRayTracingPipelinesKHR");
        load(mFunctions.getRayTracingShaderGroupHandles, "vkGetRayTracingShaderGroupHandlesKHR");
        load(mFunctions.cmdTraceRays, "vkCmdTraceRaysKHR");
        if (mInfo.tracesIndirect)
            load(mFunctions.cmdTraceRaysIndirect, "vkCmdTraceRaysIndirectKHR");
    }
    if (mHasDebugUtils) {
        load(mFunctions.cmdBeginDebugUtilsLabel, "vkCmdBeginDebugUtilsLabelEXT");
        load(mFunctions.cmdEndDebugUtilsLabel, "vkCmdEndDebugUtilsLabelEXT");
        load(mFunctions.setDebugUtilsObjectName, "vkSetDebugUtilsObjectNameEXT");
    }
}

bool Device::canDrawSamples(VkFormat format, uint32_t count) const {
    const bool isColor = (aspectOf(format) & VK_IMAGE_ASPECT_COLOR_BIT) != 0;
    const VkImageUsageFlags usage =
        isColor ? VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT : VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    VkImageFormatProperties properties{};
    return mLimits.standardSampleLocations &&
           vkGetPhysicalDeviceImageFormatProperties(
               mInfo.handle,
               format,
               VK_IMAGE_TYPE_2D,
               VK_IMAGE_TILING_OPTIMAL,
               usage | VK_IMAGE_USAGE_SAMPLED_BIT,
               0,
               &properties
           ) == VK_SUCCESS &&
           (properties.sampleCounts & count) != 0;
}

void Device::loadLimits() {
    VkPhysicalDeviceRayTracingPipelinePropertiesKHR pipeline{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_TRACING_PIPELINE_PROPERTIES_KHR};
    VkPhysicalDeviceAccelerationStructurePropertiesKHR structure{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR};
    if (mInfo.rayTier == RayTier::Pipeline)
        structure.pNext = &pipeline;
    VkPhysicalDeviceVulkan13Properties v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES};
    if (hasRays())
        v13.pNext = &structure;
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &v13};
    vkGetPhysicalDeviceProperties2(mInfo.handle, &properties);
    mLimits = properties.properties.limits;
    vkGetPhysicalDeviceMemoryProperties(mInfo.handle, &mMemoryProperties);
    if (mControlsSubgroupSize &&
        (v13.requiredSubgroupSizeStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0) {
        mLeastSubgroupSize = v13.minSubgroupSize;
        mMostSubgroupSize = v13.maxSubgroupSize;
    }
    if (hasRays())
        mMinScratchAlignment = structure.minAccelerationStructureScratchOffsetAlignment;
    if (mInfo.rayTier == RayTier::Pipeline)
        mShaderGroupLimits = {
            pipeline.shaderGroupHandleSize,
            pipeline.shaderGroupHandleAlignment,
            pipeline.shaderGroupBaseAlignment};
}

void Device::createSamplers() {
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.maxLod = VK_LOD_CLAMP_NONE; // clamping costs on some devices, and images have one level
    require(vkCreateSampler(mDevice, &info, nullptr, &mNearestSampler), "creating a sampler");
    info.magFilter = VK_FILTER_LINEAR;
    info.minFilter = VK_FILTER_LINEAR;
    require(vkCreateSampler(mDevice, &info, nullptr, &mLinearSampler), "creating a sampler");
}

std::string Device::cacheFileName() const {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(mInfo.handle, &properties);
    return fmt::format("pipelines-{:x}-{:x}.bin", properties.vendorID, properties.deviceID);
}

void Device::loadPipelineCache() {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(mInfo.handle, &properties);
    PipelineCacheOwner owner{.vendorId = properties.vendorID, .deviceId = properties.deviceID};
    std::copy_n(properties.pipelineCacheUUID, VK_UUID_SIZE, owner.uuid.begin());
    const std::vector<uint8_t> data = readPipelineCache(mCacheFile, owner);
    VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    info.initialDataSize = data.size();
    info.pInitialData = data.data();
    require(vkCreatePipelineCache(mDevice, &info, nullptr, &mPipelineCache), "making a cache");
}

void Device::savePipelineCache() const {
    if (mCacheFile.empty() || !mPipelineCache)
        return;
    size_t bytes = 0;
    if (vkGetPipelineCacheData(mDevice, mPipelineCache, &bytes, nullptr) != VK_SUCCESS)
        return;
    std::vector<uint8_t> data(bytes);
    if (vkGetPipelineCacheData(mDevice, mPipelineCache, &bytes, data.data()) != VK_SUCCESS)
        return;
    const std::vector<uint8_t> packed = packPipelineCache(std::span(data).first(bytes));
    // A cache that cannot be written costs time, nothing else: no error.
    std::error_code ignored;
    std::filesystem::create_directories(mCacheFile.parent_path(), ignored);
    (void)core::writeWholeFile(mCacheFile, std::as_bytes(std::span(packed)));
}

uint64_t
Device::submit(std::span<const VkCommandBuffer> batches, const SubmitSemaphores& semaphores) {
    SHUTTER_CHECK(!mIsAdopted, "work recorded for a host is submitted by the host");
    SHUTTER_CHECK(!batches.empty(), "nothing is submitted");
    const auto at = [](VkSemaphore semaphore, uint64_t value) {
        VkSemaphoreSubmitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
        info.semaphore = semaphore;
        info.value = value; // of timelines only
        info.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        return info;
    };
    const VkSemaphoreSubmitInfo wait = at(semaphores.wait, 0);
    const std::array signals{at(mTimeline, mLastSubmitted + 1), at(semaphores.signal, 0)};
    std::vector<VkCommandBufferSubmitInfo> buffers;
    for (const VkCommandBuffer commands : batches) {
        VkCommandBufferSubmitInfo& buffer = buffers.emplace_back();
        buffer = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
        buffer.commandBuffer = commands;
    }
    std::vector<VkSubmitInfo2> infos;
    for (const VkCommandBufferSubmitInfo& buffer : buffers) {
        VkSubmitInfo2& info = infos.emplace_back();
        info = {VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
        info.commandBufferInfoCount = 1;
        info.pCommandBufferInfos = &buffer;
    }
    VkSubmitInfo2& last = infos.back();
    last.waitSemaphoreInfoCount = semaphores.wait ? 1 : 0;
    last.pWaitSemaphoreInfos = &wait;
    last.signalSemaphoreInfoCount = semaphores.signal ? 2 : 1;
    last.pSignalSemaphoreInfos = signals.data();
    require(
        vkQueueSubmit2(mQueue, static_cast<uint32_t>(infos.size()), infos.data(), VK_NULL_HANDLE),
        "submitting a frame"
    );
    return ++mLastSubmitted;
}

void Device::wait(uint64_t timelineValue) {
    if (mIsAdopted) {
        SHUTTER_CHECK(timelineValue <= completedValue(), "only the host can wait for its queue");
        collect();
        return;
    }
    VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
    info.semaphoreCount = 1;
    info.pSemaphores = &mTimeline;
    info.pValues = &timelineValue;
    require(vkWaitSemaphores(mDevice, &info, UINT64_MAX), "waiting for the device");
    collect();
}

void Device::waitIdle() {
    wait(mLastSubmitted);
}

uint64_t Device::completedValue() const {
    if (mIsAdopted)
        return mHandedOver.empty() ? mLastSubmitted : *mHandedOver.begin() - 1;
    uint64_t value = 0;
    require(vkGetSemaphoreCounterValue(mDevice, mTimeline, &value), "reading the timeline");
    return value;
}

void Device::retire(std::function<void()> destroy) {
    mRetired.emplace_back(mLastSubmitted + 1, std::move(destroy));
}

void Device::collectIdle() {
    SHUTTER_CHECK(!mIsAdopted, "what the host submitted is not known");
    vkDeviceWaitIdle(mDevice); // of a lost device, at once
    destroyRetired();
}

void Device::destroyRetired() {
    while (!mRetired.empty()) {
        auto destroy = std::move(mRetired.front().second);
        mRetired.pop_front();
        destroy();
    }
}

void Device::collect() {
    const uint64_t done = completedValue();
    while (!mRetired.empty() && mRetired.front().first <= done) {
        auto destroy = std::move(mRetired.front().second);
        mRetired.pop_front();
        destroy();
    }
}

void Device::setName(VkObjectType type, uint64_t object, const std::string& name) const {
    if (!mFunctions.setDebugUtilsObjectName || name.empty())
        return;
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = object;
    info.pObjectName = name.c_str();
    mFunctions.setDebugUtilsObjectName(mDevice, &info);
}

VkDescriptorSetLayout Device::textureLayout(uint32_t count) {
    const auto known = mTextureLayouts.find(count);
    if (known != mTextureLayouts.end())
        return known->second;
    VkDescriptorSetLayoutBinding binding{};
    binding.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    binding.descriptorCount = count;
    binding.stageFlags = kSceneStages;
    if (mInfo.rayTier != RayTier::Pipeline)
        binding.stageFlags &= VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
    const VkDescriptorBindingFlags flags = VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT;
    VkDescriptorSetLayoutBindingFlagsCreateInfo bindingFlags{
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO};
    bindingFlags.bindingCount = 1;
    bindingFlags.pBindingFlags = &flags;
    VkDescriptorSetLayoutCreateInfo info{
        VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, &bindingFlags};
    info.bindingCount = 1;
    info.pBindings = &binding;
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    require(
        vkCreateDescriptorSetLayout(mDevice, &info, nullptr, &layout),
        "creating the layout of the texture table"
    );
    mTextureLayouts.emplace(count, layout);
    return layout;
}

std::optional<PipelineObjects> Device::takePipeline(const std::string& key) {
    return mKeptPipelines.take(key);
}

void Device::giveUpPipeline(std::string key, const PipelineObjects& objects) {
    if (const auto leaves = mKeptPipelines.keep(std::move(key), objects))
        retire([device = mDevice, objects = *leaves] { destroy(device, objects); });
}

void Device::destroyKept() {
    for (const PipelineObjects& objects : mKeptPipelines.takeAll())
        destroy(mDevice, objects);
    for (const auto& [count, layout] : mTextureLayouts)
        vkDestroyDescriptorSetLayout(mDevice, layout, nullptr);
    mTextureLayouts.clear();
}

} // namespace shutter::gpu
