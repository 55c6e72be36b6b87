// SPDX-License-Identifier: MIT
// Writes the compiler statistics of each pipeline to a file in the folder SHUTTER_STATISTICS,
// shared by all runs, so that each pipeline is measured once. The driver compiles measured
// pipelines again; others may come from its cache.
#include "tests/gpu_static/layer/layer.h"

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::gpu_static {

namespace {

std::mutex sMutex;
std::map<VkShaderModule, uint64_t> sModules;      // hashes of their code
std::map<VkPipeline, std::string> sNamelessFiles; // of pipelines that have no name yet

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
    const VkResult result = next().CreateShaderModule(device, info, allocator, module);
    const std::lock_guard lock(sMutex);
    if (result == VK_SUCCESS)
        sModules[*module] = hashBytes(info->pCode, info->codeSize);
    return result;
}

/// The program names a pipeline right after it is made.
VKAPI_ATTR VkResult VKAPI_CALL setName(VkDevice device, const VkDebugUtilsObjectNameInfoEXT* info) {
    if (info->objectType == VK_OBJECT_TYPE_PIPELINE && info->pObjectName) {
        const std::lock_guard lock(sMutex);
        const auto found = sNamelessFiles.find(reinterpret_cast<VkPipeline>(info->objectHandle));
        if (found != sNamelessFiles.end()) {
            if (std::FILE* file = std::fopen(found->second.c_str(), "a")) {
                std::fprintf(file, "name\t%s\n", info->pObjectName);
                std::fclose(file);
            }
            sNamelessFiles.erase(found);
        }
    }
    return next().SetDebugUtilsObjectNameEXT(device, info);
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
    const std::lock_guard lock(sMutex);
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

/// File of a pipeline's statistics; empty: not wanted.
std::string pathOf(const Identity& identity) {
    const char* folder = std::getenv("SHUTTER_STATISTICS");
    std::array<char, 24> name{};
    std::snprintf(
        name.data(), name.size(), "/%016llx", static_cast<unsigned long long>(identity.hash)
    );
    return folder ? std::string(folder) + name.data() : "";
}

/// Lines: the constants; then for each of the pipeline's programs the stage with the size of its
/// subgroups, and the statistics.
void write(std::FILE* file, const Identity& identity, VkPipeline pipeline) {
    std::fprintf(file, "constants\t%s\n", identity.constants.c_str());
    VkPipelineInfoKHR info{VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR};
    info.pipeline = pipeline;
    uint32_t count = 0;
    next().GetPipelineExecutablePropertiesKHR(next().device, &info, &count, nullptr);
    std::vector<VkPipelineExecutablePropertiesKHR> programs(
        count, {VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR}
    );
    next().GetPipelineExecutablePropertiesKHR(next().device, &info, &count, programs.data());
    for (uint32_t i = 0; i < count; ++i) {
        std::fprintf(file, "program\t%s\t%u\n", programs[i].name, programs[i].subgroupSize);
        VkPipelineExecutableInfoKHR program{VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR};
        program.pipeline = pipeline;
        program.executableIndex = i;
        uint32_t rows = 0;
        next().GetPipelineExecutableStatisticsKHR(next().device, &program, &rows, nullptr);
        std::vector<VkPipelineExecutableStatisticKHR> statistics(
            rows, {VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR}
        );
        next().GetPipelineExecutableStatisticsKHR(
            next().device, &program, &rows, statistics.data()
        );
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

/// Replaces a function that creates pipelines, and calls it for one at a time.
template <class Info, class Create>
VkResult createEach(std::span<const Info> infos, VkPipeline* pipelines, Create create) {
    VkResult result = VK_SUCCESS;
    for (size_t i = 0; i < infos.size(); ++i) {
        const Identity identity = identify(infos[i]);
        const std::string path = pathOf(identity);
        // One that is there was written by another pipeline of this code.
        std::FILE* file = path.empty() ? nullptr : std::fopen(path.c_str(), "wx");
        Info info = infos[i];
        if (file)
            info.flags |= VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
        const VkResult made = create(info, pipelines + i);
        if (made != VK_SUCCESS)
            result = made;
        if (!file)
            continue;
        if (made == VK_SUCCESS)
            write(file, identity, pipelines[i]);
        std::fclose(file);
        if (made != VK_SUCCESS)
            continue;
        const std::lock_guard lock(sMutex);
        sNamelessFiles[pipelines[i]] = path;
    }
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createCompute(
    VkDevice device,
    VkPipelineCache cache,
    uint32_t count,
    const VkComputePipelineCreateInfo* infos,
    const VkAllocationCallbacks* allocator,
    VkPipeline* pipelines
) {
    return createEach(std::span(infos, count), pipelines, [&](const auto& info, VkPipeline* made) {
        return next().CreateComputePipelines(device, cache, 1, &info, allocator, made);
    });
}

VKAPI_ATTR VkResult VKAPI_CALL createGraphics(
    VkDevice device,
    VkPipelineCache cache,
    uint32_t count,
    const VkGraphicsPipelineCreateInfo* infos,
    const VkAllocationCallbacks* allocator,
    VkPipeline* pipelines
) {
    return createEach(std::span(infos, count), pipelines, [&](const auto& info, VkPipeline* made) {
        return next().CreateGraphicsPipelines(device, cache, 1, &info, allocator, made);
    });
}

VKAPI_ATTR VkResult VKAPI_CALL createRays(
    VkDevice device,
    VkDeferredOperationKHR deferred,
    VkPipelineCache cache,
    uint32_t count,
    const VkRayTracingPipelineCreateInfoKHR* infos,
    const VkAllocationCallbacks* allocator,
    VkPipeline* pipelines
) {
    return createEach(std::span(infos, count), pipelines, [&](const auto& info, VkPipeline* made) {
        return next().CreateRayTracingPipelinesKHR(
            device, deferred, cache, 1, &info, allocator, made
        );
    });
}

} // namespace

std::span<const test::LayerEntry> listPipelines() {
    static const std::array sEntries{
        SHUTTER_ENTRY(CreateShaderModule, createModule),
        SHUTTER_ENTRY(SetDebugUtilsObjectNameEXT, setName),
        SHUTTER_ENTRY(CreateComputePipelines, createCompute),
        SHUTTER_ENTRY(CreateGraphicsPipelines, createGraphics),
        SHUTTER_ENTRY(CreateRayTracingPipelinesKHR, createRays),
    };
    return sEntries;
}

} // namespace shutter::gpu_static
