// SPDX-License-Identifier: MIT
#include "engine/gpu/memory_type.h"

#include <algorithm>
#include <array>

namespace shutter::gpu {

namespace {

constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags kVisible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
constexpr VkMemoryPropertyFlags kCoherent = VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

/// A property that is preferred or avoided.
struct Preference {
    VkMemoryPropertyFlags property = 0;
    bool present = true;
};

/// Required properties of a use, and preferred ones in order of importance.
struct Needs {
    VkMemoryPropertyFlags required = 0;
    std::array<Preference, 3> preferences;
};

Needs needsOf(MemoryUse use) {
    switch (use) {
    case MemoryUse::Device:
        // The window that the CPU sees may be small, and streams want it.
        return {0, {Preference{kLocal, true}, Preference{kVisible, false}, Preference{}}};
    case MemoryUse::Staging:
        // Cached memory makes transfers snoop the CPU's caches, and writes gain nothing.
        return {
            kVisible | kCoherent,
            {Preference{kLocal, false}, Preference{kCached, false}, Preference{}}};
    case MemoryUse::Stream:
        return {
            kVisible | kCoherent,
            {Preference{kLocal, true}, Preference{kCached, false}, Preference{}}};
    case MemoryUse::Readback:
        // The CPU reads uncached memory a hundred times slower; an invalidation costs little.
        return {
            kVisible,
            {Preference{kCached, true}, Preference{kCoherent, true}, Preference{kLocal, false}}};
    }
    return {};
}

} // namespace

std::vector<uint32_t> rankMemoryTypes(
    const VkPhysicalDeviceMemoryProperties& memory,
    uint32_t typeBits,
    MemoryUse use,
    VkDeviceSize bytes
) {
    const Needs needs = needsOf(use);
    std::array<uint32_t, VK_MAX_MEMORY_TYPES> scores{};
    std::vector<uint32_t> types;
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        const VkMemoryPropertyFlags properties = memory.memoryTypes[i].propertyFlags;
        const bool isPlain = (properties & ~(kLocal | kVisible | kCoherent | kCached)) == 0;
        if ((typeBits & (1u << i)) == 0 || !isPlain ||
            (properties & needs.required) != needs.required)
            continue;
        const VkMemoryHeap& heap = memory.memoryHeaps[memory.memoryTypes[i].heapIndex];
        const bool fillsWindow = use == MemoryUse::Stream && bytes > heap.size / 4;
        scores[i] = fillsWindow ? 0 : 1;
        for (const Preference& preference : needs.preferences)
            scores[i] =
                2 * scores[i] + (((properties & preference.property) != 0) == preference.present);
        types.push_back(i);
    }
    // Among equals the driver's order, which is by speed.
    std::stable_sort(types.begin(), types.end(), [&](uint32_t a, uint32_t b) {
        return scores[a] > scores[b];
    });
    return types;
}

TypeAttempt
allocateInTurn(std::span<const uint32_t> types, const std::function<VkResult(uint32_t)>& allocate) {
    TypeAttempt attempt;
    for (const uint32_t type : types) {
        attempt = {allocate(type), type};
        if (attempt.result != VK_ERROR_OUT_OF_DEVICE_MEMORY)
            break;
    }
    return attempt;
}

} // namespace shutter::gpu
