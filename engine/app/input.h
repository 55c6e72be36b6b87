// SPDX-License-Identifier: MIT
// The player's input, from a window's events or from a script.
#pragma once

#include "engine/math/math.h"

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace shutter::app {

/// Keys by their place on a US keyboard.
// clang-format off
enum class Key : uint8_t {
    A, B, C, D, E, F, G, H, I, J, K, L, M, N, O, P, Q, R, S, T, U, V, W, X, Y, Z,
    Digit0, Digit1, Digit2, Digit3, Digit4, Digit5, Digit6, Digit7, Digit8, Digit9,
    F1, F2, F3, F4, F5, F6, F7, F8, F9, F10, F11, F12,
    Left, Right, Up, Down, Space, Enter, Escape, Tab, Backspace, Delete, Home, End, PageUp, PageDown,
    Shift, Control, Alt, Minus, Equal, Period, Comma, Slash,
    Count,
};
// clang-format on

inline constexpr size_t kKeyCount = static_cast<size_t>(Key::Count);

enum class MouseButton : uint8_t { Left, Right, Middle, Count };

inline constexpr size_t kMouseButtonCount = static_cast<size_t>(MouseButton::Count);

enum class PadButton : uint8_t { A, B, X, Y, LeftBumper, RightBumper, Back, Start, Count };

inline constexpr size_t kPadButtonCount = static_cast<size_t>(PadButton::Count);

/// "a", "7", "f1", "left", "space": names of scripts and of help texts, lower case.
[[nodiscard]] std::string_view nameOf(Key key);
[[nodiscard]] std::optional<Key> findKey(std::string_view name);

/// The first gamepad. Sticks in [-1, 1], right and up positive; at rest exactly 0.
struct Gamepad {
    bool present = false;
    math::dvec2 leftStick{0.0};
    math::dvec2 rightStick{0.0};
    double leftTrigger = 0.0;  ///< [0, 1]
    double rightTrigger = 0.0; ///< [0, 1]
    std::bitset<kPadButtonCount> down;
};

/// Input of one frame.
struct InputState {
    std::bitset<kKeyCount> down;
    std::bitset<kKeyCount> pressed; ///< went down in this frame
    std::bitset<kMouseButtonCount> buttons;
    std::bitset<kMouseButtonCount> clicked; ///< went down in this frame
    math::dvec2 pointerPx{0.0};             ///< framebuffer pixels from the upper left corner
    math::dvec2 pointerMovePx{0.0};         ///< in this frame
    double wheel = 0.0;                     ///< steps in this frame, up is positive
    std::vector<uint32_t> characters;       ///< typed in this frame, Unicode
    Gamepad pad;
    std::bitset<kPadButtonCount> padPressed; ///< went down in this frame

    [[nodiscard]] bool isDown(Key key) const { return down[static_cast<size_t>(key)]; }

    [[nodiscard]] bool wasPressed(Key key) const { return pressed[static_cast<size_t>(key)]; }

    [[nodiscard]] bool isDown(MouseButton button) const {
        return buttons[static_cast<size_t>(button)];
    }

    [[nodiscard]] bool wasClicked(MouseButton button) const {
        return clicked[static_cast<size_t>(button)];
    }

    [[nodiscard]] bool wasPressed(PadButton button) const {
        return padPressed[static_cast<size_t>(button)];
    }
};

/// -1, 0 or 1 of two keys that pull apart.
[[nodiscard]] double axisOf(const InputState& input, Key negative, Key positive);

/// Removes the zone around 0 in which a worn stick rests; continuous outside of that zone.
[[nodiscard]] double applyDeadZone(double value);

/// Takes events as they come and gives out frames of them.
class InputCollector {
  public:
    void setKey(Key key, bool down);
    void setButton(MouseButton button, bool down);
    void movePointer(const math::dvec2& px);
    void turnWheel(double steps);
    void type(uint32_t character);
    void setPad(const Gamepad& pad);
    /// Nothing is held any more: the window lost the keyboard.
    void releaseAll();

    /// The frame since the last call.
    [[nodiscard]] InputState take();

  private:
    InputState mState;
    math::dvec2 mLastPointerPx{0.0};
    std::bitset<kPadButtonCount> mLastPad;
    bool mHasPointer = false;
};

} // namespace shutter::app
