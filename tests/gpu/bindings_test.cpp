// SPDX-License-Identifier: MIT
// Storage images must have the format that the shader declares: values are undefined otherwise, and
// not every validation layer sees it.
#include "engine/gpu/descriptors.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "shaders/accumulate/accumulate_shared.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"

#include <string>
#include <utility>

namespace shutter {
namespace {

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
    const gpu::Pipeline scale = test::makeScalePipeline(device());
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

TEST_F(Bindings, APipelineThatWasMovedKeepsItsFormats) {
    gpu::Pipeline scale = test::makeScalePipeline(device());
    gpu::Pipeline moved;
    moved = std::move(scale);
    EXPECT_EQ(moved.storageFormat(1), VK_FORMAT_R32G32B32A32_SFLOAT);
    EXPECT_EQ(moved.name(), "scale");
}

using BindingsDeathTest = Bindings;

TEST_F(BindingsDeathTest, AFrameRefusesAStorageImageOfAnotherFormat) {
    // The driver has threads: the test runs once more in a process of its own.
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
