// SPDX-License-Identifier: MIT
#include "engine/graph/compile.h"
#include "tests/graph/story.h"

namespace shutter::graph {
namespace {

TEST(Dump, AnEmptyGraphSaysSo) {
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

TEST(Dump, ABarrierThatOnlyWaitsSaysSo) {
    Graph graph;
    const ImageHandle v1 = store(graph, "one", makeImage(graph, "a"));
    addPass(graph, "look", PassKind::Compute, [&](PassBuilder& builder) {
        builder.read(v1, Access::StorageRead);
        builder.sideEffect();
    });
    graph.markOutput(store(graph, "two", v1));
    const std::string text = dump(graph, mustCompile(graph));
    EXPECT_NE(text.find("barrier 'a' compute -> compute, execution only\n"), std::string::npos)
        << text;
    EXPECT_NE(text.find("'look' (compute, side effect)"), std::string::npos) << text;
}

TEST(Dump, AFormatWithoutANameHasItsNumber) {
    Graph graph;
    graph.markOutput(store(graph, "a", makeImage(graph, "odd", 16, VK_FORMAT_R64_UINT)));
    EXPECT_NE(dump(graph, mustCompile(graph)).find("format 110"), std::string::npos);
}

} // namespace
} // namespace shutter::graph
