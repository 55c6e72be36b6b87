// SPDX-License-Identifier: MIT
#include "game/play/panel/panel.h"

#include "engine/core/check.h"
#include "game/play/panel/panel_sections.h"

#include <algorithm>
#include <imgui.h>

namespace shutter::game {

namespace {

/// In characters of the font.
constexpr float kPanelWidth = 46.0f;

/// At the right edge, between what the head-up display has there.
bool beginPanel(const PanelFacts& facts, const HudSpace& space) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    const float width =
        std::min(kPanelWidth * ImGui::CalcTextSize("0").x, std::max(0.6f * window.x, 1.0f));
    const float height = std::max(window.y - space.top - space.bottom, 1.0f);
    ImGui::SetNextWindowPos({window.x - width, space.top});
    ImGui::SetNextWindowSize({width, height});
    return ImGui::Begin(
        (facts.title + "###panel").c_str(),
        nullptr,
        ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
            ImGuiWindowFlags_NoSavedSettings
    );
}

bool unfold(const char* title, bool open) {
    return ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

} // namespace

PanelRequests Panel::draw(const PanelFacts& facts, PlaySettings& settings) {
    PanelRequests requests;
    if (facts.right)
        mHistory.add(*facts.right);
    const HudSpace space = drawHud(facts, settings);
    if (!settings.showPanel)
        return requests;
    if (beginPanel(facts, space)) {
        if (unfold("Play", true))
            drawPlaySection(facts, requests);
        if (unfold("Method", true))
            drawMethodSection(facts, settings);
        if (unfold("Effects", true))
            drawEffectSection(settings);
        if (unfold("Picture", false))
            drawPictureSection(facts, settings);
        if (unfold("Depth of field", false))
            drawLensSection(facts, settings, requests);
        if (unfold("Reduced motion", false))
            drawReducedMotionSection(settings);
        if (unfold("Settings of the blur", false))
            drawSettingSection(facts, settings);
        if (unfold("Shutter", false))
            drawShutterSection(facts, settings);
        if (unfold("Times of passes", false))
            drawTimeSection(mHistory, settings);
        if (unfold("Why", false))
            drawReasonSection(facts);
        if (unfold("Keys", false))
            drawKeySection(facts);
    }
    ImGui::End();
    const core::Status valid = validate(settings);
    SHUTTER_CHECK(
        valid.ok(), "the panel made settings that are invalid: {}", valid.error().message
    );
    return requests;
}

} // namespace shutter::game
