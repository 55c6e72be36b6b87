// SPDX-License-Identifier: MIT
#include "game/setting_table.h"

#include <cstdlib>

namespace shutter::game {

namespace {

using motion_blur::MotionBlurSettings;
using Row = SettingRow<MotionBlurSettings>;

constexpr std::string_view kObjectTests[] = {"mesh_id", "luminance"};
constexpr std::string_view kTraversals[] = {"single", "stepping"};
constexpr std::string_view kOccluderTests[] = {"none", "velocity"};

std::vector<Row> makeTapRows() {
    using S = MotionBlurSettings;
    return {
        {"sampleCount",
         &S::sampleCount,
         "",
         {.lowest = 1, .highest = 256, .step = 1, .isLogarithmic = true},
         "Taps of each gather. Time is proportional to it; too few show as noise."},
        {"tileSizePx",
         &S::tileSizePx,
         "px",
         {.lowest = 1, .highest = 256, .step = 1},
         "Longest blur. Larger tiles make more pixels gather."},
        {"neighbourhoodTiles",
         &S::neighbourhoodTiles,
         "tiles",
         {.lowest = 1, .highest = 15, .step = 2},
         "Side of the square of tiles whose longest motion is the dominant one. 1 lets blur end at "
         "tile borders."},
        {"jitter",
         &S::jitter,
         "",
         {.lowest = 0, .highest = 1},
         "Of the taps, as a share of their distance. 0 gives bands instead of noise."},
        {"softDepthExtent",
         &S::softDepthExtent,
         "m",
         {.lowest = 1e-6,
          .highest = 1e6,
          .isLogarithmic = true,
          .slideLowest = 1e-4,
          .slideHighest = 10},
         "Depth over which foreground and background mix."},
        {"uniformMotionPx",
         &S::uniformMotionPx,
         "px",
         {.lowest = 0, .highest = 16},
         "Deviation from the dominant motion within which taps read colour only. 0 turns the fast "
         "path off; higher is faster and less exact."},
        {"halfResolutionPx",
         &S::halfResolutionPx,
         "px",
         {.lowest = 2,
          .highest = 1e6,
          .isUnlimited = true,
          .isLogarithmic = true,
          .slideHighest = 256},
         "Uniform motion from which two pixels along it share a value, which halves the taps."},
        {"maxMotionDepth",
         &S::maxMotionDepth,
         "m",
         {.lowest = 0,
          .highest = 1e6,
          .isUnlimited = true,
          .isLogarithmic = true,
          .slideHighest = 10000},
         "What is deeper along the view, the sky too, counts as still."},
        {"foregroundMagnification",
         &S::foregroundMagnification,
         "x",
         {.lowest = 1, .highest = 1000, .isLogarithmic = true},
         "Of the foreground's weight where the target lies deeper. The paper's 30 makes smears "
         "opaque; 1 turns it off and is nearer to the truth."},
    };
}

std::vector<Row> makeRayRows() {
    using S = MotionBlurSettings;
    return {
        {"backgroundMagnification",
         &S::backgroundMagnification,
         "x",
         {.lowest = 1, .highest = 100, .isLogarithmic = true},
         "Of the weight of what rays revealed. 1 turns it off."},
        {"edgeThreshold",
         &S::edgeThreshold,
         "",
         {.lowest = 0, .highest = 1},
         "Of the measure that makes an edge part of the ray mask. Higher: fewer rays."},
        {"rayShare",
         &S::rayShare,
         "",
         {.lowest = 0, .highest = 1},
         "Of the masked pixels that trace a ray. Below 1 pixels share rays, below 1/4 parts of the "
         "mask go without."},
        {"objectTest",
         makeWordField<&S::objectTest>(kObjectTests),
         "",
         {},
         "How a ray knows that it met another object: by its number, or by its luminance as in the "
         "paper's implementation."},
        {"revealTraversal",
         makeWordField<&S::revealTraversal>(kTraversals),
         "",
         {},
         "How a ray gets past the object in front: in one traversal, or from hit to hit as in the "
         "paper's implementation."},
        {"recursionLimit",
         &S::recursionLimit,
         "hits",
         {.lowest = 1, .highest = 64, .step = 1},
         "Surfaces along a ray, with revealTraversal stepping or objectTest luminance."},
        {"luminanceThreshold",
         &S::luminanceThreshold,
         "",
         {.lowest = 0,
          .highest = 1e6,
          .isLogarithmic = true,
          .slideLowest = 1e-4,
          .slideHighest = 100},
         "Smallest difference that objectTest luminance takes for another object, linear."},
    };
}

std::vector<Row> makeRivalRows() {
    using S = MotionBlurSettings;
    return {
        {"occluderTest",
         makeWordField<&S::occluderTest>(kOccluderTests),
         "",
         {},
         "Whether samples of what may be in front are dropped where their own motion does not "
         "reach the pixel."},
        {"centreBias",
         &S::centreBias,
         "",
         {.lowest = 1, .highest = 1000, .isLogarithmic = true},
         "Kappa: higher, and the pixel itself counts less."},
        {"speedThresholdPx",
         &S::speedThresholdPx,
         "px",
         {.lowest = 1e-3, .highest = 100, .isLogarithmic = true},
         "Gamma: half motion above half a pixel from which the second direction is the pixel's "
         "own."},
        {"filterLevels",
         &S::filterLevels,
         "passes",
         {.lowest = 0, .highest = 8, .step = 1},
         "Of the filter, each twice as wide as the one before. 0 leaves the noise."},
        {"luminanceSigma",
         &S::luminanceSigma,
         "deviations",
         {.lowest = 0.01, .highest = 100, .isLogarithmic = true},
         "Standard deviations that count as noise. Higher is smoother."},
    };
}

} // namespace

std::span<const Row> listBlurRows() {
    static const std::vector<Row> kRows = [] {
        std::vector<Row> rows = makeTapRows();
        for (const std::vector<Row>& more : {makeRayRows(), makeRivalRows()})
            rows.insert(rows.end(), more.begin(), more.end());
        return rows;
    }();
    return kRows;
}

bool contains(const NumberRange& range, double value) {
    if (range.isUnlimited && value == std::numeric_limits<double>::infinity())
        return true;
    // Written so that NaN is outside.
    if (!(value >= range.lowest && value <= range.highest))
        return false;
    return range.step == 0.0 || std::fmod(value - range.lowest, range.step) == 0.0;
}

std::string describeRange(const NumberRange& range, const char* unit) {
    std::string text = fmt::format("{:g} to {:g}", range.lowest, range.highest);
    if (*unit != '\0')
        text += fmt::format(" {}", unit);
    if (range.step > 1.0)
        text += fmt::format(" in steps of {:g}", range.step);
    else if (range.step == 1.0)
        text += ", whole";
    if (range.isUnlimited)
        text += fmt::format(" or {}", kUnlimited);
    return text;
}

double shortestOf(float value) {
    return std::strtod(fmt::format("{}", value).c_str(), nullptr);
}

} // namespace shutter::game
