// SPDX-License-Identifier: MIT
// Guertin's dominant motion and variance on the device against the same rules in C++.
#include "modules/motion_blur/passes/tile_motion.h"
#include "modules/motion_blur/settings.h"
#include "shaders/motion_blur/guertin2014.glsl"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"

#include <algorithm>
#include <random>
#include <vector>

namespace shutter {
namespace {

using glm::ivec2;
using glm::vec2;
using image::Image;

class GuertinTiles : public test::GpuTest {};

struct Tiles {
    Image dominant;
    Image variance;
};

/// One texel of `motion` is one tile.
Tiles runPass(gpu::Device& device, const Image& motion, uint32_t neighbourhoodTiles = 3) {
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

vec2 motionAt(const Image& picture, int x, int y) {
    return {picture.at(uint32_t(x), uint32_t(y), 0), picture.at(uint32_t(x), uint32_t(y), 1)};
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
            const vec2 candidate = motionAt(motion, x, y);
            if (glm::length(candidate) >= shader::kStillPx)
                moving.push_back(candidate);
            if (shader::reachesTile(ivec2(x, y) - tile, candidate) &&
                glm::length(candidate) > glm::length(expected.dominant))
                expected.dominant = candidate;
        }
    if (glm::length(expected.dominant) < shader::kStillPx)
        return expected;
    const vec2 own = motionAt(motion, tile.x, tile.y);
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
            const Tiles tiles = runPass(device(), motion, uint32_t(2 * radius + 1));
            for (int y = 0; y < int(height); ++y)
                for (int x = 0; x < int(width); ++x) {
                    const Expected expected = expectTile(motion, {x, y}, radius);
                    ASSERT_EQ(motionAt(tiles.dominant, x, y), expected.dominant) << x << ", " << y;
                    // Some 30 operations in single precision on numbers near 1.
                    ASSERT_NEAR(
                        tiles.variance.at(uint32_t(x), uint32_t(y), 0), expected.variance, 1e-5
                    ) << x
                      << ", " << y;
                }
        }
    }
}

TEST_F(GuertinTiles, WhatMovesAlikeHasNoVarianceAndWhatStandsStillNeither) {
    Image alike(5, 5, 4);
    for (uint32_t y = 0; y < 5; ++y)
        for (uint32_t x = 0; x < 5; ++x) {
            alike.at(x, y, 0) = 7.0f + float(x);
            alike.at(x, y, 1) = 7.0f + float(x);
        }
    for (const Image& motion : {alike, Image(5, 5, 4)})
        for (float variance : runPass(device(), motion).variance.pixels)
            EXPECT_NEAR(variance, 0.0f, 1e-6f);
}

} // namespace
} // namespace shutter
