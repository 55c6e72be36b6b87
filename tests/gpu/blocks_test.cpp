// SPDX-License-Identifier: MIT
// The lists of blocks on the device against the same rules in C++, what the filters do with them,
// and what the ray mask lists, block by block, as GPUs do, against pixel by pixel.
#include "spirv/motion_blur/copy_blocks.comp.h"

#include "engine/graph/execute.h"
#include "engine/image/image.h"
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/motion_blur.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/block_lists.h"
#include "modules/motion_blur/passes/ray_mask.h"
#include "modules/motion_blur/passes/static_pixels.h"
#include "modules/motion_blur/passes/tile_motion.h"
#include "shaders/motion_blur/block_class.glsl"
#include "shaders/motion_blur/hybrid_shared.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace shutter {
namespace {

using glm::ivec2;
using glm::vec2;
using glm::vec3;
using image::Image;
using motion_blur::getMethod;
using motion_blur::MaskListing;
using motion_blur::Method;
using motion_blur::MotionBlurSettings;
using test::makeMotion;
using test::makeNoise;
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
    const motion_blur::StaticPixels still(device);
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
            still.begin(rig.graph, poison, {}, motion_blur::StaticPixelsBy::WholeCopy);
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
    for (uint32_t top = 0; top < motion.height; top += 8)
        for (uint32_t left = 0; left < motion.width; left += 8) {
            ++counts[size_t(foundClass(sorted, left, top))];
            const Demand expected = expectBlock(motion, sorted, ivec2(left, top), size, uniform);
            ASSERT_GE(expected.most, expected.least) << left << ", " << top;
            for (uint32_t y = top; y < std::min(top + 8, motion.height); ++y)
                for (uint32_t x = left; x < std::min(left + 8, motion.width); ++x)
                    ASSERT_EQ(foundClass(sorted, x, y), expected.most) << x << ", " << y;
        }
    EXPECT_EQ(sorted.counters.still, counts[0]);
    EXPECT_EQ(sorted.counters.uniform, counts[1]);
    EXPECT_EQ(sorted.counters.mixed, counts[2] + counts[3]);
}

/// Left a third still, then uniform motion, then mixed; depth steps on the right.
Image makeThirds(uint32_t width, uint32_t height) {
    std::mt19937 random(width);
    std::uniform_real_distribution<float> component(-12.0f, 12.0f);
    return makeMotion(width, height, [&](uint32_t x, uint32_t) {
        const uint32_t third = 3 * x / width;
        const float right = third == 0 ? 0.1f : third == 1 ? 9.0f : component(random);
        const float down = third == 2 ? component(random) : 0.0f;
        return vec3(right, down, 3.0f + (x > width * 4 / 5 ? float(random() % 2) : 0.0f));
    });
}

TEST_F(BlockLists, EveryBlockIsInTheListThatItsTilesRequire) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {41u, 39u}, {250u, 90u}})
        for (const uint32_t tile : {1u, 12u, 16u, 40u, 256u}) {
            SCOPED_TRACE(fmt::format("{}x{}, tile {}", width, height, tile));
            MotionBlurSettings settings;
            settings.tileSizePx = tile;
            const Image motion = makeThirds(width, height);
            const Sorted sorted = sortBlocks(device(), motion, settings, true);
            expectLists(motion, sorted, int(tile), settings.uniformMotionPx);
        }
}

TEST_F(BlockLists, NonUniformBlocksAreMixedWithoutAMask) {
    MotionBlurSettings settings;
    settings.tileSizePx = 16;
    const Image motion = makeThirds(250, 90);
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
    const Image motion = makeMotion(640, 360, [](uint32_t x, uint32_t y) {
        return vec3((x + y) % 2 == 0 ? 9.0f : 5.0f, 0.0f, 3.0f);
    });
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
        const auto sort = [&](float speed, float at50) {
            const Image motion = makeMotion(96, 48, [&](uint32_t x, uint32_t y) {
                return vec3(x == 50 && y == 20 ? at50 : speed, 0.0f, 0.0f);
            });
            return sortBlocks(device(), motion, settings, false).counters;
        };
        EXPECT_EQ(sort(6.0f, 6.0f).uniform, 12u * 6u);
        // The tile of (50, 20) and those around it, 48 x 48 pixels.
        EXPECT_EQ(sort(6.0f, bad).mixed, 6u * 6u);
        EXPECT_EQ(sort(6.0f, bad).uniform, 6u * 6u);
        EXPECT_EQ(sort(0.0f, bad).still, 12u * 6u);
    }
}

