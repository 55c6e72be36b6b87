// SPDX-License-Identifier: MIT
#include "tests/graph/story.h"

namespace shutter::graph {
namespace {

TEST(Culling, AnEmptyGraphCompilesToNothing) {
    const Graph graph;
    const Plan plan = mustCompile(graph);
    EXPECT_TRUE(plan.passes.empty());
    EXPECT_TRUE(plan.culled.empty());
    EXPECT_TRUE(plan.images.empty());
    EXPECT_EQ(plan.blockBytes, 0u);
    EXPECT_EQ(plan.unaliasedBytes, 0u);
}

TEST(Culling, AResourceNobodyUsesCostsNothing) {
    Graph graph;
    (void)makeImage(graph, "unused");
    (void)makeBuffer(graph, "unused too");
    const Plan plan = mustCompile(graph);
    EXPECT_TRUE(plan.images.empty());
    EXPECT_TRUE(plan.buffers.empty());
}

TEST(Culling, APassNobodyReadsIsCulledWithTheReason) {
    Graph graph;
    const ImageHandle shown = store(graph, "draw", makeImage(graph, "shown"));
    (void)store(graph, "forgotten", makeImage(graph, "tiles"));
    graph.markOutput(shown);
    const Plan plan = mustCompile(graph);
    EXPECT_EQ(namesOf(graph, plan), Names{"draw"});
    ASSERT_EQ(plan.culled.size(), 1u);
    EXPECT_EQ(plan.culled[0].name, "forgotten");
    EXPECT_EQ(plan.culled[0].reason, "nobody reads 'tiles'");
    EXPECT_EQ(plan.images.size(), 1u) << "what only culled passes write needs no memory";
}

TEST(Culling, AChainThatEndsNowhereIsCulledAsAWhole) {
    Graph graph;
    const ImageHandle a = store(graph, "first", makeImage(graph, "a"));
    const ImageHandle b = filter(graph, "second", a, makeImage(graph, "b"));
    (void)filter(graph, "third", b, makeImage(graph, "c"));
    const Plan plan = mustCompile(graph);
    EXPECT_TRUE(plan.passes.empty());
    ASSERT_EQ(plan.culled.size(), 3u);
    EXPECT_EQ(plan.culled[0].reason, "only culled passes read 'a'");
    EXPECT_EQ(plan.culled[2].reason, "nobody reads 'c'");
}

TEST(Culling, AChainThatReachesAnOutputStays) {
    Graph graph;
    const ImageHandle a = store(graph, "first", makeImage(graph, "a"));
    const ImageHandle b = filter(graph, "second", a, makeImage(graph, "b"));
    graph.markOutput(filter(graph, "third", b, makeImage(graph, "c")));
    EXPECT_EQ(namesOf(graph, mustCompile(graph)), (Names{"first", "second", "third"}));
}

TEST(Culling, ASideEffectKeepsAPassAndWhatItReads) {
    Graph graph;
    sample(graph, "print", store(graph, "draw", makeImage(graph, "a")));
    EXPECT_EQ(namesOf(graph, mustCompile(graph)), (Names{"draw", "print"}));
}

TEST(Culling, APassThatOnlyReadsIsCulled) {
    Graph graph;
    const ImageHandle a = store(graph, "draw", makeImage(graph, "a"));
    addPass(graph, "look", PassKind::Compute, [&](PassBuilder& builder) {
        builder.read(a, Access::SampledCompute);
    });
    const Plan plan = mustCompile(graph);
    EXPECT_TRUE(plan.passes.empty());
    ASSERT_EQ(plan.culled.size(), 2u);
    EXPECT_EQ(plan.culled[1].reason, "writes nothing");
}

TEST(Culling, AWriteToAnImportedResourceStays) {
    Graph graph;
    const gpu::Image target;
    const ImageHandle image =
        graph.importImage("target", target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    (void)store(graph, "draw", image);
    EXPECT_EQ(namesOf(graph, mustCompile(graph)), Names{"draw"});
}

TEST(Culling, AnEarlierVersionThatIsClearedAwayIsCulled) {
    Graph graph;
    const ImageHandle first = draw(graph, "wasted", makeImage(graph, "a"), true);
    graph.markOutput(draw(graph, "final", first, true));
    EXPECT_EQ(namesOf(graph, mustCompile(graph)), Names{"final"});
}

TEST(Culling, AnEarlierVersionThatIsDrawnOverStays) {
    Graph graph;
    const ImageHandle first = draw(graph, "below", makeImage(graph, "a"), true);
    graph.markOutput(draw(graph, "above", first, false));
    EXPECT_EQ(namesOf(graph, mustCompile(graph)), (Names{"below", "above"}));
}

TEST(Culling, ALaterVersionThatNobodyWantsIsCulledAndTheOutputStands) {
    Graph graph;
    const ImageHandle first = store(graph, "wanted", makeImage(graph, "a"));
    (void)store(graph, "unwanted", first);
    graph.markOutput(first);
    EXPECT_EQ(namesOf(graph, mustCompile(graph)), Names{"wanted"});
}

} // namespace
} // namespace shutter::graph
