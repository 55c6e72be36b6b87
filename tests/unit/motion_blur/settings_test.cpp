// SPDX-License-Identifier: MIT
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/settings.h"
#include "shaders/motion_blur/hybrid_shared.h"

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

TEST(MotionBlurSettings, ThePapersAreThoseThatItPrintsAndValid) {
    const MotionBlurSettings settings = paperSettings();
    EXPECT_TRUE(validate(settings).ok());
    EXPECT_EQ(settings.method, &getMethod("hybrid"));
    EXPECT_EQ(settings.tileSizePx, 40u);
    EXPECT_EQ(settings.neighbourhoodTiles, 3u);
    EXPECT_EQ(settings.sampleCount, 15u);
    EXPECT_EQ(settings.softDepthExtent, 0.03f);
    EXPECT_EQ(settings.softDepthShare, 0.0f);
    EXPECT_EQ(settings.edgeThreshold, 0.9f);
    EXPECT_EQ(settings.foregroundMagnification, 30.0f);
    EXPECT_EQ(settings.backgroundMagnification, 3.0f);
    EXPECT_EQ(settings.recursionLimit, 5u);
    EXPECT_EQ(settings.maskTest, MaskTest::Paper);
}

TEST(MotionBlurSettings, TheDefaultsNeedNoMoreThanEveryHostHas) {
    const MotionBlurSettings settings;
    EXPECT_TRUE(validate(settings).ok());
    EXPECT_EQ(settings.method->rays, RayNeed::None);
    EXPECT_FALSE(settings.method->readsNormal);
    EXPECT_FALSE(settings.method->readsEntityId);
    EXPECT_FALSE(settings.method->readsCamera);
    EXPECT_FALSE(settings.method->readsInstantMotions);
}

TEST(MotionBlurSettings, TilesGrowWithThePictureUnlessTheirSizeIsGiven) {
    MotionBlurSettings settings;
    for (const auto& [height, tile] :
         {std::pair(0u, 40u),
          {1u, 40u},
          {480u, 40u},
          {720u, 60u},
          {1080u, 90u},
          {2160u, 180u},
          {32768u, 256u}})
        EXPECT_EQ(chooseTileSize(settings, height), tile) << height;
    settings.tileSizePx = 7;
    EXPECT_EQ(chooseTileSize(settings, 1080), 7u);
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
    for (const Method* method : {&getMethod("gather"), &getMethod("hybrid")}) {
        settings.method = method;
        EXPECT_EQ(resolve(settings, 8, 8, 1.0).uniformMotionPx, 0.5f);
    }
    for (const Method* method :
         {&getMethod("own_velocity"),
          &getMethod("mcguire2012"),
          &getMethod("guertin2014"),
          &getMethod("jimenez2014")}) {
        settings.method = method;
        EXPECT_EQ(resolve(settings, 8, 8, 1.0).uniformMotionPx, 0.0f);
    }
}

TEST(MotionBlurSettings, BlocksLookAsFarAsTheirFiltersDo) {
    MotionBlurSettings settings;
    const auto margin = [&](const Method* method, float jitter) {
        settings.method = method;
        settings.jitter = jitter;
        return resolve(settings, 8, 8, 1.0).marginPx;
    };
    EXPECT_EQ(margin(&getMethod("gather"), 1.0f), 0.0f);
    EXPECT_EQ(margin(&getMethod("guertin2014"), 1.0f), 10.0f) << "a quarter of a tile";
    EXPECT_EQ(margin(&getMethod("guertin2014"), 0.0f), 0.0f);
    EXPECT_EQ(margin(&getMethod("jimenez2014"), 1.0f), 10.0f);
    settings.sampleCount = 8;
    EXPECT_EQ(margin(&getMethod("jimenez2014"), 0.0f), 5.0f) << "one tap's distance";
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
    EXPECT_EQ(tiles(1280, 720), glm::uvec2(22, 12)) << "of 60 px";
}

