// SPDX-License-Identifier: MIT
// Reports of a frame: statistics, reasons, idle time.
#include "engine/render/explainer.h"
#include "engine/render/frame_statistics.h"
#include "engine/render/renderer.h"

#include <gtest/gtest.h>

#include <vector>

namespace shutter::render {
namespace {

FrameStatistics makeFrame(double milliseconds) {
    FrameStatistics frame;
    frame.passes = {{"draw", milliseconds, 2.0 * milliseconds}, {"blur", 10.0, 1.0}};
    frame.cpuMilliseconds = 3.0 * milliseconds;
    frame.wallMilliseconds = 4.0 * milliseconds;
    frame.counters = {{"rays traced", 5}};
    frame.transientBytes = static_cast<uint64_t>(milliseconds) * 100;
    return frame;
}

FrameStatistics medianOf(const std::vector<double>& milliseconds) {
    std::vector<FrameStatistics> frames;
    for (const double value : milliseconds)
        frames.push_back(makeFrame(value));
    return computeMedian(frames);
}

TEST(FrameStatistics, TheMedianIsTheMiddleWhateverTheOrderAndBetweenTwo) {
    const FrameStatistics median = medianOf({100.0, 1.0, 3.0});
    EXPECT_EQ(median.passes.at(0).gpuMilliseconds, 3.0);
    EXPECT_EQ(median.passes.at(0).cpuMilliseconds, 6.0);
    EXPECT_EQ(median.cpuMilliseconds, 9.0);
    EXPECT_EQ(median.wallMilliseconds, 12.0);
    EXPECT_EQ(median.passes.at(1).gpuMilliseconds, 10.0);
    EXPECT_EQ(medianOf({7.0}).passes.at(0).gpuMilliseconds, 7.0);
    EXPECT_EQ(medianOf({4.0, 100.0, 2.0, 1.0}).wallMilliseconds, 12.0);
}

TEST(FrameStatistics, SumsAreByPassNameInTheOrderOfFirstAppearanceAndThatOfMemoryIsItsMaximum) {
    FrameStatistics total;
    addStatistics(total, makeFrame(1.0));
    FrameStatistics next = makeFrame(2.0);
    next.passes = {{"blur", 5.0, 1.0}, {"tone map", 7.0, 1.0}, {"draw", 2.0, 4.0}};
    next.explanations = {{ExplainedKind::Effect, "motion blur", {true, "later"}}};
    total.measures = {{"standard error", 0.5}, {"other", 2.0}};
    next.measures = {{"standard error", 0.25}};
    addStatistics(total, next);
    EXPECT_EQ(total.measures.at("standard error"), 0.25) << "the later frame's";
    EXPECT_EQ(total.measures.at("other"), 2.0);
    ASSERT_EQ(total.passes.size(), 3u);
    EXPECT_EQ(total.passes[0].name, "draw");
    EXPECT_EQ(total.passes[0].gpuMilliseconds, 3.0);
    EXPECT_EQ(total.passes[0].cpuMilliseconds, 6.0);
    EXPECT_EQ(total.passes[1].gpuMilliseconds, 15.0);
    EXPECT_EQ(total.passes[2].name, "tone map");
    EXPECT_EQ(total.cpuMilliseconds, 9.0);
    EXPECT_EQ(total.wallMilliseconds, 12.0);
    EXPECT_EQ(total.counters.at("rays traced"), 10u);
    EXPECT_EQ(total.transientBytes, 200u) << "memory is used again";
    const core::Decision* blur = findDecision(total.explanations, "motion blur");
    ASSERT_NE(blur, nullptr);
    EXPECT_EQ(core::describe(*blur), "ran: later");
    addStatistics(total, makeFrame(1.0));
    EXPECT_EQ(total.transientBytes, 200u);
}

/// A pass that writes `target`, so that it stays.
void addPass(graph::Graph& graph, const std::string& name, graph::BufferHandle& target) {
    struct Data {};

    graph.addPass<Data>(
        name,
        graph::PassKind::Compute,
        [&](graph::PassBuilder& builder, Data&) {
            target = builder.write(target, graph::Access::StorageWrite);
        },
        [](const Data&, graph::PassContext&) {}
    );
}

graph::Plan compile(const graph::Graph& graph) {
    auto plan = graph::compile(graph, [](const auto&, VkImageUsageFlags) {
        return graph::MemoryRequirement{};
    });
    EXPECT_TRUE(plan.ok());
    return std::move(plan).value();
}

TEST(Explainer, PassesHaveTheReasonOfThoseWhoDeclaredThem) {
    graph::Graph graph;
    Explainer explainer;
    auto kept = graph.createBuffer("kept", {16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
    auto unread = graph.createBuffer("unread", {16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
    explainer.decide(ExplainedKind::Effect, "blur", {true, "something moves"});
    const auto declare = [&](PassOwner owner, const char* reason, auto&& passes) {
        explainer.declareOwned(graph, owner, reason, passes);
    };
    declare(PassOwner::Scene, "the picture is drawn", [&] { addPass(graph, "draw", kept); });
    declare(PassOwner::Rays, "nobody declared a pass for this", [] {});
    declare(PassOwner::Blur, "blur runs", [&] {
        addPass(graph, "blur", kept);
        declare(PassOwner::Other, "it is lost", [&] { addPass(graph, "lost", unread); });
        addPass(graph, "blur again", kept);
    });
    addPass(graph, "nobody's", kept);
    explainer.decide(ExplainedKind::Pass, "rays", {false, "only sky lies behind"});
    graph.markOutput(kept);
    const graph::Plan plan = compile(graph);

    const auto all = explainer.finish(graph, plan, true);
    ASSERT_EQ(all.size(), 7u);
    EXPECT_EQ(all[0].subject, "blur");
    EXPECT_EQ(all[0].kind, ExplainedKind::Effect);
    EXPECT_EQ(all[1].subject, "draw");
    EXPECT_EQ(describe(all[1].decision), "ran: the picture is drawn");
    EXPECT_EQ(all[2].kind, ExplainedKind::Pass);
    EXPECT_EQ(describe(all[2].decision), "ran: blur runs");
    EXPECT_EQ(describe(all[3].decision), "ran: blur runs") << "after passes within its own";
    EXPECT_EQ(describe(all[4].decision), "ran: the frame needs it");
    EXPECT_EQ(describe(all[5].decision), "skipped: only sky lies behind");
    EXPECT_EQ(all[6].subject, "lost");
    EXPECT_FALSE(all[6].decision.run);
    EXPECT_FALSE(all[6].decision.reason.empty());

    EXPECT_EQ(explainer.finish(graph, plan, false).size(), 1u);
    using enum PassOwner;
    EXPECT_EQ(explainer.listOwners(plan), (std::vector{Scene, Blur, Blur, Scene}));
    // The pass of the same name is not the decision.
    ASSERT_NE(findDecision(all, "blur"), nullptr);
    EXPECT_EQ(findDecision(all, "blur")->reason, "something moves");
    EXPECT_EQ(findDecision(all, "draw"), nullptr);
}

TEST(IdleCounter, IdlenessIsReportedOnceAndAUseRestartsTheCounter) {
    core::IdleCounter counter;
    for (uint32_t frame = 0; frame <= 4 * (core::kFramesKept - 1); ++frame)
        EXPECT_FALSE(counter.advance(frame % (core::kFramesKept - 1) == 0)) << frame;
    for (uint32_t frame = 1; frame < core::kFramesKept; ++frame)
        EXPECT_FALSE(counter.advance(false)) << frame;
    EXPECT_TRUE(counter.advance(false));
    for (uint32_t frame = 0; frame < 3 * core::kFramesKept; ++frame)
        EXPECT_FALSE(counter.advance(false)) << frame;
}

} // namespace
} // namespace shutter::render
