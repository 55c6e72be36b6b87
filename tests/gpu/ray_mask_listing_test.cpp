// SPDX-License-Identifier: MIT
// What the ray mask lists, block by block, as GPUs do, against pixel by pixel.
#include "engine/graph/execute.h"
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/block_lists.h"
#include "modules/motion_blur/passes/ray_mask.h"
#include "modules/motion_blur/passes/tile_motion.h"
#include "shaders/motion_blur/hybrid_shared.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

namespace shutter {
namespace {

using image::Image;
using motion_blur::MaskListing;

class RayMaskListing : public test::GpuTest {};

constexpr uint32_t kWidth = 515; // the last block is of 3 x 5 pixels
constexpr uint32_t kHeight = 221;

/// Bars that move over a still wall, some by more than a block.
struct Layer {
    Image motionDepth{kWidth, kHeight, 4};
    Image normal{kWidth, kHeight, 4};
    Image id{kWidth, kHeight, 1};

    Layer() {
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x) {
                const uint32_t bar = (x / 23 + y / 31) % 3;
                motionDepth.at(x, y, 0) = bar == 1 ? 14.0f : 0.0f;
                motionDepth.at(x, y, 1) = bar == 2 ? -5.0f : 0.0f;
                motionDepth.at(x, y, 2) = 6.0f - float(bar);
                normal.at(x, y, 2) = 1.0f;
                id.at(x, y, 0) = float(bar);
            }
    }
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
        mWordCounts.push_back(bytes / sizeof(uint32_t)); // a buffer may be larger than asked for
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
    const auto params = motion_blur::resolve(settings, kWidth, kHeight, 0.5);
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
    const size_t list = copies.add(rig.graph, outputs.list);
    const size_t lists = copies.add(rig.graph, outputs.blocks.lists.blocks);
    const size_t candidates = copies.add(rig.graph, outputs.blocks.candidates.blocks);
    const size_t tileList = copies.add(rig.graph, outputs.tiles);
    const size_t arguments[] = {
        copies.add(rig.graph, outputs.arguments),
        copies.add(rig.graph, outputs.blocks.lists.arguments),
        copies.add(rig.graph, outputs.tileArguments)};
    const size_t mask = rig.want(outputs.mask);
    test::run(rig);

    constexpr size_t kHead = 4; // words of each header
    Listed listed;
    const auto words = copies.words(list);
    listed.header = {words[0], words[1], words[2], words[3]};
    listed.pixels = sortPart(words, kHead, listed.header.listedPixels);
    const size_t blockCount = size_t((kWidth + 7) / 8) * ((kHeight + 7) / 8);
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
        ASSERT_GT(one.header.listedPixels, share < 0.2f ? 500u : 2000u);
        EXPECT_EQ(one.header.sharingPixels > 0, share < 1.0f);
        EXPECT_EQ(one.header.listedPixels, other.header.listedPixels);
        EXPECT_EQ(one.header.sharingPixels, other.header.sharingPixels);
        EXPECT_EQ(one.pixels, other.pixels);
        EXPECT_EQ(one.blocks, other.blocks);
        EXPECT_EQ(one.tiles, other.tiles);
        EXPECT_EQ(one.flags, other.flags);
        EXPECT_EQ(one.arguments, other.arguments);
        EXPECT_EQ(one.mask.pixels, other.mask.pixels);
    }
}

TEST_F(RayMaskListing, ALaunchHasAGroupForEveryListedPixel) {
    for (const auto listing : {MaskListing::PixelByPixel, MaskListing::BlockByBlock}) {
        const Listed listed = listMask(device(), listing, 1.0f);
        const uint32_t groups =
            (listed.header.listedPixels + shader::kRevealThreads - 1) / shader::kRevealThreads;
        ASSERT_GT(groups, shader::kListRow) << "no more than one row: the rest is not seen";
        EXPECT_EQ(listed.arguments[0], shader::kListRow);
        EXPECT_EQ(listed.arguments[1], (groups + shader::kListRow - 1) / shader::kListRow);
        EXPECT_EQ(listed.arguments[2], 1u);
    }
}

} // namespace
} // namespace shutter
