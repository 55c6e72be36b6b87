// SPDX-License-Identifier: MIT
#include "engine/graph/compile_stages.h"
#include "tests/graph/story.h"

namespace shutter::graph {
namespace {

constexpr VkDeviceSize kBytes = 16 * 16 * 4;

/// a -> b -> c -> d: a's life ends where c's begins behind it.
struct Chain {
    Graph graph;
    ImageHandle a = store(graph, "1", makeImage(graph, "a"));
    ImageHandle b = filter(graph, "2", a, makeImage(graph, "b"));
    ImageHandle c = filter(graph, "3", b, makeImage(graph, "c"));
};

TEST(Alias, ImagesWithDisjointLivesShareMemory) {
    Chain chain;
    chain.graph.markOutput(chain.c);
    const Plan plan = mustCompile(chain.graph);
    EXPECT_EQ(placementOf(plan, chain.a).offset, placementOf(plan, chain.c).offset);
    EXPECT_EQ(plan.blockBytes, 2 * kBytes);
    EXPECT_EQ(plan.unaliasedBytes, 3 * kBytes);
}

TEST(Alias, ImagesThatMeetInOnePassDoNotShare) {
    Chain chain;
    chain.graph.markOutput(chain.c);
    const Plan plan = mustCompile(chain.graph);
    EXPECT_FALSE(overlapInMemory(placementOf(plan, chain.a), placementOf(plan, chain.b)));
    EXPECT_FALSE(overlapInMemory(placementOf(plan, chain.b), placementOf(plan, chain.c)));
}

TEST(Alias, AnOutputIsNotOverwrittenAfterItsLastUse) {
    Chain chain;
    chain.graph.markOutput(chain.a);
    chain.graph.markOutput(chain.c);
    const Plan plan = mustCompile(chain.graph);
    EXPECT_EQ(placementOf(plan, chain.a).lastPass, 2u);
    EXPECT_FALSE(overlapInMemory(placementOf(plan, chain.a), placementOf(plan, chain.c)));
    EXPECT_EQ(plan.blockBytes, 3 * kBytes);
}

TEST(Alias, WhatNobodyReadsAfterItsLastPassIsWantedNoMore) {
    Graph graph;
    ImageHandle depth;
    ImageHandle color;
    addPass(graph, "draw", PassKind::Raster, [&](PassBuilder& builder) {
        color = builder.colorTarget(makeImage(graph, "color"), std::nullopt);
        depth = builder.depthTarget(makeImage(graph, "depth", 16, VK_FORMAT_D32_SFLOAT), 0.0f);
    });
    addPass(graph, "draw more", PassKind::Raster, [&](PassBuilder& builder) {
        color = builder.colorTarget(color, std::nullopt);
        depth = builder.depthTarget(depth, std::nullopt);
    });
    graph.markOutput(color);
    const Plan plan = mustCompile(graph);
    ASSERT_EQ(plan.passes.size(), 2u);
    EXPECT_TRUE(isWantedAfter(graph, plan, depth.resource, 0));
    EXPECT_FALSE(isWantedAfter(graph, plan, depth.resource, 1));
    EXPECT_TRUE(isWantedAfter(graph, plan, color.resource, 1)) << "an output";
}

TEST(Alias, WhatIsImportedStaysWanted) {
    Graph graph;
    const gpu::Image target;
    ImageHandle image =
        graph.importImage("target", target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    image = draw(graph, "draw", image, true);
    EXPECT_TRUE(isWantedAfter(graph, mustCompile(graph), image.resource, 0));
}

TEST(Alias, ASmallImageFitsIntoTheHoleOfALargeOne) {
    Graph graph;
    const ImageHandle large = store(graph, "1", makeImage(graph, "large", 64));
    const ImageHandle kept = filter(graph, "2", large, makeImage(graph, "kept", 32));
    const ImageHandle small = filter(graph, "3", kept, makeImage(graph, "small", 16));
    graph.markOutput(small);
    const Plan plan = mustCompile(graph);
    EXPECT_EQ(placementOf(plan, small).offset, 0u);
    EXPECT_EQ(plan.blockBytes, (64u * 64 + 32 * 32) * 4);
}

TEST(Alias, ImportedImagesTakeNoPartInIt) {
    Graph graph;
    const gpu::Image target;
    const ImageHandle image =
        graph.importImage("target", target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    (void)store(graph, "draw", image);
    const Plan plan = mustCompile(graph);
    EXPECT_TRUE(plan.images.empty());
    EXPECT_EQ(plan.blockBytes, 0u);
}

TEST(Alias, UsageFollowsFromThePassesThatStay) {
    Graph graph;
    const ImageHandle a = draw(graph, "draw", makeImage(graph, "a"), true);
    sample(graph, "sample", a);
    addPass(graph, "culled copy", PassKind::Transfer, [&](PassBuilder& builder) {
        builder.read(a, Access::TransferRead);
    });
    const Plan plan = mustCompile(graph);
    EXPECT_EQ(
        placementOf(plan, a).imageUsage,
        VkImageUsageFlags{VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT}
    );
}

TEST(Alias, ASampledDepthTargetHasBothUsages) {
    Graph graph;
    ImageHandle depth = makeImage(graph, "depth", 16, kDepth);
    addPass(graph, "draw", PassKind::Raster, [&](PassBuilder& builder) {
        depth = builder.depthTarget(depth, 0.0f);
    });
    sample(graph, "sample", depth);
    const VkImageUsageFlags wanted =
        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    EXPECT_EQ(placementOf(mustCompile(graph), depth).imageUsage, wanted);
}

TEST(Alias, ABufferHasTheUsageItAsksForAndTheOneItsPassesNeed) {
    Graph graph;
    BufferHandle arguments =
        graph.createBuffer("arguments", {0, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT});
    addPass(graph, "count", PassKind::Compute, [&](PassBuilder& builder) {
        arguments = builder.write(arguments, Access::StorageWrite);
    });
    addPass(graph, "dispatch", PassKind::Compute, [&](PassBuilder& builder) {
        builder.read(arguments, Access::IndirectRead);
        builder.sideEffect();
    });
    const Plan plan = mustCompile(graph);
    ASSERT_EQ(plan.buffers.size(), 1u);
    EXPECT_EQ(
        plan.buffers[0].bufferUsage,
        VkBufferUsageFlags{
            VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
            VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT}
    );
}

Placement life(uint32_t first, uint32_t last, VkDeviceSize bytes, VkDeviceSize alignment) {
    Placement placement;
    placement.firstPass = first;
    placement.lastPass = last;
    placement.bytes = bytes;
    placement.alignment = alignment;
    return placement;
}

TEST(PackImages, NothingNeedsNothing) {
    std::vector<Placement> none;
    EXPECT_EQ(packImages(none), 0u);
}

TEST(PackImages, OneLiesAtTheStart) {
    std::vector<Placement> one{life(0, 0, 10, 64)};
    EXPECT_EQ(packImages(one), 10u);
    EXPECT_EQ(one[0].offset, 0u);
}

TEST(PackImages, AnOffsetKeepsItsAlignment) {
    std::vector<Placement> two{life(0, 1, 100, 1), life(0, 1, 10, 64)};
    EXPECT_EQ(packImages(two), 138u);
    EXPECT_EQ(two[1].offset, 128u);
}

TEST(PackImages, ARivalInsideAnotherDoesNotDragTheNextOneBack) {
    // Second and third never live together and may share; the last meets both.
    std::vector<Placement> images{
        life(0, 0, 100, 1), life(1, 1, 40, 1), life(0, 1, 30, 1), life(0, 1, 20, 1)};
    EXPECT_EQ(packImages(images), 150u);
    for (size_t i = 0; i < images.size(); ++i)
        for (size_t j = i + 1; j < images.size(); ++j)
            EXPECT_FALSE(
                overlapInTime(images[i], images[j]) && overlapInMemory(images[i], images[j])
            ) << i
              << " and " << j;
}

} // namespace
} // namespace shutter::graph
