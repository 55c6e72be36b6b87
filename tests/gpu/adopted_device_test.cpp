// SPDX-License-Identifier: MIT
// A device of a host: what is retired waits for what the host says, and nothing of the host's goes.
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "tests/support/gpu_fixture.h"

#include <string>

namespace shutter {
namespace {

class AdoptedDevice : public test::GpuTest {
  protected:
    static std::unique_ptr<gpu::Device> adopt() {
        auto adopted = gpu::Device::adopt({device().physical(), device().handle()});
        EXPECT_TRUE(adopted.ok());
        return std::move(adopted).value();
    }
};

TEST_F(AdoptedDevice, WhatIsRetiredWaitsForEverythingHandedOverUntilThen) {
    const auto host = adopt();
    const uint64_t first = host->handOver();
    bool destroyed = false;
    host->retire([&] { destroyed = true; }); // may be in the commands that are recorded now
    const uint64_t second = host->handOver();
    host->markDone(second);
    EXPECT_FALSE(destroyed) << "the first is not done";
    host->markDone(first);
    EXPECT_TRUE(destroyed);
    EXPECT_EQ(host->completedValue(), second);
}

TEST_F(AdoptedDevice, WhatTheHostSaysTwiceOrOfNothingChangesNothing) {
    const auto host = adopt();
    host->markDone(0);
    const uint64_t first = host->handOver();
    const uint64_t second = host->handOver();
    host->markDone(first);
    host->markDone(first);
    EXPECT_EQ(host->completedValue(), first);
    host->markDone(second + 7);
    EXPECT_EQ(host->completedValue(), first);
}

TEST_F(AdoptedDevice, ItEndsWithWhatItHoldsAndWithoutTheHostsDevice) {
    bool destroyed = false;
    {
        const auto host = adopt();
        (void)host->handOver();
        const gpu::Buffer buffer(*host, "buffer", 64, 0, gpu::MemoryUse::Device);
        EXPECT_EQ(host->living().buffers, 1u);
        host->retire([&] { destroyed = true; });
    }
    EXPECT_TRUE(destroyed);
    const gpu::Buffer alive(device(), "the host's", 64, 0, gpu::MemoryUse::Device);
    EXPECT_NE(alive.handle(), VK_NULL_HANDLE);
}

TEST_F(AdoptedDevice, PipelinesAreKeptInTheHostsCache) {
    VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    VkPipelineCache cache = VK_NULL_HANDLE;
    gpu::require(vkCreatePipelineCache(device().handle(), &info, nullptr, &cache), "a cache");
    {
        const auto host = gpu::Device::adopt(
            {.physical = device().physical(), .device = device().handle(), .pipelineCache = cache}
        );
        ASSERT_TRUE(host) << host.error().message;
        EXPECT_EQ(host.value()->pipelineCache(), cache);
    }
    size_t bytes = 0;
    EXPECT_EQ(vkGetPipelineCacheData(device().handle(), cache, &bytes, nullptr), VK_SUCCESS)
        << "it is still the host's";
    vkDestroyPipelineCache(device().handle(), cache, nullptr);
    EXPECT_NE(adopt()->pipelineCache(), VkPipelineCache(VK_NULL_HANDLE)) << "or one of its own";
}

TEST_F(AdoptedDevice, LaunchesFromMemoryAreTheHostsToAllow) {
    if (!device().info().hasRayPipeline)
        GTEST_SKIP() << device().info().name << " has no ray-tracing pipelines";
    for (const bool allowed : {false, true}) {
        const auto host = gpu::Device::adopt(
            {.physical = device().physical(),
             .device = device().handle(),
             .tracesIndirect = allowed}
        );
        ASSERT_TRUE(host) << host.error().message;
        EXPECT_EQ(host.value()->info().tracesIndirect, allowed);
    }
}

TEST_F(AdoptedDevice, AnAdoptedImageKeepsTheHostsImage) {
    gpu::ImageDesc desc{8, 8, VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_SAMPLED_BIT};
    gpu::Image image(device(), "the host's", desc);
    const auto host = adopt();
    {
        gpu::Image adopted = gpu::Image::adopt(*host, "adopted", image.handle(), desc);
        EXPECT_EQ(adopted.handle(), image.handle());
        EXPECT_NE(adopted.view(), VK_NULL_HANDLE);
        EXPECT_NE(adopted.view(), image.view());
        const gpu::Image moved = std::move(adopted);
        EXPECT_EQ(moved.handle(), image.handle());
        EXPECT_EQ(host->living().images, 0u);
    }
    host->markDone(host->handOver());
    EXPECT_GT(image.requirements().size, 0u); // validation speaks up where it is gone
}

TEST_F(AdoptedDevice, ANullHandleIsNamed) {
    const auto noDevice = gpu::Device::adopt({device().physical(), VK_NULL_HANDLE});
    ASSERT_FALSE(noDevice.ok());
    EXPECT_NE(noDevice.error().message.find("device is null"), std::string::npos);
    const auto noPhysical = gpu::Device::adopt({VK_NULL_HANDLE, device().handle()});
    ASSERT_FALSE(noPhysical.ok());
    EXPECT_NE(noPhysical.error().message.find("physical is null"), std::string::npos);
}

using AdoptedDeviceDeathTest = AdoptedDevice;

TEST_F(AdoptedDeviceDeathTest, ItDoesNotWaitForTheHost) {
    ::testing::FLAGS_gtest_death_test_style = "threadsafe"; // the driver has threads
    const auto host = adopt();
    const uint64_t value = host->handOver();
    EXPECT_DEATH(host->wait(value), "only the host can wait");
}

} // namespace
} // namespace shutter
