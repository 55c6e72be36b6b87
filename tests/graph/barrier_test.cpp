// SPDX-License-Identifier: MIT
// Each hazard in the smallest frame that has it.
#include "tests/graph/hazard_simulator.h"
#include "tests/graph/story.h"

namespace shutter::graph {
namespace {

constexpr VkPipelineStageFlags2 kComputeStage = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkPipelineStageFlags2 kFragmentStage = VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT;
constexpr VkPipelineStageFlags2 kColorStage = VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT;
constexpr VkAccessFlags2 kSampledRead = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT;
constexpr VkAccessFlags2 kStorageRead = VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
constexpr VkAccessFlags2 kStorageWrite = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;

constexpr VkPipelineStageFlags2 kRayStage = VK_PIPELINE_STAGE_2_RAY_TRACING_SHADER_BIT_KHR;

template <class Barrier>
void expectHalves(
    const Barrier& barrier,
    std::pair<VkPipelineStageFlags2, VkAccessFlags2> src,
    std::pair<VkPipelineStageFlags2, VkAccessFlags2> dst
) {
    EXPECT_EQ(barrier.srcStages, src.first);
    EXPECT_EQ(barrier.srcAccess, src.second);
    EXPECT_EQ(barrier.dstStages, dst.first);
    EXPECT_EQ(barrier.dstAccess, dst.second);
}

void expectLayouts(const ImageBarrier& barrier, VkImageLayout before, VkImageLayout after) {
    EXPECT_EQ(barrier.oldLayout, before);
    EXPECT_EQ(barrier.newLayout, after);
}

/// The only image barrier of a pass; a failure if there is not exactly one.
ImageBarrier onlyBarrier(const Plan& plan, size_t position) {
    if (position >= plan.passes.size() || plan.passes[position].imageBarriers.size() != 1) {
        ADD_FAILURE() << "not one image barrier before pass " << position;
        return {};
    }
    return plan.passes[position].imageBarriers[0];
}

BufferBarrier onlyBufferBarrier(const Plan& plan, size_t position) {
    if (position >= plan.passes.size() || plan.passes[position].bufferBarriers.size() != 1) {
        ADD_FAILURE() << "not one buffer barrier before pass " << position;
        return {};
    }
    return plan.passes[position].bufferBarriers[0];
}

BufferHandle fill(Graph& graph, BufferHandle buffer) {
    addPass(graph, "fill", PassKind::Compute, [&](PassBuilder& builder) {
        buffer = builder.write(buffer, Access::StorageWrite);
    });
    return buffer;
}

void readBuffer(Graph& graph, BufferHandle buffer, Access access, PassKind kind) {
    addPass(graph, "read", kind, [&](PassBuilder& builder) {
        builder.read(buffer, access);
        builder.sideEffect();
        if (kind == PassKind::Raster)
            (void)builder.colorTarget(makeImage(graph, "target"), std::nullopt);
    });
}

/// Three passes that store to one image with `access`, and one that samples it.
void storeThrice(Graph& graph, Access access) {
    ImageHandle image = makeImage(graph, "target");
    for (const char* name : {"first", "second", "third"})
        addPass(graph, name, PassKind::Compute, [&](PassBuilder& builder) {
            image = builder.write(image, access);
        });
    addPass(graph, "read", PassKind::Compute, [&](PassBuilder& builder) {
        builder.read(image, Access::SampledCompute);
        builder.sideEffect();
    });
}

TEST(Barriers, DisjointWritesHaveNoBarriersBetweenThem) {
    Graph graph;
    storeThrice(graph, Access::StorageWriteDisjoint);
    const Plan plan = mustCompile(graph);
    ASSERT_EQ(plan.passes.size(), 4u);
    expectLayouts(onlyBarrier(plan, 0), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    EXPECT_TRUE(plan.passes[1].imageBarriers.empty());
    EXPECT_TRUE(plan.passes[2].imageBarriers.empty());
    expectHalves(
        onlyBarrier(plan, 3), {kComputeStage, kStorageWrite}, {kComputeStage, kSampledRead}
    );
    EXPECT_TRUE(findHazards(graph, plan).empty());
}

TEST(Barriers, OrderedDisjointWritesHaveBarriersLikeOthers) {
    Graph graph;
    storeThrice(graph, Access::StorageWriteDisjoint);
    const auto plan = compile(graph, requireMemory, DisjointWrites::Ordered);
    ASSERT_TRUE(plan);
    (void)onlyBarrier(plan.value(), 1);
    (void)onlyBarrier(plan.value(), 2);
}

TEST(Barriers, ALaunchOfRaysTouchesResourcesInItsOwnStage) {
    Graph graph;
    const BufferHandle filled = fill(graph, makeBuffer(graph, "list"));
    BufferHandle written;
    addPass(graph, "launch", PassKind::RayTracing, [&](PassBuilder& builder) {
        written = builder.write(filled, Access::StorageWrite);
    });
    readBuffer(graph, written, Access::AccelerationRead, PassKind::RayTracing);
    const Plan plan = mustCompile(graph);
    expectHalves(
        onlyBufferBarrier(plan, 1),
        {kComputeStage, kStorageWrite},
        {kRayStage, kStorageRead | kStorageWrite}
    );
    expectHalves(
        onlyBufferBarrier(plan, 2),
        {kRayStage, kStorageWrite},
        {kRayStage, VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR}
    );
}

TEST(Barriers, ALaunchOfRaysReadsItsSizeWhereDispatchesDo) {
    Graph graph;
    readBuffer(
        graph, fill(graph, makeBuffer(graph, "size")), Access::IndirectRead, PassKind::RayTracing
    );
    expectHalves(
        onlyBufferBarrier(mustCompile(graph), 1),
        {kComputeStage, kStorageWrite},
        {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT}
    );
}

TEST(Barriers, AReadAfterAWriteWaitsAndSees) {
    Graph graph;
    sample(graph, "sample", draw(graph, "draw", makeImage(graph, "a"), true));
    const ImageBarrier barrier = onlyBarrier(mustCompile(graph), 1);
    expectHalves(
        barrier,
        {kColorStage, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT},
        {kComputeStage, kSampledRead}
    );
    expectLayouts(
        barrier, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
    );
}

TEST(Barriers, AReadInAnotherLayoutIsATransitionBehindTheReaders) {
    Graph graph;
    const ImageHandle a = store(graph, "store", makeImage(graph, "a"));
    sample(graph, "sample", a);
    addPass(graph, "copy", PassKind::Transfer, [&](PassBuilder& builder) {
        builder.read(a, Access::TransferRead);
        builder.sideEffect();
    });
    const ImageBarrier barrier = onlyBarrier(mustCompile(graph), 2);
    expectHalves(
        barrier,
        {kComputeStage, 0},
        {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT}
    );
    expectLayouts(
        barrier, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL
    );
}

TEST(Barriers, AWriteAfterAReadWaitsOnly) {
    Graph graph;
    const BufferHandle v1 = fill(graph, makeBuffer(graph, "a"));
    readBuffer(graph, v1, Access::StorageRead, PassKind::Compute);
    graph.markOutput(fill(graph, v1));
    expectHalves(onlyBufferBarrier(mustCompile(graph), 2), {kComputeStage, 0}, {kComputeStage, 0});
}

TEST(Barriers, AWriteAfterAReadElsewhereSeesWhatItAddsTo) {
    Graph graph;
    const BufferHandle v1 = fill(graph, makeBuffer(graph, "a"));
    readBuffer(graph, v1, Access::IndirectRead, PassKind::Compute);
    graph.markOutput(fill(graph, v1));
    expectHalves(
        onlyBufferBarrier(mustCompile(graph), 2),
        {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT | kComputeStage, kStorageWrite},
        {kComputeStage, kStorageRead | kStorageWrite}
    );
}

TEST(Barriers, AClearDropsTheOldContentsWithTheLayout) {
    Graph graph;
    const ImageHandle v1 = store(graph, "store", makeImage(graph, "a"));
    sample(graph, "sample", v1);
    graph.markOutput(draw(graph, "clear", v1, true));
    const ImageBarrier barrier = onlyBarrier(mustCompile(graph), 2);
    EXPECT_EQ(barrier.srcStages, kComputeStage);
    expectLayouts(barrier, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
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
    const ImageHandle history = graph.importImage(
        "history", image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL
    );
    sample(graph, "sample", history);
    const Plan plan = mustCompile(graph);
    const ImageBarrier barrier = onlyBarrier(plan, 0);
    expectHalves(
        barrier,
        {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT},
        {kComputeStage, kSampledRead}
    );
    expectLayouts(barrier, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    ASSERT_EQ(plan.finalImageBarriers.size(), 1u);
    expectLayouts(
        plan.finalImageBarriers[0],
        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
        VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL
    );
    EXPECT_EQ(plan.finalImageBarriers[0].srcStages, kComputeStage);
}

TEST(Barriers, AnImportedImageThatAnyLayoutSuitsIsLeftAsItIs) {
    Graph graph;
    const gpu::Image image;
    sample(
        graph,
        "sample",
        graph.importImage("history", image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_UNDEFINED)
    );
    EXPECT_TRUE(mustCompile(graph).finalImageBarriers.empty());
}

TEST(Barriers, AnImportedImageWithKnownUsersStandsBetweenThem) {
    Graph graph;
    const gpu::Image image;
    const ImageHandle shared = graph.importImage(
        "shared",
        image,
        OutsideUse{
            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
            kColorStage,
            VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT},
        OutsideUse{VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kFragmentStage, kSampledRead}
    );
    sample(graph, "sample", shared);
    const Plan plan = mustCompile(graph);
    const ImageBarrier first = onlyBarrier(plan, 0);
    expectHalves(
        first, {kColorStage, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT}, {kComputeStage, kSampledRead}
    );
    expectLayouts(
        first, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
    );
    // The layout stays, and yet the next user need not wait for the first one by itself.
    ASSERT_EQ(plan.finalImageBarriers.size(), 1u);
    EXPECT_EQ(plan.finalImageBarriers[0].srcStages & kComputeStage, kComputeStage);
    EXPECT_EQ(plan.finalImageBarriers[0].dstStages, kFragmentStage);
    EXPECT_EQ(plan.finalImageBarriers[0].dstAccess, kSampledRead);
    expectLayouts(
        plan.finalImageBarriers[0],
        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
    );
}

TEST(Barriers, AnImportedImageThatNobodyReadsGoesOverToItsNextUse) {
    Graph graph;
    const gpu::Image image;
    (void)graph.importImage(
        "unread",
        image,
        OutsideUse{
            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
            kColorStage,
            VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT},
        OutsideUse{VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, kFragmentStage, kSampledRead}
    );
    const Plan plan = mustCompile(graph);
    ASSERT_EQ(plan.finalImageBarriers.size(), 1u);
    expectHalves(
        plan.finalImageBarriers[0],
        {kColorStage, VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT},
        {kFragmentStage, kSampledRead}
    );
    expectLayouts(
        plan.finalImageBarriers[0],
        VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
        VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
    );
}

TEST(Barriers, AnImportedImageThatNobodyReadsStaysInTheLayoutThatAnySuits) {
    Graph graph;
    const gpu::Image empty;
    const gpu::Image full;
    const VkImageLayout kept = VK_IMAGE_LAYOUT_GENERAL;
    (void)graph.importImage("empty", empty, OutsideUse{}, OutsideUse{});
    (void)graph.importImage("full", full, OutsideUse{kept}, OutsideUse{});
    const Plan plan = mustCompile(graph);
    ASSERT_EQ(plan.finalImageBarriers.size(), 1u) << "no image can go over to no layout";
    expectLayouts(plan.finalImageBarriers[0], kept, kept);
}

} // namespace
} // namespace shutter::graph
