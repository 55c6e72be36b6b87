// SPDX-License-Identifier: MIT
// The judge is judged: it must see what is wrong with plans made wrong by hand.
#include "tests/graph/hazard_simulator.h"
#include "tests/graph/story.h"

namespace shutter::graph {
namespace {

struct Frame {
    Graph graph;
    ImageHandle a = store(graph, "1", makeImage(graph, "a"));
    ImageHandle b = filter(graph, "2", a, makeImage(graph, "b"));
    ImageHandle c = filter(graph, "3", b, makeImage(graph, "c"));
    Plan plan;

    Frame() {
        graph.markOutput(c);
        plan = mustCompile(graph);
    }
};

TEST(HazardSimulator, AGoodPlanHasNothingAgainstIt) {
    const Frame frame;
    EXPECT_EQ(findHazards(frame.graph, frame.plan), Names{});
}

TEST(HazardSimulator, TwoLiveImagesInOnePlaceAreSeen) {
    Frame frame;
    for (Placement& image : frame.plan.images)
        image.offset = 0;
    EXPECT_NE(findHazards(frame.graph, frame.plan), Names{});
}

TEST(HazardSimulator, AReadThatIsNotMadeToSeeIsSeen) {
    Frame frame;
    ASSERT_FALSE(frame.plan.passes[1].imageBarriers.empty());
    frame.plan.passes[1].imageBarriers[0].dstAccess = 0;
    EXPECT_EQ(
        findHazards(frame.graph, frame.plan).front(),
        "at 2: 'a' is read without seeing what was written"
    );
}

TEST(HazardSimulator, AReuseThatDoesNotWaitIsSeen) {
    Frame frame;
    for (ImageBarrier& barrier : frame.plan.passes[2].imageBarriers)
        if (barrier.resource == frame.c.resource)
            barrier.srcStages = 0;
    EXPECT_EQ(
        findHazards(frame.graph, frame.plan).front(),
        "at 3: 'c' is moved to a layout while still in use"
    );
}

TEST(HazardSimulator, PassesInTheWrongOrderAreSeen) {
    Frame frame;
    std::swap(frame.plan.passes[0], frame.plan.passes[1]);
    EXPECT_NE(findHazards(frame.graph, frame.plan), Names{});
}

} // namespace
} // namespace shutter::graph
