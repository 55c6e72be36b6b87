// SPDX-License-Identifier: MIT
#include "engine/render/explainer.h"

#include <gtest/gtest.h>

namespace shutter::render {

namespace {

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

} // namespace

TEST(Explainer, PassesHaveTheReasonOfThoseWhoDeclaredThem) {
    graph::Graph graph;
    Explainer explainer;
    auto kept = graph.createBuffer("kept", {16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
    auto unread = graph.createBuffer("unread", {16, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
    explainer.decide(ExplainedKind::Effect, "blur", {true, "something moves"});
    explainer.beginPasses(graph, PassOwner::Scene, "the picture is drawn");
    addPass(graph, "draw", kept);
    explainer.beginPasses(graph, PassOwner::Rays, "nobody declared a pass for this");
    explainer.beginPasses(graph, PassOwner::Effect, "blur runs");
    addPass(graph, "blur", kept);
    addPass(graph, "lost", unread);
    explainer.decide(ExplainedKind::Pass, "rays", {false, "only sky lies behind"});
    graph.markOutput(kept);
    const graph::Plan plan = compile(graph);

    const auto all = explainer.finish(graph, plan, true);
    ASSERT_EQ(all.size(), 5u);
    EXPECT_EQ(all[0].subject, "blur");
    EXPECT_EQ(all[0].kind, ExplainedKind::Effect);
    EXPECT_EQ(all[1].subject, "draw");
    EXPECT_EQ(describe(all[1].decision), "ran: the picture is drawn");
    EXPECT_EQ(all[2].kind, ExplainedKind::Pass);
    EXPECT_EQ(describe(all[2].decision), "ran: blur runs");
    EXPECT_EQ(describe(all[3].decision), "skipped: only sky lies behind");
    EXPECT_EQ(all[4].subject, "lost");
    EXPECT_FALSE(all[4].decision.run);
    EXPECT_FALSE(all[4].decision.reason.empty());

    EXPECT_EQ(explainer.finish(graph, plan, false).size(), 1u);
    EXPECT_EQ(explainer.listOwners(plan), (std::vector{PassOwner::Scene, PassOwner::Effect}))
        << "of \"draw\" and \"blur\"";
    // The pass of the same name is not what was decided.
    ASSERT_NE(findDecision(all, "blur"), nullptr);
    EXPECT_EQ(findDecision(all, "blur")->reason, "something moves");
    EXPECT_EQ(findDecision(all, "draw"), nullptr);
}

} // namespace shutter::render
