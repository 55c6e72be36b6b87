// SPDX-License-Identifier: MIT
// What `shutter play` begins with, and the keys that change it.
#include "game/play/loop/first_use.h"
#include "game/play/loop/hotkeys.h"
#include "game/play/loop/numbered_file.h"
#include "game/play/loop/play_options.h"
#include "game/play/loop/settings_keeper.h"
#include "game/play/loop/stage.h"
#include "game/play/panel/effect_switches.h"
#include "game/play/panel/panel_sections.h"
#include "tests/support/outcomes.h"
#include "tests/support/temp_folder.h"

#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <set>
#include <string>
#include <vector>

namespace shutter::game {
namespace {

namespace fs = std::filesystem;

using app::Key;

TEST(PlayOptions, ADemoStartsWithoutASceneAndItsNameWinsOverAFile) {
    const PlayOptions options = test::valueOf(interpret(PlayArguments()));
    EXPECT_EQ(options.demo, "rally");
    EXPECT_EQ(options.shot.width, 960u);
    EXPECT_TRUE(options.hasWindow);
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
    EXPECT_EQ(options.shot.picture.features.shadows.mode, shadows::ShadowMode::Sharp);
    EXPECT_EQ(options.shot.picture.frameFit, extract::FrameFit::Height);
    EXPECT_EQ(options.shot.picture.bloom.share, 0.1f);
    EXPECT_EQ(options.environment, false);
    EXPECT_EQ(options.typed, (std::set<std::string>{"--frame-fit", "--bloom", "--shadows"}));
    arguments.shot.sky = 3.0;
    options = interpret(arguments).value();
    EXPECT_EQ(options.environment, true);
    EXPECT_EQ(options.shot.turbidity, 3.0);
    arguments.shot.sky = 11.0;
    test::expectRefused(interpret(arguments), "--sky");
    arguments = {};
    arguments.shot.picture.bloom.share = 1.5f;
    test::expectRefused(interpret(arguments), "bloomShare");
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
    test::expectRefused(interpret(arguments), "--fstop");
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
    test::expectRefused(interpret(arguments), "--method");
    arguments = {};
    arguments.film = "film.png";
    test::expectRefused(interpret(arguments), "--film");
    arguments.film = "film%04d.exr";
    test::expectRefused(interpret(arguments), "--film");
    arguments = {};
    arguments.noWindow = true;
    test::expectRefused(interpret(arguments), "--no-window");
    arguments.frames = 3;
    EXPECT_TRUE(interpret(arguments));
    arguments = {};
    for (const double scale : {0.49, 4.01, -1.0, double(NAN)}) {
        arguments.uiScale = scale;
        test::expectRefused(interpret(arguments), "--ui-scale");
    }
    arguments.uiScale = 1.5;
    EXPECT_EQ(interpret(arguments).value().uiScale, 1.5);
    arguments = {};
    arguments.shot.camera = "left";
    test::expectRefused(interpret(arguments), "--camera");
    for (const char* option : {"--vsync", "--size"}) {
        CLI::App app;
        definePlayOptions(app, arguments);
        EXPECT_THROW(app.parse(std::vector<std::string>{"maybe", option}), CLI::ValidationError);
    }
}

TEST(PlayOptions, AStageThatIsNeitherADemoNorAFileIsRefusedWithTheDemosNames) {
    const test::TempFolder folder;
    PlayArguments arguments;
    EXPECT_TRUE(checkStage(interpret(arguments).value()));
    arguments.shot.scene = folder.write("a.glb", "");
    EXPECT_TRUE(checkStage(interpret(arguments).value()));
    arguments.shot.scene = "nosuch";
    EXPECT_EQ(
        checkStage(interpret(arguments).value()).error().message,
        "'nosuch' is neither a demo (rally, gallery, spin) nor a file"
    );
}

TEST(PlayOptions, AFilmShowsTheHeadUpDisplayOnlyIfThatIsTyped) {
    PlayArguments arguments;
    arguments.filmsHud = true;
    test::expectRefused(interpret(arguments), "--film-hud");
    arguments.film = "film%04d.png";
    EXPECT_TRUE(interpret(arguments).value().filmsHud);
    arguments.filmsHud = false;
    EXPECT_FALSE(interpret(arguments).value().filmsHud);
}

class Keeper : public testing::Test {
  protected:
    PlaySettings load(const std::string& lens, const PlayOptions& named) {
        return loadMember(R"("lens": )" + lens, named);
    }

