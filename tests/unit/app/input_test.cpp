// SPDX-License-Identifier: MIT
#include "engine/app/input.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

namespace shutter::app {
namespace {

TEST(Input, EveryKeyHasANameOfItsOwn) {
    std::set<std::string_view> names;
    for (size_t i = 0; i < kKeyCount; ++i) {
        const Key key = static_cast<Key>(i);
        EXPECT_FALSE(nameOf(key).empty()) << i;
        EXPECT_EQ(findKey(nameOf(key)), key);
        names.insert(nameOf(key));
    }
    EXPECT_EQ(names.size(), kKeyCount);
    EXPECT_FALSE(findKey("W"));
    EXPECT_FALSE(findKey(""));
}

TEST(Input, AKeyIsPressedInOneFrameAndHeldUntilItIsReleased) {
    InputCollector collector;
    collector.setKey(Key::W, true);
    collector.setKey(Key::W, true); // repeats
    InputState first = collector.take();
    EXPECT_TRUE(first.wasPressed(Key::W));
    EXPECT_TRUE(first.isDown(Key::W));
    const InputState second = collector.take();
    EXPECT_FALSE(second.wasPressed(Key::W));
    EXPECT_TRUE(second.isDown(Key::W));
    collector.setKey(Key::W, false);
    EXPECT_FALSE(collector.take().isDown(Key::W));
}

TEST(Input, ATapWithinAFrameIsSeen) {
    InputCollector collector;
    collector.setKey(Key::M, true);
    collector.setKey(Key::M, false);
    const InputState frame = collector.take();
    EXPECT_TRUE(frame.wasPressed(Key::M));
    EXPECT_FALSE(frame.isDown(Key::M));
}

TEST(Input, WhoLosesTheKeyboardHoldsNothing) {
    InputCollector collector;
    collector.setKey(Key::W, true);
    collector.setButton(MouseButton::Left, true);
    collector.releaseAll();
    const InputState frame = collector.take();
    EXPECT_TRUE(frame.down.none());
    EXPECT_TRUE(frame.buttons.none());
}

TEST(Input, ThePointerMovesFromWhereItWasAndNotFromTheCorner) {
    InputCollector collector;
    collector.movePointer({300.0, 200.0});
    EXPECT_EQ(collector.take().pointerMovePx, math::dvec2(0.0));
    collector.movePointer({310.0, 195.0});
    collector.movePointer({320.0, 190.0});
    EXPECT_EQ(collector.take().pointerMovePx, math::dvec2(20.0, -10.0));
    EXPECT_EQ(collector.take().pointerMovePx, math::dvec2(0.0));
}

TEST(Input, PadButtonsArePressedOnce) {
    InputCollector collector;
    Gamepad pad;
    pad.present = true;
    pad.down.set(static_cast<size_t>(PadButton::A));
    collector.setPad(pad);
    EXPECT_TRUE(collector.take().wasPressed(PadButton::A));
    collector.setPad(pad);
    EXPECT_FALSE(collector.take().wasPressed(PadButton::A));
}

TEST(Input, ASticksRestIsZeroAndItsEndIsOne) {
    EXPECT_EQ(applyDeadZone(0.11), 0.0);
    EXPECT_EQ(applyDeadZone(-0.12), 0.0);
    EXPECT_NEAR(applyDeadZone(0.1201), 0.0, 1e-3);
    EXPECT_EQ(applyDeadZone(1.0), 1.0);
    EXPECT_EQ(applyDeadZone(-1.2), -1.0);
    EXPECT_EQ(applyDeadZone(std::numeric_limits<double>::quiet_NaN()), 0.0);
}

TEST(Input, KeysThatPullApartCancel) {
    InputCollector collector;
    collector.setKey(Key::A, true);
    EXPECT_EQ(axisOf(collector.take(), Key::A, Key::D), -1.0);
    collector.setKey(Key::D, true);
    EXPECT_EQ(axisOf(collector.take(), Key::A, Key::D), 0.0);
}

} // namespace
} // namespace shutter::app
