// SPDX-License-Identifier: MIT
#include "engine/render/pass_trace.h"

#include "engine/gpu/memory.h"

namespace shutter::render {

namespace {

bool canBeCopied(const graph::ResourceRecord& resource) {
    return resource.isImage && resource.imageDesc.samples == 1 &&
           (!resource.imported ||
            (resource.importedImage->desc().usage & VK_IMAGE_USAGE_TRANSFER_SRC_BIT) != 0);
}

} // namespace

core::Status PassTrace::declare(
    graph::Graph& graph, Readback& readback, const graph::RequirementFunction& requirement
) {
    // A copy of a culled pass's output would make it run.
    const auto plan = graph::compile(graph, requirement);
    if (!plan)
        return plan.error();
    for (const graph::PlannedPass& planned : plan.value().passes) {
        // Copied: each pass that is added may move the others.
        const graph::PassRecord pass = graph.passes()[planned.pass];
        for (const graph::ResourceUse& use : pass.uses) {
            const graph::ResourceRecord& resource = graph.resources()[use.resource];
            if (use.writeVersion == graph::kNoVersion || !canBeCopied(resource))
                continue;
            const std::string image = resource.name;
            const size_t ticket =
                readback.add(graph, image, graph.findImage(use.resource, use.writeVersion));
            mEntries.push_back({pass.name, image, ticket});
        }
    }
    return {};
}

std::vector<WrittenImage> PassTrace::take(const Readback& readback) const {
    std::vector<WrittenImage> written;
    for (const Entry& entry : mEntries) {
        const std::span<const std::byte> bytes = readback.bytes(entry.ticket);
        written.push_back({0, entry.pass, entry.image, {bytes.begin(), bytes.end()}});
    }
    return written;
}

} // namespace shutter::render
