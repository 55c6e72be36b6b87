// SPDX-License-Identifier: MIT
#include "tests/graph/story.h"

namespace shutter::graph {
namespace {

TEST(Order, IndependentPassesRunAsDeclared) {
    Graph graph;
    for (const char* name : {"c", "a", "b"})
        graph.markOutput(store(graph, name, makeImage(graph, name)));
    EXPECT_EQ(namesOf(graph, mustCompile(graph)), (Names{"c", "a", "b"}));
}

TEST(Order, EachWriteGivesANewVersionOfTheSameImage) {
    Graph graph;
    const ImageHandle a = makeImage(graph, "a");
    const ImageHandle a1 = store(graph, "one", a);
    const ImageHandle a2 = store(graph, "two", a1);
    EXPECT_EQ(a1.resource, a.resource);
    EXPECT_NE(a1, a);
    EXPECT_EQ(a2.version, 2u);
    EXPECT_EQ(graph.describeImage(a2), (TransientImageDesc{16, 16, kColor}));
}

TEST(Order, AReaderOfAnOldVersionRunsBeforeTheOverwriting) {
    Graph graph;
    const ImageHandle before = store(graph, "draw", makeImage(graph, "a"));
    const ImageHandle after = store(graph, "overwrite", before);
    graph.markOutput(after);
    sample(graph, "look at the old one", before);
    EXPECT_EQ(
        namesOf(graph, mustCompile(graph)), (Names{"draw", "look at the old one", "overwrite"})
    );
}

TEST(Order, ACulledVersionInBetweenLeavesTheOrderOfTheOthers) {
    Graph graph;
    const ImageHandle v1 = draw(graph, "first", makeImage(graph, "a"), true);
    const ImageHandle v2 = draw(graph, "culled", v1, true);
    const ImageHandle v3 = draw(graph, "last", v2, true);
    graph.markOutput(v3);
    sample(graph, "reader of the first", v1);
    EXPECT_EQ(namesOf(graph, mustCompile(graph)), (Names{"first", "reader of the first", "last"}));
}

TEST(Order, ASetupMayAddPassesOfItsOwn) {
    Graph graph;
    addPass(graph, "outer", PassKind::Compute, [&](PassBuilder& builder) {
        const ImageHandle inner = store(graph, "inner", makeImage(graph, "a"));
        builder.read(inner, Access::SampledCompute);
        builder.sideEffect();
    });
    EXPECT_EQ(namesOf(graph, mustCompile(graph)), (Names{"inner", "outer"}));
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
    // The callback looks at neither the frame nor the resources.
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

} // namespace
} // namespace shutter::graph
