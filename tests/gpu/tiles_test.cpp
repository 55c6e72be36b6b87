// SPDX-License-Identifier: MIT
// Tile max and neighbour max, and Guertin's dominant motion and variance, on the device against the
// same rules in C++.
#include "modules/motion_blur/passes/tile_motion.h"
#include "modules/motion_blur/settings.h"
#include "shaders/motion_blur/guertin2014.glsl"
#include "shaders/motion_blur/weights.glsl"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>
#include <vector>

namespace shutter {
namespace {

using glm::ivec2;
using glm::vec2;
using image::Image;

class TileMotion : public test::GpuTest {};

constexpr uint32_t kTilePx = 40;

struct Tiles {
    Image longest;
    Image dominant;
};

Tiles runPasses(gpu::Device& device, const Image& motion, uint32_t neighbourhoodTiles) {
    motion_blur::MotionBlurSettings settings;
    settings.tileSizePx = kTilePx;
    settings.neighbourhoodTiles = neighbourhoodTiles;
    const auto params = motion_blur::resolve(settings, motion.width, motion.height, 1.0);
    test::GraphRig rig(device);
    const motion_blur::TileMotion passes(device);
    const auto outputs = passes.add(rig.graph, rig.upload(motion), params);
    const size_t tiles = rig.want(outputs.tiles);
    const size_t dominant = rig.want(outputs.dominant);
    run(rig);
    return {rig.take(tiles), rig.take(dominant)};
}

vec2 motionAt(const Image& picture, uint32_t x, uint32_t y) {
    return {picture.at(x, y, 0), picture.at(x, y, 1)};
}

bool isFinite(const vec2& v) {
    return std::isfinite(v.x) && std::isfinite(v.y);
}

/// The device's answer must be one of `candidates`, and none may be longer. Lengths and clamping
/// are some ten operations on numbers up to 40, 2^-24 each: 1e-4 is wide.
void expectLongest(const vec2& actual, const std::vector<vec2>& candidates) {
    constexpr float kTolerancePx = 1e-4f;
    float longest = 0.0f;
    bool isCandidate = false;
    for (const vec2& candidate : candidates) {
        longest = std::max(longest, glm::length(candidate));
        isCandidate = isCandidate || glm::length(candidate - actual) <= kTolerancePx;
    }
    ASSERT_TRUE(isFinite(actual));
    EXPECT_TRUE(isCandidate || glm::length(actual) == 0.0f) << actual.x << ", " << actual.y;
    EXPECT_NEAR(glm::length(actual), longest, kTolerancePx);
}

void expectTiles(const Image& motion, const Tiles& tiles, int radius) {
    const uint32_t columns = (motion.width + kTilePx - 1) / kTilePx;
    const uint32_t rows = (motion.height + kTilePx - 1) / kTilePx;
    for (const Image* picture : {&tiles.longest, &tiles.dominant}) {
        ASSERT_EQ(picture->width, columns);
        ASSERT_EQ(picture->height, rows);
    }
    for (uint32_t row = 0; row < rows; ++row)
        for (uint32_t column = 0; column < columns; ++column) {
            std::vector<vec2> inTile;
            for (uint32_t y = row * kTilePx; y < std::min((row + 1) * kTilePx, motion.height); ++y)
                for (uint32_t x = column * kTilePx;
                     x < std::min((column + 1) * kTilePx, motion.width);
                     ++x) {
                    const vec2 clamped =
                        shader::clampMotion(motionAt(motion, x, y), float(kTilePx));
                    if (isFinite(clamped))
                        inTile.push_back(clamped);
                }
            expectLongest(motionAt(tiles.longest, column, row), inTile);
            std::vector<vec2> around;
            for (int y = std::max(int(row) - radius, 0);
                 y <= std::min(int(row) + radius, int(rows) - 1);
                 ++y)
                for (int x = std::max(int(column) - radius, 0);
                     x <= std::min(int(column) + radius, int(columns) - 1);
                     ++x)
                    around.push_back(motionAt(tiles.longest, uint32_t(x), uint32_t(y)));
            expectLongest(motionAt(tiles.dominant, column, row), around);
        }
}

/// Short motions everywhere; in some tiles, one pixel that is long, some longer than a tile.
Image makeRandomMotion(uint32_t width, uint32_t height, uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> shortMotion(-5.0f, 5.0f);
    std::uniform_real_distribution<float> longMotion(-60.0f, 60.0f);
    Image motion(width, height, 4);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const bool isLong = random() % 4000 == 0;
            motion.at(x, y, 0) = isLong ? longMotion(random) : shortMotion(random);
            motion.at(x, y, 1) = isLong ? longMotion(random) : shortMotion(random);
            motion.at(x, y, 2) = 1.0f;
        }
    return motion;
}

TEST_F(TileMotion, EverySizeAndNeighbourhoodHasTheLongestMotionOfEachTile) {
    for (const auto& [width, height, radius] :
         {std::tuple{1u, 1u, 1u},
          {40u, 40u, 1u},
          {41u, 39u, 1u},
          {120u, 80u, 1u},
          {330u, 250u, 0u},
          {330u, 250u, 2u},
          {1366u, 768u, 1u}}) {
        const Image motion = makeRandomMotion(width, height, width * 7 + height);
        SCOPED_TRACE(fmt::format("{}x{}, {}", width, height, radius));
        expectTiles(motion, runPasses(device(), motion, 2 * radius + 1), int(radius));
    }
}

TEST_F(TileMotion, NaNAndInfinityNeverLeaveTheirPixel) {
    Image motion = makeRandomMotion(121, 83, 3);
    const float values[] = {
        std::numeric_limits<float>::quiet_NaN(),
        std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()};
    std::mt19937 random(9);
    for (int i = 0; i < 2000; ++i)
        motion.at(uint32_t(random() % 121), uint32_t(random() % 83), uint32_t(random() % 2)) =
            values[random() % 3];
    // The first and the last pixel of a tile start and end a thread's walk.
    motion.at(0, 0, 0) = motion.at(39, 39, 1) = values[0];
    const Tiles tiles = runPasses(device(), motion, 3);
    EXPECT_TRUE(test::allFinite(tiles.longest));
    EXPECT_TRUE(test::allFinite(tiles.dominant));
    expectTiles(motion, tiles, 1);
}

TEST_F(TileMotion, EachKindOfValueThatIsNotFiniteIsPassedOver) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Tiles none = runPasses(device(), test::makePicture(41, 41, nan), 3);
    for (float value : none.dominant.pixels)
        EXPECT_EQ(value, 0.0f) << "nothing but NaN is no motion";
    const float infinity = std::numeric_limits<float>::infinity();
    for (const vec2& bad :
         {vec2(nan, 0),
          vec2(3, nan),
          vec2(nan, nan),
          vec2(infinity, 0),
          vec2(0, -infinity),
          vec2(-infinity, infinity),
          vec2(nan, infinity),
          vec2(3e38f, 3e38f)}) { // its length overflows
        SCOPED_TRACE(fmt::format("{}, {}", bad.x, bad.y));
        Image motion(40, 40, 4);
        // A thread of the tile walks over (2, 2), (10, 2), (18, 2): before, bad, after.
        motion.at(2, 2, 0) = 6.0f;
        motion.at(10, 2, 0) = bad.x;
        motion.at(10, 2, 1) = bad.y;
        motion.at(18, 2, 0) = 4.0f;
        EXPECT_EQ(motionAt(runPasses(device(), motion, 3).dominant, 0, 0), vec2(6, 0));
        motion.at(18, 2, 0) = 7.0f;
        EXPECT_EQ(motionAt(runPasses(device(), motion, 3).dominant, 0, 0), vec2(7, 0));
    }
}

