// SPDX-License-Identifier: MIT
#include "game/play/panel/panel_sections.h"
#include "game/shot/methods.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <imgui.h>

namespace shutter::game {

namespace {

constexpr ImU32 kBudgetLine = IM_COL32(255, 255, 255, 140);
constexpr std::array kBudgets = {1000.0f / 60.0f, 1000.0f / 30.0f}; ///< milliseconds

constexpr PassGroup kGroups[] = {
    PassGroup::Scene, PassGroup::Display, PassGroup::Other, PassGroup::Blur};

const char* describe(PassGroup group) {
    switch (group) {
    case PassGroup::Scene:
        return "scene";
    case PassGroup::Blur:
        return "motion blur";
    case PassGroup::Other:
        return "other effects";
    case PassGroup::Display:
        break;
    }
    return "display";
}

/// Stable by name: warm colours are the blur's, blues and greens the scene's,
/// violets those of other effects, greys the display's.
ImU32 colorOf(PassGroup group, std::string_view name) {
    uint32_t hash = 2166136261u; // FNV-1a
    for (const char c : name)
        hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
    const float first = static_cast<float>(hash % 1024u) / 1023.0f;
    const float second = static_cast<float>((hash >> 10) % 1024u) / 1023.0f;
    float hue = -0.08f + 0.24f * first;
    float saturation = 0.85f;
    float darkest = 0.55f;
    if (group == PassGroup::Scene)
        hue = 0.38f + 0.24f * first;
    if (group == PassGroup::Other)
        hue = 0.7f + 0.15f * first;
    if (group == PassGroup::Display) {
        saturation = 0.15f * first;
        darkest = 0.3f;
    }
    ImVec4 color{0.0f, 0.0f, 0.0f, 1.0f};
    ImGui::ColorConvertHSVtoRGB(
        hue < 0.0f ? hue + 1.0f : hue,
        saturation,
        darkest + (0.95f - darkest) * second,
        color.x,
        color.y,
        color.z
    );
    return ImGui::ColorConvertFloat4ToU32(color);
}

struct Band {
    size_t pass = 0; ///< index into PassHistory::passes()
    PassGroup group = PassGroup::Scene;
    ImU32 color = 0;
};

/// From the bottom up: the blur is stacked on the rest of the frame.
std::vector<Band> listBands(const PassHistory& history, const MethodInfo& method) {
    std::vector<Band> bands;
    for (const PassGroup group : kGroups)
        for (size_t pass = 0; pass < history.passes().size(); ++pass) {
            const auto& [name, owner] = history.passes()[pass];
            if (groupOf(method, owner) == group)
                bands.push_back({pass, group, colorOf(group, name)});
        }
    return bands;
}

float sumFrame(const PassHistory& history, size_t frame, std::span<const Band> bands, PassGroup g) {
    float sum = 0.0f;
    for (const Band& band : bands)
        if (band.group == g)
            sum += history.milliseconds(frame, band.pass);
    return sum;
}

float findMedianOf(const PassHistory& history, std::span<const Band> bands, PassGroup group) {
    std::vector<float> sums;
    for (size_t frame = 0; frame < history.frameCount(); ++frame)
        sums.push_back(sumFrame(history, frame, bands, group));
    const auto middle = sums.begin() + static_cast<std::ptrdiff_t>(sums.size() / 2);
    std::nth_element(sums.begin(), middle, sums.end());
    return *middle;
}

/// The first of 1, 2, 5, 10, ... that is not below.
float roundUp(float milliseconds) {
    const float decade = std::pow(10.0f, std::floor(std::log10(std::max(milliseconds, 1.0f))));
    for (const float factor : {1.0f, 2.0f, 5.0f})
        if (milliseconds <= factor * decade)
            return factor * decade;
    return 10.0f * decade;
}

float findHighest(const PassHistory& history, std::span<const Band> bands) {
    float highest = 0.0f;
    for (size_t frame = 0; frame < history.frameCount(); ++frame) {
        float total = 0.0f;
        for (const Band& band : bands)
            total += history.milliseconds(frame, band.pass);
        highest = std::max(highest, total);
    }
    return highest;
}

struct Graph {
    ImVec2 corner; ///< upper left
    ImVec2 size;
    float highest; ///< milliseconds at the top

