// SPDX-License-Identifier: MIT
// Devices that execute nothing: each submission has ended when it is made, and the driver sees none
// of them. The compiler's statistics of each pipeline are written to a file in a folder that all
// runs share, so that each pipeline is compiled and measured once.
#include "tests/fault_layer/dispatch.h"
#include "tests/fault_layer/fault_plan.h"

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

namespace shutter::faults {

namespace {

std::mutex sStatisticsMutex;
std::map<VkShaderModule, uint64_t> sModules;      // hashes of their code
std::map<VkPipeline, std::string> sNamelessFiles; // of pipelines that have no name yet
std::map<VkSemaphore, uint64_t> sValues;          // of timelines

/// FNV-1a.
uint64_t hashBytes(const void* data, size_t size, uint64_t hash = 0xcbf29ce484222325) {
    for (const char byte : std::string_view(static_cast<const char*>(data), size))
        hash = (hash ^ static_cast<uint8_t>(byte)) * 0x100000001b3;
    return hash;
}

VKAPI_ATTR VkResult VKAPI_CALL createModule(
    VkDevice device,
    const VkShaderModuleCreateInfo* info,
    const VkAllocationCallbacks* allocator,
    VkShaderModule* module
) {
    const VkResult result = findDevice(device).CreateShaderModule(device, info, allocator, module);
    const std::lock_guard lock(sStatisticsMutex);
    if (result == VK_SUCCESS)
        sModules[*module] = hashBytes(info->pCode, info->codeSize);
    return result;
}

/// The program names a pipeline right after it is made.
VKAPI_ATTR VkResult VKAPI_CALL
nameMeasured(VkDevice device, const VkDebugUtilsObjectNameInfoEXT* info) {
    if (info->objectType == VK_OBJECT_TYPE_PIPELINE && info->pObjectName) {
        const std::lock_guard lock(sStatisticsMutex);
        const auto found = sNamelessFiles.find(reinterpret_cast<VkPipeline>(info->objectHandle));
        if (found != sNamelessFiles.end()) {
            if (std::FILE* file = std::fopen(found->second.c_str(), "a")) {
                std::fprintf(file, "name\t%s\n", info->pObjectName);
                std::fclose(file);
            }
            sNamelessFiles.erase(found);
        }
    }
    return findDevice(device).SetDebugUtilsObjectNameEXT(device, info);
}

template <class Info> const Info* findInfo(const void* chain, VkStructureType type) {
    for (auto* info = static_cast<const VkBaseInStructure*>(chain); info; info = info->pNext)
        if (info->sType == type)
            return reinterpret_cast<const Info*>(info);
    return nullptr;
}

struct Identity {
    std::string constants; ///< of the last stage, by commas
    uint64_t hash = 0;     ///< of all that its code depends on
};

std::string describe(const VkSpecializationInfo* info) {
    std::string text;
    for (uint32_t i = 0; info && i < info->mapEntryCount; ++i) {
        uint32_t value = 0;
        const VkSpecializationMapEntry& entry = info->pMapEntries[i];
        std::memcpy(&value, static_cast<const char*>(info->pData) + entry.offset, sizeof(value));
        text += (text.empty() ? "" : ",") + std::to_string(static_cast<int32_t>(value));
    }
    return text;
}

Identity identify(std::span<const VkPipelineShaderStageCreateInfo> stages) {
    const std::lock_guard lock(sStatisticsMutex);
    Identity identity;
    for (const VkPipelineShaderStageCreateInfo& stage : stages) {
        using Size = VkPipelineShaderStageRequiredSubgroupSizeCreateInfo;
        const auto* size = findInfo<Size>(
            stage.pNext, VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO
        );
        identity.constants = describe(stage.pSpecializationInfo);
        const std::string text = identity.constants + ' ' + std::to_string(sModules[stage.module]) +
                                 ' ' + std::to_string(size ? size->requiredSubgroupSize : 0);
        identity.hash = hashBytes(text.data(), text.size(), identity.hash);
    }
    return identity;
}

Identity identify(const VkComputePipelineCreateInfo& info) {
    return identify({&info.stage, 1});
}

Identity identify(const VkRayTracingPipelineCreateInfoKHR& info) {
    return identify({info.pStages, info.stageCount});
}

/// Fragment shaders end with code for the formats and the blending of their targets.
Identity identify(const VkGraphicsPipelineCreateInfo& info) {
    Identity identity = identify({info.pStages, info.stageCount});
    const auto* targets = findInfo<VkPipelineRenderingCreateInfo>(
        info.pNext, VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO
    );
    if (targets)
        identity.hash = hashBytes(
            targets->pColorAttachmentFormats,
            targets->colorAttachmentCount * sizeof(VkFormat),
            identity.hash
        );
    if (info.pColorBlendState)
        identity.hash = hashBytes(
            info.pColorBlendState->pAttachments,
            info.pColorBlendState->attachmentCount * sizeof(VkPipelineColorBlendAttachmentState),
            identity.hash
        );
    return identity;
}

std::string pathOf(const Identity& identity) {
    std::array<char, 24> name{};
    std::snprintf(
        name.data(), name.size(), "/%016llx", static_cast<unsigned long long>(identity.hash)
    );
    return FaultPlan::get().statisticsFolder + name.data();
}

/// Lines: the constants; then for each of the pipeline's programs the stage with the size of its
/// subgroups, and the statistics.
void write(
    const DeviceTable& table, std::FILE* file, const Identity& identity, VkPipeline pipeline
) {
    std::fprintf(file, "constants\t%s\n", identity.constants.c_str());
    VkPipelineInfoKHR info{VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR};
    info.pipeline = pipeline;
    uint32_t count = 0;
    table.GetPipelineExecutablePropertiesKHR(table.device, &info, &count, nullptr);
    std::vector<VkPipelineExecutablePropertiesKHR> programs(
        count, {VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR}
    );
    table.GetPipelineExecutablePropertiesKHR(table.device, &info, &count, programs.data());
    for (uint32_t i = 0; i < count; ++i) {
        std::fprintf(file, "program\t%s\t%u\n", programs[i].name, programs[i].subgroupSize);
        VkPipelineExecutableInfoKHR program{VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR};
        program.pipeline = pipeline;
        program.executableIndex = i;
        uint32_t rows = 0;
        table.GetPipelineExecutableStatisticsKHR(table.device, &program, &rows, nullptr);
        std::vector<VkPipelineExecutableStatisticKHR> statistics(
            rows, {VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR}
        );
        table.GetPipelineExecutableStatisticsKHR(table.device, &program, &rows, statistics.data());
        for (const VkPipelineExecutableStatisticKHR& statistic : statistics)
            if (statistic.format == VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR)
                std::fprintf(
                    file,
                    "statistic\t%s\t%llu\n",
                    statistic.name,
                    static_cast<unsigned long long>(statistic.value.u64)
                );
    }
}

/// A compute shader of one invocation that does nothing.
constexpr uint32_t kNothing[] = {
    0x07230203, 0x00010000, 0,          5,          0,    // version 1.0, names below 5
    0x00020011, 1,                                        // OpCapability Shader
    0x0003000e, 0,          1,                            // OpMemoryModel Logical GLSL450
    0x0005000f, 5,          1,          0x6e69616d, 0,    // OpEntryPoint GLCompute %1 "main"
    0x00060010, 1,          17,         1,          1, 1, // OpExecutionMode %1 LocalSize 1 1 1
    0x00020013, 2,                                        // %2 = OpTypeVoid
    0x00030021, 3,          2,                            // %3 = OpTypeFunction %2
    0x00050036, 2,          1,          0,          3,    // %1 = OpFunction %2 None %3
    0x000200f8, 4,          0x000100fd, 0x00010038,       // %4 = OpLabel, OpReturn, OpFunctionEnd
};

/// Only compute pipelines are replaced.
void replaceCode(const DeviceTable&, auto&) {}

/// Nothing executes the pipeline: one that was measured is not compiled again. Drivers keep no
/// measured pipeline in their cache.
void replaceCode(const DeviceTable& table, VkComputePipelineCreateInfo& info) {
    static const VkShaderModule kModule = [&] {
        VkShaderModuleCreateInfo nothing{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
        nothing.codeSize = sizeof(kNothing);
        nothing.pCode = kNothing;
        VkShaderModule module = VK_NULL_HANDLE;
        if (table.CreateShaderModule(table.device, &nothing, nullptr, &module) != VK_SUCCESS)
            refuse("cannot make a shader that does nothing");
        return module;
    }();
    info.stage.module = kModule;
}

/// Replaces a function that creates pipelines, and calls it for one at a time.
template <auto next> struct Measure;

template <class... Args, VkResult (VKAPI_PTR* DeviceTable::*next)(VkDevice, Args...)>
struct Measure<next> {
    static VKAPI_ATTR VkResult VKAPI_CALL call(VkDevice device, Args... args) {
        constexpr size_t kCount = sizeof...(Args) - 4; // then infos, allocator and pipelines
        std::tuple<Args...> one(args...);
        const std::span infos(std::get<kCount + 1>(one), std::get<kCount>(one));
        VkPipeline* pipeline = std::get<kCount + 3>(one);
        const DeviceTable& table = findDevice(device);
        VkResult result = VK_SUCCESS;
        for (auto info : infos) {
            const Identity identity = identify(info);
            const std::string path = pathOf(identity);
            // One that is there was written by another pipeline of this code.
            std::FILE* file = std::fopen(path.c_str(), "wx");
            if (file)
                info.flags |= VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
            else
                replaceCode(table, info);
            std::get<kCount>(one) = 1;
            std::get<kCount + 1>(one) = &info;
            std::get<kCount + 3>(one) = pipeline;
            const VkResult made =
                std::apply([&](auto... each) { return (table.*next)(device, each...); }, one);
            if (made != VK_SUCCESS)
                result = made;
            if (file && made == VK_SUCCESS) {
                write(table, file, identity, *pipeline);
                const std::lock_guard lock(sStatisticsMutex);
                sNamelessFiles[*pipeline] = path;
            }
            if (file)
                std::fclose(file);
            ++pipeline;
        }
        return result;
    }
};

VKAPI_ATTR VkResult VKAPI_CALL
endSubmission(VkQueue, uint32_t count, const VkSubmitInfo2* infos, VkFence) {
    const std::lock_guard lock(sStatisticsMutex);
    for (const VkSubmitInfo2& info : std::span(infos, count))
        for (const VkSemaphoreSubmitInfo& signal :
             std::span(info.pSignalSemaphoreInfos, info.signalSemaphoreInfoCount))
            sValues[signal.semaphore] = signal.value;
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL endWait(VkDevice, const VkSemaphoreWaitInfo*, uint64_t) {
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL readCounter(VkDevice, VkSemaphore semaphore, uint64_t* value) {
    const std::lock_guard lock(sStatisticsMutex);
    *value = sValues[semaphore];
    return VK_SUCCESS;
}

/// All times are 0, and so are all sizes.
VKAPI_ATTR VkResult VKAPI_CALL readQueries(
    VkDevice,
    VkQueryPool,
    uint32_t,
    uint32_t,
    size_t bytes,
    void* data,
    VkDeviceSize,
    VkQueryResultFlags
) {
    std::memset(data, 0, bytes);
    return VK_SUCCESS;
}

} // namespace

std::span<const test::LayerEntry> listStatistics() {
#define SHUTTER_MEASURE(name) SHUTTER_ENTRY(name, Measure<&DeviceTable::name>::call)
    static const std::array sEntries{
        SHUTTER_ENTRY(CreateShaderModule, createModule),
        SHUTTER_ENTRY(SetDebugUtilsObjectNameEXT, nameMeasured),
        SHUTTER_MEASURE(CreateComputePipelines),
        SHUTTER_MEASURE(CreateGraphicsPipelines),
        SHUTTER_MEASURE(CreateRayTracingPipelinesKHR),
        SHUTTER_ENTRY(QueueSubmit2, endSubmission),
        SHUTTER_ENTRY(WaitSemaphores, endWait),
        SHUTTER_ENTRY(GetSemaphoreCounterValue, readCounter),
        SHUTTER_ENTRY(GetQueryPoolResults, readQueries),
    };
#undef SHUTTER_MEASURE
    if (FaultPlan::get().statisticsFolder.empty())
        return {};
    return sEntries;
}

VkResult createMeasured(
    PFN_vkCreateDevice create,
    VkPhysicalDevice physical,
    const VkDeviceCreateInfo& info,
    const VkAllocationCallbacks* allocator,
    VkDevice* device
) {
    std::vector<const char*> extensions(
        info.ppEnabledExtensionNames, info.ppEnabledExtensionNames + info.enabledExtensionCount
    );
    extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
    VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR};
    statistics.pNext = const_cast<void*>(info.pNext);
    statistics.pipelineExecutableInfo = VK_TRUE;
    VkDeviceCreateInfo extended = info;
    extended.pNext = &statistics;
    extended.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    extended.ppEnabledExtensionNames = extensions.data();
    return create(physical, &extended, allocator, device);
}

} // namespace shutter::faults