TEST(MotionBlurSettings, ResolveTurnsSettingsIntoWhatShadersRead) {
    MotionBlurSettings settings;
    settings.method = &getMethod("gather");
    settings.tileSizePx = 20;
    settings.neighbourhoodTiles = 7;
    settings.sampleCount = 31;
    settings.softDepthExtent = 0.5f;
    settings.softDepthShare = 0.25f;
    settings.jitter = 0.75f;
    settings.uniformMotionPx = 0.25f;
    settings.maxMotionDepth = 50.0f;
    const PassParams params = resolve(settings, 100, 50, 0.5);
    EXPECT_EQ(params.sizePx, glm::uvec2(100, 50));
    EXPECT_EQ(params.tileCount, glm::uvec2(5, 3));
    EXPECT_EQ(params.tileSizePx, 20u);
    EXPECT_EQ(params.neighbourRadius, 3);
    EXPECT_EQ(params.sampleCount, 31u);
    EXPECT_EQ(params.softDepthExtent, 0.5f);
    EXPECT_EQ(params.softDepthShare, 0.25f);
    EXPECT_EQ(params.rasterTime, 0.5f);
    EXPECT_EQ(params.jitter, 0.75f);
    EXPECT_EQ(params.uniformMotionPx, 0.25f);
    EXPECT_EQ(params.maxMotionDepth, 50.0f);
}

TEST(MotionBlurSettings, TheHybridMethodsOwnBlockHoldsItsSettings) {
    MotionBlurSettings settings;
    settings.method = &getMethod("hybrid");
    const auto own = [&] { return resolve(settings, 8, 8, 1.0).getMethod<shader::HybridParams>(); };
    EXPECT_EQ(own().flags, shader::kFlagRelativeMask);
    settings.maskTest = MaskTest::Paper;
    EXPECT_EQ(own().flags, 0u);
    settings.edgeThreshold = 0.25f;
    settings.recursionLimit = 9;
    settings.luminanceThreshold = 0.125f;
    settings.foregroundMagnification = 12.0f;
    settings.backgroundMagnification = 6.0f;
    settings.halfResolutionPx = 24.0f;
    settings.rayShare = 0.5f;
    EXPECT_EQ(own().edgeThreshold, 0.25f);
    EXPECT_EQ(own().recursionLimit, 9u);
    EXPECT_EQ(own().luminanceThreshold, 0.125f);
    EXPECT_EQ(own().gather.foregroundMagnification, 12.0f);
    EXPECT_EQ(own().gather.backgroundMagnification, 6.0f);
    EXPECT_EQ(own().gather.halfResolutionPx, 24.0f);
    EXPECT_EQ(own().rayShare, 0.5f);
    settings.objectTest = ObjectTest::Luminance;
    EXPECT_EQ(own().flags, shader::kFlagLuminanceTest | shader::kFlagSteppingReveal)
        << "by luminance it always steps";
    settings.objectTest = ObjectTest::MeshId;
    settings.revealTraversal = RevealTraversal::Stepping;
    EXPECT_EQ(own().flags, shader::kFlagSteppingReveal);
}

/// A setting that changed nothing of what its method's shaders get would be read by nobody.
TEST(MotionBlurSettings, EachSettingOfAMethodReachesItsShaders) {
    const auto bytes = [](const MotionBlurSettings& settings) {
        const PassParams params = resolve(settings, 640, 360, 0.5);
        return std::string(reinterpret_cast<const char*>(&params), sizeof(params));
    };
    for (const Method* method : listMethods()) {
        MotionBlurSettings settings;
        settings.method = method;
        for (const std::string_view name : method->settings) {
            // The number of passes, how many layers there are, the tables, and a share of the
            // picture's size.
            if (name == "filterLevels" || name == "history" || name == "instantNoise" ||
                name == "raysPerPixel" || name == "secondRaster")
                continue;
            const auto* row = core::findRow(listSettingRows(), name);
            ASSERT_TRUE(row) << method->name << " " << name;
            MotionBlurSettings changed = settings;
            if (const auto* words = std::get_if<core::WordField<MotionBlurSettings>>(&row->field))
                words->set(changed, words->get(changed) == 0 ? words->words.size() - 1 : 0);
            else
                ASSERT_TRUE(core::setNumber(
                    *row,
                    changed,
                    core::getNumber(*row, changed) == row->range.lowest ? row->range.highest
                                                                        : row->range.lowest
                )) << name;
            EXPECT_NE(bytes(changed), bytes(settings)) << method->name << " " << name;
        }
    }
}

TEST(MotionBlurSettings, TheRasterInstantLiesInsideTheExposure) {
    EXPECT_EQ(resolve({}, 8, 8, -1.0).rasterTime, 0.0f);
    EXPECT_EQ(resolve({}, 8, 8, 2.0).rasterTime, 1.0f);
}

} // namespace shutter::motion_blur
