// SPDX-License-Identifier: MIT
// Each refusal, word for word, as a person gets to see it; objects kept between frames.
#include "engine/graph/kept_objects.h"
#include "tests/graph/story.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

namespace shutter::graph {
namespace {

TEST(GraphError, ReadingAnUnwrittenResourceIsRefused) {
    Graph graph;
    sample(graph, "tonemap", makeImage(graph, "color"));
    EXPECT_EQ(errorOf(graph), "pass 'tonemap' reads 'color' that no pass writes");
}

TEST(GraphError, ACulledPassIsCheckedToo) {
    Graph graph;
    (void)filter(graph, "blur", makeImage(graph, "color"), makeImage(graph, "blurred"));
    EXPECT_EQ(errorOf(graph), "pass 'blur' reads 'color' that no pass writes");
}

TEST(GraphError, WritingAnOldVersionIsRefused) {
    Graph graph;
    const ImageHandle v0 = makeImage(graph, "color");
    (void)store(graph, "first", v0);
    (void)store(graph, "second", v0);
    EXPECT_EQ(errorOf(graph), "pass 'second' writes an old version of 'color'");
}

TEST(GraphError, AHandleOfAnotherGraphIsRefused) {
    Graph yesterday;
    const ImageHandle old = store(yesterday, "draw", makeImage(yesterday, "color"));
    Graph today;
    (void)store(today, "draw", makeImage(today, "color"));
    sample(today, "tonemap", old);
    EXPECT_EQ(errorOf(today), "pass 'tonemap' uses a handle that this graph never gave out");
}

TEST(GraphError, ADefaultConstructedHandleIsRefused) {
    Graph graph;
    (void)store(graph, "draw", ImageHandle{});
    EXPECT_EQ(errorOf(graph), "pass 'draw' uses a handle that this graph never gave out");
    Graph other;
    other.markOutput(BufferHandle{});
    EXPECT_EQ(errorOf(other), "an output uses a handle that this graph never gave out");
}

TEST(GraphError, AnUnwrittenOutputIsRefused) {
    Graph graph;
    graph.markOutput(makeImage(graph, "color"));
    EXPECT_EQ(errorOf(graph), "output 'color' is written by no pass");
}

TEST(GraphError, AnOverwrittenOutputIsRefused) {
    Graph graph;
    const ImageHandle v1 = store(graph, "draw", makeImage(graph, "color"));
    const ImageHandle v2 = store(graph, "smear", v1);
    graph.markOutput(v1);
    sample(graph, "show", v2);
    EXPECT_EQ(
        errorOf(graph), "output 'color' is overwritten by pass 'smear' before the frame ends"
    );
}

TEST(GraphError, AttachmentsOfDifferentSizeAreRefused) {
    Graph graph;
    addPass(graph, "geometry", PassKind::Raster, [&](PassBuilder& builder) {
        (void)builder.colorTarget(makeImage(graph, "color", 16), ClearColor::uints(0));
        (void)builder.depthTarget(makeImage(graph, "depth", 32, kDepth), 0.0f);
    });
    EXPECT_EQ(
        errorOf(graph), "pass 'geometry' draws into 'color' of 16 x 16 and 'depth' of 32 x 32"
    );
}

TEST(GraphError, AttachmentsOfDifferentSampleCountsAreRefused) {
    Graph graph;
    addPass(graph, "geometry", PassKind::Raster, [&](PassBuilder& builder) {
        (void)builder.colorTarget(makeImage(graph, "color", 16), ClearColor::uints(0));
        (void)builder.depthTarget(graph.createImage("depth", {16, 16, kDepth, 4}), 0.0f);
    });
    EXPECT_EQ(
        errorOf(graph),
        "pass 'geometry' draws into 'color' with 1 samples per pixel and 'depth' with 4"
    );
}

TEST(GraphError, StoringToAMultisampledImageIsRefused) {
    Graph graph;
    const auto image = graph.createImage("color", {16, 16, VK_FORMAT_R16G16B16A16_SFLOAT, 4});
    graph.markOutput(store(graph, "blur", image));
    EXPECT_EQ(
        errorOf(graph), "pass 'blur' uses 'color' as storage write, but it has 4 samples per pixel"
    );
}

TEST(GraphError, ARasterPassWithoutAttachmentsIsRefused) {
    Graph graph;
    addPass(graph, "geometry", PassKind::Raster, [](PassBuilder&) {});
    EXPECT_EQ(errorOf(graph), "raster pass 'geometry' has no attachment");
}

TEST(GraphError, TwoDepthTargetsAreRefused) {
    Graph graph;
    addPass(graph, "geometry", PassKind::Raster, [&](PassBuilder& builder) {
        (void)builder.depthTarget(makeImage(graph, "near", 16, kDepth), 0.0f);
        (void)builder.depthTarget(makeImage(graph, "far", 16, kDepth), 0.0f);
    });
    EXPECT_EQ(errorOf(graph), "pass 'geometry' has two depth targets, 'near' and 'far'");
}

TEST(GraphError, AnAttachmentInAComputePassIsRefused) {
    Graph graph;
    addPass(graph, "blur", PassKind::Compute, [&](PassBuilder& builder) {
        (void)builder.colorTarget(makeImage(graph, "color"), std::nullopt);
    });
    EXPECT_EQ(
        errorOf(graph),
        "pass 'blur' uses 'color' as colour attachment, which a compute pass cannot do"
    );
}

TEST(GraphError, BuildingAnImageIsRefused) {
    Graph graph;
    addPass(graph, "build", PassKind::Build, [&](PassBuilder& builder) {
        (void)builder.write(makeImage(graph, "color"), Access::AccelerationBuild);
    });
    EXPECT_EQ(errorOf(graph), "pass 'build' uses 'color' as built, which an image cannot be");
}

TEST(GraphError, SamplingABufferIsRefused) {
    Graph graph;
    const BufferHandle buffer = graph.importBuffer("lights", fakeBuffer(1), 64);
    addPass(graph, "shade", PassKind::Compute, [&](PassBuilder& builder) {
        builder.read(buffer, Access::SampledCompute);
    });
    EXPECT_EQ(
        errorOf(graph), "pass 'shade' uses 'lights' as sampled in compute, which a buffer cannot be"
    );
}

TEST(GraphError, FormatsThatDoNotFitTheTargetAreRefused) {
    Graph graph;
    addPass(graph, "a", PassKind::Raster, [&](PassBuilder& builder) {
        (void)builder.depthTarget(makeImage(graph, "color"), 0.0f);
    });
    EXPECT_EQ(
        errorOf(graph),
        "pass 'a' uses 'color' as depth attachment, but its format is a colour format"
    );
    Graph other;
    (void)draw(other, "b", makeImage(other, "depth", 16, kDepth), true);
    EXPECT_EQ(
        errorOf(other),
        "pass 'b' uses 'depth' as colour attachment, but its format is a depth format"
    );
}

TEST(GraphError, AResourceUsedTwiceByOnePassIsRefused) {
    Graph graph;
    const ImageHandle color = store(graph, "draw", makeImage(graph, "color"));
    (void)filter(graph, "blur", color, color);
    EXPECT_EQ(
        errorOf(graph), "pass 'blur' uses 'color' twice: sampled in compute and storage write"
    );
}

TEST(GraphError, TheSameReadTwiceIsOneRead) {
    Graph graph;
    const ImageHandle color = store(graph, "draw", makeImage(graph, "color"));
    addPass(graph, "blur", PassKind::Compute, [&](PassBuilder& builder) {
        builder.read(color, Access::SampledCompute);
        builder.read(color, Access::SampledCompute);
        builder.sideEffect();
    });
    EXPECT_EQ(errorOf(graph), "");
    EXPECT_EQ(graph.passes()[1].uses.size(), 1u);
}

TEST(GraphError, AccessesThatContradictTheirUseAreRefused) {
    Graph graph;
    const ImageHandle color = store(graph, "draw", makeImage(graph, "color"));
    addPass(graph, "a", PassKind::Compute, [&](PassBuilder& builder) {
        builder.read(color, Access::StorageWrite);
    });
    EXPECT_EQ(errorOf(graph), "pass 'a' reads 'color' with an access that writes (storage write)");
    Graph other;
    addPass(other, "b", PassKind::Compute, [&](PassBuilder& builder) {
        (void)builder.write(makeImage(other, "color"), Access::StorageRead);
    });
    EXPECT_EQ(
        errorOf(other), "pass 'b' writes 'color' with an access that only reads (storage read)"
    );
}

TEST(GraphError, AnImageWithoutSizeOrFormatIsRefused) {
    Graph graph;
    (void)store(graph, "draw", makeImage(graph, "color", 0));
    EXPECT_EQ(errorOf(graph), "image 'color' is 0 x 0");
    Graph other;
    (void)store(other, "draw", makeImage(other, "color", 16, VK_FORMAT_UNDEFINED));
    EXPECT_EQ(errorOf(other), "image 'color' has no format");
}

TEST(GraphError, AnImageImportedUnderTwoNamesIsRefused) {
    Graph graph;
    const gpu::Image image;
    for (const char* name : {"screen", "target"})
        (void)graph.importImage(name, image, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL);
    EXPECT_EQ(errorOf(graph), "'screen' and 'target' import the same image");
}

TEST(GraphError, ABufferImportedUnderTwoNamesIsValidUntilOneIsWritten) {
    Graph graph;
    (void)graph.importBuffer("a", fakeBuffer(1), 64);
    const BufferHandle b = graph.importBuffer("b", fakeBuffer(1), 64);
    EXPECT_EQ(errorOf(graph), "");
    addPass(graph, "fill", PassKind::Transfer, [&](PassBuilder& builder) {
        (void)builder.write(b, Access::TransferWrite);
    });
    EXPECT_EQ(errorOf(graph), "'a' and 'b' import the same buffer");
}

TEST(GraphError, TheHostCannotReadATransient) {
    Graph graph;
    BufferHandle buffer = makeBuffer(graph, "counts");
    addPass(graph, "count", PassKind::Compute, [&](PassBuilder& builder) {
        buffer = builder.write(buffer, Access::StorageWrite);
    });
    addPass(graph, "print", PassKind::Transfer, [&](PassBuilder& builder) {
        builder.read(buffer, Access::HostRead);
    });
    EXPECT_EQ(
        errorOf(graph),
        "pass 'print' makes the host read 'counts', which is transient and not mapped"
    );
}

TEST(GraphError, TheHostCannotReadWhatIsOverwrittenLater) {
    Graph graph;
    BufferHandle buffer = graph.importBuffer("counts", fakeBuffer(1), 64);
    addPass(graph, "print", PassKind::Transfer, [&](PassBuilder& builder) {
        builder.read(buffer, Access::HostRead);
        builder.sideEffect();
    });
    addPass(graph, "count", PassKind::Compute, [&](PassBuilder& builder) {
        buffer = builder.write(buffer, Access::StorageWrite);
    });
    EXPECT_EQ(
        errorOf(graph), "pass 'print' makes the host read 'counts', but pass 'count' overwrites it"
    );
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

TEST(KeptObjects, AReusedKeyCreatesNoNewObject) {
    Kept kept;
    int made = 0;
    for (int round = 0; round < 10; ++round) {
        kept.beginRound();
        EXPECT_EQ(*obtain(kept, round % 2, made), "made " + std::to_string(round % 2 + 1));
        kept.dropIdle(10, costOf);
    }
    EXPECT_EQ(made, 2);
}

TEST(KeptObjects, ARoundUsesEachObjectOnce) {
    Kept kept;
    int made = 0;
    for (int round = 0; round < 3; ++round) {
        kept.beginRound();
        EXPECT_NE(obtain(kept, 5, made), obtain(kept, 5, made));
    }
    EXPECT_EQ(made, 2);
}

TEST(KeptObjects, TheLongestUnusedObjectsAreDroppedAndNeverThoseInUse) {
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
}

TEST(KeptObjects, ObjectsUnusedForSomeRoundsAreDropped) {
    Kept kept;
    int made = 0;
    kept.beginRound();
    (void)obtain(kept, 4, made);
    for (int round = 0; round < 3; ++round) {
        EXPECT_EQ(kept.sum(costOf), 4u);
        kept.beginRound();
        kept.dropUnused(2);
    }
    EXPECT_EQ(kept.sum(costOf), 0u);
}

} // namespace
} // namespace shutter::graph
