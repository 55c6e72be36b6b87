// SPDX-License-Identifier: MIT
// The head-up display's text of the method: a budget that reduces quality is named.
#include "game/play/panel/panel_sections.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace shutter::game {
namespace {

render::FrameStatistics makeFrame(double level) {
    render::FrameStatistics statistics;
    statistics.measures["blur budget level"] = level;
    return statistics;
}

TEST(HudText, AMethodThatGaveSomethingUpIsCalledReducedWithTheBudgetThatMadeIt) {
    const auto frame = makeFrame(2.0);
    EXPECT_EQ(describeMethod("resolved", &frame, {16.0}), "resolved, reduced: 16 ms budget");
    EXPECT_EQ(describeMethod("gather", &frame, {0.1}), "gather, reduced: 0.1 ms budget");
}

TEST(HudText, AMethodThatKeptEverythingHasItsNameAlone) {
    const auto whole = makeFrame(0.0);
    const auto reduced = makeFrame(2.0);
    const render::FrameStatistics unlimited; // measures nothing
    EXPECT_EQ(describeMethod("resolved", &whole, {16.0}), "resolved");
    EXPECT_EQ(describeMethod("resolved", &unlimited, {}), "resolved");
    EXPECT_EQ(describeMethod("resolved", nullptr, {16.0}), "resolved") << "no frame is done yet";
    // The player took the budget away; the last finished frame had it still.
    EXPECT_EQ(describeMethod("resolved", &reduced, {}), "resolved");
}

TEST(HudText, AMethodThatAnotherStandsInForNamesIt) {
    auto frame = makeFrame(2.0);
    frame.measures["blur stands in"] = 1.0;
    EXPECT_EQ(
        describeMethod("hybrid", &frame, {16.0}), "hybrid: gather until its pipelines are made"
    );
    // The player chose another method; the last finished frame had the one before.
    frame.measures.erase("blur budget level");
    EXPECT_EQ(describeMethod("resolved", &frame, {16.0}), "resolved");
    EXPECT_EQ(describeMethod("truth", &frame, {16.0}), "truth");
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

} // namespace
} // namespace shutter::game
