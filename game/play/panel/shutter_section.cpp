// SPDX-License-Identifier: MIT
#include "engine/scene/shutter.h"
#include "game/play/panel/panel_sections.h"
#include "game/play/panel/play_settings.h"
#include "game/play/panel/setting_widgets.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>

namespace shutter::game {

namespace {

using scene::ResponseShape;
using scene::ShutterMode;
using scene::ShutterResponse;

constexpr ImU32 kCurve = IM_COL32(120, 190, 255, 255);
constexpr ImU32 kArea = IM_COL32(120, 190, 255, 70);
constexpr ImU32 kAxis = IM_COL32(160, 160, 160, 255);
constexpr ImU32 kRaster = IM_COL32(255, 200, 90, 255);

/// A bell of five samples: something to start from.
const std::vector<double> kFirstSamples = {0.0, 0.5, 1.0, 0.5, 0.0};

/// Where the curve deforms: shutter time and sensitivity over its mean.
std::vector<ImVec2> listCurvePoints(const ShutterResponse& response) {
    const auto table = scene::computeResponseTable(response);
    if (!table)
        return {{0.0f, 1.0f}, {1.0f, 1.0f}};
    std::vector<ImVec2> points;
    for (uint32_t i = 0; i < table->knotCount; ++i)
        points.push_back({table->knots[i].s, table->knots[i].density});
    return points;
}

void drawLabel(const ImVec2& place, float share, float left, float right, const std::string& text) {
    const float width = ImGui::CalcTextSize(text.c_str()).x;
    const float x = std::clamp(place.x - share * width, left, std::max(left, right - width));
    ImGui::GetWindowDrawList()->AddText(
        {std::floor(x), std::floor(place.y)}, ImGui::GetColorU32(ImGuiCol_Text), text.c_str()
    );
}

/// The response over time, and where on it open, raster image and close lie.
void drawCurve(const scene::ExposureInterval& exposure) {
    const float line = ImGui::GetTextLineHeightWithSpacing();
    const float width = std::max(ImGui::GetContentRegionAvail().x, 8.0f * line);
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const float height = 5.0f * line;
    const float left = corner.x + line;
    const float right = corner.x + width - line;
    const float top = corner.y + line;
    const float bottom = top + height;
    ImGui::Dummy({width, height + 2.0f * line});
    drawTooltip("Sensitivity over the exposure; the area under it is the light of the picture.");
    const std::vector<ImVec2> points = listCurvePoints(exposure.shutter.response);
    float highest = 1.0f;
    for (const ImVec2& point : points)
        highest = std::max(highest, point.y);
    const auto place = [&](const ImVec2& point) {
        return ImVec2{left + point.x * (right - left), bottom - 0.95f * height * point.y / highest};
    };
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddLine({corner.x, bottom}, {corner.x + width, bottom}, kAxis);
    for (size_t i = 0; i + 1 < points.size(); ++i) {
        const ImVec2 a = place(points[i]);
        const ImVec2 b = place(points[i + 1]);
        list.AddQuadFilled({a.x, bottom}, a, b, {b.x, bottom}, kArea);
        list.AddLine(a, b, kCurve, 2.0f);
    }
    // A shutter that opens at once.
    list.AddLine({left, bottom}, place(points.front()), kCurve, 2.0f);
    list.AddLine({right, bottom}, place(points.back()), kCurve, 2.0f);
    const float raster = left + static_cast<float>(exposure.rasterTime) * (right - left);
    list.AddLine({raster, top}, {raster, bottom}, kRaster, 2.0f);
    const auto milliseconds = [&](double seconds) { return 1000.0 * (seconds - exposure.raster); };
    const float end = corner.x + width;
    drawLabel({raster, corner.y}, 0.5f, corner.x, end, "raster image 0 ms");
    drawLabel(
        {left, bottom},
        0.5f,
        corner.x,
        end,
        fmt::format("open {:.1f} ms", milliseconds(exposure.open))
    );
    drawLabel(
        {right, bottom},
        0.5f,
        corner.x,
        end,
        fmt::format("close {:.1f} ms", milliseconds(exposure.close))
    );
}

/// One upright slider a sample.
void drawSamples(std::vector<double>& samples) {
    const double largest = std::max(1.0, *std::max_element(samples.begin(), samples.end()));
    const double none = 0.0;
    const float side = ImGui::GetFrameHeight();
    for (size_t i = 0; i < samples.size(); ++i) {
        ImGui::PushID(static_cast<int>(i));
        if (i > 0) {
            ImGui::SameLine(0.0f, 2.0f);
            if (ImGui::GetContentRegionAvail().x < side)
                ImGui::NewLine();
        }
        double sample = samples[i];
        ImGui::VSliderScalar(
            "##sample",
            {side, 4.0f * side},
            ImGuiDataType_Double,
            &sample,
            &none,
            &largest,
            "",
            ImGuiSliderFlags_AlwaysClamp
        );
        if (std::isfinite(sample))
            samples[i] = std::clamp(sample, none, largest);
        drawTooltip(
            fmt::format("Sample {} of {}: {:.3g}. Range: 0 up.", i + 1, samples.size(), sample)
        );
        ImGui::PopID();
    }
    if (ImGui::Button("More") && samples.size() < shader::kMaxResponseKnots)
        samples.push_back(samples.back());
    drawTooltip(fmt::format("One sample more, up to {}.", shader::kMaxResponseKnots));
    ImGui::SameLine();
    if (ImGui::Button("Fewer") && samples.size() > 2)
        samples.pop_back();
    drawTooltip("One sample fewer, down to 2.");
}

/// What a change leaves valid: the other share gives way, and some light is always taken.
void drawResponse(ShutterResponse& response) {
    const ShutterResponse before = response;
    static const ShutterResponse kDefaults;
    if (beginRows("response")) {
        for (const auto& row : scene::listResponseRows()) {
            const bool isRead =
                std::holds_alternative<core::WordField<ShutterResponse>>(row.field) ||
                response.shape == ResponseShape::Trapezoid;
            ImGui::BeginDisabled(!isRead);
            drawRow(row, response, kDefaults);
            ImGui::EndDisabled();
        }
        endRows();
    }
    if (response.openShare != before.openShare)
        response.closeShare = std::min(response.closeShare, 1.0 - response.openShare);
    response.openShare = std::min(response.openShare, 1.0 - response.closeShare);
    if (response.shape == ResponseShape::Sampled) {
        if (!scene::validateResponse(response))
            response.samples = kFirstSamples;
        drawSamples(response.samples);
    }
    if (!scene::validateResponse(response))
        response = before;
}

bool isRead(const char* name, ShutterMode mode) {
    const std::string_view row = name;
    if (row == "exposureSeconds")
        return mode == ShutterMode::Physical;
    if (row == "angleDegrees")
        return mode != ShutterMode::Physical;
    return row != "referenceFps" || mode == ShutterMode::Capped;
}

} // namespace

void drawShutterSection(const PanelFacts& facts, PlaySettings& settings) {
    const auto exposure =
        scene::computeExposure(makeShutter(settings), 0.0, facts.exposure.frameSeconds);
    if (exposure.close > exposure.open)
        drawCurve(exposure);
    else
        ImGui::TextDisabled("Closed: the exposure is 0, the picture sharp.");
    static const scene::CameraShutter kDefaults = makePlayShutter();
    if (beginRows("shutter")) {
        for (const auto& row : scene::listShutterRows()) {
            ImGui::BeginDisabled(!isRead(row.name, settings.shutter.mode));
            drawRow(row, settings.shutter, kDefaults);
            ImGui::EndDisabled();
        }
        endRows();
    }
    ImGui::TextUnformatted("Response");
    drawResponse(settings.shutter.response);
    ImGui::TextUnformatted("Cut detection");
    ImGui::PushID("cuts");
    drawRows("cuts", scene::listCutRows(), settings.shutter.cuts);
    ImGui::PopID();
}

} // namespace shutter::game
