// SPDX-License-Identifier: MIT
// The scene's textures: few objects of the device for many textures, and a limit in a sentence.
#include "engine/gpu_scene/texture_table.h"
#include "tests/support/gpu_fixture.h"

#include <cstdint>
#include <string>
#include <vector>

namespace shutter {
namespace {

using gpu_scene::TextureTable;

/// Textures of images of their own, which wrap in two ways by turns.
scene::Assets makeAssets(uint32_t textureCount) {
    scene::Assets assets;
    for (uint32_t i = 0; i < textureCount; ++i) {
        assets.images.push_back({"image " + std::to_string(i), 4, 4, std::vector<uint8_t>(64, 200)}
        );
        scene::Texture texture;
        texture.image = i;
        texture.wrapU = i % 2 == 0 ? scene::Wrap::Repeat : scene::Wrap::ClampToEdge;
        assets.textures.push_back(texture);
    }
    return assets;
}

class TextureTables : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure())
            device().collectIdle(); // what other tests left
    }
};

TEST_F(TextureTables, ManyTexturesShareBlocksOfMemoryAndSamplers) {
    const gpu::LivingObjects before = device().living();
    const scene::Assets assets = makeAssets(120);
    const uint64_t allocations = device().allocationCount();
    const uint64_t submissions = device().completedValue();
    {
        const TextureTable table(device(), assets, std::vector<bool>(240, true));
        EXPECT_NE(table.set(), VkDescriptorSet{VK_NULL_HANDLE});
        EXPECT_EQ(device().living().images, before.images + 240);
        EXPECT_EQ(device().living().samplers, before.samplers + 2);
        // One that stays, and one for staging.
        EXPECT_EQ(device().allocationCount(), allocations + 2);
        EXPECT_EQ(device().completedValue(), submissions + 1);
        device().collectIdle();
        EXPECT_EQ(device().living().memoryBlocks, before.memoryBlocks + 1);
    }
    device().collectIdle();
    EXPECT_EQ(device().living(), before);
}

TEST_F(TextureTables, AnImageThatSeveralTexturesShowIsUploadedOnce) {
    scene::Assets assets = makeAssets(4);
    for (scene::Texture& texture : assets.textures)
        texture.image = 1;
    const uint32_t before = device().living().images;
    const TextureTable table(
        device(), assets, {true, false, true, true, false, false, true, false}
    );
    EXPECT_EQ(device().living().images, before + 2) << "as sRGB and linear";
}

TEST_F(TextureTables, ASceneWithoutTexturesHasATable) {
    const TextureTable table(device(), {}, {});
    EXPECT_NE(table.layout(), VkDescriptorSetLayout{VK_NULL_HANDLE});
}

TEST(TextureLimit, TheSmallestLimitCountsLessWhatPassesBind) {
    VkPhysicalDeviceLimits limits{};
    limits.maxPerStageResources = 5000;
    limits.maxPerStageDescriptorSamplers = 4000;
    limits.maxPerStageDescriptorSampledImages = 1016;
    limits.maxDescriptorSetSamplers = 4000;
    limits.maxDescriptorSetSampledImages = 4000;
    EXPECT_EQ(gpu_scene::findTextureLimit(limits).count, 1000u);
    EXPECT_STREQ(gpu_scene::findTextureLimit(limits).name, "maxPerStageDescriptorSampledImages");
    limits.maxDescriptorSetSamplers = 7;
    EXPECT_EQ(gpu_scene::findTextureLimit(limits).count, 0u);
    EXPECT_STREQ(gpu_scene::findTextureLimit(limits).name, "maxDescriptorSetSamplers");
}

} // namespace
} // namespace shutter