class BlockFilters : public test::GpuTest {};

/// Frames on one effect, so that the second knows how much moved in the first.
class Effect {
  public:
    explicit Effect(gpu::Device& device)
        : mDevice(device), mEffect(device, VK_NULL_HANDLE), mStill(device) {}

    Image blur(
        const Image& color, const Image& motion, const MotionBlurSettings& settings, bool writable
    ) {
        test::GraphRig rig(mDevice);
        motion_blur::MotionBlurInputs inputs;
        // A transient: its usage follows from the passes.
        inputs.color = mStill.begin(
            rig.graph, rig.uploadColor(color), {}, motion_blur::StaticPixelsBy::WholeCopy
        );
        inputs.motionDepth = rig.upload(motion);
        inputs.colorIsWritable = writable;
        const auto outputs = mEffect.add(rig.graph, inputs, settings);
        const size_t ticket = rig.want(outputs.color);
        const graph::Plan plan = run(rig);
        hasWholeCopy = false;
        for (const auto& pass : plan.passes)
            hasWholeCopy =
                hasWholeCopy ||
                (rig.graph.passes()[pass.pass].name == "copy still pixels" && pass.pass != 0);
        return rig.take(ticket);
    }

    /// \param kind "still", "uniform", "mixed" or "masked"
    [[nodiscard]] uint64_t countBlocks(const std::string& kind) const {
        return mEffect.counters().at("blocks " + kind);
    }

    bool hasWholeCopy = false; ///< of the effect's own, in the last frame

  private:
    gpu::Device& mDevice;
    motion_blur::MotionBlur mEffect;
    motion_blur::StaticPixels mStill;
};

/// Those whose filters go over blocks and need no rays.
std::vector<const Method*> listBlockMethods() {
    std::vector<const Method*> methods;
    for (const Method* method : motion_blur::listMethods())
        if (method->countsBlocks && method->readsImagesOnly())
            methods.push_back(method);
    return methods;
}

/// One mover near the left border.
Image makeMover(uint32_t width, uint32_t height) {
    return makeMotion(width, height, [](uint32_t x, uint32_t y) {
        const bool mover = x >= 20 && x < 30 && y >= 20 && y < 34;
        return vec3(mover ? 9.0f : 0.0f, 0.0f, mover ? 2.0f : 5.0f);
    });
}

TEST_F(BlockFilters, FewMovingBlocksGiveTheSamePictureAndStaticBlocksAreNotTouched) {
    const Image color = makeNoise(240, 96);
    const Image motion = makeMover(240, 96);
    MotionBlurSettings settings;
    settings.tileSizePx = 16;
    for (const Method* method : listBlockMethods()) {
        settings.method = method;
        Effect effect(device());
        const Image first = effect.blur(color, motion, settings, true);
        EXPECT_TRUE(effect.hasWholeCopy) << method->name << ": nothing is known yet";
        const Image second = effect.blur(color, motion, settings, true);
        EXPECT_FALSE(effect.hasWholeCopy) << method->name;
        EXPECT_TRUE(test::sameBits(first, second)) << method->name;
        EXPECT_FALSE(test::sameBits(first, color)) << method->name;
        const auto isFar = [](uint32_t x, uint32_t) { return x >= 72; };
        EXPECT_EQ(test::computeMaxDifferenceWhere(first, color, isFar), 0.0) << method->name;
        EXPECT_GT(effect.countBlocks("still"), 280u) << method->name << " of 360";
        effect.blur(color, motion, settings, false);
        EXPECT_TRUE(effect.hasWholeCopy) << "the picture may not be written";
        const Image all = makeMotion(64, 64, [](auto, auto) { return vec3(5.0f, 0.0f, 0.0f); });
        for (int again = 0; again < 2; ++again)
            effect.blur(makeNoise(64, 64), all, settings, true);
        EXPECT_TRUE(effect.hasWholeCopy) << "much moves";
        EXPECT_EQ(effect.countBlocks("still"), 0u);
    }
}

