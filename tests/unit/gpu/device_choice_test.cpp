// SPDX-License-Identifier: MIT
// Which device shows pictures, on lists of machines that this suite never runs on.
#include "engine/gpu/device_select.h"

#include <gtest/gtest.h>

#include <optional>
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

TEST(QueueFamily, TheFirstThatDoesAllIsTaken) {
    const std::vector<QueueFamily> families{
        {VK_QUEUE_TRANSFER_BIT, 64, true},
        {kCompute, 64, true},
        {kAll, 64, false},
        {kAll, 36, true}};
    EXPECT_EQ(chooseQueueFamily(families, false), 2u);
    EXPECT_EQ(chooseQueueFamily(families, true), 3u);
}

TEST(QueueFamily, AFamilyThatOnlyPresentsOrHasNoTimestampsIsNotChosen) {
    const std::vector<QueueFamily> apart{{kAll, 64, false}, {VK_QUEUE_TRANSFER_BIT, 64, true}};
    EXPECT_EQ(chooseQueueFamily(apart, true), std::nullopt);
    const std::vector<QueueFamily> timeless{{kAll, 0, true}};
    EXPECT_EQ(chooseQueueFamily(timeless, false), std::nullopt);
    EXPECT_EQ(chooseQueueFamily({}, false), std::nullopt);
}

TEST(DeviceChoice, ADeviceThatCannotPresentIsSkippedWithAMessage) {
    // A card under a display without a screen, and one of a data centre: lavapipe shows.
    for (const char* card : {"NVIDIA GeForce RTX 2080 Ti", "NVIDIA H100"}) {
        const std::vector<DeviceInfo> devices{
            makeInfo(card, "discrete", kNoDisplay), makeInfo("llvmpipe", "software", "")};
        const auto chosen = chooseDevice(devices, "");
        ASSERT_TRUE(chosen.ok());
        EXPECT_EQ(chosen.value().name, "llvmpipe");
        EXPECT_EQ(
            describePassedOver(devices, chosen.value()),
            Strings{std::string(card) + " is passed over for llvmpipe: it lacks " + kNoDisplay}
        );
    }
}

TEST(DeviceChoice, UnchosenDevicesAreNotMentioned) {
    const std::vector<DeviceInfo> devices{
        makeInfo("card", "discrete", ""),
        makeInfo("llvmpipe", "software", kNoDisplay),
        makeInfo("laptop", "integrated", "Vulkan 1.3")};
    EXPECT_EQ(chooseDevice(devices, "").value().name, "card");
    EXPECT_EQ(describePassedOver(devices, devices[0]), Strings{});
}

TEST(DeviceChoice, ANamedUnusableDeviceIsRefusedWithTheReason) {
    const std::vector<DeviceInfo> devices{
        makeInfo("NVIDIA H100", "discrete", kNoDisplay), makeInfo("llvmpipe", "software", "")};
    const auto chosen = chooseDevice(devices, "h100");
    ASSERT_FALSE(chosen.ok());
    EXPECT_EQ(
        chosen.error().message, "--device 'h100': NVIDIA H100 lacks " + std::string(kNoDisplay)
    );
}

Strings listNames(const DeviceInfo& device, bool presents, Bounds bounds) {
    const auto names = listDeviceExtensions(device, presents, bounds);
    return {names.begin(), names.end()};
}

TEST(DeviceExtensions, ADeviceOverAnotherInterfaceIsMadeWithThePortabilitySubset) {
    DeviceInfo mac = makeInfo("Apple M2", "integrated", "");
    mac.isPortable = true;
    EXPECT_EQ(
        listNames(mac, true, Bounds::Trusted),
        (Strings{"VK_KHR_swapchain", "VK_KHR_portability_subset"})
    );
    EXPECT_EQ(listNames(mac, false, Bounds::Trusted), Strings{"VK_KHR_portability_subset"});
    mac.isPortable = false;
    EXPECT_EQ(listNames(mac, false, Bounds::Trusted), Strings{});
}

TEST(DeviceExtensions, RaysBringTheOnesOfTheirTier) {
    DeviceInfo card = makeInfo("card", "discrete", "");
    card.rayTier = RayTier::Pipeline;
    EXPECT_EQ(
        listNames(card, false, Bounds::Trusted),
        (Strings{
            "VK_KHR_acceleration_structure",
            "VK_KHR_deferred_host_operations",
            "VK_KHR_ray_tracing_pipeline"})
    );
}

TEST(DeviceExtensions, BoundsAreCheckedByTheBetterRulesWhereTheDeviceHasThem) {
    DeviceInfo card = makeInfo("card", "discrete", "");
    EXPECT_EQ(listNames(card, false, Bounds::Checked), Strings{});
    card.hasRobustness2 = true;
    EXPECT_EQ(listNames(card, false, Bounds::Checked), Strings{"VK_EXT_robustness2"});
    EXPECT_EQ(listNames(card, false, Bounds::Trusted), Strings{});
}

} // namespace
} // namespace shutter::gpu
