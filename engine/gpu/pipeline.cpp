// SPDX-License-Identifier: MIT
#include "engine/gpu/pipeline.h"

#include "engine/core/check.h"
#include "engine/gpu/pipeline_key.h"
#include "engine/gpu/shader_reflection.h"

#include <algorithm>
#include <array>
#include <utility>

namespace shutter::gpu {

namespace {

/// A shader module that lives while a pipeline is made.
class LoadedShader {
  public:
    LoadedShader(Device& device, std::span<const uint32_t> spirv, const std::string& name)
        : mDevice(device) {
        VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
        info.codeSize = spirv.size_bytes();
        info.pCode = spirv.data();
        require(
            vkCreateShaderModule(device.handle(), &info, nullptr, &mModule),
            fmt::format("loading the shader '{}'", name)
        );
        device.setName(VK_OBJECT_TYPE_SHADER_MODULE, reinterpret_cast<uint64_t>(mModule), name);
    }

    ~LoadedShader() { vkDestroyShaderModule(mDevice.handle(), mModule, nullptr); }

    LoadedShader(const LoadedShader&) = delete;
    LoadedShader& operator=(const LoadedShader&) = delete;

    [[nodiscard]] VkShaderModule handle() const { return mModule; }

  private:
    Device& mDevice;
    VkShaderModule mModule = VK_NULL_HANDLE;
};

/// Specialization constants 0, 1, 2, ... of 32 bits each. Must outlive info().
class Specialization {
  public:
    explicit Specialization(const std::vector<uint32_t>& values) {
        for (uint32_t i = 0; i < values.size(); ++i)
            mEntries.push_back({i, i * 4, 4});
        mInfo.mapEntryCount = static_cast<uint32_t>(mEntries.size());
        mInfo.pMapEntries = mEntries.data();
        mInfo.dataSize = values.size() * 4;
        mInfo.pData = values.data();
    }

    [[nodiscard]] const VkSpecializationInfo* info() const { return &mInfo; }

