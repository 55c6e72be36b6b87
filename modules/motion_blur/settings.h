// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "engine/core/setting_row.h"

#include <cstdint>
#include <limits>

namespace shutter::motion_blur {

struct Method;

/// The default method: `resolved` or, if motion through the exposure is unknown
/// (Method::readsInstantMotions), `gather`.
[[nodiscard]] const Method& getDefaultMethod(bool knowsMotions = true);

/// How the reveal knows that it met another object.
enum class ObjectTest : uint8_t {
    MeshId,    ///< another row of the entity table (the paper's future work)
    Luminance, ///< another luminance than the first hit's (the paper's implementation)
};

/// How the reveal's ray passes the object in front with ObjectTest::MeshId.
enum class RevealTraversal : uint8_t {
    Single,   ///< one traversal that leaves that object out: any number of its surfaces is passed
    Stepping, ///< from hit to hit (the paper's implementation), up to recursionLimit
};

/// Which moving pixels near a silhouette belong to the ray mask.
enum class MaskTest : uint8_t {
    Paper,    ///< all whose motion meets one before something deeper (the paper)
    Relative, ///< of these only ones that move relative to the background and are not behind it
};

/// How what a ray revealed enters a masked pixel.
enum class CompositeRule : uint8_t {
    Weights, ///< both layers are gathered, and their weighted sums added (the paper)
    Counted, ///< for each tap, as the surface that the pixel saw at its instant
};

/// Treatment of samples of possible occluders by own velocity.
enum class OccluderTest : uint8_t {
    None,     ///< takes them all (three.js, Babylon.js)
    Velocity, ///< drops those whose own motion does not reach the pixel (Bevy)
};

/// Whether all pixels see the same instants of the exposure, which shows as copies of edges that
/// move farther than there are instants, or each its own, which shows as grain.
enum class InstantNoise : uint8_t {
    Off,
    Fixed,    ///< in every frame the same ones
    PerFrame, ///< in each frame others
};

/// Defaults are the best measured values; paperSettings() are the publication's. settings.cpp lists
/// ranges and units, each method's file which fields it reads, modules/motion_blur/settings.md what
/// each costs.
struct MotionBlurSettings {
    const Method* method = nullptr;  ///< methods.h; null: getDefaultMethod()
    uint32_t tileSizePx = 0;         ///< m; also the longest blur; 0: chooseTileSize()
    uint32_t neighbourhoodTiles = 3; ///< n, odd; with 1 blur ends at tile borders
    uint32_t sampleCount = 0;        ///< of Method::sampleUnit; 0: Method::defaultSamples
    float softDepthExtent = 0.0f;    ///< SOFT_Z_EXTENT; the paper: 5 mm to 3 cm
    float softDepthShare = 0.01f;    ///< of the depth, added to softDepthExtent
    float edgeThreshold = 0.9f;      ///< e; the paper: 0.9 to 0.98; higher: fewer rays
    /// Most surfaces along a ray, the first included, with RevealTraversal::Stepping or
    /// ObjectTest::Luminance.
    uint32_t recursionLimit = 5;
    ObjectTest objectTest = ObjectTest::MeshId;
    RevealTraversal revealTraversal =
        RevealTraversal::Single;      ///< ObjectTest::Luminance always steps
    float luminanceThreshold = 0.01f; ///< smallest difference that ObjectTest::Luminance sees
    MaskTest maskTest = MaskTest::Relative;
    CompositeRule composite = CompositeRule::Counted;
    float foregroundMagnification = 1.0f; ///< of w_f where the target is deeper; 1: off
    float backgroundMagnification = 2.0f; ///< of the revealed layer inside the mask; 1: off
    float jitter = 1.0f;                  ///< of the taps; 0: banding, no noise
    OccluderTest occluderTest = OccluderTest::None;
    float centreBias = 40.0f;      ///< kappa (Guertin 2014): divides the pixel's own weight
    float speedThresholdPx = 1.5f; ///< gamma (Guertin 2014): half velocity beyond half a pixel at
                                   ///< which the second direction is the pixel's own
    uint32_t filterLevels = 5;     ///< passes of the denoiser, each twice as wide as the last
    float luminanceSigma = 4.0f;   ///< standard deviations that the denoiser takes for noise
    float uniformMotionPx = 0.5f;  ///< deviation from a block's common motion within which its
                                   ///< pixels read colour only; 0: never
    float rayShare = 1.0f;         ///< of the masked pixels that trace; below 1 quads share a ray,
                                   ///< below 1/4 parts of the mask go without
    /// Uniform motion from which the gathers work at half of the resolution along it.
    float halfResolutionPx = std::numeric_limits<float>::infinity();
    bool history = true;       ///< the last frame's raster is looked up, too
    bool secondRaster = false; ///< so is one that is drawn at the other end of the exposure
    InstantNoise instantNoise = InstantNoise::Off;
    /// Maximum number of rays for samples that no layer holds, mean per pixel of the picture.
    /// Infinity: every sample of movers is traced.
    float raysPerPixel = 0.1f;
    /// Depth along the view beyond which everything, the sky included, counts as still.
    float maxMotionDepth = std::numeric_limits<float>::infinity();

    bool operator==(const MotionBlurSettings&) const = default;
};

/// Returns the settings with defaults filled in for method and sampleCount.
/// \param knowsMotions getDefaultMethod()'s
[[nodiscard]] MotionBlurSettings
complete(const MotionBlurSettings& settings, bool knowsMotions = true);

/// Method `hybrid` with the numbers of the publication. Rays distinguish objects by id, which the
/// paper names as future work; its authors' implementation has ObjectTest::Luminance,
/// RevealTraversal::Stepping and no fast path (uniformMotionPx 0).
[[nodiscard]] MotionBlurSettings paperSettings();

/// tileSizePx, or where that is 0 a twelfth of the picture's height, from the paper's 40 up to 256:
/// the longest blur is then the same share of the picture at every resolution above 480 lines.
[[nodiscard]] uint32_t chooseTileSize(const MotionBlurSettings& settings, uint32_t height);

/// Instants of the exposure that the pixels choose theirs from: sampleCount, and several times as
/// many with noise or a lens. \param settings complete()
/// \param hasLens each has a place of the camera's lens (InstantMotions::hasLens)
[[nodiscard]] uint32_t countInstants(const MotionBlurSettings& settings, bool hasLens = false);

/// One row per field of MotionBlurSettings, except for `method`.
[[nodiscard]] core::SettingRows<MotionBlurSettings> listSettingRows();

/// One sentence naming the field where a setting is out of its range.
[[nodiscard]] core::Status validate(const MotionBlurSettings& settings);

} // namespace shutter::motion_blur
