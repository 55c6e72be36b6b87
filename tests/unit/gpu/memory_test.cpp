// SPDX-License-Identifier: MIT
// Plans of blocks and uploads, and the choice of memory on the layouts of devices that this suite
// never runs on: types in the order in which the drivers list them (from what people published of
// vulkaninfo), heaps rounded.
#include "engine/gpu/memory_blocks.h"
#include "engine/gpu/memory_type.h"
#include "engine/gpu/upload.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace shutter::gpu {
namespace {

constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
constexpr VkMemoryPropertyFlags kVisible =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
constexpr VkMemoryPropertyFlags kCached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
constexpr VkMemoryPropertyFlags kNotCoherent = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | kCached;
constexpr VkMemoryPropertyFlags kAmd =
    VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD | VK_MEMORY_PROPERTY_DEVICE_UNCACHED_BIT_AMD;

constexpr VkDeviceSize kMebi = VkDeviceSize(1) << 20;
constexpr VkDeviceSize kGibi = VkDeviceSize(1) << 30;

struct Type {
    VkMemoryPropertyFlags properties = 0;
    uint32_t heap = 0;
};

struct Layout {
    std::string device;
    std::vector<VkMemoryHeap> heaps;
    std::vector<Type> types;
    /// The first choices, by index, as kUses has the uses.
    std::array<uint32_t, 4> first;
};

constexpr std::array kUses = {
    MemoryUse::Device, MemoryUse::Staging, MemoryUse::Stream, MemoryUse::Readback};

constexpr VkMemoryHeap localHeap(VkDeviceSize bytes) {
    return {bytes, VK_MEMORY_HEAP_DEVICE_LOCAL_BIT};
}

constexpr VkMemoryHeap mainHeap(VkDeviceSize bytes) {
    return {bytes, 0};
}

VkPhysicalDeviceMemoryProperties makeProperties(const Layout& layout) {
    VkPhysicalDeviceMemoryProperties memory{};
    memory.memoryHeapCount = static_cast<uint32_t>(layout.heaps.size());
    for (size_t i = 0; i < layout.heaps.size(); ++i)
        memory.memoryHeaps[i] = layout.heaps[i];
    memory.memoryTypeCount = static_cast<uint32_t>(layout.types.size());
    for (size_t i = 0; i < layout.types.size(); ++i)
        memory.memoryTypes[i] = {layout.types[i].properties, layout.types[i].heap};
    return memory;
}

Layout nvidiaWithoutResizableBar() {
    return {
        "NVIDIA, a window of 246 MiB",
        {localHeap(8 * kGibi), mainHeap(24 * kGibi), localHeap(246 * kMebi)},
        {{0, 1},
         {0, 1},
         {0, 1},
         {0, 1},
         {0, 1},
         {0, 1},
         {0, 1},
         {kLocal, 0},
         {kVisible, 1},
         {kVisible | kCached, 1},
         {kLocal | kVisible, 2}},
        {7, 8, 10, 9}};
}

/// NVK lists the window before main memory, which it has of the cached kind alone.
Layout nvkWithoutResizableBar() {
    return {
        "NVK, a window of 256 MiB",
        {localHeap(8 * kGibi), localHeap(256 * kMebi), mainHeap(12 * kGibi)},
        {{kLocal, 0}, {kLocal | kVisible, 1}, {kVisible | kCached, 2}},
        {0, 2, 1, 2}};
}

std::vector<Layout> layouts() {
    return {
        nvidiaWithoutResizableBar(),
        {"NVIDIA with resizable BAR",
         {localHeap(24 * kGibi), mainHeap(48 * kGibi)},
         {{0, 1}, {kLocal, 0}, {kVisible, 1}, {kVisible | kCached, 1}, {kLocal | kVisible, 0}},
         {1, 2, 4, 3}},
        nvkWithoutResizableBar(),
        {"RADV, discrete",
         {localHeap(8 * kGibi - 256 * kMebi), mainHeap(8 * kGibi), localHeap(256 * kMebi)},
         {{kLocal, 0},
          {kVisible, 1},
          {kLocal | kVisible, 2},
          {kVisible | kCached, 1},
          {kLocal | kAmd, 0},
          {kVisible | kAmd, 1},
          {kLocal | kVisible | kAmd, 2},
          {kVisible | kCached | kAmd, 1}},
         {0, 1, 2, 3}},
        {"RADV, integrated",
         {mainHeap(kGibi + kGibi / 3), localHeap(3 * kGibi - kGibi / 3)},
         {{kLocal, 1},
          {kVisible, 0},
          {kLocal | kVisible, 1},
          {kVisible | kCached, 0},
          {kLocal | kAmd, 1},
          {kLocal | kVisible | kAmd, 1}},
         {0, 1, 2, 3}},
        {"ANV, discrete",
         {localHeap(16 * kGibi), mainHeap(24 * kGibi)},
         {{kLocal, 0}, {kVisible | kCached, 1}, {kLocal | kVisible, 0}},
         {0, 1, 2, 1}},
        {"ANV, integrated with a shared cache",
         {localHeap(12 * kGibi)},
         {{kLocal, 0}, {kLocal | kVisible | kCached, 0}},
         {0, 1, 1, 1}},
        {"ANV, integrated without coherent cached memory",
         {localHeap(24 * kGibi)},
         {{kLocal, 0}, {kLocal | kVisible, 0}, {kLocal | kNotCoherent, 0}},
         {0, 1, 1, 2}},
        {"lavapipe", {localHeap(2 * kGibi)}, {{kLocal | kVisible | kCached, 0}}, {0, 0, 0, 0}},
    };
}

constexpr uint32_t kAnyType = ~0u;

uint32_t firstChoice(const Layout& layout, MemoryUse use, VkDeviceSize bytes = kMebi) {
    const auto types = rankMemoryTypes(makeProperties(layout), kAnyType, use, bytes);
    return types.empty() ? VK_MAX_MEMORY_TYPES : types.front();
}

TEST(MemoryType, EachUseFindsItsOwnOnEachLayoutAndTheCpuWritesToCoherentMemoryAlone) {
    for (const Layout& layout : layouts())
        for (size_t i = 0; i < kUses.size(); ++i) {
            SCOPED_TRACE(layout.device);
            EXPECT_EQ(firstChoice(layout, kUses[i]), layout.first[i]) << "use " << i;
            for (const uint32_t type :
                 rankMemoryTypes(makeProperties(layout), kAnyType, kUses[i], kMebi)) {
                const VkMemoryPropertyFlags properties = layout.types[type].properties;
                EXPECT_EQ(properties & kAmd, 0u);
                const bool isWritten =
                    kUses[i] == MemoryUse::Staging || kUses[i] == MemoryUse::Stream;
                EXPECT_TRUE(!isWritten || (properties & kVisible) == kVisible);
            }
        }
}

TEST(MemoryType, OnlyTypesThatTheResourceAllowsAreNamedAndAStreamLeavesMostOfTheWindow) {
    const Layout nvidia = nvidiaWithoutResizableBar();
    EXPECT_EQ(firstChoice(nvidia, MemoryUse::Stream, 61 * kMebi), 10u);
    EXPECT_EQ(firstChoice(nvidia, MemoryUse::Stream, 62 * kMebi), 8u);
    EXPECT_EQ(firstChoice(nvkWithoutResizableBar(), MemoryUse::Stream, 200 * kMebi), 2u);
    const auto memory = makeProperties(nvidiaWithoutResizableBar());
    EXPECT_EQ(
        rankMemoryTypes(memory, 1u << 9 | 1u << 10, MemoryUse::Staging, kMebi),
        (std::vector<uint32_t>{9, 10})
    );
    EXPECT_TRUE(rankMemoryTypes(memory, 1u << 7, MemoryUse::Stream, kMebi).empty());
}

/// Allocates in a machine whose `full` types have no room; records the requests.
std::pair<TypeAttempt, std::vector<uint32_t>> tryTypes(
    const std::vector<uint32_t>& types, const std::vector<uint32_t>& full, VkResult otherwise
) {
    std::vector<uint32_t> tried;
    const TypeAttempt attempt = allocateInTurn(types, [&](uint32_t type) {
        tried.push_back(type);
        for (const uint32_t one : full)
            if (one == type)
                return VK_ERROR_OUT_OF_DEVICE_MEMORY;
        return otherwise;
    });
    return {attempt, tried};
}

TEST(MemoryType, TheNextTypeIsTriedWhereTheBestIsFullAndAnotherErrorEndsTheSearch) {
    const auto streams =
        rankMemoryTypes(makeProperties(nvkWithoutResizableBar()), kAnyType, MemoryUse::Stream, 1);
    const auto [attempt, tried] = tryTypes(streams, {1}, VK_SUCCESS);
    EXPECT_EQ(attempt.result, VK_SUCCESS);
    EXPECT_EQ(attempt.type, 2u);
    EXPECT_EQ(tried, (std::vector<uint32_t>{1, 2}));
    EXPECT_EQ(tryTypes({3, 5}, {3, 5}, VK_SUCCESS).first.result, VK_ERROR_OUT_OF_DEVICE_MEMORY);
    const auto [ended, triedOnce] = tryTypes({3, 5}, {}, VK_ERROR_TOO_MANY_OBJECTS);
    EXPECT_EQ(ended.result, VK_ERROR_TOO_MANY_OBJECTS);
    EXPECT_EQ(triedOnce, std::vector<uint32_t>{3});
}

using Place = BlockPlan::Place;
using Block = BlockPlan::Block;

TEST(MemoryBlocks, ThingsLieOneAfterAnotherAtTheirAlignmentInFewBlocks) {
    const std::vector<VkMemoryRequirements> needs{{100, 16, 7}, {10, 64, 3}, {1, 1, 7}};
    const BlockPlan plan = planBlocks(needs);
    EXPECT_EQ(plan.places, (std::vector<Place>{{0, 0}, {0, 128}, {0, 138}}));
    EXPECT_EQ(plan.blocks, (std::vector<Block>{{139, 3}}));
    // Of a scene's pictures of 256 x 256 with their levels.
    const std::vector<VkMemoryRequirements> textures(5000, {350000, 65536, 1});
    EXPECT_LT(planBlocks(textures).blocks.size(), 20u);
    EXPECT_TRUE(planBlocks({}).blocks.empty());
}

TEST(MemoryBlocks, AFullBlockAndAnotherKindOfMemoryStartAnother) {
    const std::vector<VkMemoryRequirements> needs{
        {kBlockBytes - 1, 1, 1},
        {1, 1, 1},
        {1, 1, 1},
        {5, 1, 2},
        {2 * kBlockBytes, 1, 2},
        {1, 1, 2}};
    const BlockPlan plan = planBlocks(needs);
    EXPECT_EQ(
        plan.places,
        (std::vector<Place>{{0, 0}, {0, kBlockBytes - 1}, {1, 0}, {2, 0}, {3, 0}, {4, 0}})
    );
    EXPECT_EQ(plan.blocks[3], (Block{2 * kBlockBytes, 2})) << "a larger item has a separate block";
}

TEST(UploadParts, TransfersAreCutIntoPartsOfWholeRowsAndNoByteIsLost) {
    EXPECT_EQ(splitUpload(0, 1), std::vector<UploadPart>{});
    EXPECT_EQ(splitUpload(7, 1), (std::vector<UploadPart>{{0, 7}}));
    EXPECT_EQ(splitUpload(kStagingBytes, 4), (std::vector<UploadPart>{{0, kStagingBytes}}));
    EXPECT_EQ(
        splitUpload(2 * kStagingBytes + 5, 1),
        (std::vector<UploadPart>{
            {0, kStagingBytes}, {kStagingBytes, kStagingBytes}, {2 * kStagingBytes, 5}})
    );
    constexpr VkDeviceSize kRow = 3 * kStagingBytes / 4;
    EXPECT_EQ(splitUpload(2 * kRow, kRow), (std::vector<UploadPart>{{0, kRow}, {kRow, kRow}}));
    constexpr VkDeviceSize kLong = 2 * kStagingBytes;
    EXPECT_EQ(splitUpload(kLong, kLong), (std::vector<UploadPart>{{0, kLong}}));
}

} // namespace
} // namespace shutter::gpu
