// SPDX-License-Identifier: MIT
// Pipelines that a device keeps for whoever wants the same.
#include "engine/gpu/pipeline_key.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"

#include <cstdint>
#include <memory>
#include <utility>

namespace shutter {
namespace {

/// A device of its own that keeps so many pipelines.
class KeptPipelines : public test::GpuTest {
  protected:
    void openDevice(uint32_t kept) {
        gpu::DeviceOptions options;
        options.validate = true;
        options.wanted = device().info().name;
        options.keptPipelines = kept;
        auto made = gpu::Device::create(options);
        ASSERT_TRUE(made) << made.error().message;
        mOwn = std::move(made).value();
    }

    void TearDown() override {
        if (mOwn) {
            mOwn->waitIdle();
            EXPECT_EQ(mOwn->validationMessageCount(), 0u);
        }
        mOwn.reset();
        GpuTest::TearDown();
    }

    std::unique_ptr<gpu::Device> mOwn;
};

TEST_F(KeptPipelines, TheSameIsHandedOverWithAllThatIsKnownOfIt) {
    openDevice(4);
    VkPipeline first = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    {
        const gpu::Pipeline pipeline(*mOwn, test::describeScalePipeline());
        first = pipeline.handle();
        layout = pipeline.layout();
    }
    const gpu::Pipeline again(*mOwn, test::describeScalePipeline());
    EXPECT_EQ(again.handle(), first);
    EXPECT_EQ(again.layout(), layout);
    EXPECT_EQ(again.name(), "scale");
    EXPECT_EQ(again.bindingCount(), 2u);
    EXPECT_NE(again.storageFormat(1), VK_FORMAT_UNDEFINED);
    EXPECT_NE(again.setLayout(), VkDescriptorSetLayout(VK_NULL_HANDLE));
}

TEST_F(KeptPipelines, OneInUseIsNotShared) {
    openDevice(4);
    const gpu::Pipeline one(*mOwn, test::describeScalePipeline());
    const gpu::Pipeline other(*mOwn, test::describeScalePipeline());
    EXPECT_NE(one.handle(), other.handle());
}

TEST_F(KeptPipelines, AnotherNameIsAnotherPipeline) {
    openDevice(4);
    const gpu::Pipeline held(*mOwn, test::describeScalePipeline());
    { const gpu::Pipeline kept(*mOwn, test::describeScalePipeline()); }
    gpu::ComputePipelineDesc desc = test::describeScalePipeline();
    desc.name = "other";
    const gpu::Pipeline other(*mOwn, desc);
    ASSERT_NE(other.handle(), held.handle());
    const auto key = gpu::makePipelineKey(test::describeScalePipeline());
    const auto kept = mOwn->takePipeline(key);
    ASSERT_TRUE(kept) << "it is still there";
    mOwn->giveUpPipeline(key, *kept);
}

TEST_F(KeptPipelines, WithoutTheOptionNothingIsKept) {
    openDevice(0);
    { const gpu::Pipeline gone(*mOwn, test::describeScalePipeline()); }
    EXPECT_FALSE(mOwn->keepsPipelines());
    EXPECT_FALSE(mOwn->takePipeline(gpu::makePipelineKey(test::describeScalePipeline())));
}

TEST_F(KeptPipelines, TextureTablesOfOneSizeShareTheirLayout) {
    openDevice(0);
    EXPECT_EQ(mOwn->textureLayout(3), mOwn->textureLayout(3));
    EXPECT_NE(mOwn->textureLayout(3), mOwn->textureLayout(4));
}

} // namespace
} // namespace shutter