TEST(StaticPixels, TheChoiceHasSlack) {
    using motion_blur::chooseStaticPixels;
    using By = motion_blur::StaticPixelsBy;
    for (const By last : {By::WholeCopy, By::CopyBack}) {
        EXPECT_EQ(chooseStaticPixels(0.0, last), By::CopyBack);
        EXPECT_EQ(chooseStaticPixels(0.25, last), last);
        EXPECT_EQ(chooseStaticPixels(1.0, last), By::WholeCopy);
    }
}

TEST_F(BlockFilters, NoSeamShowsWhereUniformMotionMeetsMixed) {
    // One flat wall; motion is 12 px on the left and varies by more than the bound on the right.
    const Image color = makeNoise(192, 64);
    const Image motion = makeMotion(192, 64, [](uint32_t x, uint32_t) {
        return vec3(x < 128 ? 12.0f : 12.0f - 0.1f * float(x % 8), 0.0f, 3.0f);
    });
    MotionBlurSettings settings;
    settings.method = &getMethod("gather");
    settings.tileSizePx = 16;
    Effect effect(device());
    const Image fast = effect.blur(color, motion, settings, false);
    EXPECT_GT(effect.countBlocks("uniform"), 100u);
    EXPECT_GT(effect.countBlocks("mixed"), 40u);
    settings.uniformMotionPx = 0.0f;
    const Image full = effect.blur(color, motion, settings, false);
    EXPECT_EQ(effect.countBlocks("uniform"), 0u);
    const auto everywhere = [](uint32_t, uint32_t) { return true; };
    EXPECT_LE(test::computeMaxDifferenceWhere(fast, full, everywhere), 0.5 / 255.0);
}

TEST_F(BlockFilters, OverDepthStepsThatMoveAlikeTheUniformPathIsNearerToTheTruth) {
    // Everything moves by 16 px to the right at any depth: each pixel is the mean of the 16 px to
    // its left.
    constexpr uint32_t kWide = 192;
    const Image color = makeNoise(kWide, 64);
    const Image motion = makeMotion(kWide, 64, [](uint32_t x, uint32_t) {
        return vec3(16.0f, 0.0f, x / 24 % 2 == 0 ? 2.0f : 6.0f);
    });
    // With the paper's numbers, whose full path takes the nearer stripes for smears over the
    // others.
    MotionBlurSettings settings = motion_blur::paperSettings();
    settings.method = &getMethod("gather");
    settings.sampleCount = 64;
    Effect effect(device());
    const auto error = [&](float uniformMotionPx) {
        settings.uniformMotionPx = uniformMotionPx;
        const Image picture = effect.blur(color, motion, settings, false);
        double sum = 0.0;
        for (uint32_t y = 0; y < 64; ++y)
            for (uint32_t x = 32; x < kWide - 32; ++x) {
                // From half a pixel on: half of the first and of the last, and all in between.
                double truth = (color.at(x, y, 0) + color.at(x + 16, y, 0)) / 32.0;
                for (uint32_t i = 1; i < 16; ++i)
                    truth += color.at(x + i, y, 0) / 16.0;
                sum += std::pow(picture.at(x, y, 0) - truth, 2.0);
            }
        return sum;
    };
    const double full = error(0.0f);
    const double fast = error(0.5f);
    EXPECT_LT(fast, 0.5 * full);
}

TEST_F(BlockFilters, SurfacesBeyondTheDepthLimitCountAsStatic) {
    const Image color = makeNoise(96, 64);
    const auto make = [](bool nearOnly) {
        return makeMotion(96, 64, [&](uint32_t x, uint32_t y) {
            const bool isFar = x % 24 >= 12;
            const float far = y < 32 ? 40.0f : 1e9f; // below: the sky
            const float speed = isFar && nearOnly ? 0.0f : 3.0f + 0.1f * float(y % 7);
            return vec3(speed, 0.0f, isFar ? far : 4.0f);
        });
    };
    const Image motion = make(false);
    const Image near = make(true);
    for (const Method* method : listBlockMethods()) {
        MotionBlurSettings settings;
        settings.method = method;
        settings.tileSizePx = 16;
        settings.occluderTest = motion_blur::OccluderTest::Velocity;
        Effect effect(device());
        const Image unlimited = effect.blur(color, motion, settings, false);
        settings.maxMotionDepth = 10.0f;
        const Image limited = effect.blur(color, motion, settings, false);
        EXPECT_FALSE(test::sameBits(unlimited, limited)) << method->name;
        settings.maxMotionDepth = std::numeric_limits<float>::infinity();
        EXPECT_TRUE(test::sameBits(effect.blur(color, near, settings, false), limited))
            << method->name;
        settings.maxMotionDepth = 0.0f;
        EXPECT_TRUE(test::sameBits(effect.blur(color, motion, settings, false), color))
            << method->name;
        EXPECT_EQ(effect.countBlocks("still"), 12u * 8u) << method->name;
    }
}

