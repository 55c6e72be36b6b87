// SPDX-License-Identifier: MIT
// What the panel and the head-up display show of a frame.
#include "game/play/panel/panel_sections.h"
#include "game/play/panel/pass_history.h"
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace shutter::game {
namespace {

render::FrameStatistics makeBudgetFrame(double level) {
    render::FrameStatistics statistics;
    statistics.measures["blur budget level"] = level;
    return statistics;
}

/// Another method drew the frame in place of `wanted`.
render::FrameStatistics drawnBy(render::FrameStatistics frame, const char* wanted, const char* by) {
    frame.explanations.push_back(
        {render::ExplainedKind::Work,
         motion_blur::nameReplacement(motion_blur::getMethod(wanted)),
         {true, by}}
    );
    return frame;
}

TEST(HudText, AReducedMethodIsNamedByWhatDrawsAndOneThatKeptAllHasItsNameAlone) {
    const auto whole = makeBudgetFrame(0.0);
    const auto reduced = makeBudgetFrame(2.0);
    const auto replaced = drawnBy(makeBudgetFrame(4.0), "resolved", "own_velocity");
    const render::FrameStatistics unlimited; // measures nothing
    EXPECT_EQ(describeMethod("resolved", &whole, true), "resolved");
    EXPECT_EQ(describeMethod("resolved", &reduced, true), "resolved, reduced: budget, F1");
    EXPECT_EQ(describeMethod("resolved", &replaced, true), "own_velocity for resolved: budget, F1");
    EXPECT_EQ(findDrawnMethod("resolved", &replaced), "own_velocity");
    EXPECT_EQ(describeMethod("resolved", &unlimited, false), "resolved");
    EXPECT_EQ(describeMethod("resolved", nullptr, true), "resolved") << "no frame is done yet";
    // The player took the budget away; the last finished frame had it still.
    EXPECT_EQ(describeMethod("resolved", &reduced, false), "resolved");
    // The player chose another method; the last finished frame had the one before.
    EXPECT_EQ(findDrawnMethod("denoised", &replaced), "denoised");
}

TEST(HudText, AMethodThatAnotherStandsInForNamesIt) {
    auto frame = drawnBy(makeBudgetFrame(2.0), "hybrid", "gather");
    frame.measures["blur stands in"] = 1.0;
    EXPECT_EQ(
        describeMethod("hybrid", &frame, true), "hybrid: gather until its pipelines are made"
    );
    // The player chose another method; the last finished frame had the one before.
    EXPECT_EQ(describeMethod("resolved", &frame, true), "resolved");
    EXPECT_EQ(describeMethod("truth", &frame, true), "truth");
}

TEST(HudText, TheBlursShareOfAFrameIsShownUnlessFramesOverlap) {
    render::FrameStatistics frame;
    frame.passes.push_back({"resolve", 30.0, 0.0, render::PassOwner::Blur});
    EXPECT_EQ(describeBlurCost("gather", frame, 120.0), "motion blur 30.0 ms (25 % of the frame)");
    EXPECT_EQ(describeBlurCost("gather", frame, 20.0), "motion blur 30.0 ms");
    EXPECT_EQ(describeBlurCost("gather", frame, 0.0), "motion blur 30.0 ms");
}

TEST(HudText, TheStateNamesTheViewAndAMissingOne) {
    PanelFacts facts;
    EXPECT_EQ(describeState(facts, ""), "");
    EXPECT_EQ(describeState(facts, "depth"), "view: depth");
    facts.paused = facts.isViewMissing = true;
    EXPECT_EQ(describeState(facts, "tiles"), "paused, view: tiles, which this frame does not have");
    facts.speed = 0.5;
    EXPECT_EQ(describeState(facts, ""), "paused, speed 0.5");
    facts.photo = true;
    facts.photoMethod = "truth";
    facts.photoRays = 1;
    EXPECT_EQ(describeState(facts, "tiles"), "photo mode: truth, 1 ray per pixel");
    facts.photoRays.reset();
    facts.photoMethod = "gather";
    EXPECT_EQ(describeState(facts, ""), "photo mode: gather");
}

TEST(PanelRows, TheCountOfSamplesIsShownForTapsAndInstantsAndRaysHaveTheirOwn) {
    const auto reads = [](const char* method) {
        const auto names = listReadSettings(*findMethod(method).value());
        return std::find(names.begin(), names.end(), "sampleCount") != names.end();
    };
    EXPECT_TRUE(reads("gather"));
    EXPECT_TRUE(reads("resolved"));
    EXPECT_TRUE(reads("adaptive"));
    EXPECT_FALSE(reads("denoised"));
    EXPECT_FALSE(reads("accumulate"));
}

render::FrameStatistics makeFrame(const std::vector<std::pair<const char*, double>>& passes) {
    render::FrameStatistics frame;
    for (const auto& [name, milliseconds] : passes)
        frame.passes.push_back({name, milliseconds, 0.0});
    return frame;
}

std::vector<std::string> namesOf(const PassHistory& history) {
    std::vector<std::string> names;
    for (const PassHistory::Pass& pass : history.passes())
        names.push_back(pass.name);
    return names;
}

using Names = std::vector<std::string>;

TEST(PassHistory, PassesComeAndGoInTheOrderOfTheFrameAndThoseOfOneNameAddUp) {
    PassHistory history;
    EXPECT_EQ(history.frameCount(), 0u);
    history.add(makeFrame({{"a", 1.0}, {"c", 3.0}}));
    history.add(makeFrame({{"a", 1.5}, {"b", 2.0}, {"c", 3.5}, {"d", 4.0}}));
    history.add(makeFrame({}));
    EXPECT_EQ(namesOf(history), (Names{"a", "b", "c", "d"}));
    const float expected[3][4] = {
        {1.0f, 0.0f, 3.0f, 0.0f}, {1.5f, 2.0f, 3.5f, 4.0f}, {0.0f, 0.0f, 0.0f, 0.0f}};
    for (size_t frame = 0; frame < 3; ++frame)
        for (size_t pass = 0; pass < 4; ++pass)
            EXPECT_EQ(history.milliseconds(frame, pass), expected[frame][pass]);
    EXPECT_EQ(history.findMedian(0), 1.0f);
    EXPECT_EQ(history.findMedian(3), 0.0f);
    PassHistory sums;
    sums.add(makeFrame(
        {{"a", 1.0},
         {"a", 2.0},
         {"b", std::numeric_limits<double>::quiet_NaN()},
         {"c", std::numeric_limits<double>::infinity()},
         {"d", -1.0}}
    ));
    EXPECT_EQ(sums.milliseconds(0, 0), 3.0f);
    for (size_t pass = 1; pass < 4; ++pass)
        EXPECT_EQ(sums.milliseconds(0, pass), 0.0f);
}

TEST(PassHistory, OldFramesAndUnusedPassesAreForgotten) {
    PassHistory history;
    history.add(makeFrame({{"once", 1.0}, {"always", 0.0}}));
    for (size_t i = 1; i < PassHistory::kFrames; ++i)
        history.add(makeFrame({{"always", double(i)}}));
    EXPECT_EQ(namesOf(history), (Names{"once", "always"}));
    history.add(makeFrame({{"always", 1000.0}}));
    EXPECT_EQ(history.frameCount(), PassHistory::kFrames);
    EXPECT_EQ(namesOf(history), (Names{"always"}));
    EXPECT_EQ(history.milliseconds(0, 0), 1.0f);
    EXPECT_EQ(history.milliseconds(PassHistory::kFrames - 1, 0), 1000.0f);
}

} // namespace
} // namespace shutter::game