  private:
    std::vector<VkSpecializationMapEntry> mEntries;
    VkSpecializationInfo mInfo{};
};

VkPipelineShaderStageCreateInfo
makeStage(VkShaderStageFlagBits stage, VkShaderModule module, const Specialization& constants) {
    VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    info.stage = stage;
    info.module = module;
    info.pName = "main";
    info.pSpecializationInfo = constants.info();
    return info;
}

constexpr VkColorComponentFlags kColorBits =
    VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT;

VkPipelineColorBlendAttachmentState makeBlend(Blend blend) {
    VkPipelineColorBlendAttachmentState state{};
    state.colorWriteMask = kColorBits | VK_COLOR_COMPONENT_A_BIT;
    state.colorBlendOp = state.alphaBlendOp = VK_BLEND_OP_ADD;
    state.blendEnable = blend != Blend::None && blend != Blend::AlphaOnly;
    switch (blend) {
    case Blend::None:
        break;
    case Blend::Over:
        state.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
        state.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
        state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        break;
    case Blend::Under:
        state.srcColorBlendFactor = VK_BLEND_FACTOR_DST_ALPHA;
        state.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
        state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
        state.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        break;
    case Blend::Premultiplied:
    case Blend::PremultipliedLayer:
        state.srcColorBlendFactor = VK_BLEND_FACTOR_ONE;
        state.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        state.srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
        state.dstAlphaBlendFactor = blend == Blend::Premultiplied
                                        ? VK_BLEND_FACTOR_ONE
                                        : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
        break;
    case Blend::AlphaOnly:
        state.colorWriteMask = VK_COLOR_COMPONENT_A_BIT;
        break;
    }
    return state;
}

std::vector<VkPipelineColorBlendAttachmentState> makeBlends(size_t targets, Blend blend) {
    std::vector<VkPipelineColorBlendAttachmentState> states(targets, makeBlend(blend));
    if (blend == Blend::Over || blend == Blend::Premultiplied)
        for (size_t i = 1; i < targets; ++i)
            states[i] = {}; // not written
    return states;
}

} // namespace

void Pipeline::createLayout(const PipelineInterface& interface) {
    SHUTTER_CHECK(interface.pushConstantBytes <= 128, "{}", interface.pushConstantBytes);
    std::vector<VkDescriptorSetLayoutBinding> bindings;
    for (uint32_t i = 0; i < interface.bindings.size(); ++i)
        bindings.push_back({i, interface.bindings[i], 1, mStages, nullptr});
    VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    set.bindingCount = static_cast<uint32_t>(bindings.size());
    set.pBindings = bindings.data();
    require(
        vkCreateDescriptorSetLayout(mDevice->handle(), &set, nullptr, &mObjects.setLayout),
        "creating a descriptor layout"
    );
    const std::array layouts{mObjects.setLayout, interface.sceneLayout};
    const VkPushConstantRange range{mStages, 0, interface.pushConstantBytes};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = interface.sceneLayout ? 2 : 1;
    info.pSetLayouts = layouts.data();
    info.pushConstantRangeCount = interface.pushConstantBytes > 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    require(
        vkCreatePipelineLayout(mDevice->handle(), &info, nullptr, &mObjects.layout),
        "creating a pipeline layout"
    );
}

template <typename Desc> bool Pipeline::takeKept(const Desc& desc) {
    mBindingCount = desc.interface.bindings.size();
    if (!mDevice->keepsPipelines())
        return false;
    std::string key = makePipelineKey(desc);
    if (const auto kept = mDevice->takePipeline(key))
        mObjects = *kept;
    mKey = std::move(key);
    return mObjects.pipeline != VK_NULL_HANDLE;
}

void Pipeline::
    addShader(std::span<const uint32_t> spirv, VkShaderStageFlagBits stage, const PipelineInterface& interface) {
    const core::Status fits = checkInterface(spirv, stage, interface);
    SHUTTER_CHECK(fits.ok(), "pipeline '{}': {}", mName, fits.error().message);
    const std::vector<VkFormat> formats = reflectStorageFormats(spirv);
    mStorageFormats.resize(std::max(mStorageFormats.size(), formats.size()));
    for (size_t i = 0; i < formats.size(); ++i)
        if (formats[i] != VK_FORMAT_UNDEFINED)
            mStorageFormats[i] = formats[i];
}

Pipeline::Pipeline(Device& device, const ComputePipelineDesc& desc)
    : Pipeline(device, VK_PIPELINE_BIND_POINT_COMPUTE, VK_SHADER_STAGE_COMPUTE_BIT, desc.name) {
    addShader(desc.spirv, VK_SHADER_STAGE_COMPUTE_BIT, desc.interface);
    if (takeKept(desc))
        return;
    createLayout(desc.interface);
    const LoadedShader module(device, desc.spirv, desc.name);
    const Specialization constants(desc.specialization);
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = makeStage(VK_SHADER_STAGE_COMPUTE_BIT, module.handle(), constants);
    VkPipelineShaderStageRequiredSubgroupSizeCreateInfo subgroups{
        VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO};
    subgroups.requiredSubgroupSize = desc.subgroupSize;
    // If there are smaller ones, drivers choose by the shader's resource use.
    if (device.canRequireSubgroupSize(desc.subgroupSize) &&
        !device.canRequireSubgroupSize(desc.subgroupSize / 2))
        info.stage.pNext = &subgroups;
    info.layout = mObjects.layout;
    require(
        vkCreateComputePipelines(
            device.handle(), device.pipelineCache(), 1, &info, nullptr, &mObjects.pipeline
        ),
        fmt::format("creating the pipeline '{}'", desc.name)
    );
    device.setName(
        VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(mObjects.pipeline), desc.name
    );
}

Pipeline::Pipeline(Device& device, const GraphicsPipelineDesc& desc)
    : Pipeline(
          device,
          VK_PIPELINE_BIND_POINT_GRAPHICS,
          VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT,
          desc.name
      ) {
    addShader(desc.vertexSpirv, VK_SHADER_STAGE_VERTEX_BIT, desc.interface);
    addShader(desc.fragmentSpirv, VK_SHADER_STAGE_FRAGMENT_BIT, desc.interface);
    if (takeKept(desc))
        return;
    createLayout(desc.interface);
    const LoadedShader vertex(device, desc.vertexSpirv, desc.name);
    const LoadedShader fragment(device, desc.fragmentSpirv, desc.name);
    const Specialization constants(desc.specialization);
    const std::array stages{
        makeStage(VK_SHADER_STAGE_VERTEX_BIT, vertex.handle(), constants),
        makeStage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment.handle(), constants)};

