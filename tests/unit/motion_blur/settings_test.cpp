// SPDX-License-Identifier: MIT
#include "modules/motion_blur/settings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::motion_blur {

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using Field = std::function<void(MotionBlurSettings&)>;

core::Status validateWith(const Field& set) {
    MotionBlurSettings settings;
    set(settings);
    return validate(settings);
}

} // namespace

TEST(MotionBlurSettings, TheDefaultsAreThePapersAndValid) {
    const MotionBlurSettings settings;
    EXPECT_TRUE(validate(settings).ok());
    EXPECT_EQ(settings.tileSizePx, 40u);
    EXPECT_EQ(settings.neighbourhoodTiles, 3u);
    EXPECT_EQ(settings.sampleCount, 15u);
    EXPECT_EQ(settings.recursionLimit, 5u);
}

TEST(MotionBlurSettings, TheDepthLimitMayBeInfiniteButNotNegativeOrNoNumber) {
    for (const float metres : {0.0f, 0.01f, 1e9f, kInfinity})
        EXPECT_TRUE(validateWith([&](auto& s) { s.maxMotionDepth = metres; }).ok()) << metres;
    for (const float metres : {-0.01f, -kInfinity, kNan}) {
        const core::Status valid = validateWith([&](auto& s) { s.maxMotionDepth = metres; });
        ASSERT_FALSE(valid.ok()) << metres;
        EXPECT_NE(valid.error().message.find("maxMotionDepth"), std::string::npos);
    }
    EXPECT_EQ(resolve({}, 8, 8, 1.0).maxMotionDepth, kInfinity);
}

TEST(MotionBlurSettings, OnlyTheGathersHaveAPathForUniformMotion) {
    MotionBlurSettings settings;
    for (const Method method : {Method::Gather, Method::Hybrid}) {
        settings.method = method;
        EXPECT_EQ(resolve(settings, 8, 8, 1.0).uniformMotionPx, 0.5f);
    }
    for (const Method method :
         {Method::OwnVelocity, Method::McGuire2012, Method::Guertin2014, Method::Jimenez2014}) {
        settings.method = method;
        EXPECT_EQ(resolve(settings, 8, 8, 1.0).uniformMotionPx, 0.0f);
    }
}

TEST(MotionBlurSettings, BlocksLookAsFarAsTheirFiltersDo) {
    MotionBlurSettings settings;
    const auto margin = [&](Method method, float jitter) {
        settings.method = method;
        settings.jitter = jitter;
        return resolve(settings, 8, 8, 1.0).marginPx;
    };
    EXPECT_EQ(margin(Method::Gather, 1.0f), 0.0f);
    EXPECT_EQ(margin(Method::Guertin2014, 1.0f), 10.0f) << "a quarter of a tile";
    EXPECT_EQ(margin(Method::Guertin2014, 0.0f), 0.0f);
    EXPECT_EQ(margin(Method::Jimenez2014, 1.0f), 10.0f);
    settings.sampleCount = 8;
    EXPECT_EQ(margin(Method::Jimenez2014, 0.0f), 5.0f) << "one tap's distance";
}

TEST(MotionBlurSettings, ANeighbourhoodWithoutAMiddleTileIsRefused) {
    for (uint32_t tiles = 1; tiles <= 15; ++tiles)
        EXPECT_EQ(
            validateWith([&](auto& s) { s.neighbourhoodTiles = tiles; }).ok(), tiles % 2 == 1
        );
}

TEST(MotionBlurSettings, TilesCoverThePictureAndNoMore) {
    const auto tiles = [](uint32_t width, uint32_t height) {
        return resolve({}, width, height, 1.0).tileCount;
    };
    EXPECT_EQ(tiles(1, 1), glm::uvec2(1, 1));
    EXPECT_EQ(tiles(40, 41), glm::uvec2(1, 2));
    EXPECT_EQ(tiles(1280, 720), glm::uvec2(32, 18));
}

