// SPDX-License-Identifier: MIT
// Pipelines that are made ahead of their use, kept by a device, and made for certain taps; and the
// formats of bound images: a storage image must have the one that the shader declares.
#include "spirv/motion_blur/reconstruct.comp.h"

#include "engine/gpu/descriptors.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu/pipeline_key.h"
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/block_lists.h"
#include "modules/motion_blur/passes/gather.h"
#include "modules/motion_blur/passes/tap_pipelines.h"
#include "modules/motion_blur/passes/tile_motion.h"
#include "shaders/accumulate/accumulate_shared.h"
#include "shaders/common/shutter_response.glsl"
#include "shaders/motion_blur/gather_shared.h"
#include "tests/gpu/effect_rig.h"
#include "tests/gpu/other_device.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <chrono>
#include <cstdint>
#include <string>
#include <thread>
#include <utility>

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

TEST_F(Pipelines, APreparedPipelineIsNotMadeAgainAndMayBeDestroyed) {
    for (int i = 0; i < 4; ++i)
        gpu::LazyPipeline(device(), test::describeScalePipeline()).prepare(); // not waited for
    const gpu::LazyPipeline pipeline(device(), test::describeScalePipeline());
    EXPECT_FALSE(pipeline.isReady());
    pipeline.prepare();
    pipeline.prepare(); // which changes nothing
    const gpu::Pipeline& made = pipeline.get();
    EXPECT_NE(made.handle(), VkPipeline(VK_NULL_HANDLE));
    EXPECT_TRUE(pipeline.isReady());
    pipeline.prepare();
    EXPECT_EQ(&pipeline.get(), &made);
}

TEST_F(Pipelines, AFewNumbersOfTapsAreKept) {
    const TapPipelines taps(device(), describeGather(), TapVariants::Made);
    for (uint32_t count = 1; count <= TapPipelines::kMaxVariants + 3; ++count)
        (void)taps.find(makeParams(count));
    EXPECT_EQ(taps.variantCount(), TapPipelines::kMaxVariants);
    const gpu::Pipeline& last = taps.find(makeParams(TapPipelines::kMaxVariants + 3));
    const gpu::Pipeline& early = taps.find(makeParams(4));
    EXPECT_NE(&last, &early);
    EXPECT_EQ(&taps.find(makeParams(4)), &early) << "the oldest that is kept";
    PassParams table = makeParams(4);
    table.response = {16, 0};
    EXPECT_NE(&taps.find(table), &early) << "another kind of response";
}

TEST_F(Pipelines, OnePipelineServesAllTapCountsWithoutVariants) {
    const TapPipelines taps(device(), describeGather(), TapVariants::None);
    EXPECT_EQ(&taps.find(makeParams(3)), &taps.find(makeParams(15)));
    EXPECT_EQ(taps.variantCount(), 0u);
}

// A pipeline for certain taps draws the same as the general one.

constexpr uint32_t kDrawnWidth = 120;
constexpr uint32_t kDrawnHeight = 72;

/// Left a wall that turns evenly, right bars that pass each other.
Image makeBars() {
    return test::makeMotion(kDrawnWidth, kDrawnHeight, [](uint32_t x, uint32_t) {
        const bool bar = x > kDrawnWidth / 2 && (x / 9) % 2 == 0;
        return bar ? math::vec3(-11.0f, 4.0f, 2.0f) : math::vec3(17.0f, 1.0f, 5.0f);
    });
}

Image gather(gpu::Device& device, TapVariants variants, uint32_t taps, VkDeviceAddress response) {
    motion_blur::MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod("gather");
    settings.tileSizePx = 20;
    settings.sampleCount = taps;
    PassParams params = motion_blur::resolve(settings, kDrawnWidth, kDrawnHeight, 0.5);
    params.response = gpu::splitAddress(response);
    const motion_blur::TileMotion tileMotion(device);
    const motion_blur::BlockSorter sorter(device);
    const motion_blur::Gather filter(device, variants);
    test::GraphRig rig(device);
    const auto motion = rig.upload(makeBars());
    const auto color = rig.uploadColor(test::makeNoise(kDrawnWidth, kDrawnHeight));
    const auto tiles = tileMotion.add(rig.graph, motion, params);
    const auto blocks = sorter.add(rig.graph, tiles, params, false);
    const auto target = rig.graph.createImage("blurred", rig.graph.describeImage(color));
    const size_t ticket =
        rig.want(filter.add(rig.graph, {color, motion, tiles.dominant, {}}, blocks, target, params)
        );
    test::run(rig);
    return rig.take(ticket);
}

double worstDifference(const Image& one, const Image& other) {
    return test::computeMaxDifferenceWhere(one, other, [](auto, auto) { return true; });
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
            EXPECT_LE(worstDifference(general, variant), 1.0 / 1024.0) << taps;
            if (taps == 15u && response == 0)
                box = general;
            if (taps == 15u && response != 0) {
                EXPECT_GT(worstDifference(general, box), 0.1) << "the response was not read";
            }
        }
}

using OwnDevice = test::OtherDeviceTest;

