// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/host_blended_pass.h"

#include "engine/graph/execute.h"
#include "modules/motion_blur/passes/instant_surfaces.h"

namespace shutter::motion_blur {

namespace {

using graph::Access;

/// The part of the task that is known before the frame is recorded.
BlendedTask describeTask(const BlendedDraws& draws, uint32_t part) {
    const shader::InstantSurfaces& head = draws.rectangle;
    BlendedTask task{};
    task.structBytes = sizeof(task);
    task.area = {
        {int32_t(head.originPx.x), int32_t(head.originPx.y)}, {head.sizePx.x, head.sizePx.y}};
    task.part = part;
    task.partCount = head.partCount;
    task.instantCount = head.instantCount;
    for (uint32_t i = 0; i < head.instantCount; ++i) {
        const uint32_t of = shader::surfacePartOf(head, i);
        task.firstInstant += of < part ? 1 : 0;
        task.partInstantCount += of == part ? 1 : 0;
    }
    return task;
}

/// Declares the draws of a part.
BlendedSums addPart(
    graph::Graph& graph,
    const HostBlended& own,
    const BlendedDraws& draws,
    graph::BufferHandle surfaces,
    const BlendedTask& known
) {
    const graph::TransientImageDesc size{
        draws.rectangle.sizePx.x, draws.rectangle.sizePx.y, VK_FORMAT_R16G16B16A16_SFLOAT};
    const graph::ImageHandle color = graph.createImage("own blended color", size);
    const graph::ImageHandle opacity = own.isOpacityInAlpha
                                           ? graph::ImageHandle()
                                           : graph.createImage("own blended opacity", size);
    BlendedSums sums;
    sums.share = float(known.partInstantCount) / float(known.instantCount);
    graph.addPass<BlendedSums>(
        "own blended",
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, BlendedSums& data) {
            if (surfaces.isValid())
                builder.read(surfaces, Access::ShaderRead);
            sums.color = builder.write(color, Access::OutsideWrite);
            if (opacity.isValid())
                sums.opacity = builder.write(opacity, Access::OutsideWrite);
            data = sums;
        },
        [&own, known, surfaces, times = draws.times, bytes = surfaceBytes(draws.rectangle)](
            const BlendedSums& data, graph::PassContext& context
        ) {
            const graph::PassResources& resources = context.resources;
            const auto give = [&](graph::ImageHandle image) -> ShutterBlurRevealTarget {
                return {resources.image(image).handle(), resources.view(image)};
            };
            BlendedTask task = known;
            task.commands = context.commands;
            task.times = times.data();
            if (surfaces.isValid()) {
                task.surfaces = resources.buffer(surfaces);
                task.surfacesAddress = resources.address(surfaces);
                task.surfacesBytes = bytes;
            }
            task.color = give(data.color);
            if (data.opacity.isValid())
                task.opacity = give(data.opacity);
            own.record(task);
        }
    );
    return sums;
}

} // namespace

std::vector<BlendedSums> addHostBlended(
    graph::Graph& graph,
    const HostBlended& own,
    const BlendedDraws& draws,
    graph::BufferHandle surfaces
) {
    std::vector<BlendedSums> parts;
    for (uint32_t part = 0; part < draws.rectangle.partCount; ++part)
        parts.push_back(addPart(graph, own, draws, surfaces, describeTask(draws, part)));
    return parts;
}

} // namespace shutter::motion_blur
