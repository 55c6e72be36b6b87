// SPDX-License-Identifier: MIT
#include "modules/motion_blur/settings.h"

#include "engine/core/check.h"
#include "modules/motion_blur/setting_rows.h"

#include <algorithm>
#include <vector>

namespace shutter::motion_blur {

namespace {

/// Guertin and Jimenez look tiles up to a quarter of a tile away (tileJitter()); a smear of Jimenez
/// fades over one tap's distance beyond its end.
float findMargin(const MotionBlurSettings& settings) {
    const auto tile = static_cast<float>(settings.tileSizePx);
    const float lookUp = 0.25f * tile * settings.jitter;
    switch (settings.method) {
    case Method::Guertin2014:
        return lookUp;
    case Method::Jimenez2014:
        return std::max(lookUp, tile / static_cast<float>(settings.sampleCount));
    default:
        return 0.0f;
    }
}

} // namespace

std::span<const std::string_view> listSettings(Method method) {
    using Names = std::vector<std::string_view>;
    static const Names kTiled = {
        "tileSizePx", "neighbourhoodTiles", "softDepthExtent", "jitter", "maxMotionDepth"};
    static const auto with = [](Names names, const Names& more) {
        names.insert(names.end(), more.begin(), more.end());
        return names;
    };
    static const Names kGather =
        with(kTiled, {"foregroundMagnification", "uniformMotionPx", "halfResolutionPx"});
    static const Names kHybrid = with(
        kGather,
        {"backgroundMagnification",
         "edgeThreshold",
         "recursionLimit",
         "objectTest",
         "revealTraversal",
         "rayShare",
         "luminanceThreshold"}
    );
    static const Names kOwnVelocity = {"jitter", "occluderTest", "maxMotionDepth"};
    static const Names kGuertin = with(kTiled, {"centreBias", "speedThresholdPx"});
    static const Names kDenoised = {
        "tileSizePx", "neighbourhoodTiles", "filterLevels", "luminanceSigma"};
    switch (method) {
    case Method::Gather:
        return kGather;
    case Method::Hybrid:
        return kHybrid;
    case Method::OwnVelocity:
        return kOwnVelocity;
    case Method::Guertin2014:
        return kGuertin;
    case Method::McGuire2012:
    case Method::Jimenez2014:
        return kTiled;
    case Method::Denoised:
        return kDenoised;
    }
    SHUTTER_CHECK(false, "there is no method {}", static_cast<int>(method));
    return {};
}

core::Status validate(const MotionBlurSettings& settings) {
    return core::validateRows(listSettingRows(), settings, "motion blur: ");
}

shader::MotionBlurParams
resolve(const MotionBlurSettings& settings, uint32_t width, uint32_t height, double rasterTime) {
    shader::MotionBlurParams params{};
    const uint32_t tile = settings.tileSizePx;
    params.sizePx = {width, height};
    params.tileCount = {(width + tile - 1) / tile, (height + tile - 1) / tile};
    params.tileSizePx = tile;
    params.neighbourRadius = static_cast<int32_t>(settings.neighbourhoodTiles / 2);
    params.sampleCount = settings.sampleCount;
    params.softDepthExtent = settings.softDepthExtent;
    params.edgeThreshold = settings.edgeThreshold;
    params.rasterTime = static_cast<float>(std::clamp(rasterTime, 0.0, 1.0));
    params.foregroundMagnification = settings.foregroundMagnification;
    params.backgroundMagnification = settings.backgroundMagnification;
    params.jitter = settings.jitter;
    params.recursionLimit = settings.recursionLimit;
    params.luminanceThreshold = settings.luminanceThreshold;
    if (settings.objectTest == ObjectTest::Luminance)
        params.flags |= shader::kFlagLuminanceTest | shader::kFlagSteppingReveal;
    if (settings.revealTraversal == RevealTraversal::Stepping)
        params.flags |= shader::kFlagSteppingReveal;
    if (settings.occluderTest == OccluderTest::Velocity)
        params.flags |= shader::kFlagVelocityOccluder;
    params.centreBias = settings.centreBias;
    params.speedThresholdPx = settings.speedThresholdPx;
    params.luminanceSigma = settings.luminanceSigma;
    const bool isGather = settings.method == Method::Gather || settings.method == Method::Hybrid;
    params.uniformMotionPx = isGather ? settings.uniformMotionPx : 0.0f;
    params.maxMotionDepth = settings.maxMotionDepth;
    params.rayShare = settings.rayShare;
    params.halfResolutionPx = settings.halfResolutionPx;
    params.marginPx = findMargin(settings);
    return params;
}

} // namespace shutter::motion_blur
