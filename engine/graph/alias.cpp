// SPDX-License-Identifier: MIT
#include "engine/core/check.h"
#include "engine/graph/compile_stages.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace shutter::graph {

bool overlapInTime(const Placement& a, const Placement& b) {
    return a.firstPass <= b.lastPass && b.firstPass <= a.lastPass;
}

bool overlapInMemory(const Placement& a, const Placement& b) {
    return a.offset < b.offset + b.bytes && b.offset < a.offset + a.bytes;
}

VkDeviceSize packImages(std::vector<Placement>& images) {
    std::vector<size_t> bySize(images.size());
    std::iota(bySize.begin(), bySize.end(), size_t{0});
    std::stable_sort(bySize.begin(), bySize.end(), [&](size_t a, size_t b) {
        return images[a].bytes > images[b].bytes;
    });
    VkDeviceSize blockBytes = 0;
    std::vector<const Placement*> placed;
    for (size_t index : bySize) {
        Placement& image = images[index];
        std::vector<const Placement*> rivals;
        for (const Placement* other : placed)
            if (overlapInTime(image, *other))
                rivals.push_back(other);
        std::sort(rivals.begin(), rivals.end(), [](const Placement* a, const Placement* b) {
            return a->offset < b->offset;
        });
        // Rivals in order of offset: behind each that is in the way is the next place to try.
        image.offset = 0;
        for (const Placement* rival : rivals)
            if (overlapInMemory(image, *rival)) {
                const VkDeviceSize end = rival->offset + rival->bytes;
                image.offset = (end + image.alignment - 1) / image.alignment * image.alignment;
            }
        blockBytes = std::max(blockBytes, image.offset + image.bytes);
        placed.push_back(&image);
    }
    return blockBytes;
}

namespace {

/// Transients in order of first use.
void findLives(const Graph& graph, Plan& plan) {
    std::map<uint32_t, Placement> lives;
    for (uint32_t position = 0; position < plan.passes.size(); ++position)
        for (const ResourceUse& use : graph.passes()[plan.passes[position].pass].uses) {
            const ResourceRecord& resource = graph.resources()[use.resource];
            if (resource.imported)
                continue;
            const auto [entry, isFirstUse] = lives.try_emplace(use.resource);
            Placement& life = entry->second;
            if (isFirstUse)
                life.firstPass = position;
            life.resource = use.resource;
            life.lastPass = position;
            if (resource.isImage)
                life.imageUsage |= imageUsageOf(use.access);
            else
                life.bufferUsage |= resource.bufferDesc.usage | bufferUsageOf(use.access);
        }
    for (const auto& [resource, version] : graph.outputs())
        if (const auto life = lives.find(resource); life != lives.end())
            life->second.lastPass = static_cast<uint32_t>(plan.passes.size() - 1);
    for (const auto& [resource, life] : lives)
        (graph.resources()[resource].isImage ? plan.images : plan.buffers).push_back(life);
}

} // namespace

void placeTransients(const Graph& graph, const RequirementFunction& requirement, Plan& plan) {
    findLives(graph, plan);
    for (Placement& image : plan.images) {
        const ResourceRecord& resource = graph.resources()[image.resource];
        const MemoryRequirement needed = requirement(resource.imageDesc, image.imageUsage);
        SHUTTER_CHECK(
            needed.bytes > 0 && needed.alignment > 0,
            "image '{}' needs {} bytes at {}",
            resource.name,
            needed.bytes,
            needed.alignment
        );
        image.bytes = needed.bytes;
        image.alignment = needed.alignment;
        plan.unaliasedBytes += needed.bytes;
    }
    for (Placement& buffer : plan.buffers)
        buffer.bytes = graph.resources()[buffer.resource].bufferDesc.bytes;
    plan.blockBytes = packImages(plan.images);
}

} // namespace shutter::graph