    [[nodiscard]] float yOf(float milliseconds) const {
        return corner.y + size.y * (1.0f - std::min(milliseconds / highest, 1.0f));
    }
};

/// One column of rectangles per frame; those lower than half a pixel join the next.
void drawColumns(const Graph& graph, const PassHistory& history, std::span<const Band> bands) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float step = graph.size.x / static_cast<float>(PassHistory::kFrames);
    const size_t missing = PassHistory::kFrames - history.frameCount();
    for (size_t frame = 0; frame < history.frameCount(); ++frame) {
        const float left = graph.corner.x + std::floor(static_cast<float>(frame + missing) * step);
        const float right =
            graph.corner.x + std::floor(static_cast<float>(frame + missing + 1) * step);
        float total = 0.0f;
        float bottom = graph.yOf(0.0f);
        for (const Band& band : bands) {
            total += history.milliseconds(frame, band.pass);
            const float top = graph.yOf(total);
            if (bottom - top < 0.5f)
                continue;
            list.AddRectFilled({left, top}, {right, bottom}, band.color);
            bottom = top;
        }
    }
}

void drawBudgets(const Graph& graph) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (const float budget : kBudgets) {
        if (budget > graph.highest)
            continue;
        const float y = std::floor(graph.yOf(budget));
        list.AddLine({graph.corner.x, y}, {graph.corner.x + graph.size.x, y}, kBudgetLine);
        const std::string text = fmt::format("{:.1f} ms, {:.0f} fps", budget, 1000.0f / budget);
        list.AddText({graph.corner.x + 2.0f, y}, kBudgetLine, text.c_str());
    }
    const std::string top = fmt::format("{:g} ms", graph.highest);
    const float width = ImGui::CalcTextSize(top.c_str()).x;
    list.AddText(
        {graph.corner.x + graph.size.x - width - 2.0f, graph.corner.y}, kBudgetLine, top.c_str()
    );
}

void drawLegendRow(ImU32 color, const std::string& name, float milliseconds, bool isGroup) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    if (!isGroup) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float side = ImGui::GetTextLineHeight();
        ImGui::Dummy({2.0f * side, side});
        ImGui::GetWindowDrawList()->AddRectFilled(
            {at.x + side, at.y + 1.0f}, {at.x + 2.0f * side, at.y + side - 1.0f}, color
        );
        ImGui::SameLine();
    }
    ImGui::TextUnformatted(name.c_str());
    ImGui::TableNextColumn();
    ImGui::Text("%8.2f ms", static_cast<double>(milliseconds));
}

void drawLegend(const PassHistory& history, std::span<const Band> bands) {
    if (!ImGui::BeginTable("legend", 2, ImGuiTableFlags_SizingFixedFit))
        return;
    ImGui::TableSetupColumn("pass", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("median", ImGuiTableColumnFlags_WidthFixed);
    // The blur first, as the most relevant group.
    for (const PassGroup group :
         {PassGroup::Blur, PassGroup::Other, PassGroup::Scene, PassGroup::Display}) {
        if (std::none_of(bands.begin(), bands.end(), [&](auto& b) { return b.group == group; }))
            continue;
        drawLegendRow(0, describe(group), findMedianOf(history, bands, group), true);
        for (const Band& band : bands)
            if (band.group == group)
                drawLegendRow(
                    band.color,
                    history.passes()[band.pass].name,
                    history.findMedian(band.pass),
                    false
                );
    }
    ImGui::EndTable();
}

} // namespace

void drawTimeSection(const PassHistory& history, const PlaySettings& settings) {
    const auto method = findMethod(settings.method);
    if (!method || history.frameCount() == 0) {
        ImGui::TextDisabled("No frame is finished yet.");
        return;
    }
    const std::vector<Band> bands = listBands(history, *method.value());
    const float line = ImGui::GetTextLineHeightWithSpacing();
    Graph graph{
        ImGui::GetCursorScreenPos(),
        {std::max(ImGui::GetContentRegionAvail().x, 4.0f * line), 8.0f * line},
        roundUp(findHighest(history, bands))};
    ImGui::Dummy(graph.size);
    ImGui::GetWindowDrawList()->AddRectFilled(
        graph.corner,
        {graph.corner.x + graph.size.x, graph.corner.y + graph.size.y},
        IM_COL32(0, 0, 0, 160)
    );
    drawColumns(graph, history, bands);
    drawBudgets(graph);
    ImGui::TextDisabled("GPU time of the last %zu frames; medians:", history.frameCount());
    drawLegend(history, bands);
}

} // namespace shutter::game
