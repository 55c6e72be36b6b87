// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/task_queue.h"
#include "engine/gpu/device.h"
#include "engine/gpu/vulkan.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace shutter::gpu {

/// The descriptor sets of a pipeline. Set 0 belongs to the pass and is written each frame; set 1,
/// if given, belongs to the scene (bindless textures) and is long-lived.
struct PipelineInterface {
    std::vector<VkDescriptorType> bindings; ///< set 0, binding i
    uint32_t pushConstantBytes = 0;         ///< [0, 128]
    VkDescriptorSetLayout sceneLayout = VK_NULL_HANDLE;
};

struct ComputePipelineDesc {
    std::string name;
    std::span<const uint32_t> spirv;
    PipelineInterface interface;
    std::vector<uint32_t> specialization; ///< constant_id 0, 1, 2, ...
    /// Invocations of a subgroup, a power of two, if devices have none of fewer; 0, or where they
    /// do: the driver's choice.
    uint32_t subgroupSize = 0;
};

/// Shaders of one traversal. Only the ray generation shader starts rays.
struct RayPipelineDesc {
    std::string name;
    std::span<const uint32_t> raygenSpirv;
    std::span<const uint32_t> missSpirv;
    std::span<const uint32_t> closestHitSpirv;
    std::span<const uint32_t> anyHitSpirv;
    PipelineInterface interface;
    std::vector<uint32_t> specialization; ///< of all shaders
};

/// How fragments are blended with the targets.
enum class Blend : uint8_t {
    None,
    Over, ///< attachment 0 alone, by its alpha; the others are not written
    /// All attachments, nearest first: premultiplied colours are added by the transmittance
    /// accumulated in alpha, and alpha is multiplied by the surface's transmittance.
    Under,
    Premultiplied, ///< over, with premultiplied colours; alpha does not change; attachment 0 only
    /// The same, and alpha is multiplied by the transmittance.
    PremultipliedLayer,
    AlphaOnly, ///< alpha of all attachments is replaced, colours do not change
};

struct GraphicsPipelineDesc {
    std::string name;
    std::span<const uint32_t> vertexSpirv;
    std::span<const uint32_t> fragmentSpirv;
    PipelineInterface interface;
    std::vector<uint32_t> specialization;
    std::vector<VkFormat> colorFormats;
    VkFormat depthFormat = VK_FORMAT_UNDEFINED;
    VkCompareOp depthCompare = VK_COMPARE_OP_GREATER; ///< reversed depth
    bool depthWrite = true;
    Blend blend = Blend::None;
    uint32_t samples = 1; ///< per pixel of all targets
};

/// A compute, graphics or ray-tracing pipeline with its layout. Cull mode is dynamic for graphics.
class Pipeline {
  public:
    Pipeline() = default;
    Pipeline(Device& device, const ComputePipelineDesc& desc);
    Pipeline(Device& device, const GraphicsPipelineDesc& desc);
    /// Groups: 0 start, 1 miss, 2 hit. RayPipeline adds the table that launches need.
    Pipeline(Device& device, const RayPipelineDesc& desc);
    ~Pipeline();
    Pipeline(Pipeline&& other) noexcept;
    Pipeline& operator=(Pipeline&& other) noexcept;

    [[nodiscard]] VkPipeline handle() const { return mObjects.pipeline; }

    [[nodiscard]] VkPipelineLayout layout() const { return mObjects.layout; }

    [[nodiscard]] VkDescriptorSetLayout setLayout() const { return mObjects.setLayout; }

    [[nodiscard]] VkPipelineBindPoint bindPoint() const { return mBindPoint; }

    [[nodiscard]] VkShaderStageFlags stages() const { return mStages; }

    [[nodiscard]] size_t bindingCount() const { return mBindingCount; }

    [[nodiscard]] const std::string& name() const { return mName; }

    /// The format that its shaders declare for the storage image at a binding of set 0; UNDEFINED
    /// where they declare none.
    [[nodiscard]] VkFormat storageFormat(size_t binding) const {
        return binding < mStorageFormats.size() ? mStorageFormats[binding] : VK_FORMAT_UNDEFINED;
    }

  private:
    /// Makes an empty object. The other constructors delegate to it, so that members are destroyed
    /// if they throw.
    Pipeline(
        Device& device, VkPipelineBindPoint bindPoint, VkShaderStageFlags stages, std::string name
    )
        : mDevice(&device), mBindPoint(bindPoint), mStages(stages), mName(std::move(name)) {}

    void createLayout(const PipelineInterface& interface);
    /// Takes over the storage formats of one of its shaders, which must name nothing that the
    /// layout does not bind (CHECKed).
    void
    addShader(std::span<const uint32_t> spirv, VkShaderStageFlagBits stage, const PipelineInterface& interface);
    /// Takes over the cached objects of an equal pipeline. \return false: it must be made
    template <typename Desc> bool takeKept(const Desc& desc);
    void release();

    Device* mDevice = nullptr;
    PipelineObjects mObjects;
    std::string mKey; ///< under which the device may cache it
    VkPipelineBindPoint mBindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
    VkShaderStageFlags mStages = 0;
    size_t mBindingCount = 0;
    std::string mName;
    std::vector<VkFormat> mStorageFormats; ///< by binding; the rest have none
};

/// A compute or ray-tracing pipeline that is created on first use or, on a device that makes
/// pipelines ahead, by one of its few background threads. Like all objects made from a device, it
/// may be used by one thread only.
class LazyPipeline {
  public:
    LazyPipeline(Device& device, const ComputePipelineDesc& desc);
    LazyPipeline(Device& device, const RayPipelineDesc& desc);
    /// Waits where a thread has begun to make it.
    ~LazyPipeline();
    LazyPipeline(LazyPipeline&&) noexcept = default;
    LazyPipeline& operator=(LazyPipeline&&) = delete;

    /// Requests it from Device::pipelineQueue(), unless that is done.
    void prepare() const;
    /// Whether get() returns at once.
    [[nodiscard]] bool isReady() const;
    /// Makes it, or waits for it. Throws DeviceError.
    [[nodiscard]] const Pipeline& get() const;
    /// The same, handed over. Once.
    [[nodiscard]] Pipeline take();

  private:
    LazyPipeline(Device& device, std::function<Pipeline()> make);

    Device* mDevice;
    std::function<Pipeline()> mMake;
    std::unique_ptr<std::optional<Pipeline>> mPipeline; ///< where mTask puts it, wherever this is
    mutable std::shared_ptr<core::QueuedTask> mTask;    ///< of prepare(), until get()
};

} // namespace shutter::gpu
