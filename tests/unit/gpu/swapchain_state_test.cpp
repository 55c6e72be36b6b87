// SPDX-License-Identifier: MIT
#include "engine/gpu/swapchain.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

namespace shutter::gpu {
namespace {

constexpr VkExtent2D kMade{640, 360};
constexpr VkExtent2D kOther{640, 361};
constexpr VkExtent2D kAny{UINT32_MAX, UINT32_MAX};

TEST(SwapchainState, OnlyAnOutdatedSwapchainIsRecreated) {
    EXPECT_EQ(judgeSwapchain(VK_SUCCESS, kMade, kMade), SwapchainState::Fits);
    EXPECT_EQ(judgeSwapchain(VK_SUCCESS, kMade, kOther), SwapchainState::Fits);
    EXPECT_EQ(judgeSwapchain(VK_ERROR_OUT_OF_DATE_KHR, kMade, kMade), SwapchainState::Outdated);
    EXPECT_EQ(judgeSwapchain(VK_ERROR_SURFACE_LOST_KHR, kMade, kMade), SwapchainState::SurfaceLost);
}

TEST(SwapchainState, ADriverThatAlwaysReportsSuboptimalHasNoEffectUntilTheSizeChanges) {
    EXPECT_EQ(judgeSwapchain(VK_SUBOPTIMAL_KHR, kMade, kMade), SwapchainState::Fits);
    EXPECT_EQ(judgeSwapchain(VK_SUBOPTIMAL_KHR, kMade, kAny), SwapchainState::Fits);
    EXPECT_EQ(judgeSwapchain(VK_SUBOPTIMAL_KHR, kMade, kOther), SwapchainState::Outdated);
}

TEST(SwapchainState, AnUnexpectedResultIsAnError) {
    EXPECT_THROW((void)judgeSwapchain(VK_ERROR_DEVICE_LOST, kMade, kMade), DeviceError);
    EXPECT_THROW((void)judgeSwapchain(VK_ERROR_OUT_OF_DEVICE_MEMORY, kMade, kMade), DeviceError);
}

constexpr VkSurfaceFormatKHR inSrgb(VkFormat format) {
    return {format, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR};
}

TEST(SurfaceFormat, EightBitsComeBeforeTenWhateverTheOrder) {
    const std::vector<VkSurfaceFormatKHR> offered{
        inSrgb(VK_FORMAT_A2B10G10R10_UNORM_PACK32),
        inSrgb(VK_FORMAT_B8G8R8A8_SRGB),
        inSrgb(VK_FORMAT_R8G8B8A8_UNORM),
        inSrgb(VK_FORMAT_B8G8R8A8_UNORM)};
    EXPECT_EQ(chooseSurfaceFormat(offered)->format, VK_FORMAT_B8G8R8A8_UNORM);
    EXPECT_EQ(chooseSurfaceFormat(std::span(offered).first(3))->format, VK_FORMAT_R8G8B8A8_UNORM);
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

TEST(SurfaceFormat, SrgbFormatsAreNotChosen) {
    const std::vector<VkSurfaceFormatKHR> offered{
        inSrgb(VK_FORMAT_B8G8R8A8_SRGB),
        {VK_FORMAT_B8G8R8A8_UNORM, VK_COLOR_SPACE_EXTENDED_SRGB_LINEAR_EXT}};
    EXPECT_FALSE(chooseSurfaceFormat(offered));
    EXPECT_FALSE(chooseSurfaceFormat({}));
}

} // namespace
} // namespace shutter::gpu
