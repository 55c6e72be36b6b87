// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "shaders/motion_blur/motion_blur_shared.h"

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

namespace shutter::motion_blur {

enum class Method : uint8_t {
    Gather,      ///< the raster layer alone (Tan et al., "Post-process")
    Hybrid,      ///< with the background that rays reveal inside the ray mask
    OwnVelocity, ///< mean of samples along the pixel's own motion
    McGuire2012, ///< "A Reconstruction Filter for Plausible Motion Blur"
    Guertin2014, ///< "A Fast and Stable Feature-Aware Motion Blur Filter"
    Jimenez2014, ///< "Next Generation Post Processing in Call of Duty: Advanced Warfare"
    Denoised,    ///< rays at random times and a filter along the motion (Oberberger 2022)
};

/// How the reveal knows that it met another object.
enum class ObjectTest : uint8_t {
    MeshId,    ///< another row of the entity table (the paper's future work)
    Luminance, ///< another luminance than the first hit's (the paper's implementation)
};

/// How the reveal's ray gets past the object in front where ObjectTest::MeshId tells objects apart.
enum class RevealTraversal : uint8_t {
    Single,   ///< one traversal that leaves that object out: any number of its surfaces is passed
    Stepping, ///< from hit to hit (the paper's implementation), up to recursionLimit
};

/// What own velocity does with samples of what may be in front.
enum class OccluderTest : uint8_t {
    None,     ///< takes them all (three.js, Babylon.js)
    Velocity, ///< drops those whose own motion does not reach the pixel (Bevy)
};

/// Defaults are the publications'. README.md says which method reads which, and what each costs.
struct MotionBlurSettings {
    Method method = Method::Hybrid;
    uint32_t tileSizePx = 40;        ///< m, [1, 256]; also the longest blur, pixels
    uint32_t neighbourhoodTiles = 3; ///< n, odd, [1, 15]; 1 lets blur end at tile borders
    uint32_t sampleCount = 15;       ///< taps of each gather, or rays a pixel (Denoised), [1, 256]
    float softDepthExtent = 0.03f;   ///< SOFT_Z_EXTENT, metres, above 0; the paper: 5 mm to 3 cm
    float edgeThreshold = 0.9f;      ///< e, [0, 1]; the paper: 0.9 to 0.98; higher: fewer rays
    /// RevealTraversal::Stepping and ObjectTest::Luminance: surfaces along a ray, the first
    /// included, [1, 64]
    uint32_t recursionLimit = 5;
    ObjectTest objectTest = ObjectTest::MeshId;
    RevealTraversal revealTraversal = RevealTraversal::Single; ///< luminance steps whatever this is
    float luminanceThreshold =
        0.01f; ///< ObjectTest::Luminance: smallest difference, linear, [0, 1e6]
    float foregroundMagnification =
        30.0f; ///< of w_f where the target is deeper, [1, 1000]; 1 turns it off
    float backgroundMagnification =
        3.0f;            ///< of the revealed layer in the mask, [1, 100]; 1 turns it off
    float jitter = 1.0f; ///< of the taps, share of their distance, [0, 1]; 0: banding, no noise
    OccluderTest occluderTest = OccluderTest::None; ///< Method::OwnVelocity
    float centreBias =
        40.0f; ///< Method::Guertin2014, kappa: divides the pixel's own weight, [1, 1000]
    float speedThresholdPx =
        1.5f;                  ///< Method::Guertin2014, gamma: half velocity beyond half a pixel
                               ///< at which the second direction is the pixel's own, (0, 100]
    uint32_t filterLevels = 5; ///< Method::Denoised: of the filter, each twice as wide, [0, 8]
    float luminanceSigma =
        4.0f; ///< Method::Denoised: standard deviations that count as noise, [0.01, 100]
    float uniformMotionPx = 0.5f; ///< deviation from the dominant motion within which taps of the
                                  ///< gathers read colour only, pixels, [0, 16]; 0 turns that off
    float rayShare = 1.0f; ///< Method::Hybrid: of the masked pixels that trace, [0, 1]: below 1
                           ///< quads share a ray, below 1/4 parts of the mask go without
    float halfResolutionPx =
        std::numeric_limits<float>::infinity(); ///< uniform motion from which the gathers work at
                                                ///< half of the resolution along it, pixels, [2,
                                                ///< infinity]
    float maxMotionDepth =
        std::numeric_limits<float>::infinity(); ///< metres along the view, [0, infinity]; what is
                                                ///< deeper, the sky too, counts as still

    bool operator==(const MotionBlurSettings&) const = default;
};

/// Names of the MotionBlurSettings that a method reads, sampleCount apart, which each does.
[[nodiscard]] std::span<const std::string_view> listSettings(Method method);

/// One sentence naming the field where a setting is out of its range.
[[nodiscard]] core::Status validate(const MotionBlurSettings& settings);

/// What the shaders get. Pure.
/// \param rasterTime s of the raster instant in the exposure, clamped to [0, 1]
[[nodiscard]] shader::MotionBlurParams
resolve(const MotionBlurSettings& settings, uint32_t width, uint32_t height, double rasterTime);

} // namespace shutter::motion_blur
