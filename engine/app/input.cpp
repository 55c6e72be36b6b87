// SPDX-License-Identifier: MIT
#include "engine/app/input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace shutter::app {

namespace {

/// By Key.
// clang-format off
constexpr std::array<std::string_view, kKeyCount> kNames = {
    "a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m", "n", "o", "p", "q", "r", "s",
    "t", "u", "v", "w", "x", "y", "z",
    "0", "1", "2", "3", "4", "5", "6", "7", "8", "9",
    "f1", "f2", "f3", "f4", "f5", "f6", "f7", "f8", "f9", "f10", "f11", "f12",
    "left", "right", "up", "down", "space", "enter", "escape", "tab", "backspace", "delete", "home",
    "end", "page_up", "page_down",
    "shift", "control", "alt", "minus", "equal", "period", "comma", "slash",
};
// clang-format on

constexpr double kDeadZone = 0.12;

} // namespace

std::string_view nameOf(Key key) {
    return kNames.at(static_cast<size_t>(key));
}

std::optional<Key> findKey(std::string_view name) {
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end())
        return std::nullopt;
    return static_cast<Key>(found - kNames.begin());
}

double axisOf(const InputState& input, Key negative, Key positive) {
    return double(input.isDown(positive)) - double(input.isDown(negative));
}

double applyDeadZone(double value) {
    // Written so that NaN is rest.
    if (!(std::abs(value) > kDeadZone))
        return 0.0;
    return std::copysign(std::min((std::abs(value) - kDeadZone) / (1.0 - kDeadZone), 1.0), value);
}

void InputCollector::setKey(Key key, bool down) {
    const auto index = static_cast<size_t>(key);
    // A key that repeats goes down once.
    if (down && !mState.down[index])
        mState.pressed.set(index);
    mState.down.set(index, down);
}

void InputCollector::setButton(MouseButton button, bool down) {
    const auto index = static_cast<size_t>(button);
    if (down && !mState.buttons[index])
        mState.clicked.set(index);
    mState.buttons.set(index, down);
}

void InputCollector::movePointer(const math::dvec2& px) {
    if (!mHasPointer) // where it was before is not known
        mLastPointerPx = px;
    mHasPointer = true;
    mState.pointerPx = px;
}

void InputCollector::turnWheel(double steps) {
    mState.wheel += steps;
}

void InputCollector::type(uint32_t character) {
    mState.characters.push_back(character);
}

void InputCollector::setPad(const Gamepad& pad) {
    mState.pad = pad;
}

void InputCollector::releaseAll() {
    mState.down.reset();
    mState.buttons.reset();
}

InputState InputCollector::take() {
    mState.pointerMovePx = mState.pointerPx - mLastPointerPx;
    mState.padPressed = mState.pad.down & ~mLastPad;
    InputState taken = mState;
    mLastPointerPx = mState.pointerPx;
    mLastPad = mState.pad.down;
    mState.pressed.reset();
    mState.clicked.reset();
    mState.wheel = 0.0;
    mState.characters.clear();
    return taken;
}

} // namespace shutter::app
