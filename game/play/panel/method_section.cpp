// SPDX-License-Identifier: MIT
#include "engine/core/check.h"
#include "engine/scene/lens.h"
#include "game/play/panel/effect_switches.h"
#include "game/play/panel/panel_sections.h"
#include "game/play/panel/play_settings.h"
#include "game/play/panel/setting_widgets.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/settings.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>
#include <set>

namespace shutter::game {

namespace {

constexpr double kSlowest = 1.0 / 64.0;
constexpr double kFastest = 1.0;
/// Metres, from which a focus distance is called infinite.
constexpr double kFar = 1.0e6;

/// Buttons in a row, wrapped at the panel's edge.
class ButtonRow {
  public:
    bool add(const char* text, const char* tooltip, bool enabled = true) {
        const ImGuiStyle& style = ImGui::GetStyle();
        const float width = ImGui::CalcTextSize(text).x + 2.0f * style.FramePadding.x;
        if (!mIsFirst) {
            ImGui::SameLine();
            if (ImGui::GetContentRegionAvail().x < width)
                ImGui::NewLine();
        }
        mIsFirst = false;
        ImGui::BeginDisabled(!enabled);
        const bool pressed = ImGui::Button(text);
        ImGui::EndDisabled();
        drawTooltip(tooltip);
        return pressed;
    }