    VkPipelineVertexInputStateCreateInfo input{
        VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{
        VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = 1;
    viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{
        VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.lineWidth = 1.0f;
    VkPipelineMultisampleStateCreateInfo multisample{
        VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    multisample.rasterizationSamples = static_cast<VkSampleCountFlagBits>(desc.samples);
    VkPipelineDepthStencilStateCreateInfo depth{
        VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = desc.depthFormat != VK_FORMAT_UNDEFINED;
    depth.depthWriteEnable = desc.depthWrite;
    depth.depthCompareOp = desc.depthCompare;
    const auto blendStates = makeBlends(desc.colorFormats.size(), desc.blend);
    VkPipelineColorBlendStateCreateInfo blend{
        VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = static_cast<uint32_t>(blendStates.size());
    blend.pAttachments = blendStates.data();
    constexpr std::array kDynamic{
        VK_DYNAMIC_STATE_VIEWPORT,
        VK_DYNAMIC_STATE_SCISSOR,
        VK_DYNAMIC_STATE_CULL_MODE,
        VK_DYNAMIC_STATE_FRONT_FACE};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = kDynamic.size();
    dynamic.pDynamicStates = kDynamic.data();
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = static_cast<uint32_t>(desc.colorFormats.size());
    rendering.pColorAttachmentFormats = desc.colorFormats.data();
    rendering.depthAttachmentFormat = desc.depthFormat;

    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
    info.stageCount = stages.size();
    info.pStages = stages.data();
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = mObjects.layout;
    require(
        vkCreateGraphicsPipelines(
            device.handle(), device.pipelineCache(), 1, &info, nullptr, &mObjects.pipeline
        ),
        fmt::format("creating the pipeline '{}'", desc.name)
    );
    device.setName(
        VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(mObjects.pipeline), desc.name
    );
}

Pipeline::Pipeline(Device& device, const RayPipelineDesc& desc)
    : Pipeline(
          device,
          VK_PIPELINE_BIND_POINT_RAY_TRACING_KHR,
          VK_SHADER_STAGE_RAYGEN_BIT_KHR | VK_SHADER_STAGE_MISS_BIT_KHR |
              VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR | VK_SHADER_STAGE_ANY_HIT_BIT_KHR,
          desc.name
      ) {
    addShader(desc.raygenSpirv, VK_SHADER_STAGE_RAYGEN_BIT_KHR, desc.interface);
    addShader(desc.missSpirv, VK_SHADER_STAGE_MISS_BIT_KHR, desc.interface);
    addShader(desc.closestHitSpirv, VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, desc.interface);
    addShader(desc.anyHitSpirv, VK_SHADER_STAGE_ANY_HIT_BIT_KHR, desc.interface);
    if (takeKept(desc))
        return;
    createLayout(desc.interface);
    const LoadedShader raygen(device, desc.raygenSpirv, desc.name);
    const LoadedShader miss(device, desc.missSpirv, desc.name);
    const LoadedShader closestHit(device, desc.closestHitSpirv, desc.name);
    const LoadedShader anyHit(device, desc.anyHitSpirv, desc.name);
    const Specialization constants(desc.specialization);
    const std::array stages{
        makeStage(VK_SHADER_STAGE_RAYGEN_BIT_KHR, raygen.handle(), constants),
        makeStage(VK_SHADER_STAGE_MISS_BIT_KHR, miss.handle(), constants),
        makeStage(VK_SHADER_STAGE_CLOSEST_HIT_BIT_KHR, closestHit.handle(), constants),
        makeStage(VK_SHADER_STAGE_ANY_HIT_BIT_KHR, anyHit.handle(), constants)};
    std::array<VkRayTracingShaderGroupCreateInfoKHR, 3> groups{};
    for (uint32_t i = 0; i < groups.size(); ++i) {
        groups[i].sType = VK_STRUCTURE_TYPE_RAY_TRACING_SHADER_GROUP_CREATE_INFO_KHR;
        groups[i].type = VK_RAY_TRACING_SHADER_GROUP_TYPE_GENERAL_KHR;
        groups[i].generalShader = i; // stages 0 and 1
        groups[i].closestHitShader = VK_SHADER_UNUSED_KHR;
        groups[i].anyHitShader = VK_SHADER_UNUSED_KHR;
        groups[i].intersectionShader = VK_SHADER_UNUSED_KHR;
    }
    groups[2].type = VK_RAY_TRACING_SHADER_GROUP_TYPE_TRIANGLES_HIT_GROUP_KHR;
    groups[2].generalShader = VK_SHADER_UNUSED_KHR;
    groups[2].closestHitShader = 2;
    groups[2].anyHitShader = 3;
    VkRayTracingPipelineCreateInfoKHR info{VK_STRUCTURE_TYPE_RAY_TRACING_PIPELINE_CREATE_INFO_KHR};
    info.stageCount = stages.size();
    info.pStages = stages.data();
    info.groupCount = groups.size();
    info.pGroups = groups.data();
    info.maxPipelineRayRecursionDepth = 1;
    info.layout = mObjects.layout;
    require(
        device.functions().createRayTracingPipelines(
            device.handle(),
            VK_NULL_HANDLE,
            device.pipelineCache(),
            1,
            &info,
            nullptr,
            &mObjects.pipeline
        ),
        fmt::format("creating the pipeline '{}'", desc.name)
    );
    device.setName(
        VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(mObjects.pipeline), desc.name
    );
}

Pipeline::~Pipeline() {
    release();
}

Pipeline::Pipeline(Pipeline&& other) noexcept {
    *this = std::move(other);
}

Pipeline& Pipeline::operator=(Pipeline&& other) noexcept {
    if (this == &other)
        return *this;
    release();
    mDevice = std::exchange(other.mDevice, nullptr);
    mObjects = std::exchange(other.mObjects, {});
    mKey = std::move(other.mKey);
    mBindPoint = other.mBindPoint;
    mStages = other.mStages;
    mBindingCount = other.mBindingCount;
    mName = std::move(other.mName);
    mStorageFormats = std::move(other.mStorageFormats);
    return *this;
}

void Pipeline::release() {
    if (!mDevice)
        return;
    mDevice->giveUpPipeline(std::move(mKey), mObjects);
    mDevice = nullptr;
}

LazyPipeline::LazyPipeline(Device& device, std::function<Pipeline()> make)
    : mDevice(&device), mMake(std::move(make)),
      mPipeline(std::make_unique<std::optional<Pipeline>>()) {
    if (device.makesPipelinesAhead())
        prepare();
}

LazyPipeline::LazyPipeline(Device& device, const ComputePipelineDesc& desc)
    : LazyPipeline(device, [&device, desc] { return Pipeline(device, desc); }) {}

LazyPipeline::LazyPipeline(Device& device, const RayPipelineDesc& desc)
    : LazyPipeline(device, [&device, desc] { return Pipeline(device, desc); }) {}

LazyPipeline::~LazyPipeline() {
    if (mTask)
        mTask->drop();
}

void LazyPipeline::prepare() const {
    if (mTask || *mPipeline)
        return;
    mDevice->countLazyPipeline();
    mTask = mDevice->pipelineQueue().add([make = mMake, made = mPipeline.get()] {
        made->emplace(make());
    });
}

bool LazyPipeline::isReady() const {
    return mTask ? mTask->isDone() : mPipeline->has_value();
}

const Pipeline& LazyPipeline::get() const {
    if (mTask) {
        mTask->finish();
        mTask.reset();
    }
    if (!*mPipeline) {
        mDevice->countLazyPipeline();
        mPipeline->emplace(mMake());
    }
    return **mPipeline;
}

Pipeline LazyPipeline::take() {
    (void)get();
    return std::move(**mPipeline);
}

} // namespace shutter::gpu
