// SPDX-License-Identifier: MIT
#include "game/play/panel/play_rows.h"

namespace shutter::game {

core::SettingRows<PlaySettings> listPlayRows() {
    using S = PlaySettings;
    static const std::vector<core::SettingRow<S>> kRows = {
        {"cameraBlurScale",
         &S::cameraBlurScale,
         "",
         {.lowest = 0, .highest = 1},
         "Scales the blur that the camera's own motion causes, for players whom it makes sick. At "
         "0 "
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
         "Rays per pixel and picture of truth. Time is proportional to it."},
        {"denoisedRays",
         &S::denoisedRays,
         "rays",
         {.lowest = 1, .highest = 256, .step = 1, .isLogarithmic = true},
         "Rays per pixel and picture of denoised. Time is proportional to it."},
        {"resolutionScale",
         &S::resolutionScale,
         "",
         {.lowest = 0.25, .highest = 1},
         "Sides of the picture as a share of the window's. Lower is faster."},
        {"vsync", &S::vsync, "", {}, "Frames wait for the display: no tearing."},
        {"showPanel", &S::showPanel, "", {}, "This panel, and the help at the bottom (F1)."},
    };
    return kRows;
}

} // namespace shutter::game