TEST_F(OwnDevice, AKeptPipelineIsHandedOverWithAllThatIsKnownOfItUnlessItIsInUse) {
    gpu::DeviceOptions options;
    options.keptPipelines = 4;
    open(options);
    VkPipeline first = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    {
        const gpu::Pipeline pipeline(*mOther, test::describeScalePipeline());
        first = pipeline.handle();
        layout = pipeline.layout();
    }
    const gpu::Pipeline again(*mOther, test::describeScalePipeline());
    EXPECT_EQ(again.handle(), first);
    EXPECT_EQ(again.layout(), layout);
    EXPECT_EQ(again.name(), "scale");
    EXPECT_EQ(again.bindingCount(), 2u);
    EXPECT_NE(again.storageFormat(1), VK_FORMAT_UNDEFINED);
    EXPECT_NE(again.setLayout(), VkDescriptorSetLayout(VK_NULL_HANDLE));
    const auto key = gpu::makePipelineKey(test::describeScalePipeline());
    {
        const gpu::Pipeline other(*mOther, test::describeScalePipeline());
        EXPECT_NE(again.handle(), other.handle()) << "the first is in use";
    }
    gpu::ComputePipelineDesc desc = test::describeScalePipeline();
    desc.name = "other";
    const gpu::Pipeline other(*mOther, desc);
    const auto kept = mOther->takePipeline(key);
    ASSERT_TRUE(kept) << "another name is another pipeline";
    mOther->giveUpPipeline(key, *kept);
}

TEST_F(OwnDevice, OnlyTheTextureLayoutIsCachedWithoutTheOption) {
    open({});
    { const gpu::Pipeline gone(*mOther, test::describeScalePipeline()); }
    EXPECT_FALSE(mOther->keepsPipelines());
    EXPECT_FALSE(mOther->takePipeline(gpu::makePipelineKey(test::describeScalePipeline())));
    EXPECT_EQ(mOther->textureLayout(3), mOther->textureLayout(3));
    EXPECT_NE(mOther->textureLayout(3), mOther->textureLayout(4));
}

TEST_F(OwnDevice, PipelinesAheadOfTimeNoFrameWaitsForAVariant) {
    gpu::DeviceOptions options;
    options.pipelinesAhead = gpu::PipelinesAhead::Always;
    open(options);
    ASSERT_TRUE(mOther->makesPipelinesAhead());
    const TapPipelines taps(*mOther, describeGather(), TapVariants::Made);
    const gpu::Pipeline* const first = &taps.find(makeParams(15));
    EXPECT_EQ(taps.variantCount(), 1u);
    // The general one is used until the special one is ready, and no longer.
    const gpu::Pipeline* found = first;
    for (int i = 0; i < 2000 && found == first; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        found = &taps.find(makeParams(15));
    }
    EXPECT_NE(found, first);
    EXPECT_EQ(&taps.find(makeParams(15)), found);
    EXPECT_EQ(&taps.find(makeParams(9)), first) << "for another number it stands in again";
}

class Bindings : public test::GpuTest {};

gpu::Image makeImage(gpu::Device& device, std::string name, VkFormat format) {
    const VkImageUsageFlags usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    return {device, std::move(name), {8, 8, format, usage}};
}

/// What the pipeline of test::makeScalePipeline() binds.
gpu::BindingList bind(gpu::Device& device, const gpu::Image& source, const gpu::Image& target) {
    gpu::BindingList bindings;
    bindings.sampled(source.view(), device.nearestSampler()).storage(target);
    return bindings;
}

TEST_F(Bindings, AStorageImageFitsIfItsFormatIsTheShaders) {
    gpu::Pipeline made = test::makeScalePipeline(device());
    const gpu::Pipeline scale = std::move(made); // keeps its formats
    const gpu::Image floats = makeImage(device(), "floats", VK_FORMAT_R32G32B32A32_SFLOAT);
    const gpu::Image halves = makeImage(device(), "halves", VK_FORMAT_R16G16B16A16_SFLOAT);
    EXPECT_EQ(scale.storageFormat(0), VK_FORMAT_UNDEFINED) << "sampled";
    EXPECT_EQ(scale.storageFormat(1), VK_FORMAT_R32G32B32A32_SFLOAT);
    EXPECT_EQ(scale.storageFormat(2), VK_FORMAT_UNDEFINED) << "not bound";
    EXPECT_TRUE(bind(device(), halves, floats).checkFormats(scale)) << "any format may be sampled";
    const core::Status status = bind(device(), floats, halves).checkFormats(scale);
    ASSERT_FALSE(status);
    EXPECT_EQ(
        status.error().message,
        "the pipeline 'scale' declares binding 1 as R32G32B32A32_SFLOAT, and the image 'halves' "
        "bound there is R16G16B16A16_SFLOAT"
    );
}

using BindingsDeathTest = Bindings;

TEST_F(BindingsDeathTest, AFrameRefusesAStorageImageOfAnotherFormat) {
    // The driver has threads: the test runs again in a separate process.
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const gpu::Pipeline scale = test::makeScalePipeline(device());
    const gpu::Image halves = makeImage(device(), "halves", VK_FORMAT_R16G16B16A16_SFLOAT);
    const gpu::BindingList bindings = bind(device(), halves, halves);
    const shader::AccumulateParams params{{8, 8}, 1, 1.0f, 1.0f};
    gpu::Frame frame(device());
    frame.begin();
    EXPECT_DEATH(
        frame.bind(scale, bindings, &params, sizeof(params)),
        "the image 'halves' bound there is R16G16B16A16_SFLOAT"
    );
    frame.submit();
    frame.wait();
}

} // namespace
} // namespace shutter