class RayMaskListing : public test::GpuTest {};

constexpr uint32_t kOddWidth = 515; // the last block is of 3 x 5 pixels
constexpr uint32_t kOddHeight = 221;

/// Bars that move over a still wall, some by more than a block.
struct Layer {
    Image motionDepth = makeMotion(kOddWidth, kOddHeight, [](uint32_t x, uint32_t y) {
        const uint32_t bar = barAt(x, y);
        return vec3(bar == 1 ? 14.0f : 0.0f, bar == 2 ? -5.0f : 0.0f, 6.0f - float(bar));
    });
    Image normal =
        makeMotion(kOddWidth, kOddHeight, [](auto, auto) { return vec3(0.0f, 0.0f, 1.0f); });
    Image id{kOddWidth, kOddHeight, 1};

    Layer() {
        for (uint32_t y = 0; y < kOddHeight; ++y)
            for (uint32_t x = 0; x < kOddWidth; ++x)
                id.at(x, y, 0) = float(barAt(x, y));
    }

    static uint32_t barAt(uint32_t x, uint32_t y) { return (x / 23 + y / 31) % 3; }
};

/// What one listing left in the buffers that later passes read.
struct Listed {
    shader::MaskHeader header{};
    std::vector<uint32_t> pixels; ///< sorted, as the order is free
    std::vector<uint32_t> blocks; ///< of kMaskedList, sorted
    std::vector<uint32_t> tiles;  ///< sorted
    std::vector<uint32_t> flags;  ///< of the picture's blocks
    std::vector<uint32_t> arguments;
    Image mask;
};

/// Copies a transient out.
class Copies {
  public:
    explicit Copies(gpu::Device& device) : mDevice(device) {}

    size_t add(graph::Graph& graph, graph::BufferHandle source) {
        using graph::Access;
        const VkDeviceSize bytes = graph.resources()[source.resource].bufferDesc.bytes;
        const gpu::Buffer& target =
            mBuffers.emplace_back(mDevice, "copy", bytes, 0, gpu::MemoryUse::Readback);
        mWordCounts.push_back(bytes / sizeof(uint32_t)); // a buffer may be larger than requested
        const auto imported = graph.importBuffer("copy", target.handle(), bytes);

        struct Data {
            graph::BufferHandle from;
            graph::BufferHandle to;
        };

        graph.addPass<Data>(
            "copy out",
            graph::PassKind::Transfer,
            [&](graph::PassBuilder& builder, Data& data) {
                data.from = builder.read(source, Access::TransferRead);
                data.to = builder.write(imported, Access::TransferWrite);
                graph.markOutput(data.to);
            },
            [bytes](const Data& data, graph::PassContext& context) {
                const VkBufferCopy region{0, 0, bytes};
                vkCmdCopyBuffer(
                    context.commands,
                    context.resources.buffer(data.from),
                    context.resources.buffer(data.to),
                    1,
                    &region
                );
            }
        );
        return mBuffers.size() - 1;
    }

    [[nodiscard]] std::vector<uint32_t> words(size_t index) const {
        const auto* first = static_cast<const uint32_t*>(mBuffers.at(index).mapped());
        return {first, first + mWordCounts.at(index)};
    }

  private:
    gpu::Device& mDevice;
    std::deque<gpu::Buffer> mBuffers;
    std::vector<size_t> mWordCounts;
};

std::vector<uint32_t> sortPart(const std::vector<uint32_t>& words, size_t first, size_t count) {
    EXPECT_LE(first + count, words.size());
    std::vector<uint32_t> part(words.begin() + long(first), words.begin() + long(first + count));
    std::sort(part.begin(), part.end());
    return part;
}