TEST(MotionBlurSettings, ResolveHandsEverySettingOn) {
    MotionBlurSettings settings;
    settings.tileSizePx = 20;
    settings.neighbourhoodTiles = 7;
    settings.sampleCount = 31;
    settings.softDepthExtent = 0.5f;
    settings.edgeThreshold = 0.25f;
    settings.recursionLimit = 9;
    settings.objectTest = ObjectTest::Luminance;
    settings.luminanceThreshold = 0.125f;
    settings.foregroundMagnification = 12.0f;
    settings.backgroundMagnification = 6.0f;
    settings.jitter = 0.75f;
    settings.occluderTest = OccluderTest::Velocity;
    settings.centreBias = 20.0f;
    settings.speedThresholdPx = 2.5f;
    settings.uniformMotionPx = 0.25f;
    settings.maxMotionDepth = 50.0f;
    const shader::MotionBlurParams params = resolve(settings, 100, 50, 0.5);
    EXPECT_EQ(params.uniformMotionPx, 0.25f);
    EXPECT_EQ(params.maxMotionDepth, 50.0f);
    EXPECT_EQ(params.sizePx, glm::uvec2(100, 50));
    EXPECT_EQ(params.tileCount, glm::uvec2(5, 3));
    EXPECT_EQ(params.tileSizePx, 20u);
    EXPECT_EQ(params.neighbourRadius, 3);
    EXPECT_EQ(params.sampleCount, 31u);
    EXPECT_EQ(params.softDepthExtent, 0.5f);
    EXPECT_EQ(params.edgeThreshold, 0.25f);
    EXPECT_EQ(params.rasterTime, 0.5f);
    EXPECT_EQ(params.foregroundMagnification, 12.0f);
    EXPECT_EQ(params.backgroundMagnification, 6.0f);
    EXPECT_EQ(params.jitter, 0.75f);
    EXPECT_EQ(params.recursionLimit, 9u);
    EXPECT_EQ(
        params.flags,
        shader::kFlagLuminanceTest | shader::kFlagSteppingReveal | // by luminance: always
            shader::kFlagVelocityOccluder
    );
    EXPECT_EQ(params.luminanceThreshold, 0.125f);
    EXPECT_EQ(params.centreBias, 20.0f);
    EXPECT_EQ(params.speedThresholdPx, 2.5f);
    EXPECT_EQ(resolve({}, 8, 8, 1.0).flags, 0u);
    settings = {};
    settings.revealTraversal = RevealTraversal::Stepping;
    EXPECT_EQ(resolve(settings, 8, 8, 1.0).flags, shader::kFlagSteppingReveal);
}

TEST(MotionBlurSettings, EachMethodListsWhatItReads) {
    const auto reads = [](Method method, std::string_view name) {
        const auto names = listSettings(method);
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    const Method methods[] = {
        Method::Gather,
        Method::Hybrid,
        Method::OwnVelocity,
        Method::McGuire2012,
        Method::Guertin2014,
        Method::Jimenez2014};
    for (const Method method : methods) {
        EXPECT_TRUE(reads(method, "jitter"));
        EXPECT_TRUE(reads(method, "maxMotionDepth"));
        EXPECT_EQ(
            reads(method, "uniformMotionPx"), method == Method::Gather || method == Method::Hybrid
        );
        EXPECT_EQ(reads(method, "edgeThreshold"), method == Method::Hybrid);
        EXPECT_EQ(reads(method, "occluderTest"), method == Method::OwnVelocity);
        EXPECT_EQ(reads(method, "centreBias"), method == Method::Guertin2014);
        EXPECT_EQ(reads(method, "tileSizePx"), method != Method::OwnVelocity);
        EXPECT_EQ(
            reads(method, "foregroundMagnification"),
            method == Method::Gather || method == Method::Hybrid
        );
    }
}

TEST(MotionBlurSettings, TheRasterInstantLiesInsideTheExposure) {
    EXPECT_EQ(resolve({}, 8, 8, -1.0).rasterTime, 0.0f);
    EXPECT_EQ(resolve({}, 8, 8, 2.0).rasterTime, 1.0f);
}

} // namespace shutter::motion_blur
