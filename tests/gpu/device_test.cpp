// SPDX-License-Identifier: MIT
// Choice of a device, and errors without one; and adopted devices: retired objects wait for the
// host's progress, and the host's own objects are never destroyed.
#include "engine/gpu/device.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "game/shot/methods.h"
#include "tests/support/gpu_fixture.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace shutter {
namespace {

gpu::DeviceInfo makeInfo(const std::string& name, const std::string& kind, gpu::RayTier tier) {
    gpu::DeviceInfo info;
    info.name = name;
    info.kind = kind;
    info.rayTier = tier;
    return info;
}

std::vector<gpu::DeviceInfo> threeDevices() {
    return {
        makeInfo("llvmpipe (LLVM 15)", "software", gpu::RayTier::RayQuery),
        makeInfo("Old Card", "discrete", gpu::RayTier::None),
        makeInfo("New Card", "discrete", gpu::RayTier::RayQuery)};
}

/// Name of the chosen one; else the sentence on why there is none.
std::string choose(const std::vector<gpu::DeviceInfo>& devices, const std::string& wanted = "") {
    const auto chosen = gpu::chooseDevice(devices, wanted);
    return chosen ? chosen.value().name : chosen.error().message;
}

TEST(DeviceChoice, ASoftwareDeviceIsTheLastDefaultChoiceRegardlessOfItsFeatures) {
    using gpu::RayTier;
    // Mesa's software device, next to the cards of a desktop or a data centre.
    const gpu::DeviceInfo lavapipe = makeInfo("llvmpipe (LLVM 19)", "software", RayTier::RayQuery);
    for (const gpu::DeviceInfo& card :
         {makeInfo("NVIDIA GeForce GTX 1050 (NVK GP107)", "discrete", RayTier::None),
          makeInfo("AMD Radeon RX Vega (RADV VEGA10)", "discrete", RayTier::None),
          makeInfo("Intel(R) UHD Graphics 620 (KBL GT2)", "integrated", RayTier::None),
          makeInfo("Virtio-GPU Venus", "virtual", RayTier::None),
          makeInfo("Some Card", "other", RayTier::None),
          makeInfo("NVIDIA H100", "discrete", RayTier::Pipeline)}) {
        EXPECT_EQ(choose({lavapipe, card}), card.name);
        EXPECT_EQ(choose({card, lavapipe}), card.name);
    }
    EXPECT_EQ(choose({lavapipe}), lavapipe.name);
}

TEST(DeviceChoice, AmongCardsRaysOfAnyTierComeFirstThenTheKindThenTheBetterTier) {
    using gpu::RayTier;
    const gpu::DeviceInfo old = makeInfo("Old Card", "discrete", RayTier::None);
    const gpu::DeviceInfo laptop = makeInfo("Laptop", "integrated", RayTier::RayQuery);
    const gpu::DeviceInfo centre = makeInfo("Data Centre", "discrete", RayTier::Pipeline);
    const gpu::DeviceInfo card = makeInfo("New Card", "discrete", RayTier::RayQuery);
    EXPECT_EQ(choose({old, laptop}), "Laptop");
    EXPECT_EQ(choose({old, laptop, centre}), "Data Centre");
    EXPECT_EQ(choose({old, laptop, centre, card}), "New Card");
}

TEST(DeviceChoice, ADeviceThatCanRunAMethodIsFoundForIt) {
    auto devices = threeDevices();
    const auto find = [&](const char* method) -> std::string {
        const auto* found = game::findDeviceFor(*game::findMethod(method).value(), devices);
        return found ? found->name : "none";
    };
    EXPECT_EQ(find("gather"), "llvmpipe (LLVM 15)") << "the first";
    devices.erase(devices.begin());
    EXPECT_EQ(find("hybrid"), "New Card");
    devices[1].rayTier = gpu::RayTier::Pipeline;
    EXPECT_EQ(find("hybrid"), "New Card");
    EXPECT_EQ(find("denoised"), "none");
    devices[1].missing = "Vulkan 1.3";
    EXPECT_EQ(find("hybrid"), "none");
}

TEST(DeviceChoice, TheTierIsTheBestOneThatIsThereAndAllowed) {
    using gpu::RayTier;
    gpu::DeviceInfo both;
    both.hasRayQuery = both.hasRayPipeline = true;
    EXPECT_EQ(gpu::chooseTier(both, RayTier::RayQuery), RayTier::RayQuery);
    EXPECT_EQ(gpu::chooseTier(both, RayTier::Pipeline), RayTier::Pipeline);
    EXPECT_EQ(gpu::chooseTier(both, RayTier::None), RayTier::None);
    gpu::DeviceInfo pipelines;
    pipelines.hasRayPipeline = true;
    EXPECT_EQ(gpu::chooseTier(pipelines, RayTier::RayQuery), RayTier::Pipeline);
    gpu::DeviceInfo queries;
    queries.hasRayQuery = true;
    EXPECT_EQ(gpu::chooseTier(queries, RayTier::Pipeline), RayTier::None);
    EXPECT_EQ(gpu::describeTiers(both), "VK_KHR_ray_query, VK_KHR_ray_tracing_pipeline");
    EXPECT_EQ(gpu::describeTiers(pipelines), "VK_KHR_ray_tracing_pipeline");
    EXPECT_EQ(gpu::describeTiers({}), "none");
}

TEST(DeviceChoice, AWishIsAnIndexOrAPartOfANameAndWhatLacksSomethingIsPassedOver) {
    auto devices = threeDevices();
    EXPECT_EQ(choose(devices, "1"), "Old Card");
    EXPECT_EQ(choose(devices, "LLVMPIPE"), "llvmpipe (LLVM 15)");
    const auto expectRefusal = [&](const std::string& wanted, const char* part) {
        const std::string sentence = choose(devices, wanted);
        EXPECT_NE(sentence.find(part), std::string::npos) << sentence;
    };
    expectRefusal("voodoo", "'voodoo'");
    expectRefusal("voodoo", "2: New Card");
    expectRefusal("3", "'3'");
    devices[2].missing = "timeline semaphores";
    EXPECT_EQ(choose(devices), "Old Card");
    devices[1].missing = "dynamic rendering";
    EXPECT_EQ(choose(devices), "llvmpipe (LLVM 15)");
    expectRefusal("old", "lacks dynamic rendering");
    devices[0].missing = "Vulkan 1.3";
    expectRefusal("", "llvmpipe (LLVM 15) lacks Vulkan 1.3");
    devices.clear();
    expectRefusal("", "no Vulkan device");
    expectRefusal("0", "no Vulkan device");
}

using Devices = test::GpuTest;

TEST_F(Devices, AFrameTakesAnyNumberOfSpansAndTimesOfTheFirst) {
    gpu::Frame frame(device());
    constexpr size_t kSpans = 300;
    frame.begin();
    for (size_t i = 0; i < kSpans; ++i) {
        frame.beginSpan(std::to_string(i));
        frame.endSpan();
    }
    frame.submit();
    const std::vector<gpu::PassTime> times = frame.waitForTimes();
    ASSERT_EQ(times.size(), kSpans);
    EXPECT_EQ(times.back().name, "299");
    EXPECT_EQ(times.back().gpuMilliseconds, 0.0);
}

/// Vulkan defines loads past the end of a binding: lavapipe returns 0 on every device, so no
/// picture here could show a difference.
TEST_F(Devices, AValidatedOneChecksBounds) {
    EXPECT_TRUE(device().checksBounds());
    gpu::DeviceOptions options;
    options.wanted = device().info().name;
    for (const bool isChecked : {false, true}) {
        if (isChecked)
            options.bounds = gpu::Bounds::Checked;
        const auto opened = gpu::Device::create(options);
        ASSERT_TRUE(opened.ok()) << opened.error().message;
        EXPECT_EQ(opened.value()->checksBounds(), isChecked);
    }
}

class AdoptedDevice : public test::GpuTest {
  protected:
    static std::unique_ptr<gpu::Device> adopt() {
        auto adopted = gpu::Device::adopt({device().physical(), device().handle()});
        EXPECT_TRUE(adopted.ok());
        return std::move(adopted).value();
    }
};

TEST_F(AdoptedDevice, RetiredObjectsWaitForAllEarlierSubmissions) {
    const auto host = adopt();
    host->markDone(0);
    const uint64_t first = host->handOver();
    bool destroyed = false;
    host->retire([&] { destroyed = true; }); // may be in the commands that are recorded now
    const uint64_t second = host->handOver();
    host->markDone(second);
    EXPECT_FALSE(destroyed) << "the first is not done";
    host->markDone(first);
    host->markDone(first); // repeated or unknown values change nothing
    EXPECT_TRUE(destroyed);
    EXPECT_EQ(host->completedValue(), second);
    host->markDone(second + 7);
    EXPECT_EQ(host->completedValue(), second);
}

TEST_F(AdoptedDevice, DestructionFreesItsObjectsAndNotTheHostsDevice) {
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

TEST_F(AdoptedDevice, IndirectLaunchesRequireTheHostsFeature) {
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
    for (const auto& [handles, sentence] :
         {std::pair{gpu::HostDevice{.physical = device().physical()}, "device is null"},
          {gpu::HostDevice{.device = device().handle()}, "physical is null"}}) {
        const auto refused = gpu::Device::adopt(handles);
        ASSERT_FALSE(refused.ok());
        EXPECT_NE(refused.error().message.find(sentence), std::string::npos);
    }
}

using AdoptedDeviceDeathTest = AdoptedDevice;

TEST_F(AdoptedDeviceDeathTest, DestructionDoesNotWaitForTheHost) {
    ::testing::FLAGS_gtest_death_test_style = "threadsafe"; // the driver has threads
    const auto host = adopt();
    const uint64_t value = host->handOver();
    EXPECT_DEATH(host->wait(value), "only the host can wait");
}

} // namespace
} // namespace shutter
