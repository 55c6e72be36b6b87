// SPDX-License-Identifier: MIT
#include "game/play/panel/play_rows.h"

namespace shutter::game {

namespace {

using motion_blur::BlurBudget;
using scene::CameraShutter;
using scene::CutDetection;
using scene::ShutterResponse;

constexpr std::string_view kPhases[] = {"start", "centre", "end"};
constexpr std::string_view kModes[] = {"physical", "angle", "capped"};
constexpr std::string_view kShapes[] = {"box", "triangle", "trapezoid", "samples"};

} // namespace

std::span<const core::SettingRow<PlaySettings>> listPlayRows() {
    using S = PlaySettings;
    static const std::vector<core::SettingRow<S>> kRows = {
        {"cameraBlurScale",
         &S::cameraBlurScale,
         "",
         {.lowest = 0, .highest = 1},
         "Of the blur by the camera's own turning and travel, for players whom it makes sick. At 0 "
         "only what moves in the world blurs."},
        {"split", &S::split, "", {}, "Another method's picture left of the divider."},
        {"dividerShare",
         &S::dividerShare,
         "",
         {.lowest = 0, .highest = 1},
         "Place of the divider, as a share of the window's width."},
        {"instants",
         &S::instants,
         "instants",
         {.lowest = 1, .highest = 256, .step = 1, .isLogarithmic = true},
         "Sharp frames that accumulate averages for each picture. Time is proportional to it."},
        {"rays",
         &S::rays,
         "rays",
         {.lowest = 1, .highest = 256, .step = 1, .isLogarithmic = true},
         "A pixel and picture, of truth. Time is proportional to it."},
        {"denoisedRays",
         &S::denoisedRays,
         "rays",
         {.lowest = 1, .highest = 256, .step = 1, .isLogarithmic = true},
         "A pixel and picture, of denoised. Time is proportional to it."},
        {"resolutionScale",
         &S::resolutionScale,
         "",
         {.lowest = 0.25, .highest = 1},
         "Of the picture's sides against the window's. Lower is faster."},
        {"vsync", &S::vsync, "", {}, "Frames wait for the display: no tearing."},
        {"showPanel", &S::showPanel, "", {}, "This panel, and the help at the bottom (F1)."},
    };
    return kRows;
}

std::span<const core::SettingRow<BlurBudget>> listBudgetRows() {
    static const std::vector<core::SettingRow<BlurBudget>> kRows = {
        {"milliseconds",
         &BlurBudget::milliseconds,
         "ms",
         {.lowest = 0.01,
          .highest = 1e6,
          .isUnlimited = true,
          .isLogarithmic = true,
          .sliderLowest = 0.1,
          .sliderHighest = 100},
         "GPU time that the blur may take of a frame. It gives up resolution, rays and samples, in "
         "the end itself, to stay within."},
    };
    return kRows;
}

std::span<const core::SettingRow<CameraShutter>> listShutterRows() {
    using S = CameraShutter;
    static const std::vector<core::SettingRow<S>> kRows = {
        {"mode",
         core::makeWordField<&S::mode>(kModes),
         "",
         {},
         "What the exposure's length follows: seconds; a share of the frame; that share, but never "
         "longer than at the reference rate."},
        {"angleDegrees",
         &S::angleDegrees,
         "degrees",
         {.lowest = 0, .highest = 3600, .sliderHighest = 720},
         "Of modes angle and capped: 360 is the whole frame, 180 the half that film has."},
        {"referenceFps",
         &S::referenceFps,
         "fps",
         {.lowest = 1, .highest = 1000, .isLogarithmic = true},
         "Of mode capped: slower frames are exposed as if they were this fast."},
        {"exposureSeconds",
         &S::exposureSeconds,
         "s",
         {.lowest = 0, .highest = 10, .isLogarithmic = true, .sliderHighest = 1},
         "Of mode physical: length of the exposure. 0 is sharp."},
        {"phase",
         core::makeWordField<&S::phase>(kPhases),
         "",
         {},
         "Where in the exposure the raster image lies."},
        {"cameraRotationScale",
         &S::cameraRotationScale,
         "x",
         {.lowest = 0, .highest = 2},
         "Of the blur by the camera's turning."},
        {"cameraTranslationScale",
         &S::cameraTranslationScale,
         "x",
         {.lowest = 0, .highest = 2},
         "Of the blur by the camera's travel."},
        {"objectScale",
         &S::objectScale,
         "x",
         {.lowest = 0, .highest = 2},
         "Of the blur by what moves in the world."},
        {"maxBlurPercent",
         &S::maxBlurPercent,
         "%",
         {.lowest = 0, .highest = 1000, .isUnlimited = true, .sliderHighest = 20},
         "Longest way across the picture, of its width. What moves farther moves less; measuring "
         "it draws the picture up to four times more."},
    };
    return kRows;
}

std::span<const core::SettingRow<ShutterResponse>> listResponseRows() {
    using S = ShutterResponse;
    static const std::vector<core::SettingRow<S>> kRows = {
        {"shape",
         core::makeWordField<&S::shape>(kShapes),
         "",
         {},
         "How sensitive the sensor is over the exposure."},
        {"openShare",
         &S::openShare,
         "",
         {.lowest = 0, .highest = 1},
         "Of shape trapezoid: share of the exposure that opening takes."},
        {"closeShare",
         &S::closeShare,
         "",
         {.lowest = 0, .highest = 1},
         "Of shape trapezoid: share of the exposure that closing takes."},
    };
    return kRows;
}

std::span<const core::SettingRow<CutDetection>> listCutRows() {
    using S = CutDetection;
    static const std::vector<core::SettingRow<S>> kRows = {
        {"enabled", &S::enabled, "", {}, "A camera that jumps is cut: that frame stays sharp."},
        {"degrees",
         &S::degrees,
         "degrees",
         {.lowest = 0.1, .highest = 180, .isLogarithmic = true},
         "Smallest turn that is a cut."},
        {"metres",
         &S::metres,
         "m",
         {.lowest = 0.001, .highest = 1e6, .isLogarithmic = true, .sliderHighest = 100},
         "Smallest displacement that is a cut."},
    };
    return kRows;
}

} // namespace shutter::game
