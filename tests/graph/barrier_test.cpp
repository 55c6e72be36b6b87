// SPDX-License-Identifier: MIT
// Each hazard in the smallest frame that has it.
#include "tests/graph/hazard_simulator.h"
#include "tests/graph/story.h"

#include <tuple>
#include <utility>
#include <vector>

namespace shutter::graph {
namespace {

constexpr VkPipelineStageFlags2 kComputeStage = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkPipelineStageFlags2 kFragmentStage = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr VkPipelineStageFlags2 kColorStage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr VkPipelineStageFlags2 kIndirectStage = VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
constexpr VkPipelineStageFlags2 kRayStage = VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR;
constexpr VkAccessFlags2 kSampledRead = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
constexpr VkAccessFlags2 kStorageRead = VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
constexpr VkAccessFlags2 kStorageWrite = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
constexpr VkAccessFlags2 kColorWrite = VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;

constexpr VkImageLayout kUndefined = VK_IMAGE_LAYOUT_UNDEFINED;
constexpr VkImageLayout kGeneral = VK_IMAGE_LAYOUT_GENERAL;
constexpr VkImageLayout kAttachment = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
constexpr VkImageLayout kReadOnly = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
constexpr VkImageLayout kCopySource = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;

/// What a barrier waits for, or what waits for it.
using Half = std::pair<VkPipelineStageFlags2, VkAccessFlags2>;

constexpr Half kStored{kComputeStage, kStorageWrite};
constexpr Half kSampled{kComputeStage, kSampledRead};
constexpr Half kDrawn{kColorStage, kColorWrite};

template <class Barrier>
void expectHalves(const Barrier& barrier, const Half& src, const Half& dst) {
    EXPECT_EQ(barrier.srcStages, src.first);
    EXPECT_EQ(barrier.srcAccess, src.second);
    EXPECT_EQ(barrier.dstStages, dst.first);
    EXPECT_EQ(barrier.dstAccess, dst.second);
}

void expectLayouts(const ImageBarrier& barrier, VkImageLayout before, VkImageLayout after) {
    EXPECT_EQ(barrier.oldLayout, before);
    EXPECT_EQ(barrier.newLayout, after);
}

/// A failure if there is not exactly one.
template <class Barrier> Barrier takeOnly(const std::vector<Barrier>& barriers) {
    EXPECT_EQ(barriers.size(), 1u);
    return barriers.size() == 1 ? barriers[0] : Barrier{};
}

ImageBarrier onlyBarrier(const Plan& plan, size_t position) {
    return takeOnly(plan.passes.at(position).imageBarriers);
}

BufferBarrier onlyBufferBarrier(const Plan& plan, size_t position) {
    return takeOnly(plan.passes.at(position).bufferBarriers);
}

TEST(Barriers, OnlyOrderedDisjointWritesHaveBarriersBetweenThem) {
    Graph graph;
    ImageHandle image = makeImage(graph, "target");
    for (const char* name : {"first", "second", "third"})
        image = addWriter(graph, name, PassKind::Compute, image, Access::StorageWriteDisjoint);
    sample(graph, "read", image);
    const Plan plan = mustCompile(graph);
    ASSERT_EQ(plan.passes.size(), 4u);
    expectLayouts(onlyBarrier(plan, 0), kUndefined, kGeneral);
    EXPECT_TRUE(plan.passes[1].imageBarriers.empty());
    EXPECT_TRUE(plan.passes[2].imageBarriers.empty());
    expectHalves(onlyBarrier(plan, 3), kStored, kSampled);
    EXPECT_TRUE(findHazards(graph, plan).empty());
    const auto ordered = compile(graph, requireMemory, DisjointWrites::Ordered);
    ASSERT_TRUE(ordered);
    (void)onlyBarrier(ordered.value(), 1);
    (void)onlyBarrier(ordered.value(), 2);
}

TEST(Barriers, ALaunchOfRaysTouchesResourcesInItsOwnStageAndReadsItsSizeWhereDispatchesDo) {
    Graph graph;
    const auto rays = PassKind::RayTracing;
    const BufferHandle list = store(graph, "fill", makeBuffer(graph, "list"));
    const BufferHandle written = addWriter(graph, "launch", rays, list, Access::StorageWrite);
    addReader(graph, "read", rays, written, Access::AccelerationRead);
    const BufferHandle size = store(graph, "count", makeBuffer(graph, "size"));
    addReader(graph, "launch as many", rays, size, Access::IndirectRead);
    const Plan plan = mustCompile(graph);
    expectHalves(onlyBufferBarrier(plan, 1), kStored, {kRayStage, kStorageRead | kStorageWrite});
    expectHalves(
        onlyBufferBarrier(plan, 2),
        {kRayStage, kStorageWrite},
        {kRayStage, VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR}
    );
    expectHalves(
        onlyBufferBarrier(plan, 4), kStored, {kIndirectStage, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT}
    );
}

TEST(Barriers, AReadWaitsForTheWriteAndOneInAnotherLayoutForItsReaders) {
    Graph graph;
    const ImageHandle a = draw(graph, "draw", makeImage(graph, "a"), true);
    sample(graph, "sample", a);
    addReader(graph, "copy", PassKind::Transfer, a, Access::TransferRead);
    const Plan plan = mustCompile(graph);
    const ImageBarrier sampled = onlyBarrier(plan, 1);
    expectHalves(sampled, kDrawn, kSampled);
    expectLayouts(sampled, kAttachment, kReadOnly);
    const ImageBarrier copied = onlyBarrier(plan, 2);
    expectHalves(
        copied,
        {kComputeStage, 0},
        {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT}
    );
    expectLayouts(copied, kReadOnly, kCopySource);
}

TEST(Barriers, AWriteAfterAReadWaitsAndSeesOnlyWhatTheReadDidNot) {
    for (const auto& [access, src, dst] :
         {std::tuple{Access::StorageRead, Half{kComputeStage, 0}, Half{kComputeStage, 0}},
          {Access::IndirectRead,
           {kIndirectStage | kComputeStage, kStorageWrite},
           {kComputeStage, kStorageRead | kStorageWrite}}}) {
        Graph graph;
        const BufferHandle v1 = store(graph, "fill", makeBuffer(graph, "a"));
        addReader(graph, "read", PassKind::Compute, v1, access);
        graph.markOutput(store(graph, "fill again", v1));
        expectHalves(onlyBufferBarrier(mustCompile(graph), 2), src, dst);
    }
}

TEST(Barriers, AClearDropsTheOldContentsWithTheLayout) {
    Graph graph;
    const ImageHandle v1 = store(graph, "store", makeImage(graph, "a"));
    sample(graph, "sample", v1);
    graph.markOutput(draw(graph, "clear", v1, true));
    const ImageBarrier barrier = onlyBarrier(mustCompile(graph), 2);
    EXPECT_EQ(barrier.srcStages, kComputeStage);
    expectLayouts(barrier, kUndefined, kAttachment);
}

TEST(Barriers, AFirstUseDoesNotWaitForTenantsOfOtherMemory) {
    Graph graph;
    const ImageHandle elsewhere = store(graph, "1", makeImage(graph, "elsewhere", 16));
    ImageHandle large = makeImage(graph, "large", 64);
    addPass(graph, "2", PassKind::Raster, [&](PassBuilder& builder) {
        builder.read(elsewhere, Access::SampledFragment);
        large = builder.colorTarget(large, std::nullopt);
    });
    const ImageHandle middle = filter(graph, "3", large, makeImage(graph, "middle", 32));
    const ImageHandle last = filter(graph, "4", middle, makeImage(graph, "last", 16));
    graph.markOutput(last);
    const Plan plan = mustCompile(graph);
    ASSERT_EQ(placementOf(plan, last).offset, placementOf(plan, large).offset);
    ASSERT_NE(placementOf(plan, last).offset, placementOf(plan, elsewhere).offset);
    ASSERT_EQ(plan.passes[3].imageBarriers.size(), 2u);
    for (const ImageBarrier& barrier : plan.passes[3].imageBarriers)
        if (barrier.resource == last.resource) {
            EXPECT_EQ(barrier.srcStages, kComputeStage) << "elsewhere was read in fragment";
        }
}

TEST(Barriers, AnImportedImageWaitsForEarlierSubmissionsAndEndsInItsLayout) {
    Graph graph;
    const gpu::Image image;
    sample(graph, "sample", graph.importImage("history", image, kGeneral, kCopySource));
    const Plan plan = mustCompile(graph);
    const ImageBarrier barrier = onlyBarrier(plan, 0);
    expectHalves(
        barrier, {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT}, kSampled
    );
    expectLayouts(barrier, kGeneral, kReadOnly);
    const ImageBarrier last = takeOnly(plan.finalImageBarriers);
    expectLayouts(last, kReadOnly, kCopySource);
    EXPECT_EQ(last.srcStages, kComputeStage);
    Graph other;
    sample(other, "sample", other.importImage("history", image, kGeneral, kUndefined));
    EXPECT_TRUE(mustCompile(other).finalImageBarriers.empty()) << "any layout suits";
}

constexpr OutsideUse kDrawnOutside{kAttachment, kColorStage, kColorWrite};
constexpr OutsideUse kSampledOutside{kReadOnly, kFragmentStage, kSampledRead};

TEST(Barriers, AnImportedImageWithKnownUsersStandsBetweenThem) {
    Graph graph;
    const gpu::Image image;
    sample(graph, "sample", graph.importImage("shared", image, kDrawnOutside, kSampledOutside));
    const Plan plan = mustCompile(graph);
    const ImageBarrier first = onlyBarrier(plan, 0);
    expectHalves(first, kDrawn, kSampled);
    expectLayouts(first, kAttachment, kReadOnly);
    // The layout stays, and yet the next user need not wait for the first one by itself.
    const ImageBarrier last = takeOnly(plan.finalImageBarriers);
    EXPECT_EQ(last.srcStages & kComputeStage, kComputeStage);
    EXPECT_EQ(last.dstStages, kFragmentStage);
    EXPECT_EQ(last.dstAccess, kSampledRead);
    expectLayouts(last, kReadOnly, kReadOnly);
}

TEST(Barriers, AnImportedImageThatNobodyReadsGoesOverToItsNextUse) {
    Graph graph;
    const gpu::Image image;
    (void)graph.importImage("unread", image, kDrawnOutside, kSampledOutside);
    const ImageBarrier barrier = takeOnly(mustCompile(graph).finalImageBarriers);
    expectHalves(barrier, kDrawn, {kFragmentStage, kSampledRead});
    expectLayouts(barrier, kAttachment, kReadOnly);
    // Where any layout suits it stays in its own, and without one it goes over to none.
    Graph other;
    const gpu::Image full;
    (void)other.importImage("empty", image, OutsideUse{}, OutsideUse{});
    (void)other.importImage("full", full, OutsideUse{kGeneral}, OutsideUse{});
    expectLayouts(takeOnly(mustCompile(other).finalImageBarriers), kGeneral, kGeneral);
}

} // namespace
} // namespace shutter::graph
