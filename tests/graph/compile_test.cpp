// SPDX-License-Identifier: MIT
// Compilation of a frame: culling, ordering, errors, shared memory.
#include "engine/graph/compile.h"
#include "engine/graph/compile_stages.h"
#include "tests/graph/story.h"

#include <string>
#include <utility>
#include <vector>

namespace shutter::graph {
namespace {

TEST(Culling, PassesThatNothingNeedsAreCulledWithTheReason) {
    Graph graph;
    graph.markOutput(store(graph, "draw", makeImage(graph, "shown")));
    (void)store(graph, "forgotten", makeImage(graph, "tiles"));
    const ImageHandle a = store(graph, "first", makeImage(graph, "a"));
    (void)filter(graph, "second", a, makeImage(graph, "b"));
    addPass(graph, "show", PassKind::Compute, [&](PassBuilder& builder) {
        builder.read(a, Access::SampledCompute);
    });
    const Plan plan = mustCompile(graph);
    EXPECT_EQ(namesOf(graph, plan), Names{"draw"});
    EXPECT_EQ(plan.images.size(), 1u) << "what only culled passes write needs no memory";
    std::vector<std::pair<std::string, std::string>> culled;
    for (const auto& pass : plan.culled)
        culled.emplace_back(pass.name, pass.reason);
    const std::vector<std::pair<std::string, std::string>> expected{
        {"forgotten", "nobody reads 'tiles'"},
        {"first", "only culled passes read 'a'"},
        {"second", "nobody reads 'b'"},
        {"show", "writes nothing"}};
    EXPECT_EQ(culled, expected);
}

TEST(Order, IndependentPassesRunAsDeclaredAndThoseOfASetupBeforeItsPass) {
    Graph graph;
    for (const char* name : {"c", "a", "b"})
        graph.markOutput(store(graph, name, makeImage(graph, name)));
    addPass(graph, "outer", PassKind::Compute, [&](PassBuilder& builder) {
        const ImageHandle inner = store(graph, "inner", makeImage(graph, "a"));
        builder.read(inner, Access::SampledCompute);
        builder.sideEffect();
    });
    EXPECT_EQ(namesOf(graph, mustCompile(graph)), (Names{"c", "a", "b", "inner", "outer"}));
}

TEST(Order, TheDataFilledBySetupReachesExecute) {
    struct Data {
        int number = 0;
    };

    Graph graph;
    int seen = 0;
    const Data& data = graph.addPass<Data>(
        "pass",
        PassKind::Compute,
        [](PassBuilder&, Data& filled) { filled.number = 7; },
        [&seen](const Data& given, PassContext&) { seen = given.number; }
    );
    for (int i = 0; i < 100; ++i) // the first pass's data stays where it is
        (void)store(graph, "more", makeImage(graph, "a"));
    EXPECT_EQ(data.number, 7);
    // The callback uses neither the frame nor the resources.
    alignas(PassContext) std::byte unused[sizeof(PassContext)]{};
    graph.passes()[0].execute(reinterpret_cast<PassContext&>(unused));
    EXPECT_EQ(seen, 7);
}

TEST(Order, ACycleThroughAnOldVersionIsRefusedWithThePassesOnIt) {
    Graph graph;
    const ImageHandle a1 = store(graph, "make a", makeImage(graph, "a"));
    const ImageHandle a2 = store(graph, "change a", a1);
    const ImageHandle b = filter(graph, "make b from the new a", a2, makeImage(graph, "b"));
    addPass(graph, "compare b with the old a", PassKind::Compute, [&](PassBuilder& builder) {
        builder.read(a1, Access::SampledCompute);
        builder.read(b, Access::SampledCompute);
        builder.sideEffect();
    });
    EXPECT_EQ(
        errorOf(graph),
        "the passes form a cycle: 'change a' waits for 'compare b with the old a' "
        "waits for 'make b from the new a' waits for 'change a'"
    );
}

constexpr VkDeviceSize kBytes = 16 * 16 * 4;

/// a -> b -> c -> d: a's life ends where c's begins behind it.
struct Chain {
    Graph graph;
    ImageHandle a = store(graph, "1", makeImage(graph, "a"));
    ImageHandle b = filter(graph, "2", a, makeImage(graph, "b"));
    ImageHandle c = filter(graph, "3", b, makeImage(graph, "c"));
};

TEST(Alias, ImagesWithDisjointLivesShareMemoryAndOutputsLiveToTheEnd) {
    Chain chain;
    chain.graph.markOutput(chain.c);
    const Plan plan = mustCompile(chain.graph);
    EXPECT_EQ(placementOf(plan, chain.a).offset, placementOf(plan, chain.c).offset);
    EXPECT_EQ(plan.blockBytes, 2 * kBytes);
    EXPECT_EQ(plan.unaliasedBytes, 3 * kBytes);
    chain.graph.markOutput(chain.a);
    const Plan both = mustCompile(chain.graph);
    EXPECT_EQ(placementOf(both, chain.a).lastPass, 2u);
    EXPECT_EQ(both.blockBytes, 3 * kBytes);
}

TEST(Alias, ContentsNotReadAfterTheLastPassAreDiscardedUnlessTheirImageIsImported) {
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
    Graph other;
    const gpu::Image target;
    const ImageHandle imported =
        other.importImage("target", target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
    (void)draw(other, "draw", imported, true);
    EXPECT_TRUE(isWantedAfter(other, mustCompile(other), imported.resource, 0));
}

TEST(Alias, UsageFollowsFromThePassesThatStay) {
    Graph graph;
    const ImageHandle a = draw(graph, "draw", makeImage(graph, "a"), true);
    sample(graph, "sample", a);
    addPass(graph, "culled copy", PassKind::Transfer, [&](PassBuilder& builder) {
        builder.read(a, Access::TransferRead);
    });
    ImageHandle depth = makeImage(graph, "depth", 16, kDepth);
    addPass(graph, "draw depth", PassKind::Raster, [&](PassBuilder& builder) {
        depth = builder.depthTarget(depth, 0.0f);
    });
    sample(graph, "sample depth", depth);
    const Plan plan = mustCompile(graph);
    constexpr VkImageUsageFlags kSampledUsage = VK_IMAGE_USAGE_SAMPLED_BIT;
    EXPECT_EQ(placementOf(plan, a).imageUsage, kSampledUsage | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    EXPECT_EQ(
        placementOf(plan, depth).imageUsage,
        kSampledUsage | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT
    );
}

TEST(Alias, ABufferHasTheUsageItRequestsAndTheOneItsPassesNeed) {
    Graph graph;
    const BufferHandle arguments =
        graph.createBuffer("arguments", {0, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT});
    const BufferHandle counted = store(graph, "count", arguments);
    addReader(graph, "dispatch", PassKind::Compute, counted, Access::IndirectRead);
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

TEST(PackImages, OffsetsAreAlignedAndARivalInsideAnotherDoesNotDragTheNextOneBack) {
    std::vector<Placement> two{life(0, 1, 100, 1), life(0, 1, 10, 64)};
    EXPECT_EQ(packImages(two), 138u);
    EXPECT_EQ(two[1].offset, 128u);
    // Second and third never live together and may share; the last meets both.
    std::vector<Placement> images{
        life(0, 0, 100, 1), life(1, 1, 40, 1), life(0, 1, 30, 1), life(0, 1, 20, 1)};
    EXPECT_EQ(packImages(images), 150u);
    for (const Placement& a : images)
        for (const Placement& b : images)
            EXPECT_TRUE(&a == &b || !overlapInTime(a, b) || !overlapInMemory(a, b));
}

TEST(Dump, TheDumpOfAnEmptyGraphIsMarked) {
    const Graph graph;
    EXPECT_EQ(
        dump(graph, mustCompile(graph)),
        "passes: 0\nculled: 0\nimages: 0\nbuffers: 0\nimage memory: 0 bytes, 0 without sharing\n"
    );
}

TEST(Dump, ASmallFrameReadsAsGolden) {
    Graph graph;
    ImageHandle color = makeImage(graph, "color", 16, VK_FORMAT_R16G16B16A16_SFLOAT);
    ImageHandle depth = makeImage(graph, "depth", 16, kDepth);
    BufferHandle counts = makeBuffer(graph, "counts");
    BufferHandle result = graph.importBuffer("result", fakeBuffer(1), 1024);
    addPass(graph, "geometry", PassKind::Raster, [&](PassBuilder& builder) {
        color = builder.colorTarget(color, ClearColor::floats(0, 0, 0, 1));
        depth = builder.depthTarget(depth, 0.0f);
    });
    ImageHandle blurred = makeImage(graph, "blurred");
    addPass(graph, "blur", PassKind::Compute, [&](PassBuilder& builder) {
        builder.read(color, Access::SampledCompute);
        builder.read(depth, Access::SampledCompute);
        blurred = builder.write(blurred, Access::StorageWrite);
        counts = builder.write(counts, Access::StorageWrite);
    });
    (void)filter(graph, "edges", depth, makeImage(graph, "edge map"));
    addPass(graph, "copy", PassKind::Transfer, [&](PassBuilder& builder) {
        builder.read(blurred, Access::TransferRead);
        result = builder.write(result, Access::TransferWrite);
    });
    graph.markOutput(result);
    const char* golden = R"(passes: 3
  0 'geometry' (raster)
      barrier 'color' nothing -> colour, undefined -> colour
      barrier 'depth' nothing -> depth, undefined -> depth
      clears 'color' to version 1: colour attachment
      clears 'depth' to version 1: depth attachment
  1 'blur' (compute)
      barrier 'color' colour -> compute, colour -> sampled
      barrier 'depth' depth -> compute, depth -> sampled
      barrier 'blurred' nothing -> compute, undefined -> general
      reads 'color' version 1: sampled in compute
      reads 'depth' version 1: sampled in compute
      writes 'blurred' version 1: storage write
      writes 'counts' version 1: storage write
  2 'copy' (transfer)
      barrier 'blurred' compute -> transfer, general -> copy source
      barrier 'result' all -> transfer
      reads 'blurred' version 1: copied from
      writes 'result' version 1: copied to
  end: barrier 'result' transfer -> host
culled: 1
  'edges': nobody reads 'edge map'
images: 3
  'color' 16 x 16 R16G16B16A16_SFLOAT, passes 0 to 1, 1024 bytes at 0
  'depth' 16 x 16 D32_SFLOAT, passes 0 to 1, 1024 bytes at 1024
  'blurred' 16 x 16 R8G8B8A8_UNORM, passes 1 to 2, 1024 bytes at 2048
buffers: 1
  'counts', passes 1 to 1, 64 bytes
image memory: 3072 bytes, 3072 without sharing
)";
    EXPECT_EQ(dump(graph, mustCompile(graph)), golden);
}

TEST(Dump, WaitsLaunchesAndFormatsWithoutANameAreMarked) {
    Graph graph;
    const ImageHandle v1 = store(graph, "one", makeImage(graph, "a", 16, VK_FORMAT_R64_UINT));
    addReader(graph, "show", PassKind::Compute, v1, Access::StorageRead);
    graph.markOutput(store(graph, "two", v1));
    addPass(graph, "launch", PassKind::RayTracing, [](PassBuilder& builder) {
        builder.sideEffect();
    });
    const std::string text = dump(graph, mustCompile(graph));
    for (const char* part :
         {"barrier 'a' compute -> compute, execution only\n",
          "'show' (compute, side effect)",
          "'launch' (ray tracing, side effect)",
          "format 110"})
        EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
}

} // namespace
} // namespace shutter::graph
