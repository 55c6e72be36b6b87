// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "engine/core/task_queue.h"
#include "engine/gpu/device_select.h"
#include "engine/gpu/kept_pipelines.h"
#include "engine/gpu/vulkan.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace shutter::gpu {

/// Whether pipelines that a frame may want soon are made before, on other threads, so that no frame
/// waits for a compiler.
enum class PipelinesAhead : uint8_t {
    Never,  ///< each is made when it is first used, and waited for: pictures do not depend on time
    OnGpus, ///< not on software devices, whose pictures need the same cores
    Always,
};

struct DeviceOptions {
    std::string wanted;       ///< see chooseDevice
    bool validate = false;    ///< core and synchronization validation; needs the layer installed
    bool wantsAdvice = false; ///< where `validate`: best practices too, which no count includes
    RayTier bestTier =
        RayTier::RayQuery; ///< hides the tiers above, so that lower ones can be tested
    /// Folder of the pipeline cache on disk; empty: none.
    std::filesystem::path cacheFolder;
    PipelinesAhead pipelinesAhead = PipelinesAhead::Never;
    /// Maximum number of unused pipelines that are cached for reuse (kept_pipelines.h); 0: none.
    /// Scene layouts of pipelines (PipelineInterface) must then live as long as the device, as
    /// those of textureLayout do.
    uint32_t keptPipelines = 0;
    /// Nothing: checked where Vulkan is validated. Released programs trust their shaders, whose
    /// lists are as long as their buffers; accesses through buffer addresses are never checked.
    std::optional<Bounds> bounds;
    /// Instance extensions of the window system.
    std::vector<std::string> surfaceExtensions;
    /// Makes the surface on which the device shall show pictures (swapchain.h): it comes before the
    /// choice, which leaves out devices that cannot. Empty: any device will do.
    std::function<core::Result<VkSurfaceKHR>(VkInstance)> makeSurface;
};

/// Stages that may use set 1 of a pipeline's layout.
inline constexpr VkShaderStageFlags kSceneStages =
    VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_RAYGEN_BIT_KHR |
    VK_SHADER_STAGE_ANY_HIT_BIT_KHR;

/// Semaphores of one submission; null: none.
struct SubmitSemaphores {
    VkSemaphore wait = VK_NULL_HANDLE;   ///< the last batch starts once it is signalled
    VkSemaphore signal = VK_NULL_HANDLE; ///< signalled when the submission is done
};

/// A device created and owned by a host; it must outlive all objects made from it.
struct HostDevice {
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    /// The tier of rays whose extension and features the host enabled.
    RayTier rayTier = RayTier::None;
    /// rayTracingPipelineTraceRaysIndirect is enabled (RayTier::Pipeline).
    bool tracesIndirect = false;
    bool hasDebugUtils = false; ///< VK_EXT_debug_utils is enabled: objects and passes get names
    /// The feature subgroupSizeControl is enabled: pipelines get the subgroup sizes that they
    /// request.
    bool controlsSubgroupSize = false;
    /// Pipeline cache; null: in an internal one that is not stored on disk. Other threads may use
    /// it concurrently, unless it is externally synchronized.
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;
};

/// Entry points of extensions, loaded once.
struct ExtensionFunctions {
    PFN_vkCreateAccelerationStructureKHR createAccelerationStructure = nullptr;
    PFN_vkDestroyAccelerationStructureKHR destroyAccelerationStructure = nullptr;
    PFN_vkGetAccelerationStructureBuildSizesKHR getAccelerationStructureBuildSizes = nullptr;
    PFN_vkGetAccelerationStructureDeviceAddressKHR getAccelerationStructureDeviceAddress = nullptr;
    PFN_vkCmdBuildAccelerationStructuresKHR cmdBuildAccelerationStructures = nullptr;
    PFN_vkCmdWriteAccelerationStructuresPropertiesKHR cmdWriteAccelerationStructuresProperties =
        nullptr;
    PFN_vkCmdCopyAccelerationStructureKHR cmdCopyAccelerationStructure = nullptr;
    PFN_vkCreateRayTracingPipelinesKHR createRayTracingPipelines = nullptr;
    PFN_vkGetRayTracingShaderGroupHandlesKHR getRayTracingShaderGroupHandles = nullptr;
    PFN_vkCmdTraceRaysKHR cmdTraceRays = nullptr;
    PFN_vkCmdTraceRaysIndirectKHR cmdTraceRaysIndirect = nullptr; ///< where tracesIndirect
    PFN_vkCmdBeginDebugUtilsLabelEXT cmdBeginDebugUtilsLabel = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT cmdEndDebugUtilsLabel = nullptr;
    PFN_vkSetDebugUtilsObjectNameEXT setDebugUtilsObjectName = nullptr;
};

/// Alignment and sizes of shader binding tables, bytes (RayTier::Pipeline).
struct ShaderGroupLimits {
    uint32_t handleBytes = 0;
    uint32_t handleAlignment = 1;
    uint32_t baseAlignment = 1;
};