    PlaySettings loadMember(const std::string& member, const PlayOptions& named) {
        PlayOptions options = named;
        options.settings = mFolder.write("settings", R"({"version": 1, )" + member + "}");
        std::string message;
        return test::valueOf(SettingsKeeper().open(options, true, message));
    }

    test::TempFolder mFolder;
};

TEST_F(Keeper, AnOpenFStopTurnsDepthOfFieldOn) {
    PlayOptions opened;
    opened.fStop = 1.4;
    const PlaySettings off = load(R"({"blurScale": 0})", opened);
    EXPECT_EQ(off.lens.fStop, 1.4);
    EXPECT_EQ(off.lens.blurScale, 1.0);
    EXPECT_EQ(load(R"({"blurScale": 0.5})", opened).lens.blurScale, 0.5);
    EXPECT_EQ(load(R"({"blurScale": 0})", {}).lens.blurScale, 0.0);
    PlayOptions closed;
    closed.fStop = 0.0;
    EXPECT_FALSE(load(R"({"fStop": 2})", closed).depthOfField);
}

TEST_F(Keeper, WithoutAGpuTheBudgetIsAShareOfTheFrameAndAPresetOfTheOptionsStays) {
    PlaySettings settings;
    settings.budget.milliseconds = 16.0;
    PlayOptions options;
    EXPECT_NE(SettingsKeeper::slowDown(options, settings), "");
    EXPECT_EQ(settings.picture.features.shadows.mode, shadows::ShadowMode::None);
    settings.picture.features.shadows.mode = shadows::ShadowMode::Blurred;
    EXPECT_TRUE(isApplied(*findPreset("performance").value(), settings));
    EXPECT_TRUE(settings.budget.isUnlimited());
    EXPECT_EQ(settings.budgetShare, 0.25);
    // Of the frame: the blur takes a quarter where all else takes 300 ms.
    EXPECT_NEAR(computeBudget(settings, 300.0).milliseconds, 100.0, 1e-9);
    EXPECT_TRUE(computeBudget(settings, 0.0).isUnlimited()) << "no frame is finished yet";
    settings.budget.milliseconds = 16.0;
    EXPECT_EQ(computeBudget(settings, 300.0).milliseconds, 16.0);
    settings.budgetShare = 1.0;
    EXPECT_EQ(computeBudget(settings, 3.0).milliseconds, 16.0);
    options.typed.insert("--shadows");
    options.shot.picture.features.shadows.mode = shadows::ShadowMode::Sharp;
    EXPECT_NE(SettingsKeeper::slowDown(options, settings), "");
    EXPECT_EQ(settings.picture.features.shadows.mode, shadows::ShadowMode::Sharp) << "an option's";
    options.preset = findPreset("quality").value();
    settings.method = "adaptive";
    EXPECT_EQ(SettingsKeeper::slowDown(options, settings), "");
    EXPECT_EQ(settings.method, "adaptive");
    EXPECT_EQ(settings.budgetShare, 0.25);
}

TEST_F(Keeper, AMissingFileIsNoMistakeInIt) {
    PlayOptions options;
    options.settings = mFolder.write("settings", R"({"version": 1})");
    SettingsKeeper keeper;
    std::string message;
    PlaySettings settings = test::valueOf(keeper.open(options, true, message));
    fs::remove(options.settings);
    EXPECT_NE(keeper.load(settings).find("is not there yet"), std::string::npos);
    EXPECT_EQ(keeper.save(settings), "saved " + options.settings.string());
}

TEST_F(Keeper, AnEntityToFocusOnReplacesTheDistanceOfTheSettings) {
    PlayOptions named;
    EXPECT_EQ(load(R"({"focusDistance": 3})", named).lens.focusDistance, 3.0);
    named.shot.focusEntity = "ball";
    EXPECT_EQ(load(R"({"focusDistance": 3})", named).lens.focusDistance, 0.0);
}

TEST_F(Keeper, APresetReplacesTheFilesMethodAndEffectsAndYieldsToTypedOptions) {
    const std::string file = R"("method": "gather", "antiAliasing": "box", "bloomShare": 0.5)";
    EXPECT_EQ(loadMember(file, {}).method, "gather");
    PlayOptions options;
    options.preset = findPreset("quality").value();
    const PlaySettings quality = loadMember(file, options);
    EXPECT_TRUE(isApplied(*options.preset, quality));
    EXPECT_EQ(quality.method, "adaptive");
    EXPECT_EQ(quality.picture.antiAliasing, AntiAliasing::Taa);
    options.typed = {"--aa"};
    options.shot.picture.antiAliasing = AntiAliasing::Box;
    EXPECT_EQ(loadMember(file, options).picture.antiAliasing, AntiAliasing::Box);
}

const std::vector<std::string> kMethods = {"sharp", "gather", "hybrid"};
const std::vector<std::string> kViews = {"motion", "tiles"};

class Hotkeys : public testing::Test {
  protected:
    PanelRequests press(std::initializer_list<Key> keys, double speed = 1.0) {
        app::InputCollector input;
        for (const Key key : keys)
            input.setKey(key, true);
        return applyHotkeys(input.take(), {kMethods, kViews}, speed, settings);
    }

