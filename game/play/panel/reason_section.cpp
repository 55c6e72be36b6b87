// SPDX-License-Identifier: MIT
#include "game/play/panel/panel_sections.h"

#include <imgui.h>

namespace shutter::game {

namespace {

std::optional<uint64_t> findCounter(const render::FrameStatistics& statistics, const char* name) {
    const auto found = statistics.counters.find(name);
    if (found == statistics.counters.end())
        return std::nullopt;
    return found->second;
}

void drawShare(const char* name, uint64_t count, uint64_t whole) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(name);
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(fmt::format("{}", count).c_str());
    ImGui::TableNextColumn();
    if (whole > 0)
        ImGui::TextUnformatted(
            fmt::format("{:.1f} %", 100.0 * double(count) / double(whole)).c_str()
        );
}

/// Blocks of the picture by their class, and pixels and rays, each as a share of its whole.
void drawCounters(const render::FrameStatistics& statistics, const math::uvec2& pictureSize) {
    if (!ImGui::BeginTable("counters", 3, ImGuiTableFlags_SizingFixedFit))
        return;
    const uint64_t pixels = uint64_t(pictureSize.x) * pictureSize.y;
    for (const char* name : {"pixels masked", "rays traced"})
        if (const auto count = findCounter(statistics, name))
            drawShare(name, *count, pixels);
    for (const char* name : {"rays per pixel", "crowded tiles"})
        if (const auto count = findCounter(statistics, name))
            drawShare(name, *count, 0);
    constexpr const char* kBlocks[] = {
        "blocks still", "blocks uniform", "blocks mixed", "blocks masked"};
    uint64_t blocks = 0;
    for (const char* name : kBlocks)
        blocks += findCounter(statistics, name).value_or(0);
    for (const char* name : kBlocks)
        if (const auto count = findCounter(statistics, name))
            drawShare(name, *count, blocks);
    ImGui::EndTable();
}

void drawReasons(const render::FrameStatistics& statistics) {
    if (!ImGui::BeginTable("reasons", 3, ImGuiTableFlags_SizingFixedFit))
        return;
    ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthFixed);
    ImGui::TableSetupColumn("ran", ImGuiTableColumnFlags_WidthFixed);
    ImGui::TableSetupColumn("because", ImGuiTableColumnFlags_WidthStretch);
    for (const render::Explanation& one : statistics.explanations) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        // Greyed, not disabled: a reason is there to be read.
        const ImGuiCol color = one.decision.run ? ImGuiCol_Text : ImGuiCol_TextDisabled;
        ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(color));
        ImGui::TextUnformatted(fmt::format("{} {}", render::describe(one.kind), one.subject).c_str()
        );
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(one.decision.run ? "ran" : "skipped");
        ImGui::TableNextColumn();
        ImGui::PushTextWrapPos(0.0f);
        ImGui::TextUnformatted(one.decision.reason.c_str());
        ImGui::PopTextWrapPos();
        ImGui::PopStyleColor();
    }
    ImGui::EndTable();
}

void drawSide(
    const char* title, const render::FrameStatistics* statistics, const math::uvec2& pictureSize
) {
    if (!statistics)
        return;
    ImGui::PushID(title);
    ImGui::TextUnformatted(title);
    drawCounters(*statistics, pictureSize);
    drawReasons(*statistics);
    ImGui::PopID();
}

} // namespace

void drawReasonSection(const PanelFacts& facts) {
    if (!facts.right && !facts.left)
        ImGui::TextDisabled("No frame is finished yet.");
    drawSide(facts.left ? "Right side" : "The picture", facts.right, facts.pictureSize);
    drawSide("Left side", facts.left, facts.pictureSize);
}

} // namespace shutter::game