class GuertinTiles : public test::GpuTest {};

struct GuertinOutputs {
    Image dominant;
    Image variance;
};

/// One texel of `motion` is one tile.
GuertinOutputs runPass(gpu::Device& device, const Image& motion, uint32_t neighbourhoodTiles = 3) {
    motion_blur::MotionBlurSettings settings;
    settings.neighbourhoodTiles = neighbourhoodTiles;
    settings.tileSizePx = 40;
    const auto params = motion_blur::resolve(settings, motion.width * 40, motion.height * 40, 0.5);
    test::GraphRig rig(device);
    const motion_blur::GuertinTiles pass(device);
    const auto outputs = pass.add(rig.graph, rig.upload(motion), params);
    const size_t dominant = rig.want(outputs.dominant);
    const size_t variance = rig.want(outputs.variance);
    run(rig);
    return {rig.take(dominant), rig.take(variance)};
}

/// A third of the tiles is still; no two motions have one length.
Image makeTiles(uint32_t width, uint32_t height) {
    std::mt19937 random(width * 31 + height);
    std::uniform_real_distribution<float> component(-20.0f, 20.0f);
    Image motion(width, height, 4);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            for (uint32_t c = 0; c < 2 && random() % 3 != 0; ++c)
                motion.at(x, y, c) = component(random);
    return motion;
}

struct Expected {
    vec2 dominant{0.0f};
    double variance = 0.0;
};

Expected expectTile(const Image& motion, ivec2 tile, int radius) {
    Expected expected;
    std::vector<vec2> moving;
    for (int y = std::max(tile.y - radius, 0);
         y <= std::min(tile.y + radius, int(motion.height) - 1);
         ++y)
        for (int x = std::max(tile.x - radius, 0);
             x <= std::min(tile.x + radius, int(motion.width) - 1);
             ++x) {
            const vec2 candidate = motionAt(motion, uint32_t(x), uint32_t(y));
            if (glm::length(candidate) >= shader::kStillPx)
                moving.push_back(candidate);
            if (shader::reachesTile(ivec2(x, y) - tile, candidate) &&
                glm::length(candidate) > glm::length(expected.dominant))
                expected.dominant = candidate;
        }
    if (glm::length(expected.dominant) < shader::kStillPx)
        return expected;
    const vec2 own = motionAt(motion, uint32_t(tile.x), uint32_t(tile.y));
    const vec2 reference = glm::length(own) < shader::kStillPx ? expected.dominant : own;
    double sum = 0.0;
    for (const vec2& other : moving)
        sum += double(shader::alignment(reference, other));
    expected.variance = 1.0 - sum / double(moving.size());
    return expected;
}

TEST_F(GuertinTiles, EachTileHasTheLongestThatReachesItAndTheVarianceAround) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {2u, 1u}, {9u, 7u}, {32u, 18u}}) {
        const Image motion = makeTiles(width, height);
        for (const int radius : {0, 1, 2}) {
            const GuertinOutputs tiles = runPass(device(), motion, uint32_t(2 * radius + 1));
            for (int y = 0; y < int(height); ++y)
                for (int x = 0; x < int(width); ++x) {
                    const Expected expected = expectTile(motion, {x, y}, radius);
                    ASSERT_EQ(motionAt(tiles.dominant, uint32_t(x), uint32_t(y)), expected.dominant)
                        << x << ", " << y;
                    // Some 30 operations in single precision on numbers near 1.
                    ASSERT_NEAR(
                        tiles.variance.at(uint32_t(x), uint32_t(y), 0), expected.variance, 1e-5
                    ) << x
                      << ", " << y;
                }
        }
    }
}

} // namespace
} // namespace shutter
