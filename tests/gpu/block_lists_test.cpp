// SPDX-License-Identifier: MIT
// The lists of blocks on the device against the same rules in C++, and what the filters do with
// them.
#include "engine/image/image.h"
#include "modules/motion_blur/motion_blur.h"
#include "modules/motion_blur/passes/block_lists.h"
#include "modules/motion_blur/passes/still_pixels.h"
#include "shaders/motion_blur/block_class.glsl"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

// clang-format off: needs <cstdint> before it
#include "spirv/motion_blur/copy_blocks.comp.h"

// clang-format on

namespace shutter {
namespace {

using glm::ivec2;
using glm::vec2;
using image::Image;
using motion_blur::MotionBlurSettings;
using test::makePicture;

class BlockLists : public test::GpuTest {};

constexpr float kPoison = 7.0f;

struct Sorted {
    Image tiles;
    Image dominant;
    Image tileClass;
    std::array<Image, 3> written; ///< 1 in the blocks of the uniform, the mixed, the candidate list
    motion_blur::BlockCounters counters;
};

/// Each list's blocks copied over a poisoned picture.
Sorted sortBlocks(
    gpu::Device& device, const Image& motion, const MotionBlurSettings& settings, bool forMask
) {
    const auto params = motion_blur::resolve(settings, motion.width, motion.height, 1.0);
    test::GraphRig rig(device);
    const motion_blur::TileMotion tileMotion(device);
    motion_blur::BlockSorter sorter(device);
    const motion_blur::StillPixels still(device);
    const motion_blur::BlockFilter copies[] = {
        {device, shader::kUniformList, {"copy uniform", motion_blur_copy_blocks_comp, 1}},
        {device, shader::kMixedList, {"copy mixed", motion_blur_copy_blocks_comp, 1}},
        {device, shader::kCandidateList, {"copy candidates", motion_blur_copy_blocks_comp, 1}}};
    const auto tiles = tileMotion.add(rig.graph, rig.upload(motion), params);
    const auto blocks = sorter.add(rig.graph, tiles, params, forMask);
    sorter.addCounters(rig.graph, blocks, params);
    const auto ones = rig.uploadColor(makePicture(motion.width, motion.height, 1.0f));
    const auto poison = rig.uploadColor(makePicture(motion.width, motion.height, kPoison));
    std::array<size_t, 3> tickets{};
    for (size_t i = 0; i < tickets.size(); ++i) {
        const auto target =
            still.begin(rig.graph, poison, {}, motion_blur::StillPixelsBy::WholeCopy);
        tickets[i] = rig.want(copies[i].add(
            rig.graph, std::array{ones}, i == 2 ? blocks.candidates : blocks.lists, target, params
        ));
    }
    const size_t tileTicket = rig.want(tiles.tiles);
    const size_t dominantTicket = rig.want(tiles.dominant);
    const size_t classTicket = rig.want(tiles.tileClass);
    run(rig);
    return {
        rig.take(tileTicket),
        rig.take(dominantTicket),
        rig.take(classTicket),
        {rig.take(tickets[0]), rig.take(tickets[1]), rig.take(tickets[2])},
        sorter.counters()};
}

vec2 at(const Image& picture, int x, int y) {
    return {picture.at(uint32_t(x), uint32_t(y), 0), picture.at(uint32_t(x), uint32_t(y), 1)};
}

/// Class of the pixels themselves: every one that a tap may meet.
float expectClass(const Image& motion, const Sorted& sorted, ivec2 tile, int size, float uniform) {
    const vec2 dominant = at(sorted.dominant, tile.x, tile.y);
    float deviation = 0.0f;
    float nearest = 3e38f;
    float farthest = -3e38f;
    const ivec2 first = glm::max((tile - 1) * size, ivec2(0));
    const ivec2 end = glm::min((tile + 2) * size, ivec2(motion.width, motion.height));
    for (int y = first.y; y < end.y; ++y)
        for (int x = first.x; x < end.x; ++x) {
            const float depth = motion.at(uint32_t(x), uint32_t(y), 2);
            nearest = std::min(nearest, depth);
            farthest = std::max(farthest, depth);
            deviation = std::max(deviation, glm::length(at(motion, x, y) - dominant));
        }
    return shader::classifyTile(
        glm::length(dominant), deviation, farthest - nearest, uniform, 0.03f
    );
}

/// What a block's list may be: `least` by its pixels, no more than `most`, whose spread is a bound.
struct Demand {
    float least = shader::kClassStill;
    float most = shader::kClassStill;
};

Demand
expectBlock(const Image& motion, const Sorted& sorted, ivec2 first, int size, float uniform) {
    const ivec2 end = glm::min(first + 8, ivec2(motion.width, motion.height));
    Demand demand;
    for (int ty = first.y / size; ty <= (end.y - 1) / size; ++ty)
        for (int tx = first.x / size; tx <= (end.x - 1) / size; ++tx) {
            demand.least =
                std::max(demand.least, expectClass(motion, sorted, {tx, ty}, size, uniform));
            demand.most = std::max(demand.most, sorted.tileClass.at(uint32_t(tx), uint32_t(ty), 0));
        }
    // Motion is no longer than a tile: only the next ones reach it.
    const ivec2 lowest = glm::max(first / size - 1, ivec2(0));
    const ivec2 highest =
        glm::min((end - 1) / size + 1, ivec2(sorted.tiles.width, sorted.tiles.height) - 1);
    bool reached = false;
    for (int ty = lowest.y; ty <= highest.y; ++ty)
        for (int tx = lowest.x; tx <= highest.x; ++tx) {
            const float speed = glm::length(at(sorted.tiles, tx, ty));
            const vec2 corner = vec2(tx, ty) * float(size);
            reached =
                reached ||
                (speed >= shader::kStillPx &&
                 shader::reachesBlock(vec2(first), vec2(end), corner, corner + float(size), speed));
        }
    return reached ? demand : Demand{};
}

float foundClass(const Sorted& sorted, uint32_t x, uint32_t y) {
    const bool uniform = sorted.written[0].at(x, y, 0) == 1.0f;
    const bool mixed = sorted.written[1].at(x, y, 0) == 1.0f;
    const bool candidate = sorted.written[2].at(x, y, 0) == 1.0f;
    EXPECT_LE(int(uniform) + int(mixed) + int(candidate), 1) << x << ", " << y;
    return candidate ? shader::kClassDeep
                     : (mixed ? shader::kClassMixed
                              : (uniform ? shader::kClassUniform : shader::kClassStill));
}

void expectLists(const Image& motion, const Sorted& sorted, int size, float uniform) {
    uint32_t counts[4] = {};
    for (uint32_t y = 0; y < motion.height; ++y)
        for (uint32_t x = 0; x < motion.width; ++x) {
            const ivec2 first = ivec2(x, y) / 8 * 8;
            const float found = foundClass(sorted, x, y);
            if (ivec2(x, y) == first)
                ++counts[size_t(found)];
            const Demand expected = expectBlock(motion, sorted, first, size, uniform);
            ASSERT_GE(found, expected.least) << x << ", " << y;
            ASSERT_EQ(found, expected.most) << x << ", " << y;
        }
    EXPECT_EQ(sorted.counters.still, counts[0]);
    EXPECT_EQ(sorted.counters.uniform, counts[1]);
    EXPECT_EQ(sorted.counters.mixed, counts[2] + counts[3]);
}

/// Left a third still, then uniform motion, then mixed; depth steps on the right.
Image makeMotion(uint32_t width, uint32_t height) {
    Image motion(width, height, 4);
    std::mt19937 random(width);
    std::uniform_real_distribution<float> component(-12.0f, 12.0f);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const uint32_t third = 3 * x / width;
            motion.at(x, y, 0) = third == 0 ? 0.1f : third == 1 ? 9.0f : component(random);
            motion.at(x, y, 1) = third == 2 ? component(random) : 0.0f;
            motion.at(x, y, 2) = 3.0f + (x > width * 4 / 5 ? float(random() % 2) : 0.0f);
        }
    return motion;
}

TEST_F(BlockLists, EveryBlockIsInTheListThatItsTilesAskFor) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {41u, 39u}, {250u, 90u}})
        for (const uint32_t tile : {1u, 12u, 16u, 40u, 256u}) {
            SCOPED_TRACE(fmt::format("{}x{}, tile {}", width, height, tile));
            MotionBlurSettings settings;
            settings.tileSizePx = tile;
            const Image motion = makeMotion(width, height);
            const Sorted sorted = sortBlocks(device(), motion, settings, true);
            expectLists(motion, sorted, int(tile), settings.uniformMotionPx);
        }
}