Listed listMask(gpu::Device& device, MaskListing listing, float rayShare) {
    motion_blur::MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod("hybrid");
    settings.tileSizePx = 16;
    settings.rayShare = rayShare;
    const auto params = motion_blur::resolve(settings, kOddWidth, kOddHeight, 0.5);
    const motion_blur::TileMotion tileMotion(device);
    const motion_blur::BlockSorter sorter(device);
    const motion_blur::RayMask rayMask(device, listing);
    const Layer layer;
    Copies copies(device);
    test::GraphRig rig(device);
    const auto motionDepth = rig.upload(layer.motionDepth);
    const auto tiles = tileMotion.add(rig.graph, motionDepth, params);
    const auto outputs = rayMask.add(
        rig.graph,
        {motionDepth,
         rig.upload(layer.normal),
         rig.uploadIds(layer.id),
         sorter.add(rig.graph, tiles, params, true)},
        params
    );
    const size_t list = copies.add(rig.graph, outputs.masked.list);
    const size_t lists = copies.add(rig.graph, outputs.blocks.lists.blocks);
    const size_t candidates = copies.add(rig.graph, outputs.blocks.candidates.blocks);
    const size_t tileList = copies.add(rig.graph, outputs.tiles);
    const size_t arguments[] = {
        copies.add(rig.graph, outputs.masked.arguments),
        copies.add(rig.graph, outputs.blocks.lists.arguments),
        copies.add(rig.graph, outputs.tileArguments)};
    const size_t mask = rig.want(outputs.masked.mask);
    test::run(rig);

    constexpr size_t kHead = 4; // words of each header
    Listed listed;
    const auto words = copies.words(list);
    listed.header = {words[0], words[1], words[2], words[3]};
    listed.pixels = sortPart(words, kHead, listed.header.listedPixels);
    const size_t blockCount = size_t((kOddWidth + 7) / 8) * ((kOddHeight + 7) / 8);
    const auto sorted = copies.words(lists);
    listed.blocks = sortPart(sorted, kHead + shader::kMaskedList * blockCount, sorted[2]);
    const auto tileWords = copies.words(tileList);
    listed.tiles = sortPart(tileWords, kHead, tileWords[0]);
    const auto flags = copies.words(candidates);
    listed.flags.assign(flags.begin() + long(kHead + blockCount), flags.end());
    for (const size_t index : arguments)
        for (const uint32_t word : copies.words(index))
            listed.arguments.push_back(word);
    listed.mask = rig.take(mask);
    return listed;
}

TEST_F(RayMaskListing, BlockByBlockListsWhatPixelByPixelLists) {
    for (const float share : {1.0f, 0.6f, 0.25f, 0.1f}) {
        SCOPED_TRACE(share);
        const Listed one = listMask(device(), MaskListing::PixelByPixel, share);
        const Listed other = listMask(device(), MaskListing::BlockByBlock, share);
        const uint32_t listed = one.header.listedPixels;
        ASSERT_GT(listed, share < 0.2f ? 500u : 2000u);
        EXPECT_EQ(one.header.sharingPixels > 0, share < 1.0f);
        EXPECT_EQ(listed, other.header.listedPixels);
        EXPECT_EQ(one.header.sharingPixels, other.header.sharingPixels);
        EXPECT_EQ(one.pixels, other.pixels);
        EXPECT_EQ(one.blocks, other.blocks);
        EXPECT_EQ(one.tiles, other.tiles);
        EXPECT_EQ(one.flags, other.flags);
        EXPECT_EQ(one.arguments, other.arguments);
        EXPECT_EQ(one.mask.pixels, other.mask.pixels);
        if (share < 1.0f)
            continue;
        // A launch has a group for every listed pixel.
        const uint32_t groups = (listed + shader::kRevealThreads - 1) / shader::kRevealThreads;
        ASSERT_GT(groups, shader::kListRow) << "no more than one row: the rest is not seen";
        EXPECT_EQ(one.arguments[0], shader::kListRow);
        EXPECT_EQ(one.arguments[1], (groups + shader::kListRow - 1) / shader::kListRow);
        EXPECT_EQ(one.arguments[2], 1u);
    }
}

} // namespace
} // namespace shutter