  private:
    bool mIsFirst = true;
};

bool hasName(std::span<const std::string> names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// A combo box of names. \param none what an empty choice is called; null: there is none
void drawNames(
    const char* label,
    std::span<const std::string> names,
    const char* none,
    const char* tooltip,
    std::string& chosen
) {
    ImGui::SetNextItemWidth(24.0f * ImGui::CalcTextSize("0").x);
    if (ImGui::BeginCombo(label, chosen.empty() && none ? none : chosen.c_str())) {
        if (none && ImGui::Selectable(none, chosen.empty()))
            chosen.clear();
        for (const std::string& name : names)
            if (ImGui::Selectable(name.c_str(), name == chosen))
                chosen = name;
        ImGui::EndCombo();
    }
    drawTooltip(tooltip);
}

void drawMethod(const char* label, std::span<const std::string> names, std::string& method) {
    drawNames(label, names, nullptr, "Key M; left of a split key N.", method);
    if (const auto info = findMethod(method)) {
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextDisabled("%s", info.value()->description);
        ImGui::PopTextWrapPos();
    }
}

/// Rows of PlaySettings by name.
void drawPlayRows(const char* id, PlaySettings& settings, std::span<const std::string_view> names) {
    static const PlaySettings kDefaults;
    if (names.empty() || !beginRows(id))
        return;
    for (const std::string_view name : names)
        drawRow(core::getRow(listPlayRows(), name), settings, kDefaults);
    endRows();
}

/// The budget, and the quality that it dropped.
void drawBudget(const PanelFacts& facts, PlaySettings& settings) {
    drawRows("budget", motion_blur::listBudgetRows(), settings.budget);
    drawPlayRows("budget share", settings, std::vector<std::string_view>{"budgetShare"});
    if (!facts.right || !isReduced(*facts.right))
        return;
    if (const auto* reason = render::findDecision(facts.right->explanations, "blur budget")) {
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextUnformatted(reason->reason.c_str());
        ImGui::PopTextWrapPos();
    }
}

/// Methods on the screen.
std::vector<const MethodInfo*> listShown(const PlaySettings& settings) {
    std::vector<const MethodInfo*> shown;
    if (const auto right = findMethod(settings.method))
        shown.push_back(right.value());
    if (const auto left = findMethod(settings.leftMethod); left && settings.split)
        shown.push_back(left.value());
    return shown;
}

std::string describeLens(const scene::CameraLens& lens) {
    return fmt::format(
        "f/{:.3g}, focused at {}",
        lens.fStop,
        lens.focusDistance >= kFar ? "infinity" : fmt::format("{:.4g} m", lens.focusDistance)
    );
}

/// Counts that are not of the blur's settings.
std::vector<std::string_view> listCounts(std::span<const MethodInfo* const> shown) {
    std::vector<std::string_view> names;
    for (const MethodInfo* method : shown) {
        std::string_view name;
        if (method->family == MethodFamily::Accumulate)
            name = "instants";
        else if (method->family == MethodFamily::Truth)
            name = "rays";
        else if (method->sampleUnit == SampleUnit::Rays)
            name = "denoisedRays";
        if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end())
            names.push_back(name);
    }
    return names;
}

} // namespace

std::vector<std::string_view> listReadSettings(const MethodInfo& method) {
    if (!method.blur)
        return {};
    std::vector<std::string_view> names = method.blur->settings;
    if (method.sampleUnit != SampleUnit::Rays)
        names.emplace_back("sampleCount");
    return names;
}

void drawPlaySection(const PanelFacts& facts, PanelRequests& requests) {
    ButtonRow buttons;
    requests.togglePause = buttons.add(facts.paused ? "Continue" : "Pause", "Key P.");
    requests.togglePhoto = buttons.add(
        facts.photo ? "End photo" : "Photo",
        "Pause, fly the camera freely, and trace the picture until it is the truth. Key T."
    );
    requests.savePicture =
        buttons.add("Save picture", "The picture without this panel as a PNG file. Key F2.");
    requests.singleStep = buttons.add("Step", "One frame on, and pause. Key period.");
    requests.toggleRecording = buttons.add(
        facts.recording ? "Stop recording" : "Record", "The camera's way as a flythrough. Key R."
    );
    requests.toggleFullScreen = buttons.add("Full screen", "Key F11.");
    requests.save = buttons.add("Save settings", "Keep all settings for the next time. Key F5.");
    requests.load = buttons.add("Load settings", "The settings that were kept. Key F9.");
    requests.quit = buttons.add("Quit", "Key Escape.");
    double speed = std::isnan(facts.speed) ? 1.0 : std::clamp(facts.speed, kSlowest, kFastest);
    ImGui::SetNextItemWidth(24.0f * ImGui::CalcTextSize("0").x);
    const bool moved = ImGui::SliderScalar(
        "Speed",
        ImGuiDataType_Double,
        &speed,
        &kSlowest,
        &kFastest,
        "%.3g x",
        ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp
    );
    if (moved && std::isfinite(speed))
        requests.speed = std::clamp(speed, kSlowest, kFastest);
    drawTooltip("Of the world's time. Range: 1/64 to 1. Keys comma and slash.");
}

void drawPictureSection(const PanelFacts& facts, PlaySettings& settings) {
    drawNames(
        "View",
        facts.views,
        "picture",
        "An intermediate in the picture's place. Key V.",
        settings.view
    );
    drawPlayRows(
        "display", settings, std::vector<std::string_view>{"resolutionScale", "vsync", "uiScale"}
    );
}

void drawEffectSection(PlaySettings& settings) {
    static const PlaySettings kFresh;
    if (beginRows("effects")) {
        drawRow(core::getRow(listPlayRows(), "environment"), settings, kFresh);
        visitPictureRows([&](auto rows, const auto& part) {
            for (const auto& row : rows)
                drawRow(row, part(settings.picture), part(kFresh.picture));
        });
        endRows();
    }
    ButtonRow buttons;
    if (buttons.add("All", "All effects besides the blur, as a new player has them."))
        for (const EffectSwitch& effect : listEffectSwitches())
            effect.copy(kFresh, settings);
    if (buttons.add("None", "No effect besides the blur."))
        for (const EffectSwitch& effect : listEffectSwitches())
            effect.turnOff(settings);
}

void drawMethodSection(const PanelFacts& facts, PlaySettings& settings) {
    ImGui::TextUnformatted("Presets, keys 1 to 5");
    ButtonRow buttons;
    for (const Preset& preset : listPresets()) {
        const bool canRun = hasName(facts.methods, preset.method);
        const bool isOn = isApplied(preset, settings);
        if (isOn)
            ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
        const std::string tooltip = fmt::format(
            "{}: {}", preset.method, canRun ? preset.description : "not on this device"
        );
        if (buttons.add(preset.name, tooltip.c_str(), canRun))
            applyPreset(preset, settings);
        if (isOn)
            ImGui::PopStyleColor();
    }
    drawMethod(settings.split ? "Right method" : "Method", facts.methods, settings.method);
    if (settings.split)
        drawMethod("Left method", facts.methods, settings.leftMethod);
    drawPlayRows("split", settings, std::vector<std::string_view>{"split", "dividerShare"});
}

void drawLensSection(const PanelFacts& facts, PlaySettings& settings, PanelRequests& requests) {
    if (facts.lens.fStop == 0.0)
        ImGui::TextDisabled("The camera is a pinhole: all is sharp.");
    else
        ImGui::TextUnformatted(describeLens(facts.lens).c_str());
    const std::vector<const MethodInfo*> shown = listShown(settings);
    if (std::none_of(shown.begin(), shown.end(), [](const auto* m) { return m->hasLens; }))
        ImGui::TextDisabled("The method on the screen draws pinholes.");
    drawPlayRows("depth of field", settings, std::vector<std::string_view>{"depthOfField"});
    drawRows("lens", scene::listOverrideRows(), settings.lens);
    ButtonRow buttons;
    requests.focusMiddle = buttons.add(
        "Focus on the middle", "On the surface that is in the middle of the picture. Key F."
    );
    requests.focusOwn =
        buttons.add("Camera's focus", "The camera's own focus again. Keys Shift and F.");
}

void drawReducedMotionSection(PlaySettings& settings) {
    drawPlayRows("reduced", settings, std::vector<std::string_view>{"cameraBlurScale"});
}

void drawSettingSection(const PanelFacts& facts, PlaySettings& settings) {
    const std::vector<const MethodInfo*> shown = listShown(settings);
    std::set<std::string_view> read;
    for (const MethodInfo* method : shown)
        for (const std::string_view name : listReadSettings(*method))
            read.insert(name);
    drawPlayRows("counts", settings, listCounts(shown));
    static const motion_blur::MotionBlurSettings kDefaults;
    const auto draw = [&](const char* id, bool wanted) {
        if (!beginRows(id))
            return;
        for (const auto& row : motion_blur::listSettingRows())
            if (read.contains(row.name) == wanted)
                drawRow(row, settings.blur, kDefaults);
        endRows();
    };
    if (read.empty())
        ImGui::TextDisabled("The method on the screen reads none of them.");
    else
        draw("read", true);
    if (!read.empty())
        drawBudget(facts, settings);
    if (read.size() == motion_blur::listSettingRows().size() ||
        !ImGui::TreeNode("Of other methods"))
        return;
    ImGui::BeginDisabled();
    draw("unread", false);
    ImGui::EndDisabled();
    ImGui::TreePop();
}

} // namespace shutter::game
