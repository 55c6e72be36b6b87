// SPDX-License-Identifier: MIT
#include "modules/motion_blur/instant_motions.h"
#include "shaders/motion_blur/resolved_shared.h"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

namespace shutter::motion_blur {
namespace {

constexpr uint32_t kFull = shader::kCandidatesPerTile;

/// \param movers that each have a row; the sky's follows them
math::LayerTables makeLayer(std::vector<uint32_t> movers, bool isStill) {
    movers.push_back(shader::kSkyMover);
    return {.movers = std::move(movers), .isStill = isStill};
}

math::InstantLayers makeLayers(std::vector<uint32_t> movers, bool isStill) {
    math::InstantLayers layers;
    layers.raster = makeLayer(std::move(movers), isStill);
    return layers;
}

std::vector<uint32_t> countUp(uint32_t count) {
    std::vector<uint32_t> movers;
    for (uint32_t i = 0; i < count; ++i)
        movers.push_back(shader::kSkyMover + 1 + i);
    return movers;
}

TEST(CrowdedTiles, NeedMoreMoversThanAListHolds) {
    EXPECT_FALSE(mayCrowdTiles(makeLayers(countUp(kFull), true)));
    EXPECT_TRUE(mayCrowdTiles(makeLayers(countUp(kFull + 1), true)));
}

TEST(CrowdedTiles, CountWhatStandsStillAndTheSkyOnlyBeforeACameraThatMoves) {
    const std::vector<uint32_t> still(kFull, shader::kWorldMover);
    EXPECT_FALSE(mayCrowdTiles(makeLayers(still, true)));
    EXPECT_TRUE(mayCrowdTiles(makeLayers(still, false))) << "the sky is one more";
    const std::vector<uint32_t> fewer(kFull - 1, shader::kWorldMover);
    EXPECT_FALSE(mayCrowdTiles(makeLayers(fewer, false)));
}

TEST(CrowdedTiles, MayBeThoseThatSeveralPartsOfOneDeformedEntityReach) {
    math::InstantLayers layers = makeLayers({shader::kDeformedMover}, true);
    layers.raster.deforms = true;
    EXPECT_TRUE(mayCrowdTiles(layers));
}

TEST(CrowdedTiles, CountNothingOfWhichNothingIsKnown) {
    EXPECT_FALSE(mayCrowdTiles(makeLayers(std::vector<uint32_t>(3 * kFull, shader::kNoMover), true))
    );
}

TEST(CrowdedTiles, MayBeThoseOfAnyLayer) {
    math::InstantLayers layers = makeLayers(countUp(1), true);
    layers.last = makeLayer(countUp(kFull + 1), true);
    EXPECT_TRUE(mayCrowdTiles(layers));
    layers.last.reset();
    layers.second = makeLayer(countUp(kFull + 1), true);
    EXPECT_TRUE(mayCrowdTiles(layers));
}

} // namespace
} // namespace shutter::motion_blur
