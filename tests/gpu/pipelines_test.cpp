// SPDX-License-Identifier: MIT
// Pipelines that are made ahead of their use, and those of the gathers for certain taps.
#include "engine/gpu/pipeline.h"
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/block_lists.h"
#include "modules/motion_blur/passes/gather.h"
#include "modules/motion_blur/passes/tap_pipelines.h"
#include "modules/motion_blur/passes/tile_motion.h"
#include "shaders/common/shutter_response.glsl"
#include "shaders/motion_blur/gather_shared.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <thread>

// clang-format off: needs <cstdint> before it
#include "spirv/motion_blur/reconstruct.comp.h"

// clang-format on

namespace shutter {
namespace {

using image::Image;
using motion_blur::PassParams;
using motion_blur::TapPipelines;
using motion_blur::TapVariants;

class Pipelines : public test::GpuTest {};

gpu::ComputePipelineDesc describeGather() {
    gpu::ComputePipelineDesc desc;
    desc.name = "gather";
    desc.spirv = motion_blur_reconstruct_comp;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
        VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    desc.interface.pushConstantBytes = sizeof(PassParams);
    desc.specialization = {shader::kMixedList, 0};
    return desc;
}

PassParams makeParams(uint32_t taps) {
    PassParams params{};
    params.sampleCount = taps;
    return params;
}

TEST_F(Pipelines, OneThatWasPreparedIsThereWithoutBeingMadeAgain) {
    const gpu::LazyPipeline pipeline(device(), test::describeScalePipeline());
    EXPECT_FALSE(pipeline.isReady());
    pipeline.prepare();
    pipeline.prepare(); // which changes nothing
    const gpu::Pipeline& made = pipeline.get();
    EXPECT_NE(made.handle(), VkPipeline(VK_NULL_HANDLE));
    EXPECT_TRUE(pipeline.isReady());
    EXPECT_EQ(&pipeline.get(), &made);
    pipeline.prepare();
    EXPECT_EQ(&pipeline.get(), &made);
}

TEST_F(Pipelines, OneThatNobodyWaitsForMayGo) {
    for (int i = 0; i < 4; ++i) {
        const gpu::LazyPipeline pipeline(device(), test::describeScalePipeline());
        pipeline.prepare();
    }
}

TEST_F(Pipelines, AFewNumbersOfTapsAreKept) {
    const TapPipelines taps(device(), describeGather(), TapVariants::Made);
    for (uint32_t count = 1; count <= TapPipelines::kMostVariants + 3; ++count)
        (void)taps.find(makeParams(count));
    EXPECT_EQ(taps.variantCount(), TapPipelines::kMostVariants);
    const gpu::Pipeline& last = taps.find(makeParams(TapPipelines::kMostVariants + 3));
    const gpu::Pipeline& early = taps.find(makeParams(4));
    EXPECT_NE(&last, &early);
    EXPECT_EQ(&taps.find(makeParams(4)), &early) << "the oldest that is kept";
    PassParams table = makeParams(4);
    table.response = {16, 0};
    EXPECT_NE(&taps.find(table), &early) << "another kind of response";
}

TEST_F(Pipelines, WithoutVariantsOnePipelineServesAll) {
    const TapPipelines taps(device(), describeGather(), TapVariants::None);
    EXPECT_EQ(&taps.find(makeParams(3)), &taps.find(makeParams(15)));
    EXPECT_EQ(taps.variantCount(), 0u);
}

TEST_F(Pipelines, AheadOfTimeNoFrameWaitsForAVariant) {
    gpu::DeviceOptions options;
    options.validate = true;
    options.wanted = device().info().name;
    options.pipelinesAhead = gpu::PipelinesAhead::Always;
    const auto made = gpu::Device::create(options);
    ASSERT_TRUE(made) << made.error().message;
    gpu::Device& ahead = *made.value();
    ASSERT_TRUE(ahead.makesPipelinesAhead());
    {
        const TapPipelines taps(ahead, describeGather(), TapVariants::Made);
        const TapPipelines general(ahead, describeGather(), TapVariants::None);
        const gpu::Pipeline* const first = &taps.find(makeParams(15));
        EXPECT_EQ(taps.variantCount(), 1u);
        // The general one stands in for as long as it takes, and no longer.
        const gpu::Pipeline* found = first;
        for (int i = 0; i < 2000 && found == first; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            found = &taps.find(makeParams(15));
        }
        EXPECT_NE(found, first);
        EXPECT_EQ(&taps.find(makeParams(15)), found);
        EXPECT_EQ(&taps.find(makeParams(9)), first) << "for another number it stands in again";
    }
    ahead.waitIdle();
    EXPECT_EQ(ahead.validationMessageCount(), 0u);
}

// What is made for certain taps draws what the pipeline for all draws.

constexpr uint32_t kWidth = 120;
constexpr uint32_t kHeight = 72;

/// Left a wall that turns evenly, right bars that pass each other.
Image makeMotion() {
    Image motion(kWidth, kHeight, 4);
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const bool bar = x > kWidth / 2 && (x / 9) % 2 == 0;
            motion.at(x, y, 0) = bar ? -11.0f : 17.0f;
            motion.at(x, y, 1) = bar ? 4.0f : 1.0f;
            motion.at(x, y, 2) = bar ? 2.0f : 5.0f;
        }
    return motion;
}

Image gather(gpu::Device& device, TapVariants variants, uint32_t taps, VkDeviceAddress response) {
    motion_blur::MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod("gather");
    settings.tileSizePx = 20;
    settings.sampleCount = taps;
    PassParams params = motion_blur::resolve(settings, kWidth, kHeight, 0.5);
    params.response = gpu::splitAddress(response);
    const motion_blur::TileMotion tileMotion(device);
    const motion_blur::BlockSorter sorter(device);
    const motion_blur::Gather filter(device, variants);
    test::GraphRig rig(device);
    const auto motion = rig.upload(makeMotion());
    const auto color = rig.uploadColor(test::makeNoise(kWidth, kHeight));
    const auto tiles = tileMotion.add(rig.graph, motion, params);
    const auto blocks = sorter.add(rig.graph, tiles, params, false);
    const auto target = rig.graph.createImage("blurred", rig.graph.describeImage(color));
    const size_t ticket =
        rig.want(filter.add(rig.graph, {color, motion, tiles.dominant, {}}, blocks, target, params)
        );
    test::run(rig);
    return rig.take(ticket);
}

float worstDifference(const Image& one, const Image& other) {
    float worst = 0.0f;
    for (size_t i = 0; i < one.pixels.size(); ++i)
        worst = std::max(worst, std::abs(one.pixels[i] - other.pixels[i]));
    return worst;
}

TEST_F(Pipelines, VariantsDrawWhatThePipelineForAllDraws) {
    shader::ResponseTable rising{};
    rising.knotCount = 2;
    rising.knots[1] = {1.0f, 2.0f, 1.0f, 0.0f};
    shader::fillFirstKnots(rising);
    gpu::Buffer table(
        device(),
        "response",
        sizeof(rising),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        gpu::MemoryUse::Stream
    );
    table.writeBytes(&rising, sizeof(rising), 0);
    Image box;
    for (const VkDeviceAddress response : {VkDeviceAddress(0), table.address()})
        for (const uint32_t taps : {1u, 15u, 32u}) {
            const Image general = gather(device(), TapVariants::None, taps, response);
            const Image variant = gather(device(), TapVariants::Made, taps, response);
            EXPECT_LE(worstDifference(general, variant), 1.0f / 1024.0f) << taps;
            if (taps == 15u && response == 0)
                box = general;
            if (taps == 15u && response != 0) {
                EXPECT_GT(worstDifference(general, box), 0.1f) << "the response was not read";
            }
        }
}

} // namespace
} // namespace shutter