/// Counts of the objects on a device that are not yet destroyed, including retired ones that may
/// still be in use.
struct LivingObjects {
    uint64_t memoryBytes = 0;  ///< allocated
    uint32_t memoryBlocks = 0; ///< allocations
    uint32_t buffers = 0;
    uint32_t images = 0;
    uint32_t samplers = 0; ///< of the scene's textures
    uint32_t accelerationStructures = 0;

    bool operator==(const LivingObjects&) const = default;
};

/// A logical device with one queue, its timeline and its retired objects. Everything made from it
/// must be gone before it is. Not thread-safe.
///
/// One around a host's device has no queue: the host submits, and reports progress through handOver
/// and markDone.
class Device {
  public:
    [[nodiscard]] static core::Result<std::unique_ptr<Device>> create(const DeviceOptions& options);
    /// Around a host's device. Destroys no objects of the host and never waits: before its
    /// destruction the GPU must have finished all submitted work.
    [[nodiscard]] static core::Result<std::unique_ptr<Device>> adopt(const HostDevice& host);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] VkDevice handle() const { return mDevice; }

    [[nodiscard]] VkInstance instance() const { return mInstance; }

    [[nodiscard]] VkPhysicalDevice physical() const { return mInfo.handle; }

    [[nodiscard]] VkQueue queue() const { return mQueue; }

    [[nodiscard]] uint32_t queueFamily() const { return mInfo.queueFamily; }

    /// How many bits of the queue's timestamps count; the others are zero.
    [[nodiscard]] uint32_t timestampBits() const { return mInfo.timestampBits; }

    /// Hands over the surface of DeviceOptions::makeSurface; null where there is none any more.
    [[nodiscard]] VkSurfaceKHR takeSurface() { return std::exchange(mSurface, VK_NULL_HANDLE); }

    [[nodiscard]] const DeviceInfo& info() const { return mInfo; }

    [[nodiscard]] bool hasRays() const { return mInfo.rayTier != RayTier::None; }

    /// Whether shaders of every kind may trace rays, and traversals be nested.
    [[nodiscard]] bool hasRayQuery() const { return mInfo.rayTier == RayTier::RayQuery; }

    /// What shaders load past the end of a bound buffer is 0, and stores there do nothing.
    [[nodiscard]] bool checksBounds() const { return mBounds == Bounds::Checked; }

    [[nodiscard]] const ExtensionFunctions& functions() const { return mFunctions; }

    [[nodiscard]] const VkPhysicalDeviceLimits& limits() const { return mLimits; }

    /// Whether images of the format can be drawn with that many samples per pixel, at Vulkan's
    /// standard locations, and be sampled.
    [[nodiscard]] bool canDrawSamples(VkFormat format, uint32_t count) const;

    /// Whether compute pipelines can be made with subgroups of that many invocations.
    [[nodiscard]] bool canRequireSubgroupSize(uint32_t size) const {
        return size >= mLeastSubgroupSize && size <= mMostSubgroupSize;
    }

    [[nodiscard]] const VkPhysicalDeviceMemoryProperties& memoryProperties() const {
        return mMemoryProperties;
    }

    [[nodiscard]] uint32_t minScratchAlignment() const { return mMinScratchAlignment; }

    [[nodiscard]] const ShaderGroupLimits& shaderGroupLimits() const { return mShaderGroupLimits; }

    [[nodiscard]] VkPipelineCache pipelineCache() const { return mPipelineCache; }

    /// As set in DeviceOptions. Only pipelines may be made on other threads.
    [[nodiscard]] bool makesPipelinesAhead() const { return mMakesPipelinesAhead; }

    /// Makes pipelines on few threads. It ends before the device.
    [[nodiscard]] core::TaskQueue& pipelineQueue();

    /// Pipelines that LazyPipeline has made or requested so far.
    [[nodiscard]] uint32_t lazyPipelineCount() const { return mLazyPipelines; }

    /// Counts one more.
    void countLazyPipeline() { ++mLazyPipelines; }

    /// Writes the pipeline cache to disk, as the end of the device does: pipelines made so far are
    /// preserved even if the program crashes later.
    void savePipelineCache() const;

    [[nodiscard]] VkSampler nearestSampler() const { return mNearestSampler; } ///< clamp to edge

    [[nodiscard]] VkSampler linearSampler() const { return mLinearSampler; } ///< clamp to edge

    /// Layout of a set whose binding 0 holds `count` textures, for all who want as many. It lives
    /// as long as the device.
    [[nodiscard]] VkDescriptorSetLayout textureLayout(uint32_t count);

    /// DeviceOptions::keptPipelines is not 0.
    [[nodiscard]] bool keepsPipelines() const { return mKeptPipelines.most() > 0; }

    /// One that was given up under this key; on any thread. See kept_pipelines.h.
    [[nodiscard]] std::optional<PipelineObjects> takePipeline(const std::string& key);
    /// Caches it or, without room, destroys the oldest once it is not in use.
    void giveUpPipeline(std::string key, const PipelineObjects& objects);

    /// DeviceOptions::validate.
    [[nodiscard]] bool isValidated() const { return mMessenger != VK_NULL_HANDLE; }

    /// Messages of the validation layers (warnings and errors) so far.
    [[nodiscard]] uint32_t validationMessageCount() const { return mValidationMessages; }

    /// How many objects live: counted by Buffer, Image, MemoryBlock and AccelerationStructure.
    [[nodiscard]] const LivingObjects& living() const { return mLiving; }

    [[nodiscard]] LivingObjects& living() { return mLiving; }

    /// Number of device memory allocations so far: drivers may take tens of milliseconds for one,
    /// so similar frames should not change this.
    [[nodiscard]] uint64_t allocationCount() const { return mAllocationCount; }

    void countAllocation() { ++mAllocationCount; }

    /// Submits batches, one command buffer each, which start in this order.
    /// \return the timeline value that is reached when all are complete. Not for adopted devices
    /// (CHECKed).
    uint64_t
    submit(std::span<const VkCommandBuffer> batches, const SubmitSemaphores& semaphores = {});
    /// Adopted devices wait for nothing: there the value must be complete (CHECKed).
    void wait(uint64_t timelineValue);
    void waitIdle();
    [[nodiscard]] uint64_t completedValue() const;

    /// Adopted devices: counts work that was recorded for the host to submit. \return its value
    uint64_t handOver();
    /// Adopted devices: the GPU has finished that work, or it will never be submitted. Values may
    /// be reported in any order, and twice; one is complete once all before it are done, too.
    void markDone(uint64_t value);

    /// Runs `destroy` once everything submitted so far (and the submission being recorded now) is
    /// done. Destructors of gpu objects use it, so they may die at any time.
    void retire(std::function<void()> destroy);
    /// Destroys retired objects that are no longer in use.
    void collect();
    /// Waits until the device is idle and destroys all that was retired. Not of a host's device
    /// (CHECKed).
    void collectIdle();

    /// Whether it is a host's, which alone submits and waits.
    [[nodiscard]] bool isAdopted() const { return mIsAdopted; }

    /// Name shown by validation messages and debuggers.
    void setName(VkObjectType type, uint64_t object, const std::string& name) const;

  private:
    explicit Device(size_t keptPipelines) : mKeptPipelines(keptPipelines) {}

    core::Status adoptHost(const HostDevice& host);
    core::Status createInstance(const DeviceOptions& options);
    /// Stores the choice in mInfo and logs the rejected devices.
    core::Status choosePhysicalDevice(const DeviceOptions& options);
    void createLogicalDevice();
    void loadFunctions();
    void loadLimits();
    void destroyRetired();
    void destroyKept();
    void createSamplers();
    /// A cache a kind of device: one would drop the other's.
    [[nodiscard]] std::string cacheFileName() const;
    void loadPipelineCache();

    bool mIsAdopted = false;
    std::set<uint64_t> mHandedOver; ///< adopted: values that the host has not reported as done
    VkInstance mInstance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT mMessenger = VK_NULL_HANDLE;
    VkSurfaceKHR mSurface = VK_NULL_HANDLE; ///< until it is taken
    VkDevice mDevice = VK_NULL_HANDLE;
    VkQueue mQueue = VK_NULL_HANDLE;
    DeviceInfo mInfo;
    VkPhysicalDeviceLimits mLimits{};
    uint32_t mLeastSubgroupSize = 1; ///< that pipelines can require; above the most: none
    uint32_t mMostSubgroupSize = 0;
    VkPhysicalDeviceMemoryProperties mMemoryProperties{};
    uint32_t mMinScratchAlignment = 1;
    ShaderGroupLimits mShaderGroupLimits;
    ExtensionFunctions mFunctions;
    VkSemaphore mTimeline = VK_NULL_HANDLE;
    uint64_t mLastSubmitted = 0;
    VkPipelineCache mPipelineCache = VK_NULL_HANDLE;
    bool mOwnsPipelineCache = true;
    std::filesystem::path mCacheFile;
    VkSampler mNearestSampler = VK_NULL_HANDLE;
    VkSampler mLinearSampler = VK_NULL_HANDLE;
    std::deque<std::pair<uint64_t, std::function<void()>>> mRetired;
    KeptPipelines mKeptPipelines;
    std::map<uint32_t, VkDescriptorSetLayout> mTextureLayouts; ///< by count
    LivingObjects mLiving;
    uint64_t mAllocationCount = 0;
    bool mHasDebugUtils = false;
    bool mControlsSubgroupSize = true;
    bool mMakesPipelinesAhead = false;
    std::optional<core::TaskQueue> mPipelineQueue; ///< since a pipeline was requested of it
    uint32_t mLazyPipelines = 0;
    Bounds mBounds = Bounds::Trusted;
    std::atomic<uint32_t> mValidationMessages = 0; ///< written by the messenger, any thread
};

} // namespace shutter::gpu
