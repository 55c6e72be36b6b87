// SPDX-License-Identifier: MIT
#include "engine/gpu/memory.h"
#include "engine/graph/compile.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace shutter::graph {

namespace {

std::string nameLayout(VkImageLayout layout) {
    switch (layout) {
    case VK_IMAGE_LAYOUT_UNDEFINED:
        return "undefined";
    case VK_IMAGE_LAYOUT_GENERAL:
        return "general";
    case VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL:
        return "sampled";
    case VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL:
        return "colour";
    case VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL:
        return "depth";
    case VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL:
        return "copy source";
    case VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL:
        return "copy target";
    case VK_IMAGE_LAYOUT_PRESENT_SRC_KHR:
        return "present";
    default:
        return fmt::format("layout {}", static_cast<int>(layout));
    }
}

std::string nameStages(VkPipelineStageFlags2 stages) {
    static const std::array<std::pair<VkPipelineStageFlags2, const char*>, 10> kNames{{
        {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, "indirect"},
        {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, "vertex"},
        {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT, "depth"},
        {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, "fragment"},
        {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, "colour"},
        {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, "compute"},
        {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, "transfer"},
        {VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR, "build"},
        {VK_PIPELINE_STAGE_2_HOST_BIT, "host"},
        {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, "all"},
    }};
    std::string text;
    for (const auto& [bit, name] : kNames)
        if (stages & bit)
            text += fmt::format("{}{}", text.empty() ? "" : "+", name);
    return text.empty() ? "nothing" : text;
}

template <class Barrier> std::string describeBarrier(const Graph& graph, const Barrier& barrier) {
    std::string text = fmt::format(
        "'{}' {} -> {}",
        graph.resources()[barrier.resource].name,
        nameStages(barrier.srcStages),
        nameStages(barrier.dstStages)
    );
    if (barrier.srcAccess == 0 && barrier.dstAccess == 0)
        text += ", execution only";
    return text;
}

std::string describe(const Graph& graph, const ImageBarrier& barrier) {
    const std::string text = describeBarrier(graph, barrier);
    if (barrier.oldLayout == barrier.newLayout)
        return text;
    return fmt::format(
        "{}, {} -> {}", text, nameLayout(barrier.oldLayout), nameLayout(barrier.newLayout)
    );
}

std::string describe(const Graph& graph, const BufferBarrier& barrier) {
    return describeBarrier(graph, barrier);
}

bool clears(const PassRecord& pass, uint32_t resource) {
    if (pass.depthTarget && pass.depthTarget->resource == resource)
        return pass.depthTarget->clear.has_value();
    return std::any_of(
        pass.colorTargets.begin(),
        pass.colorTargets.end(),
        [&](const ColorTarget& target) { return target.resource == resource && target.clear; }
    );
}

std::string describeUse(const Graph& graph, const PassRecord& pass, const ResourceUse& use) {
    const std::string& name = graph.resources()[use.resource].name;
    const char* access = describe(use.access);
    if (use.writeVersion == kNoVersion)
        return fmt::format("reads '{}' version {}: {}", name, use.readVersion, access);
    if (clears(pass, use.resource))
        return fmt::format("clears '{}' to version {}: {}", name, use.writeVersion, access);
    return fmt::format("writes '{}' version {}: {}", name, use.writeVersion, access);
}

void dumpPasses(const Graph& graph, const Plan& plan, std::string& text) {
    static constexpr std::array kKinds{"compute", "raster", "transfer", "build", "ray tracing"};
    auto out = std::back_inserter(text);
    fmt::format_to(out, "passes: {}\n", plan.passes.size());
    for (size_t position = 0; position < plan.passes.size(); ++position) {
        const PlannedPass& planned = plan.passes[position];
        const PassRecord& pass = graph.passes()[planned.pass];
        fmt::format_to(
            out,
            "  {} '{}' ({}{})\n",
            position,
            pass.name,
            kKinds[static_cast<size_t>(pass.kind)],
            pass.hasSideEffect ? ", side effect" : ""
        );
        for (const ImageBarrier& barrier : planned.imageBarriers)
            fmt::format_to(out, "      barrier {}\n", describe(graph, barrier));
        for (const BufferBarrier& barrier : planned.bufferBarriers)
            fmt::format_to(out, "      barrier {}\n", describe(graph, barrier));
        for (const ResourceUse& use : pass.uses)
            fmt::format_to(out, "      {}\n", describeUse(graph, pass, use));
    }
    for (const ImageBarrier& barrier : plan.finalImageBarriers)
        fmt::format_to(out, "  end: barrier {}\n", describe(graph, barrier));
    for (const BufferBarrier& barrier : plan.finalBufferBarriers)
        fmt::format_to(out, "  end: barrier {}\n", describe(graph, barrier));
}

void dumpTransients(const Graph& graph, const Plan& plan, std::string& text) {
    auto out = std::back_inserter(text);
    fmt::format_to(out, "images: {}\n", plan.images.size());
    for (const Placement& image : plan.images) {
        const ResourceRecord& record = graph.resources()[image.resource];
        fmt::format_to(
            out,
            "  '{}' {} x {} {}, passes {} to {}, {} bytes at {}\n",
            record.name,
            record.imageDesc.width,
            record.imageDesc.height,
            gpu::nameFormat(record.imageDesc.format),
            image.firstPass,
            image.lastPass,
            image.bytes,
            image.offset
        );
    }
    fmt::format_to(out, "buffers: {}\n", plan.buffers.size());
    for (const Placement& buffer : plan.buffers)
        fmt::format_to(
            out,
            "  '{}', passes {} to {}, {} bytes\n",
            graph.resources()[buffer.resource].name,
            buffer.firstPass,
            buffer.lastPass,
            buffer.bytes
        );
    fmt::format_to(
        out, "image memory: {} bytes, {} without sharing\n", plan.blockBytes, plan.unaliasedBytes
    );
}

} // namespace

std::string dump(const Graph& graph, const Plan& plan) {
    std::string text;
    dumpPasses(graph, plan, text);
    auto out = std::back_inserter(text);
    fmt::format_to(out, "culled: {}\n", plan.culled.size());
    for (const CulledPass& culled : plan.culled)
        fmt::format_to(out, "  '{}': {}\n", culled.name, culled.reason);
    dumpTransients(graph, plan, text);
    return text;
}

} // namespace shutter::graph
