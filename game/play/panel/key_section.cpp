// SPDX-License-Identifier: MIT
#include "game/play/panel/effect_switches.h"
#include "game/play/panel/panel_sections.h"

#include <fmt/format.h>

#include <array>
#include <imgui.h>
#include <string>

namespace shutter::game {

namespace {

std::string listEffects() {
    std::string words;
    for (const EffectSwitch& effect : listEffectSwitches())
        words += fmt::format("{}{}", words.empty() ? "" : ", ", effect.words);
    return words;
}

const std::array<KeyHelp, 7> kCommonKeys = {{
    {"M", "method"},
    {"X", "compare"},
    {"1-5", "presets"},
    {"6-0", listEffects()},
    {"P", "pause"},
    {"F1", "settings and all keys"},
    {"Esc", "quit"},
}};

const std::array<KeyHelp, 18> kAllKeys = {{
    {"M, Shift+M", "next, previous method"},
    {"X", "split screen; drag the divider"},
    {"N", "method left of the split"},
    {"1 to 5", "presets: off, performance, balanced, quality, paper"},
    {"6 7 8 9 0", listEffects() + ", on and off"},
    {"B", "blur of the camera's own motion, on and off"},
    {"V, Shift+V", "next, previous intermediate image"},
    {"P", "pause"},
    {".", "one frame on"},
    {",  /", "slower, faster"},
    {"T", "photo mode"},
    {"F, Shift+F", "focus on the middle of the picture, as the camera does"},
    {"F2", "save the picture as a PNG file"},
    {"R", "record the camera's flight"},
    {"F1", "this panel"},
    {"F5, F9", "save, load the settings"},
    {"F11", "full screen"},
    {"Esc", "quit"},
}};

void drawKeys(std::span<const KeyHelp> keys) {
    for (const KeyHelp& one : keys) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(one.key.c_str());
        ImGui::TableNextColumn();
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextUnformatted(one.what.c_str());
        ImGui::PopTextWrapPos();
    }
}

} // namespace

std::span<const KeyHelp> listCommonKeys() {
    return kCommonKeys;
}

void drawKeySection(const PanelFacts& facts) {
    if (!ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg))
        return;
    ImGui::TableSetupColumn("key", ImGuiTableColumnFlags_WidthFixed);
    ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch);
    drawKeys(facts.keys);
    drawKeys(kAllKeys);
    ImGui::EndTable();
}

} // namespace shutter::game
