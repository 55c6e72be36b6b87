// SPDX-License-Identifier: MIT
// Short helpers for declaring a frame.
#pragma once

#include "engine/gpu/memory.h"
#include "engine/graph/compile.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace shutter::graph {

inline constexpr VkFormat kColor = VK_FORMAT_R8G8B8A8_UNORM;
inline constexpr VkFormat kDepth = VK_FORMAT_D32_SFLOAT;

/// 4 bytes per texel, placed at multiples of 256.
inline MemoryRequirement requireMemory(const TransientImageDesc& desc, VkImageUsageFlags) {
    return {VkDeviceSize{4} * desc.width * desc.height, 256};
}

inline ImageHandle
makeImage(Graph& graph, std::string name, uint32_t size = 16, VkFormat format = kColor) {
    return graph.createImage(std::move(name), {size, size, format});
}

inline BufferHandle makeBuffer(Graph& graph, std::string name, VkDeviceSize bytes = 64) {
    return graph.createBuffer(std::move(name), {bytes, 0});
}

/// A buffer that is only ever compared.
inline VkBuffer fakeBuffer(uintptr_t number) {
    return reinterpret_cast<VkBuffer>(number);
}

/// A pass that records nothing.
template <class Setup> void addPass(Graph& graph, std::string name, PassKind kind, Setup&& setup) {
    struct Data {};

    graph.addPass<Data>(
        std::move(name),
        kind,
        [&](PassBuilder& builder, Data&) { setup(builder); },
        [](const Data&, PassContext&) {}
    );
}

/// A pass that only writes `handle`. \return the version that it leaves
template <class Handle>
Handle addWriter(Graph& graph, std::string name, PassKind kind, Handle handle, Access access) {
    addPass(graph, std::move(name), kind, [&](PassBuilder& builder) {
        handle = builder.write(handle, access);
    });
    return handle;
}

/// A pass that only reads `handle`, wanted for its own sake.
template <class Handle>
void addReader(Graph& graph, std::string name, PassKind kind, Handle handle, Access access) {
    addPass(graph, std::move(name), kind, [&](PassBuilder& builder) {
        builder.read(handle, access);
        builder.sideEffect();
    });
}

/// A compute pass that stores to `target`.
template <class Handle> Handle store(Graph& graph, std::string name, Handle target) {
    return addWriter(graph, std::move(name), PassKind::Compute, target, Access::StorageWrite);
}

/// A compute pass that samples `source` and stores to `target`.
inline ImageHandle filter(Graph& graph, std::string name, ImageHandle source, ImageHandle target) {
    addPass(graph, std::move(name), PassKind::Compute, [&](PassBuilder& builder) {
        builder.read(source, Access::SampledCompute);
        target = builder.write(target, Access::StorageWrite);
    });
    return target;
}

/// A compute pass that samples `source`, wanted for its own sake.
inline void sample(Graph& graph, std::string name, ImageHandle source) {
    addReader(graph, std::move(name), PassKind::Compute, source, Access::SampledCompute);
}

/// A raster pass with one target; cleared to black if `clear`.
inline ImageHandle draw(Graph& graph, std::string name, ImageHandle target, bool clear) {
    addPass(graph, std::move(name), PassKind::Raster, [&](PassBuilder& builder) {
        const std::optional<ClearColor> black = ClearColor::floats(0, 0, 0, 0);
        target = builder.colorTarget(target, clear ? black : std::nullopt);
    });
    return target;
}

inline Plan mustCompile(const Graph& graph) {
    core::Result<Plan> plan = compile(graph, requireMemory);
    if (plan)
        return std::move(plan).value();
    ADD_FAILURE() << plan.error().message;
    return {};
}

/// The error's sentence; empty if there is none.
inline std::string errorOf(const Graph& graph) {
    const core::Result<Plan> plan = compile(graph, requireMemory);
    return plan ? "" : plan.error().message;
}

/// Names in planned order.
inline std::vector<std::string> namesOf(const Graph& graph, const Plan& plan) {
    std::vector<std::string> names;
    for (const PlannedPass& planned : plan.passes)
        names.push_back(graph.passes()[planned.pass].name);
    return names;
}

inline const Placement& placementOf(const Plan& plan, ImageHandle image) {
    for (const Placement& placement : plan.images)
        if (placement.resource == image.resource)
            return placement;
    ADD_FAILURE() << "image " << image.resource << " is not in the plan";
    static const Placement kNone;
    return kNone;
}

using Names = std::vector<std::string>;

} // namespace shutter::graph
