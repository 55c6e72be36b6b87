// SPDX-License-Identifier: MIT
// Settings, their rows, and what methods make of them.
#include "modules/motion_blur/instant_motions.h"
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/settings.h"
#include "shaders/motion_blur/hybrid_shared.h"
#include "shaders/motion_blur/resolved_shared.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::motion_blur {
namespace {

using Field = std::function<void(MotionBlurSettings&)>;

core::Status validateWith(const Field& set) {
    MotionBlurSettings settings;
    set(settings);
    return validate(settings);
}

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

TEST(MotionBlurSettings, UnsetFieldsAreTheDefaultMethodWhichWithoutMotionReadsCommonInputs) {
    EXPECT_TRUE(validate(MotionBlurSettings{}).ok());
    EXPECT_EQ(complete({}).method, &getMethod("resolved"));
    for (const Method* method : listMethods()) {
        EXPECT_EQ(complete({.method = method}).sampleCount, method->defaultSamples);
        EXPECT_EQ(complete({.method = method, .sampleCount = 3}).sampleCount, 3u);
    }
    const MotionBlurSettings settings = complete({}, false);
    EXPECT_TRUE(settings.method->readsImagesOnly());
    EXPECT_FALSE(settings.method->readsNormal);
    EXPECT_FALSE(settings.method->readsEntityId);
}

TEST(MotionBlurSettings, TilesGrowWithThePictureUnlessTheirSizeIsGivenAndCoverNoMore) {
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
    const auto tiles = [](uint32_t width, uint32_t height) {
        return resolve({}, width, height, 1.0).tileCount;
    };
    EXPECT_EQ(tiles(1, 1), glm::uvec2(1, 1));
    EXPECT_EQ(tiles(40, 41), glm::uvec2(1, 2));
    EXPECT_EQ(tiles(1280, 720), glm::uvec2(22, 12)) << "of 60 px";
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

TEST(MotionBlurSettings, BlocksReachAsFarAsTheirFilters) {
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

/// A setting that changes no input of its method's shaders is never read.
TEST(MotionBlurSettings, EachSettingOfAMethodReachesItsShaders) {
    const auto bytes = [](const MotionBlurSettings& settings) {
        const PassParams params = resolve(settings, 640, 360, 0.5);
        return std::string(reinterpret_cast<const char*>(&params), sizeof(params));
    };
    for (const Method* method : listMethods()) {
        MotionBlurSettings settings;
        settings.method = method;
        for (const std::string_view name : method->settings) {
            // Which passes there are and how many, how many layers, the tables, and a share of the
            // picture's size.
            if (name == "composite" || name == "filterLevels" || name == "history" ||
                name == "instantNoise" || name == "raysPerPixel" || name == "secondRaster")
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

using Row = core::SettingRow<MotionBlurSettings>;

/// Sets the field without validating the row's range.
void force(const Row& row, MotionBlurSettings& settings, double value) {
    if (const auto* whole = std::get_if<uint32_t MotionBlurSettings::*>(&row.field))
        settings.** whole = static_cast<uint32_t>(value);
    else
        settings.**std::get_if<float MotionBlurSettings::*>(&row.field) = static_cast<float>(value);
}

core::Status validateWith(const Row& row, double value) {
    MotionBlurSettings settings;
    force(row, settings, value);
    return validate(settings);
}

/// Converts to any field's type.
struct Anything {
    template <class T> operator T() const; // NOLINT: never defined, used in requires alone
};

/// Number of fields of an aggregate: as many initializers as it takes.
template <class T, class... Initializers> constexpr size_t countFields() {
    if constexpr (requires { T{Initializers{}..., Anything{}}; })
        return countFields<T, Initializers..., Anything>();
    else
        return sizeof...(Initializers);
}

TEST(SettingRows, BothEndsOfEveryRangeAreValid) {
    for (const Row& row : listSettingRows()) {
        if (!core::isNumber(row))
            continue;
        EXPECT_TRUE(validateWith(row, row.range.lowest).ok()) << row.name;
        EXPECT_TRUE(validateWith(row, row.range.highest).ok()) << row.name;
        EXPECT_EQ(row.range.step == 0.0 && validateWith(row, INFINITY).ok(), row.range.isUnlimited)
            << row.name;
    }
}

TEST(SettingRows, ANumberOutsideItsRangeIsRefusedByName) {
    for (const Row& row : listSettingRows()) {
        if (!core::isNumber(row))
            continue;
        const bool isWhole = std::holds_alternative<uint32_t MotionBlurSettings::*>(row.field);
        std::vector<double> bad = {row.range.highest + (isWhole ? 1.0 : 0.001 * row.range.highest)};
        if (!isWhole)
            bad.insert(bad.end(), {row.range.lowest - 1e-4, NAN, -INFINITY, -1e7});
        else if (row.range.lowest > 0.0)
            bad.push_back(row.range.lowest - 1.0);
        for (const double value : bad) {
            const core::Status valid = validateWith(row, value);
            ASSERT_FALSE(valid.ok()) << row.name << " " << value;
            EXPECT_NE(valid.error().message.find(row.name), std::string::npos)
                << valid.error().message;
        }
    }
}

TEST(SettingRows, EveryNameLabelAndMeaningIsThereOnce) {
    std::set<std::string_view> names;
    std::set<std::string_view> labels;
    for (const Row& row : listSettingRows()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_TRUE(labels.insert(row.label).second) << row.name;
        EXPECT_FALSE(std::string_view(row.label).empty()) << row.name;
        EXPECT_TRUE(std::string_view(row.meaning).ends_with('.')) << row.name;
    }
    EXPECT_EQ(names.size(), listSettingRows().size());
}

/// A field without a row would never be validated, saved or shown.
TEST(SettingRows, EveryFieldHasARow) {
    EXPECT_EQ(countFields<MotionBlurSettings>(), listSettingRows().size() + 1) << "and `method`";
}

TEST(SettingRows, EverySettingIsReadByAMethodAndEachNameReadHasARow) {
    std::set<std::string_view> rows;
    for (const Row& row : listSettingRows())
        rows.insert(row.name);
    std::set<std::string_view> read = {"sampleCount"};
    for (const Method* method : listMethods())
        for (const std::string_view name : method->settings)
            read.insert(name);
    EXPECT_EQ(rows, read);
}

constexpr uint32_t kFull = shader::kCandidatesPerTile;

/// \param movers that each have a row; the sky's follows them
math::LayerTables makeLayer(std::vector<uint32_t> movers, bool isStatic) {
    movers.push_back(shader::kSkyMover);
    return {.movers = std::move(movers), .isStatic = isStatic};
}

math::InstantLayers makeLayers(std::vector<uint32_t> movers, bool isStatic) {
    math::InstantLayers layers;
    layers.raster = makeLayer(std::move(movers), isStatic);
    return layers;
}

std::vector<uint32_t> countUp(uint32_t count) {
    std::vector<uint32_t> movers;
    for (uint32_t i = 0; i < count; ++i)
        movers.push_back(shader::kSkyMover + 1 + i);
    return movers;
}

TEST(CrowdedTiles, NeedMoreMoversThanAListHoldsWhereSurfacesAndTheSkyMoveWithTheCamera) {
    EXPECT_FALSE(mayCrowdTiles(makeLayers(countUp(kFull), true)));
    EXPECT_TRUE(mayCrowdTiles(makeLayers(countUp(kFull + 1), true)));
    const std::vector<uint32_t> still(kFull, shader::kWorldMover);
    EXPECT_FALSE(mayCrowdTiles(makeLayers(still, true)));
    EXPECT_TRUE(mayCrowdTiles(makeLayers(still, false))) << "the sky is one more";
    const std::vector<uint32_t> fewer(kFull - 1, shader::kWorldMover);
    EXPECT_FALSE(mayCrowdTiles(makeLayers(fewer, false)));
    EXPECT_FALSE(mayCrowdTiles(makeLayers(std::vector<uint32_t>(3 * kFull, shader::kNoMover), true))
    );
}

TEST(CrowdedTiles, TilesOfAnyLayerOrReachedBySeveralPartsOfOneEntityMayBeCrowded) {
    math::InstantLayers layers = makeLayers({shader::kDeformedMover}, true);
    layers.raster.deforms = true;
    EXPECT_TRUE(mayCrowdTiles(layers));
    layers = makeLayers(countUp(1), true);
    layers.last = makeLayer(countUp(kFull + 1), true);
    EXPECT_TRUE(mayCrowdTiles(layers));
    layers.last.reset();
    layers.second = makeLayer(countUp(kFull + 1), true);
    EXPECT_TRUE(mayCrowdTiles(layers));
}

} // namespace
} // namespace shutter::motion_blur
