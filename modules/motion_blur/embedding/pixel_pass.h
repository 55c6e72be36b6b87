// SPDX-License-Identifier: MIT
// A pass that makes one image of others, pixel by pixel.
#pragma once

#include "engine/gpu/frame.h"
#include "engine/gpu/pipeline.h"
#include "engine/graph/execute.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/passes/dispatch.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace shutter::motion_blur {

/// Bindings: `sampledCount` sampled images, then a storage image.
[[nodiscard]] inline gpu::ComputePipelineDesc describePixelPass(
    const char* name,
    std::span<const uint32_t> spirv,
    uint32_t sampledCount,
    uint32_t pushConstantBytes,
    std::vector<uint32_t> specialization = {}
) {
    gpu::ComputePipelineDesc desc;
    desc.name = name;
    desc.spirv = spirv;
    desc.interface.bindings.assign(sampledCount, kSampled);
    desc.interface.bindings.push_back(kStorage);
    desc.interface.pushConstantBytes = pushConstantBytes;
    desc.specialization = std::move(specialization);
    return desc;
}

/// Declares a pass of one thread per pixel that samples `sources` and writes `target`.
/// \param push begins with `sizePx`, the picture's size
/// \return `target`, written
template <class Push>
graph::ImageHandle addPixelPass(
    graph::Graph& graph,
    const gpu::LazyPipeline& pipeline,
    const char* name,
    const std::vector<graph::ImageHandle>& sources,
    graph::ImageHandle target,
    const Push& push,
    VkSampler sampler
) {
    struct Data {
        std::vector<graph::ImageHandle> sources;
        graph::ImageHandle target;
    };

    return graph
        .addPass<Data>(
            name,
            graph::PassKind::Compute,
            [&](graph::PassBuilder& builder, Data& data) {
                for (const graph::ImageHandle source : sources)
                    data.sources.push_back(builder.read(source, graph::Access::SampledCompute));
                data.target = builder.write(target, graph::Access::StorageWrite);
            },
            [&pipeline, push, sampler](const Data& data, graph::PassContext& context) {
                gpu::BindingList bindings;
                for (const graph::ImageHandle source : data.sources)
                    bindings.sampled(context.resources.view(source), sampler);
                bindings.storage(context.resources.image(data.target));
                context.frame.bind(pipeline.get(), bindings, &push, sizeof(push));
                const glm::uvec2 groups =
                    (push.sizePx + shader::kGroupSize - 1u) / shader::kGroupSize;
                vkCmdDispatch(context.commands, groups.x, groups.y, 1);
            }
        )
        .target;
}

} // namespace shutter::motion_blur