TEST_F(BlockLists, WithoutAMaskAllThatIsNotUniformIsMixed) {
    MotionBlurSettings settings;
    settings.tileSizePx = 16;
    const Image motion = makeMotion(250, 90);
    const Sorted sorted = sortBlocks(device(), motion, settings, false);
    size_t mixed = 0;
    for (uint32_t y = 0; y < 90; ++y)
        for (uint32_t x = 0; x < 250; ++x) {
            ASSERT_EQ(sorted.written[2].at(x, y, 0), kPoison);
            mixed += sorted.written[1].at(x, y, 0) == 1.0f;
        }
    EXPECT_GT(mixed, 5000u);
    const motion_blur::BlockCounters& counted = sorted.counters;
    EXPECT_GT(counted.still, 0u);
    EXPECT_GT(counted.uniform, 0u);
    EXPECT_EQ(counted.still + counted.uniform + counted.mixed, 32u * 12u);
}

TEST_F(BlockLists, ListsOfMoreBlocksThanARowOfGroupsAreWhole) {
    // 80 x 45 blocks: fourteen rows of kListRow groups and a part of one.
    const Image motion = [] {
        Image all(640, 360, 4);
        for (uint32_t y = 0; y < 360; ++y)
            for (uint32_t x = 0; x < 640; ++x) {
                all.at(x, y, 0) = (x + y) % 2 == 0 ? 9.0f : 5.0f;
                all.at(x, y, 2) = 3.0f;
            }
        return all;
    }();
    const Sorted sorted = sortBlocks(device(), motion, {}, false);
    EXPECT_EQ(sorted.counters.mixed, 80u * 45u);
    for (uint32_t y = 0; y < 360; ++y)
        for (uint32_t x = 0; x < 640; ++x)
            ASSERT_EQ(sorted.written[1].at(x, y, 0), 1.0f) << x << ", " << y;
}

TEST_F(BlockLists, MotionThatIsNotFiniteIsNoneAndIsNotUniform) {
    MotionBlurSettings settings;
    settings.tileSizePx = 16;
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Image motion(96, 48, 4);
        for (uint32_t y = 0; y < 48; ++y)
            for (uint32_t x = 0; x < 96; ++x)
                motion.at(x, y, 0) = 6.0f;
        EXPECT_EQ(sortBlocks(device(), motion, settings, false).counters.uniform, 12u * 6u);
        motion.at(50, 20, 0) = bad;
        const auto counted = sortBlocks(device(), motion, settings, false).counters;
        // The tile of (50, 20) and those around it, 48 x 48 pixels.
        EXPECT_EQ(counted.mixed, 6u * 6u);
        EXPECT_EQ(counted.uniform, 6u * 6u);
        for (uint32_t y = 0; y < 48; ++y)
            for (uint32_t x = 0; x < 96; ++x)
                motion.at(x, y, 0) = x == 50 && y == 20 ? bad : 0.0f;
        EXPECT_EQ(sortBlocks(device(), motion, settings, false).counters.still, 12u * 6u);
    }
}

} // namespace
} // namespace shutter
