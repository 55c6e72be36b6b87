// SPDX-License-Identifier: MIT
#include "game/play/loop/play_options.h"

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace shutter::game {
namespace {

void expectRefused(const PlayArguments& arguments, const std::string& reported) {
    const auto options = interpret(arguments);
    ASSERT_FALSE(options) << reported;
    EXPECT_NE(options.error().message.find(reported), std::string::npos) << options.error().message;
}

TEST(PlayOptions, ADemoStartsWithoutAScene) {
    const auto options = interpret(PlayArguments());
    ASSERT_TRUE(options) << options.error().message;
    EXPECT_EQ(options.value().demo, "rally");
    EXPECT_EQ(options.value().shot.width, 960u);
    EXPECT_TRUE(options.value().hasWindow);
}

TEST(PlayOptions, ANameOfADemoWinsOverAFile) {
    PlayArguments arguments;
    arguments.shot.scene = "spin";
    EXPECT_EQ(interpret(arguments).value().demo, "spin");
    arguments.shot.scene = "spin.glb";
    EXPECT_EQ(interpret(arguments).value().demo, "");
}

TEST(PlayOptions, EffectsAreTheSettingsUnlessTheyAreTyped) {
    PlayArguments arguments;
    PlayOptions options = interpret(arguments).value();
    EXPECT_TRUE(options.typed.empty());
    EXPECT_FALSE(options.environment);
    CLI::App app;
    definePlayOptions(app, arguments);
    app.parse(std::vector<std::string>{
        "height", "--frame-fit", "0", "--sky", "0.1", "--bloom", "sharp", "--shadows"});
    options = interpret(arguments).value();
    EXPECT_EQ(options.shot.picture.shadows.mode, extract::ShadowMode::Sharp);
    EXPECT_EQ(options.shot.picture.frameFit, extract::FrameFit::Height);
    EXPECT_EQ(options.shot.picture.bloom.share, 0.1f);
    EXPECT_EQ(options.environment, false);
    EXPECT_EQ(options.typed, (std::set<std::string>{"--frame-fit", "--bloom", "--shadows"}));
    arguments.shot.sky = 3.0;
    options = interpret(arguments).value();
    EXPECT_EQ(options.environment, true);
    EXPECT_EQ(options.shot.turbidity, 3.0);
    arguments.shot.sky = 11.0;
    expectRefused(arguments, "--sky");
    arguments = {};
    arguments.shot.picture.bloom.share = 1.5f;
    expectRefused(arguments, "bloomShare");
}

TEST(PlayOptions, TheLensIsTheSessionsNotTheScenes) {
    PlayArguments arguments;
    EXPECT_FALSE(interpret(arguments).value().fStop);
    CLI::App app;
    definePlayOptions(app, arguments);
    app.parse(std::vector<std::string>{"3", "--focus", "2.8", "--fstop"});
    const PlayOptions options = interpret(arguments).value();
    EXPECT_EQ(options.fStop, 2.8);
    EXPECT_EQ(options.focusDistance, 3.0);
    EXPECT_FALSE(options.shot.fStop);
    EXPECT_FALSE(options.shot.focusDistance);
    arguments.shot.lens.fStop = 0.001;
    expectRefused(arguments, "--fstop");
}

TEST(PlayOptions, APresetIsAKnownNameAndExcludesAMethod) {
    const auto parse = [](std::vector<std::string> reversed) {
        PlayArguments arguments;
        CLI::App app;
        definePlayOptions(app, arguments);
        app.parse(reversed);
        return arguments;
    };
    const PlayOptions options = interpret(parse({"paper", "--preset"})).value();
    ASSERT_TRUE(options.preset);
    EXPECT_STREQ(options.preset->name, "paper");
    EXPECT_FALSE(interpret(parse({})).value().preset);
    EXPECT_THROW(parse({"gather", "--method", "off", "--preset"}), CLI::ExcludesError);
    PlayArguments wrong;
    wrong.preset = "papers";
    EXPECT_EQ(
        interpret(wrong).error().message,
        "--preset 'papers' is unknown; there are off, performance, balanced, quality, paper"
    );
}

TEST(PlayOptions, WrongUsageIsReportedByOption) {
    PlayArguments arguments;
    arguments.method = "nothing";
    expectRefused(arguments, "--method");
    arguments = {};
    arguments.film = "film.png";
    expectRefused(arguments, "--film");
    arguments.film = "film%04d.exr";
    expectRefused(arguments, "--film");
    arguments = {};
    arguments.noWindow = true;
    expectRefused(arguments, "--no-window");
    arguments.frames = 3;
    EXPECT_TRUE(interpret(arguments));
    arguments = {};
    for (const double scale : {0.49, 4.01, -1.0, double(NAN)}) {
        arguments.uiScale = scale;
        expectRefused(arguments, "--ui-scale");
    }
    arguments.uiScale = 1.5;
    EXPECT_EQ(interpret(arguments).value().uiScale, 1.5);
    arguments = {};
    arguments.shot.camera = "left";
    expectRefused(arguments, "--camera");
    for (const char* option : {"--vsync", "--size"}) {
        CLI::App app;
        definePlayOptions(app, arguments);
        EXPECT_THROW(app.parse(std::vector<std::string>{"maybe", option}), CLI::ValidationError);
    }
}

} // namespace
} // namespace shutter::game
