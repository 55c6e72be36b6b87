// SPDX-License-Identifier: MIT
#include "engine/gpu/swapchain.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace shutter::gpu {
namespace {

constexpr VkExtent2D kMade{640, 360};
constexpr VkExtent2D kOther{640, 361};
constexpr VkExtent2D kAny{UINT32_MAX, UINT32_MAX};

TEST(SwapchainState, OnlyWhatNoLongerFitsIsMadeAnew) {
    EXPECT_EQ(judgeSwapchain(VK_SUCCESS, kMade, kMade), SwapchainState::Fits);
    EXPECT_EQ(judgeSwapchain(VK_SUCCESS, kMade, kOther), SwapchainState::Fits);
    EXPECT_EQ(judgeSwapchain(VK_ERROR_OUT_OF_DATE_KHR, kMade, kMade), SwapchainState::Outdated);
    EXPECT_EQ(judgeSwapchain(VK_ERROR_SURFACE_LOST_KHR, kMade, kMade), SwapchainState::SurfaceLost);
}

TEST(SwapchainState, ADriverThatAlwaysSaysSuboptimalIsLeftAloneUntilTheSizeChanges) {
    EXPECT_EQ(judgeSwapchain(VK_SUBOPTIMAL_KHR, kMade, kMade), SwapchainState::Fits);
    EXPECT_EQ(judgeSwapchain(VK_SUBOPTIMAL_KHR, kMade, kAny), SwapchainState::Fits);
    EXPECT_EQ(judgeSwapchain(VK_SUBOPTIMAL_KHR, kMade, kOther), SwapchainState::Outdated);
}

TEST(SwapchainState, WhatIsNoAnswerOfTheWindowSystemIsAnError) {
    EXPECT_THROW((void)judgeSwapchain(VK_ERROR_DEVICE_LOST, kMade, kMade), DeviceError);
    EXPECT_THROW((void)judgeSwapchain(VK_ERROR_OUT_OF_DEVICE_MEMORY, kMade, kMade), DeviceError);
}

} // namespace
} // namespace shutter::gpu
