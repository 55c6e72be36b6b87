// SPDX-License-Identifier: MIT
// Each refusal, word for word, as a person gets to see it; objects kept between frames.
#include "engine/graph/kept_objects.h"
#include "tests/graph/story.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace shutter::graph {
namespace {

class GraphError : public ::testing::Test {
  protected:
    /// Refusal by this sentence of what has been declared; the next frame begins with nothing.
    void expectRefusal(std::string_view sentence) {
        EXPECT_EQ(errorOf(graph), sentence);
        graph = Graph();
    }

    Graph graph;
};

TEST_F(GraphError, ContentsThatNoPassLeavesAreRefused) {
    sample(graph, "tonemap", makeImage(graph, "color"));
    expectRefusal("pass 'tonemap' reads 'color' that no pass writes");
    (void)filter(graph, "blur", makeImage(graph, "color"), makeImage(graph, "blurred"));
    expectRefusal("pass 'blur' reads 'color' that no pass writes"); // a culled pass
    const ImageHandle v0 = makeImage(graph, "color");
    (void)store(graph, "first", v0);
    (void)store(graph, "second", v0);
    expectRefusal("pass 'second' writes an old version of 'color'");
    graph.markOutput(makeImage(graph, "color"));
    expectRefusal("output 'color' is written by no pass");
    const ImageHandle v1 = store(graph, "draw", makeImage(graph, "color"));
    graph.markOutput(v1);
    sample(graph, "show", store(graph, "smear", v1));
    expectRefusal("output 'color' is overwritten by pass 'smear' before the frame ends");
}

TEST_F(GraphError, HandlesOfOtherGraphsAndOfNoneAreRefused) {
    Graph yesterday;
    const ImageHandle old = store(yesterday, "draw", makeImage(yesterday, "color"));
    (void)store(graph, "draw", makeImage(graph, "color"));
    sample(graph, "tonemap", old);
    expectRefusal("pass 'tonemap' uses a handle that this graph never gave out");
    (void)store(graph, "draw", ImageHandle{});
    expectRefusal("pass 'draw' uses a handle that this graph never gave out");
    graph.markOutput(BufferHandle{});
    expectRefusal("an output uses a handle that this graph never gave out");
}

TEST_F(GraphError, AttachmentsThatDoNotFitTogetherOrTheirPassAreRefused) {
    const auto drawBoth = [&](ImageHandle color, ImageHandle depth) {
        addPass(graph, "geometry", PassKind::Raster, [&](PassBuilder& builder) {
            (void)builder.colorTarget(color, ClearColor::uints(0));
            (void)builder.depthTarget(depth, 0.0f);
        });
    };
    drawBoth(makeImage(graph, "color"), makeImage(graph, "depth", 32, kDepth));
    expectRefusal("pass 'geometry' draws into 'color' of 16 x 16 and 'depth' of 32 x 32");
    drawBoth(makeImage(graph, "color"), graph.createImage("depth", {16, 16, kDepth, 4}));
    expectRefusal("pass 'geometry' draws into 'color' with 1 samples per pixel and 'depth' with 4");
    addPass(graph, "geometry", PassKind::Raster, [](PassBuilder&) {});
    expectRefusal("raster pass 'geometry' has no attachment");
    addPass(graph, "geometry", PassKind::Raster, [&](PassBuilder& builder) {
        (void)builder.depthTarget(makeImage(graph, "near", 16, kDepth), 0.0f);
        (void)builder.depthTarget(makeImage(graph, "far", 16, kDepth), 0.0f);
    });
    expectRefusal("pass 'geometry' has two depth targets, 'near' and 'far'");
    addPass(graph, "blur", PassKind::Compute, [&](PassBuilder& builder) {
        (void)builder.colorTarget(makeImage(graph, "color"), std::nullopt);
    });
    expectRefusal("pass 'blur' uses 'color' as colour attachment, which a compute pass cannot do");
    addPass(graph, "a", PassKind::Raster, [&](PassBuilder& builder) {
        (void)builder.depthTarget(makeImage(graph, "color"), 0.0f);
    });
    expectRefusal("pass 'a' uses 'color' as depth attachment, but its format is a colour format");
    (void)draw(graph, "b", makeImage(graph, "depth", 16, kDepth), true);
    expectRefusal("pass 'b' uses 'depth' as colour attachment, but its format is a depth format");
}

TEST_F(GraphError, UsesThatAResourceOrItsPassDoesNotAllowAreRefused) {
    const auto compute = PassKind::Compute;
    graph.markOutput(store(graph, "blur", graph.createImage("color", {16, 16, kColor, 4})));
    expectRefusal("pass 'blur' uses 'color' as storage write, but it has 4 samples per pixel");
    ImageHandle color = makeImage(graph, "color");
    (void)addWriter(graph, "build", PassKind::Build, color, Access::AccelerationBuild);
    expectRefusal("pass 'build' uses 'color' as built, which an image cannot be");
    const BufferHandle lights = graph.importBuffer("lights", fakeBuffer(1), 64);
    addReader(graph, "shade", compute, lights, Access::SampledCompute);
    expectRefusal("pass 'shade' uses 'lights' as sampled in compute, which a buffer cannot be");
    color = store(graph, "draw", makeImage(graph, "color"));
    (void)filter(graph, "blur", color, color);
    expectRefusal("pass 'blur' uses 'color' twice: sampled in compute and storage write");
    color = store(graph, "draw", makeImage(graph, "color"));
    addReader(graph, "a", compute, color, Access::StorageWrite);
    expectRefusal("pass 'a' reads 'color' with an access that writes (storage write)");
    (void)addWriter(graph, "b", compute, makeImage(graph, "color"), Access::StorageRead);
    expectRefusal("pass 'b' writes 'color' with an access that only reads (storage read)");
}

TEST_F(GraphError, TheSameReadTwiceIsOneRead) {
    const ImageHandle color = store(graph, "draw", makeImage(graph, "color"));
    addPass(graph, "blur", PassKind::Compute, [&](PassBuilder& builder) {
        builder.read(color, Access::SampledCompute);
        builder.read(color, Access::SampledCompute);
        builder.sideEffect();
    });
    EXPECT_EQ(errorOf(graph), "");
    EXPECT_EQ(graph.passes()[1].uses.size(), 1u);
}

TEST_F(GraphError, ImagesWithoutSizeOrFormatAndResourcesOfTwoNamesAreRefused) {
    (void)store(graph, "draw", makeImage(graph, "color", 0));
    expectRefusal("image 'color' is 0 x 0");
    (void)store(graph, "draw", makeImage(graph, "color", 16, VK_FORMAT_UNDEFINED));
    expectRefusal("image 'color' has no format");
    const gpu::Image image;
    for (const char* name : {"screen", "target"})
        (void)graph.importImage(name, image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL);
    expectRefusal("'screen' and 'target' import the same image");
    (void)graph.importBuffer("a", fakeBuffer(1), 64);
    const BufferHandle b = graph.importBuffer("b", fakeBuffer(1), 64);
    EXPECT_EQ(errorOf(graph), "") << "a buffer may have two names until it is written to";
    (void)addWriter(graph, "fill", PassKind::Transfer, b, Access::TransferWrite);
    expectRefusal("'a' and 'b' import the same buffer");
}

TEST_F(GraphError, TheHostCannotReadATransientOrWhatIsOverwrittenLater) {
    const BufferHandle transient = store(graph, "count", makeBuffer(graph, "counts"));
    addReader(graph, "print", PassKind::Transfer, transient, Access::HostRead);
    expectRefusal("pass 'print' makes the host read 'counts', which is transient and not mapped");
    const BufferHandle counts = graph.importBuffer("counts", fakeBuffer(1), 64);
    addReader(graph, "print", PassKind::Transfer, counts, Access::HostRead);
    (void)store(graph, "count", counts);
    expectRefusal("pass 'print' makes the host read 'counts', but pass 'count' overwrites it");
}

using Kept = KeptObjects<int, std::string>;

/// Each object costs its key.
uint64_t costOf(int key) {
    return static_cast<uint64_t>(key);
}

std::string* obtain(Kept& kept, int key, int& made) {
    if (std::string* object = kept.use(key))
        return object;
    return kept.add(key, "made " + std::to_string(++made));
}

TEST(KeptObjects, AKeyIsReusedInEachRoundAndHasAnObjectForEachUseInOne) {
    Kept kept;
    int made = 0;
    for (int round = 0; round < 10; ++round) {
        kept.beginRound();
        EXPECT_EQ(*obtain(kept, round % 2, made), "made " + std::to_string(round % 2 + 1));
        kept.dropIdle(10, costOf);
    }
    EXPECT_EQ(made, 2);
    for (int round = 0; round < 3; ++round) {
        kept.beginRound();
        EXPECT_NE(obtain(kept, 5, made), obtain(kept, 5, made));
    }
    EXPECT_EQ(made, 4);
}

TEST(KeptObjects, TheLongestUnusedObjectsAreDroppedAndThoseInUseAfterSomeRounds) {
    Kept kept;
    int made = 0;
    for (const int key : {1, 2, 3}) {
        kept.beginRound();
        (void)obtain(kept, key, made);
    }
    kept.beginRound();
    std::string* used = obtain(kept, 1, made);
    kept.dropIdle(3, costOf); // 2 and 3 are idle, 2 for longer
    EXPECT_EQ(kept.sum(costOf), 4u);
    kept.dropIdle(0, costOf);
    EXPECT_EQ(kept.sum(costOf), 1u);
    EXPECT_EQ(*used, "made 1") << "addresses stay";
    for (int round = 0; round < 3; ++round) {
        EXPECT_EQ(kept.sum(costOf), 1u);
        kept.beginRound();
        kept.dropUnused(2);
    }
    EXPECT_EQ(kept.sum(costOf), 0u);
}

} // namespace
} // namespace shutter::graph
