// SPDX-License-Identifier: MIT
#include "modules/motion_blur/settings.h"

#include "modules/motion_blur/methods.h"
#include "shaders/motion_blur/resolved_shared.h"

#include <algorithm>
#include <array>
#include <vector>

namespace shutter::motion_blur {

namespace {

using core::makeWordField;
using Row = core::SettingRow<MotionBlurSettings>;

constexpr std::string_view kObjectTests[] = {"mesh_id", "luminance"};
constexpr std::string_view kTraversals[] = {"single", "stepping"};
constexpr std::string_view kMaskTests[] = {"paper", "relative"};
constexpr std::string_view kComposites[] = {"weights", "counted"};
constexpr std::string_view kInstantNoises[] = {"off", "fixed", "per_frame"};
constexpr std::string_view kOccluderTests[] = {"none", "velocity"};

std::vector<Row> makeTapRows() {
    using S = MotionBlurSettings;
    return {
        {"sampleCount",
         &S::sampleCount,
         "",
         {.lowest = 0, .highest = 256, .step = 1, .isLogarithmic = true, .sliderLowest = 1},
         "Taps of each gather, instants, or rays per pixel. Time is proportional to it; too few "
         "show as noise. 0 is the method's own number.",
         "Samples"},
        {"tileSizePx",
         &S::tileSizePx,
         "px",
         {.lowest = 0, .highest = 256, .step = 1},
         "Side of a tile, and the longest blur. Larger tiles make more pixels gather. 0 is a "
         "twelfth of the picture's height, at least 40.",
         "Tile size"},
        {"neighbourhoodTiles",
         &S::neighbourhoodTiles,
         "tiles",
         {.lowest = 1, .highest = 15, .step = 2},
         "Side of the square of tiles whose longest motion is the dominant one. With 1 "
         "blur ends at tile borders.",
         "Neighbourhood"},
        {"jitter",
         &S::jitter,
         "",
         {.lowest = 0, .highest = 1},
         "Random offset of the taps, as a share of their distance. 0 gives bands instead "
         "of noise.",
         "Jitter"},
        {"softDepthExtent",
         &S::softDepthExtent,
         "m",
         {.lowest = 0,
          .highest = 1e6,
          .isLogarithmic = true,
          .sliderLowest = 1e-4,
          .sliderHighest = 10},
         "Depth difference over which foreground and background mix. The paper: 0.005 to 0.03.",
         "Soft depth"},
        {"softDepthShare",
         &S::softDepthShare,
         "",
         {.lowest = 0, .highest = 1},
         "Share of the depth that is added to softDepthExtent, which suits scenes of any scale.",
         "Soft depth share"},
        {"uniformMotionPx",
         &S::uniformMotionPx,
         "px",
         {.lowest = 0, .highest = 16},
         "Deviation from a block's common motion within which its pixels read colour only. 0 "
         "turns the fast path off; higher is faster and less exact.",
         "Uniform motion"},
        {"halfResolutionPx",
         &S::halfResolutionPx,
         "px",
         {.lowest = 2,
          .highest = 1e6,
          .isUnlimited = true,
          .isLogarithmic = true,
          .sliderHighest = 256},
         "Length of uniform motion from which two pixels along it share a value, which "
         "halves the taps.",
         "Half resolution from"},
        {"maxMotionDepth",
         &S::maxMotionDepth,
         "m",
         {.lowest = 0,
          .highest = 1e9,
          .isUnlimited = true,
          .isLogarithmic = true,
          .sliderHighest = 10000},
         "Depth along the view beyond which everything, the sky included, counts as still.",
         "Deepest motion"},
        {"foregroundMagnification",
         &S::foregroundMagnification,
         "x",
         {.lowest = 1, .highest = 1000, .isLogarithmic = true},
         "Factor of the weight of a foreground over a deeper pixel. The paper's 30 makes "
         "smears opaque; 1 turns it off and is closer to the truth.",
         "Foreground weight"},
    };
}

std::vector<Row> makeRayRows() {
    using S = MotionBlurSettings;
    return {
        {"composite",
         makeWordField<&S::composite>(kComposites),
         "",
         {},
         "How revealed background enters a pixel: by weights as in the paper, or counted, for each "
         "tap whose instant shows it.",
         "Composite"},
        {"backgroundMagnification",
         &S::backgroundMagnification,
         "x",
         {.lowest = 1, .highest = 100, .isLogarithmic = true},
         "Factor of the weight of what rays revealed. The paper: 3. 1 turns it off.",
         "Background weight"},
        {"edgeThreshold",
         &S::edgeThreshold,
         "",
         {.lowest = 0, .highest = 1},
         "Edge measure from which a pixel belongs to the ray mask. Higher: fewer rays.",
         "Edge threshold"},
        {"maskTest",
         makeWordField<&S::maskTest>(kMaskTests),
         "",
         {},
         "Which moving pixels near a silhouette trace rays: as in the paper, or only those that "
         "move against what lies behind them.",
         "Mask test"},
        {"rayShare",
         &S::rayShare,
         "",
         {.lowest = 0, .highest = 1},
         "Share of the masked pixels that trace a ray. Below 1 pixels share rays; below "
         "1/4 parts of the mask go without.",
         "Share of rays"},
        {"objectTest",
         makeWordField<&S::objectTest>(kObjectTests),
         "",
         {},
         "How a ray knows that it met another object: by its id, or by its luminance as in "
         "the paper's implementation.",
         "Object test"},
        {"revealTraversal",
         makeWordField<&S::revealTraversal>(kTraversals),
         "",
         {},
         "How a ray passes the object in front: in one traversal, or from hit to hit as in "
         "the paper's implementation.",
         "Traversal"},
        {"recursionLimit",
         &S::recursionLimit,
         "hits",
         {.lowest = 1, .highest = 64, .step = 1},
         "Most surfaces along a ray, with revealTraversal stepping or objectTest "
         "luminance.",
         "Most hits"},
        {"luminanceThreshold",
         &S::luminanceThreshold,
         "",
         {.lowest = 0,
          .highest = 1e6,
          .isLogarithmic = true,
          .sliderLowest = 1e-4,
          .sliderHighest = 100},
         "Smallest linear difference that objectTest luminance takes for another object.",
         "Luminance threshold"},
    };
}

std::vector<Row> makeLookupRows() {
    using S = MotionBlurSettings;
    return {
        {"history",
         &S::history,
         "",
         {},
         "Whether what this frame hides is looked up in the last frame. Off saves memory and "
         "leaves gaps behind movers.",
         "Last frame"},
        {"secondRaster",
         &S::secondRaster,
         "",
         {},
         "Whether the world is drawn at the other end of the exposure, too, for what this frame "
         "hides: for films, and for devices without rays. Takes as long as a sharp picture.",
         "Second raster"},
        {"instantNoise",
         makeWordField<&S::instantNoise>(kInstantNoises),
         "",
         {},
         "Whether pixels see other instants than their neighbours where edges move farther than "
         "there are instants: grain instead of copies of the edge. per_frame has other grain in "
         "each "
         "frame.",
         "Noise"},
        {"raysPerPixel",
         &S::raysPerPixel,
         "rays",
         {.lowest = 0,
          .highest = 256,
          .isUnlimited = true,
          .isLogarithmic = true,
          .sliderLowest = 0.01,
          .sliderHighest = 16},
         "Most rays for samples that no frame holds, on average over the picture. 0 traces none; "
         "unlimited traces every sample of movers.",
         "Rays per pixel"},
    };
}

std::vector<Row> makeRivalRows() {
    using S = MotionBlurSettings;
    return {
        {"occluderTest",
         makeWordField<&S::occluderTest>(kOccluderTests),
         "",
         {},
         "Whether samples that may lie in front are dropped where their own motion does "
         "not reach the pixel.",
         "Occluder test"},
        {"centreBias",
         &S::centreBias,
         "",
         {.lowest = 1, .highest = 1000, .isLogarithmic = true},
         "Kappa: the higher it is, the less the pixel itself counts.",
         "Centre bias"},
        {"speedThresholdPx",
         &S::speedThresholdPx,
         "px",
         {.lowest = 1e-3, .highest = 100, .isLogarithmic = true},
         "Gamma: half velocity beyond half a pixel from which the second direction is the "
         "pixel's own.",
         "Speed threshold"},
        {"filterLevels",
         &S::filterLevels,
         "passes",
         {.lowest = 0, .highest = 8, .step = 1},
         "Number of filter passes, each twice as wide as the one before. 0 leaves the "
         "noise.",
         "Filter passes"},
        {"luminanceSigma",
         &S::luminanceSigma,
         "deviations",
         {.lowest = 0.01, .highest = 100, .isLogarithmic = true},
         "Standard deviations of luminance that count as noise. Higher is smoother.",
         "Luminance sigma"},
    };
}

} // namespace

core::SettingRows<MotionBlurSettings> listSettingRows() {
    static const std::vector<Row> kRows = [] {
        std::vector<Row> rows = makeTapRows();
        for (const std::vector<Row>& more : {makeRayRows(), makeLookupRows(), makeRivalRows()})
            rows.insert(rows.end(), more.begin(), more.end());
        return rows;
    }();
    return kRows;
}

MotionBlurSettings complete(const MotionBlurSettings& settings, bool knowsMotions) {
    MotionBlurSettings whole = settings;
    if (!whole.method)
        whole.method = &getDefaultMethod(knowsMotions);
    if (whole.sampleCount == 0)
        whole.sampleCount = whole.method->defaultSamples;
    return whole;
}

MotionBlurSettings paperSettings() {
    MotionBlurSettings settings;
    settings.method = &getMethod("hybrid");
    settings.tileSizePx = 40;
    settings.sampleCount = 15;
    settings.softDepthExtent = 0.03f;
    settings.softDepthShare = 0.0f;
    settings.foregroundMagnification = 30.0f;
    settings.backgroundMagnification = 3.0f;
    settings.maskTest = MaskTest::Paper;
    settings.composite = CompositeRule::Weights;
    return settings;
}

uint32_t chooseTileSize(const MotionBlurSettings& settings, uint32_t height) {
    return settings.tileSizePx > 0 ? settings.tileSizePx : std::clamp(height / 12u, 40u, 256u);
}

uint32_t countInstants(const MotionBlurSettings& settings, bool hasLens) {
    if (hasLens)
        return settings.sampleCount * shader::kLensSets;
    const bool hasNoise = settings.instantNoise != InstantNoise::Off;
    return settings.sampleCount * (hasNoise ? shader::kInstantSets : 1u);
}

core::Status validate(const MotionBlurSettings& settings) {
    const auto methods = listMethods();
    if (settings.method &&
        std::find(methods.begin(), methods.end(), settings.method) == methods.end())
        return core::makeError("motion blur: method is none of listMethods()");
    return core::validateRows(listSettingRows(), settings, "motion blur: ");
}

} // namespace shutter::motion_blur