    PlaySettings settings;
};

TEST_F(Hotkeys, MNAndVGoThroughMethodsAndViewsAndRound) {
    settings.method = "sharp";
    std::vector<std::string> seen;
    for (int i = 0; i < 3; ++i) {
        press({Key::M});
        seen.push_back(settings.method);
    }
    EXPECT_EQ(seen, (std::vector<std::string>{"gather", "hybrid", "sharp"}));
    press({Key::Shift, Key::M});
    EXPECT_EQ(settings.method, "hybrid");
    settings.method = "gone";
    press({Key::M});
    EXPECT_EQ(settings.method, "sharp");
    settings.leftMethod = "sharp";
    press({Key::N, Key::X});
    EXPECT_EQ(settings.leftMethod, "gather");
    EXPECT_TRUE(settings.split);
    EXPECT_EQ(settings.method, "sharp") << "the left side has a method of its own";
    std::vector<std::string> views;
    for (int i = 0; i < 3; ++i) {
        press({Key::V});
        views.push_back(settings.view);
    }
    EXPECT_EQ(views, (std::vector<std::string>{"motion", "tiles", ""}));
    press({Key::Shift, Key::V});
    EXPECT_EQ(settings.view, "tiles");
}

TEST_F(Hotkeys, FFocusesOnTheMiddleAndWithShiftAsTheCameraDoes) {
    const PanelRequests middle = press({Key::F});
    EXPECT_TRUE(middle.focusMiddle);
    EXPECT_FALSE(middle.focusOwn);
    const PanelRequests own = press({Key::Shift, Key::F});
    EXPECT_FALSE(own.focusMiddle);
    EXPECT_TRUE(own.focusOwn);
}

TEST_F(Hotkeys, EachEffectHasAKeyThatSwitchesItAlone) {
    settings.picture.antiAliasing = AntiAliasing::None;
    settings.picture.features.shadows.mode = shadows::ShadowMode::None;
    settings.environment = false;
    settings.picture.bloom.share = 0.0f;
    settings.picture.features.particles.areShown = false;
    press({Key::Digit6});
    EXPECT_EQ(settings.picture.antiAliasing, AntiAliasing::Taa);
    EXPECT_EQ(describeEffects(settings), "taa");
    press({Key::Digit6});
    EXPECT_EQ(describeEffects(settings), "");
    std::vector<std::string> seen;
    for (int i = 0; i < 3; ++i) {
        press({Key::Digit7});
        seen.push_back(describeEffects(settings));
    }
    EXPECT_EQ(seen, (std::vector<std::string>{"sharp shadows", "blurred shadows", ""}));
    press({Key::Digit8});
    EXPECT_EQ(describeEffects(settings), "sky");
    press({Key::Digit8, Key::Digit9});
    EXPECT_EQ(describeEffects(settings), "bloom");
    press({Key::Digit9});
    EXPECT_EQ(describeEffects(settings), "");
    press({Key::Digit0});
    EXPECT_EQ(describeEffects(settings), "particles");
}

TEST_F(Hotkeys, KeysOfSpeedPresetsAndReducedMotionChangeTheirSettingsAlone) {
    EXPECT_EQ(press({Key::Comma}, 1.0).speed, 0.5);
    EXPECT_EQ(press({Key::Comma}, 0.05).speed, 0.05);
    EXPECT_EQ(press({Key::Slash}, 0.3).speed, 0.5);
    EXPECT_EQ(press({Key::Slash}, 1.0).speed, 1.0);
    EXPECT_FALSE(press({}).speed);
    const auto presets = listPresets();
    ASSERT_EQ(presets.size(), 5u);
    press({Key::Digit1});
    EXPECT_EQ(settings.method, presets[0].method);
    press({Key::Digit5});
    EXPECT_EQ(settings.method, presets[4].method);
    press({Key::B});
    EXPECT_EQ(settings.cameraBlurScale, 0.0);
    EXPECT_EQ(makeShutter(settings).cameraRotationScale, 0.0);
    EXPECT_EQ(makeShutter(settings).cameraTranslationScale, 0.0);
    EXPECT_EQ(makeShutter(settings).objectScale, 1.0);
    press({Key::B});
    EXPECT_EQ(settings.cameraBlurScale, 1.0);
}

TEST_F(Hotkeys, KeysOtherThanSettingsAreRequests) {
    EXPECT_TRUE(press({Key::P}).togglePause);
    EXPECT_TRUE(press({Key::Period}).singleStep);
    EXPECT_TRUE(press({Key::R}).toggleRecording);
    EXPECT_TRUE(press({Key::F2}).savePicture);
    EXPECT_TRUE(press({Key::F5}).save);
    EXPECT_TRUE(press({Key::F9}).load);
    EXPECT_TRUE(press({Key::F11}).toggleFullScreen);
    EXPECT_TRUE(press({Key::Escape}).quit);
    const PanelRequests none = press({});
    EXPECT_FALSE(none.quit || none.save || none.load || none.togglePause || none.singleStep);
}

TEST_F(Hotkeys, AKeyThatChangesNothingOnTheScreenIsExplained) {
    const auto explain = [&](Key key, const KeyFacts& facts) {
        app::InputCollector input;
        input.setKey(key, true);
        return explainIdleKeys(input.take(), facts, settings);
    };
    const KeyFacts plays{.speed = 0.5};
    settings.split = true;
    for (const Key key :
         {Key::M,
          Key::N,
          Key::V,
          Key::C,
          Key::E,
          Key::B,
          Key::Digit6,
          Key::Digit8,
          Key::Digit0,
          Key::Comma,
          Key::Slash})
        EXPECT_EQ(explain(key, plays), "") << int(key);
    KeyFacts rests = plays;
    rests.stageRests = true;
    EXPECT_NE(explain(Key::C, rests), "");
    EXPECT_EQ(explain(Key::M, rests), "");
    settings.split = false;
    settings.leftMethod = "gather";
    EXPECT_EQ(explain(Key::N, plays), "left of a split: gather; X shows it");
    KeyFacts photo = rests;
    photo.photoMethod = "truth";
    for (const Key key : {Key::M, Key::V, Key::C})
        EXPECT_EQ(explain(key, photo), "photo mode draws one picture by truth; T ends it");
    EXPECT_EQ(explain(Key::Digit6, photo), "truth has smooth edges without help");
    EXPECT_EQ(explain(Key::Digit3, photo), explain(Key::M, photo)) << "a preset is a method";
    EXPECT_EQ(explain(Key::Digit3, plays), "");
    EXPECT_EQ(explain(Key::W, plays), "");
    KeyFacts fixed = plays;
    fixed.isCameraFixed = true;
    for (const Key key : {Key::W, Key::Q, Key::E})
        EXPECT_EQ(
            explain(key, fixed), "this camera is the scene's; C goes on to one that you move"
        );
    EXPECT_EQ(explain(Key::C, fixed), "");
    fixed.photoMethod = "truth"; // whose camera flies
    EXPECT_EQ(explain(Key::W, fixed), "");
    settings.method = "sharp";
    EXPECT_NE(explain(Key::B, plays), "");
    KeyFacts bare{.speed = 1.0};
    for (const EffectSwitch& effect : listEffectSwitches())
        bare.idleEffects.push_back(effect.explainIdle ? effect.explainIdle(scene::World()) : "");
    EXPECT_EQ(explain(Key::Digit8, bare), "the scene has no sky; --sky adds one");
    EXPECT_EQ(explain(Key::Digit0, bare), "the scene has no particles");
    EXPECT_NE(explain(Key::Slash, bare), "");
    EXPECT_EQ(explain(Key::Comma, bare), "");
}

TEST(DemoKeys, AControlWithoutWordsHasNoRowInTheHelp) {
    const auto join = [](const DemoControlWords& words) {
        std::string keys;
        for (const KeyHelp& key : listDemoKeys(words))
            keys += fmt::format("{}: {}; ", key.key, key.what);
        return keys;
    };
    EXPECT_EQ(join({"steer", "", "", ""}), "A D: steer; C: next camera; ");
    EXPECT_EQ(
        join({"", "drive", "brake", "car"}),
        "W S: drive; Space: brake; C: next camera; E: car in or out of the blur; "
    );
}

TEST(Hints, TheKeysAreShownFromTheFirstPictureAndASlowFrameDoesNotUseThemUp) {
    EXPECT_EQ(countHintDown(30.0, 20.0, false), 30.0);
    EXPECT_EQ(countHintDown(30.0, 60.0, true), 29.75);
    EXPECT_EQ(countHintDown(30.0, 0.125, true), 29.875);
    EXPECT_EQ(countHintDown(0.1, 1.0, true), 0.0);
}

TEST(FirstUse, APictureBeforeNewShadersAnnouncesThemAndIsDrawnWithKnownOnes) {
    FirstUse use;
    PlaySettings wanted; // resolved and all effects
    EXPECT_EQ(use.notice(), "compiling shaders");
    const PlaySettings first = use.choose(wanted);
    EXPECT_EQ(first.method, "sharp");
    EXPECT_EQ(describeEffects(first), "sky, particles");
    EXPECT_EQ(use.notice(), "");
    EXPECT_EQ(use.choose(wanted).method, "resolved");
    wanted.method = "hybrid";
    wanted.resolutionScale = 0.5;
    PlaySettings drawn = use.choose(wanted);
    EXPECT_EQ(drawn.method, "resolved");
    EXPECT_EQ(drawn.resolutionScale, 0.5) << "it compiles nothing";
    EXPECT_EQ(use.notice(), "compiling shaders of hybrid");
    EXPECT_EQ(use.choose(wanted).method, "resolved") << "the picture with the notice";
    EXPECT_EQ(use.notice(), "");
    EXPECT_EQ(use.choose(wanted).method, "hybrid");
    wanted.method = "resolved";
    EXPECT_EQ(use.choose(wanted).method, "resolved") << "it was drawn before";
    EXPECT_EQ(use.notice(), "");
}

TEST(NumberedFile, TheFirstFreeNumberIsTakenAndItsAbsenceIsReported) {
    const test::TempFolder temporary;
    const fs::path& folder = temporary.path();
    const auto take = [&] {
        auto file = findFreeFile(folder, "rally_truth", ".png");
        if (file)
            std::ofstream(file.value()) << "x";
        return file;
    };
    EXPECT_EQ(take().value().filename(), "rally_truth_001.png");
    EXPECT_EQ(take().value().filename(), "rally_truth_002.png");
    const fs::path soon[] = {folder / "rally_truth_003.png"};
    EXPECT_EQ(
        findFreeFile(folder, "rally_truth", ".png", soon).value().filename(), "rally_truth_004.png"
    );
    fs::remove(folder / "rally_truth_001.png");
    EXPECT_EQ(take().value().filename(), "rally_truth_001.png");
    for (int i = 3; i <= 999; ++i)
        ASSERT_TRUE(take()) << i;
    test::expectRefused(take(), "999 files rally_truth_NNN.png");
}

} // namespace
} // namespace shutter::game
