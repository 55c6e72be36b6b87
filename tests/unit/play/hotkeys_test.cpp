// SPDX-License-Identifier: MIT
#include "game/play/loop/hotkeys.h"
#include "game/play/panel/panel_sections.h"

#include <gtest/gtest.h>

#include <initializer_list>

namespace shutter::game {
namespace {

using app::Key;

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

TEST_F(Hotkeys, MGoesThroughEveryMethodAndRound) {
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
}

TEST_F(Hotkeys, TheLeftSideHasAMethodOfItsOwn) {
    settings.leftMethod = "sharp";
    press({Key::N, Key::X});
    EXPECT_EQ(settings.leftMethod, "gather");
    EXPECT_TRUE(settings.split);
    EXPECT_EQ(settings.method, PlaySettings().method);
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
    settings.picture.shadows.mode = extract::ShadowMode::None;
    settings.environment = false;
    settings.picture.bloom.share = 0.0f;
    settings.picture.particles = false;
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

TEST_F(Hotkeys, ViewsComeBackToThePicture) {
    std::vector<std::string> seen;
    for (int i = 0; i < 3; ++i) {
        press({Key::V});
        seen.push_back(settings.view);
    }
    EXPECT_EQ(seen, (std::vector<std::string>{"motion", "tiles", ""}));
    press({Key::Shift, Key::V});
    EXPECT_EQ(settings.view, "tiles");
}

TEST_F(Hotkeys, ReducedMotionTakesTheCamerasBlurAlone) {
    press({Key::B});
    EXPECT_EQ(settings.cameraBlurScale, 0.0);
    EXPECT_EQ(makeShutter(settings).cameraRotationScale, 0.0);
    EXPECT_EQ(makeShutter(settings).cameraTranslationScale, 0.0);
    EXPECT_EQ(makeShutter(settings).objectScale, 1.0);
    press({Key::B});
    EXPECT_EQ(settings.cameraBlurScale, 1.0);
}

TEST_F(Hotkeys, SpeedGoesByStepsAndStopsAtTheEnds) {
    EXPECT_EQ(press({Key::Comma}, 1.0).speed, 0.5);
    EXPECT_EQ(press({Key::Comma}, 0.05).speed, 0.05);
    EXPECT_EQ(press({Key::Slash}, 0.3).speed, 0.5);
    EXPECT_EQ(press({Key::Slash}, 1.0).speed, 1.0);
    EXPECT_FALSE(press({}).speed);
}

TEST_F(Hotkeys, NumbersAreThePresets) {
    const auto presets = listPresets();
    ASSERT_EQ(presets.size(), 5u);
    press({Key::Digit1});
    EXPECT_EQ(settings.method, presets[0].method);
    press({Key::Digit5});
    EXPECT_EQ(settings.method, presets[4].method);
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

} // namespace
} // namespace shutter::game
