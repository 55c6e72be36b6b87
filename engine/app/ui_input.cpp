// SPDX-License-Identifier: MIT
#include "engine/app/ui.h"

#include <imgui.h>
#include <utility>

namespace shutter::app {

namespace {

/// Keys that widgets and text fields read; the game's own keys are none of ImGui's business.
constexpr std::pair<Key, ImGuiKey> kKeys[] = {
    {Key::Tab, ImGuiKey_Tab},
    {Key::Left, ImGuiKey_LeftArrow},
    {Key::Right, ImGuiKey_RightArrow},
    {Key::Up, ImGuiKey_UpArrow},
    {Key::Down, ImGuiKey_DownArrow},
    {Key::PageUp, ImGuiKey_PageUp},
    {Key::PageDown, ImGuiKey_PageDown},
    {Key::Home, ImGuiKey_Home},
    {Key::End, ImGuiKey_End},
    {Key::Delete, ImGuiKey_Delete},
    {Key::Backspace, ImGuiKey_Backspace},
    {Key::Space, ImGuiKey_Space},
    {Key::Enter, ImGuiKey_Enter},
    {Key::Escape, ImGuiKey_Escape},
    {Key::A, ImGuiKey_A},
    {Key::C, ImGuiKey_C},
    {Key::V, ImGuiKey_V},
    {Key::X, ImGuiKey_X},
    {Key::Y, ImGuiKey_Y},
    {Key::Z, ImGuiKey_Z},
};

bool isHeld(const InputState& input, Key key) {
    return input.isDown(key) || input.wasPressed(key);
}

bool isHeld(const InputState& input, MouseButton button) {
    const auto index = static_cast<size_t>(button);
    return input.buttons[index] || input.clicked[index];
}

// ImGui's order of buttons.
constexpr MouseButton kUiButtons[] = {MouseButton::Left, MouseButton::Right, MouseButton::Middle};

} // namespace

// From 1.87 on ImGui takes events; before, it reads arrays that its host writes.
#if IMGUI_VERSION_NUM >= 18700

void mapKeys() {
    // A frame's input is that frame's: none of it is put off to the next.
    ImGui::GetIO().ConfigInputTrickleEventQueue = false;
}

void feedInput(const InputState& input) {
#if IMGUI_VERSION_NUM >= 18900
    constexpr ImGuiKey kShift = ImGuiMod_Shift;
    constexpr ImGuiKey kControl = ImGuiMod_Ctrl;
    constexpr ImGuiKey kAlt = ImGuiMod_Alt;
#else
    constexpr ImGuiKey kShift = ImGuiKey_ModShift;
    constexpr ImGuiKey kControl = ImGuiKey_ModCtrl;
    constexpr ImGuiKey kAlt = ImGuiKey_ModAlt;
#endif
    ImGuiIO& io = ImGui::GetIO();
    io.AddMousePosEvent(
        static_cast<float>(input.pointerPx.x), static_cast<float>(input.pointerPx.y)
    );
    for (int i = 0; i < 3; ++i)
        io.AddMouseButtonEvent(i, isHeld(input, kUiButtons[i]));
    if (input.wheel != 0.0)
        io.AddMouseWheelEvent(0.0f, static_cast<float>(input.wheel));
    io.AddKeyEvent(kShift, isHeld(input, Key::Shift));
    io.AddKeyEvent(kControl, isHeld(input, Key::Control));
    io.AddKeyEvent(kAlt, isHeld(input, Key::Alt));
    for (const auto& [key, theirs] : kKeys)
        io.AddKeyEvent(theirs, isHeld(input, key));
    for (const uint32_t character : input.characters)
        io.AddInputCharacter(character);
}

#else

void mapKeys() {
    ImGuiIO& io = ImGui::GetIO();
    for (const auto& [key, theirs] : kKeys)
        io.KeyMap[theirs] = static_cast<int>(key);
}

void feedInput(const InputState& input) {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {static_cast<float>(input.pointerPx.x), static_cast<float>(input.pointerPx.y)};
    for (int i = 0; i < 3; ++i)
        io.MouseDown[i] = isHeld(input, kUiButtons[i]);
    io.MouseWheel += static_cast<float>(input.wheel);
    io.KeyShift = isHeld(input, Key::Shift);
    io.KeyCtrl = isHeld(input, Key::Control);
    io.KeyAlt = isHeld(input, Key::Alt);
    for (const auto& row : kKeys)
        io.KeysDown[static_cast<size_t>(row.first)] = isHeld(input, row.first);
    for (const uint32_t character : input.characters)
        io.AddInputCharacter(character);
}

#endif

} // namespace shutter::app
