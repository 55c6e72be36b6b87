// SPDX-License-Identifier: MIT
// Devices, queues, extensions and swapchains, on machines that this suite never runs on.
#include "engine/gpu/device_select.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/swapchain.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace shutter::gpu {
namespace {

using Strings = std::vector<std::string>;

constexpr VkQueueFlags kAll = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT;
constexpr VkQueueFlags kCompute = VK_QUEUE_COMPUTE_BIT | VK_QUEUE_TRANSFER_BIT;

DeviceInfo makeInfo(const std::string& name, const std::string& kind, const std::string& missing) {
    DeviceInfo info;
    info.name = name;
    info.kind = kind;
    info.missing = missing;
    return info;
}

const char* const kNoDisplay = "a queue that shows pictures on this display";

TEST(QueueFamily, TheFirstThatDoesAllAndHasTimestampsIsTaken) {
    const std::vector<QueueFamily> families{
        {VK_QUEUE_TRANSFER_BIT, 64, true},
        {kCompute, 64, true},
        {kAll, 64, false},
        {kAll, 36, true}};
    EXPECT_EQ(chooseQueueFamily(families, false), 2u);
    EXPECT_EQ(chooseQueueFamily(families, true), 3u);
    const std::vector<QueueFamily> apart{{kAll, 64, false}, {VK_QUEUE_TRANSFER_BIT, 64, true}};
    EXPECT_EQ(chooseQueueFamily(apart, true), std::nullopt);
    const std::vector<QueueFamily> timeless{{kAll, 0, true}};
    EXPECT_EQ(chooseQueueFamily(timeless, false), std::nullopt);
    EXPECT_EQ(chooseQueueFamily({}, false), std::nullopt);
}

TEST(DeviceChoice, ADeviceThatCannotPresentIsSkippedWithAMessageAndRefusedIfNamed) {
    // A card under a display without a screen, or one of a data centre: lavapipe shows.
    const std::vector<DeviceInfo> devices{
        makeInfo("NVIDIA H100", "discrete", kNoDisplay), makeInfo("llvmpipe", "software", "")};
    const auto chosen = chooseDevice(devices, "");
    ASSERT_TRUE(chosen.ok());
    EXPECT_EQ(chosen.value().name, "llvmpipe");
    EXPECT_EQ(
        describePassedOver(devices, chosen.value()),
        Strings{std::string("NVIDIA H100 is passed over for llvmpipe: it lacks ") + kNoDisplay}
    );
    const auto named = chooseDevice(devices, "h100");
    ASSERT_FALSE(named.ok());
    EXPECT_EQ(
        named.error().message, std::string("--device 'h100': NVIDIA H100 lacks ") + kNoDisplay
    );
}

TEST(DeviceChoice, UnchosenDevicesAreNotMentioned) {
    const std::vector<DeviceInfo> devices{
        makeInfo("card", "discrete", ""),
        makeInfo("llvmpipe", "software", kNoDisplay),
        makeInfo("laptop", "integrated", "Vulkan 1.3")};
    EXPECT_EQ(chooseDevice(devices, "").value().name, "card");
    EXPECT_EQ(describePassedOver(devices, devices[0]), Strings{});
}

Strings listNames(const DeviceInfo& device, bool presents, Bounds bounds) {
    const auto names = listDeviceExtensions(device, presents, bounds);
    return {names.begin(), names.end()};
}

TEST(DeviceExtensions, EachIsMadeWithThoseOfItsPortabilityTierAndBounds) {
    DeviceInfo mac = makeInfo("Apple M2", "integrated", "");
    EXPECT_EQ(listNames(mac, false, Bounds::Trusted), Strings{});
    mac.isPortable = true;
    EXPECT_EQ(
        listNames(mac, true, Bounds::Trusted),
        (Strings{"VK_KHR_swapchain", "VK_KHR_portability_subset"})
    );
    EXPECT_EQ(listNames(mac, false, Bounds::Trusted), Strings{"VK_KHR_portability_subset"});
    DeviceInfo card = makeInfo("card", "discrete", "");
    EXPECT_EQ(listNames(card, false, Bounds::Checked), Strings{});
    card.hasRobustness2 = true;
    EXPECT_EQ(listNames(card, false, Bounds::Checked), Strings{"VK_EXT_robustness2"});
    EXPECT_EQ(listNames(card, false, Bounds::Trusted), Strings{});
    card.rayTier = RayTier::Pipeline;
    EXPECT_EQ(
        listNames(card, false, Bounds::Trusted),
        (Strings{
            "VK_KHR_acceleration_structure",
            "VK_KHR_deferred_host_operations",
            "VK_KHR_ray_tracing_pipeline"})
    );
}

constexpr VkExtent2D kMade{640, 360};
constexpr VkExtent2D kOther{640, 361};
constexpr VkExtent2D kAny{UINT32_MAX, UINT32_MAX};

TEST(SwapchainState, OnlyAnOutdatedSwapchainIsRecreatedAndAnUnexpectedResultIsAnError) {
    EXPECT_EQ(judgeSwapchain(VK_SUCCESS, kMade, kMade), SwapchainState::Fits);
    EXPECT_EQ(judgeSwapchain(VK_SUCCESS, kMade, kOther), SwapchainState::Fits);
    EXPECT_EQ(judgeSwapchain(VK_ERROR_OUT_OF_DATE_KHR, kMade, kMade), SwapchainState::Outdated);
    EXPECT_EQ(judgeSwapchain(VK_ERROR_SURFACE_LOST_KHR, kMade, kMade), SwapchainState::SurfaceLost);
    // A driver may report it of every picture.
    EXPECT_EQ(judgeSwapchain(VK_SUBOPTIMAL_KHR, kMade, kMade), SwapchainState::Fits);
    EXPECT_EQ(judgeSwapchain(VK_SUBOPTIMAL_KHR, kMade, kAny), SwapchainState::Fits);
    EXPECT_EQ(judgeSwapchain(VK_SUBOPTIMAL_KHR, kMade, kOther), SwapchainState::Outdated);
    EXPECT_THROW((void)judgeSwapchain(VK_ERROR_DEVICE_LOST, kMade, kMade), DeviceError);
    EXPECT_THROW((void)judgeSwapchain(VK_ERROR_OUT_OF_DEVICE_MEMORY, kMade, kMade), DeviceError);
}

constexpr VkSurfaceFormatKHR inSrgb(VkFormat format) {
    return {format, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR};
}

TEST(SurfaceFormat, EightBitsComeBeforeTenWhateverTheOrderAndSrgbIsNotChosen) {
    const std::vector<VkSurfaceFormatKHR> offered{
        inSrgb(VK_FORMAT_A2B10G10R10_UNORM_PACK32),
        inSrgb(VK_FORMAT_B8G8R8A8_SRGB),
        inSrgb(VK_FORMAT_R8G8B8A8_UNORM),
        inSrgb(VK_FORMAT_B8G8R8A8_UNORM)};
    EXPECT_EQ(chooseSurfaceFormat(offered)->format, VK_FORMAT_B8G8R8A8_UNORM);
    EXPECT_EQ(chooseSurfaceFormat(std::span(offered).first(3))->format, VK_FORMAT_R8G8B8A8_UNORM);
    const std::vector<VkSurfaceFormatKHR> unfit{
        inSrgb(VK_FORMAT_B8G8R8A8_SRGB),
        {VK_FORMAT_B8G8R8A8_UNORM, VK_COLOR_SPACE_EXTENDED_SRGB_LINEAR_EXT}};
    EXPECT_FALSE(chooseSurfaceFormat(unfit));
    EXPECT_FALSE(chooseSurfaceFormat({}));
}

TEST(SurfaceFormat, AScreenOfThirtyBitsShowsPictures) {
    for (const VkFormat only :
         {VK_FORMAT_A2B10G10R10_UNORM_PACK32, VK_FORMAT_A2R10G10B10_UNORM_PACK32}) {
        const std::vector<VkSurfaceFormatKHR> offered{
            {only, VK_COLOR_SPACE_HDR10_ST2084_EXT}, inSrgb(only)};
        ASSERT_TRUE(chooseSurfaceFormat(offered)) << only;
        EXPECT_EQ(chooseSurfaceFormat(offered)->format, only);
        EXPECT_EQ(chooseSurfaceFormat(offered)->colorSpace, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR);
    }
}

TEST(Timestamps, TimesAreDifferencesOverAWrapOfTheCounterToo) {
    for (const uint32_t bits : {36u, 40u, 64u}) {
        const uint64_t last = UINT64_MAX >> (64 - bits);
        EXPECT_EQ(countTicks(last - 9, 20, bits), 30u) << bits;
        EXPECT_EQ(countTicks(last, 0, bits), 1u) << bits;
        EXPECT_EQ(countTicks(1000, 1500, bits), 500u) << bits;
        EXPECT_EQ(countTicks(7, 7, bits), 0u) << bits;
        EXPECT_EQ(countTicks(0, last, bits), last) << bits;
    }
}

} // namespace
} // namespace shutter::gpu
