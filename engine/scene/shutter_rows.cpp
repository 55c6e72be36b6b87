// SPDX-License-Identifier: MIT
#include "engine/scene/shutter.h"

#include <fmt/ranges.h>

#include <array>

namespace shutter::scene {

namespace {

constexpr std::string_view kPhases[] = {"start", "centre", "end"};
constexpr std::string_view kModes[] = {"physical", "angle", "capped"};
constexpr std::string_view kShapes[] = {"box", "triangle", "trapezoid", "samples"};

} // namespace

core::SettingRows<CameraShutter> listShutterRows() {
    using S = CameraShutter;
    static const std::array<core::SettingRow<S>, 9> kRows = {{
        {"mode",
         core::makeWordField<&S::mode>(kModes),
         "",
         {},
         "What sets the exposure's length: seconds (physical), a share of the frame (angle), or "
         "that share but never longer than at the reference rate (capped).",
         "Exposure by",
         "--shutter-mode"},
        {"angleDegrees",
         &S::angleDegrees,
         "degrees",
         {.lowest = 0, .highest = 36000, .sliderHighest = 720},
         "Modes angle and capped: 360 is the whole frame, 180 the half that film has.",
         "Shutter angle",
         "--shutter-angle"},
        {"referenceFps",
         &S::referenceFps,
         "fps",
         {.lowest = 0,
          .highest = 1000,
          .isLowestValid = false,
          .isRate = true,
          .isLogarithmic = true,
          .sliderLowest = 1},
         "Mode capped: slower frames are exposed as if they were this fast.",
         "Reference rate",
         "--reference-fps"},
        {"exposureSeconds",
         &S::exposureSeconds,
         "s",
         {.lowest = 0, .highest = 1e6, .isLogarithmic = true, .sliderHighest = 1},
         "Mode physical: length of the exposure. 0 is sharp.",
         "Exposure",
         "--exposure"},
        {"phase",
         core::makeWordField<&S::phase>(kPhases),
         "",
         {},
         "Where in the exposure the raster image lies.",
         "Phase",
         "--phase"},
        {"cameraRotationScale",
         &S::cameraRotationScale,
         "x",
         {.lowest = 0, .highest = 2},
         "Scales the blur that the camera's turning causes.",
         "Camera rotation",
         "--camera-rotation-blur"},
        {"cameraTranslationScale",
         &S::cameraTranslationScale,
         "x",
         {.lowest = 0, .highest = 2},
         "Scales the blur that the camera's displacement causes.",
         "Camera translation",
         "--camera-translation-blur"},
        {"objectScale",
         &S::objectScale,
         "x",
         {.lowest = 0, .highest = 2},
         "Scales the blur of movers.",
         "Objects",
         "--object-blur"},
        {"maxBlurPercent",
         &S::maxBlurPercent,
         "%",
         {.lowest = 0, .highest = 1000, .isUnlimited = true, .sliderHighest = 20},
         "Longest blur, as a percentage of the picture's width. What moves farther moves less; "
         "measuring it draws the picture up to four times more.",
         "Longest blur",
         "--max-blur"},
    }};
    return kRows;
}

core::SettingRows<ShutterResponse> listResponseRows() {
    using S = ShutterResponse;
    static const std::array<core::SettingRow<S>, 3> kRows = {{
        {"shape",
         core::makeWordField<&S::shape>(kShapes),
         "",
         {},
         "How the sensor's sensitivity changes over the exposure.",
         "Shape"},
        {"openShare",
         &S::openShare,
         "",
         {.lowest = 0, .highest = 1},
         "Shape trapezoid: share of the exposure during which the shutter opens.",
         "Opening"},
        {"closeShare",
         &S::closeShare,
         "",
         {.lowest = 0, .highest = 1},
         "Shape trapezoid: share of the exposure during which the shutter closes.",
         "Closing"},
    }};
    return kRows;
}

core::SettingRows<CutDetection> listCutRows() {
    using S = CutDetection;
    static const std::array<core::SettingRow<S>, 3> kRows = {{
        {"enabled",
         &S::enabled,
         "",
         {},
         "A camera that jumps counts as cut: nothing moves in that frame.",
         "Detect cuts",
         "--cut-detection"},
        {"degrees",
         &S::degrees,
         "degrees",
         {.lowest = 0,
          .highest = 180,
          .isLowestValid = false,
          .isLogarithmic = true,
          .sliderLowest = 0.1},
         "Smallest turn that counts as a cut.",
         "Turn",
         "--cut-angle"},
        {"metres",
         &S::metres,
         "m",
         {.lowest = 0,
          .highest = 1e6,
          .isLowestValid = false,
          .isLogarithmic = true,
          .sliderLowest = 0.001,
          .sliderHighest = 100},
         "Smallest displacement that counts as a cut.",
         "Displacement",
         "--cut-distance"},
    }};
    return kRows;
}

core::Status validate(const CameraShutter& shutter, std::string_view prefix) {
    const std::string own(prefix);
    const core::Status checks[] = {
        core::validateRows(listShutterRows(), shutter, own),
        core::validateRows(listResponseRows(), shutter.response, own + "response."),
        core::validateRows(listCutRows(), shutter.cuts, own + "cuts.")};
    for (const core::Status& check : checks)
        if (!check)
            return check;
    if (core::Status valid = validateResponse(shutter.response); !valid)
        return core::makeError("{}response: {}", prefix, valid.error().message);
    return {};
}

std::string describe(const CameraShutter& shutter) {
    return fmt::format(
        "{} {} samples={} {}",
        core::describeValues(listShutterRows(), shutter),
        core::describeValues(listResponseRows(), shutter.response),
        fmt::join(shutter.response.samples, ","),
        core::describeValues(listCutRows(), shutter.cuts)
    );
}

} // namespace shutter::scene
