// SPDX-License-Identifier: MIT
#include "engine/gpu/swapchain.h"

#include <algorithm>
#include <utility>

namespace shutter::gpu {

namespace {

/// The surface's answer, or nothing once it is gone.
std::optional<VkSurfaceCapabilitiesKHR> querySurface(const Device& device, VkSurfaceKHR surface) {
    VkSurfaceCapabilitiesKHR capabilities{};
    const VkResult queried =
        vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical(), surface, &capabilities);
    if (queried == VK_ERROR_SURFACE_LOST_KHR)
        return std::nullopt;
    require(queried, "querying the window");
    return capabilities;
}

VkSemaphore createSemaphore(const Device& device) {
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    require(vkCreateSemaphore(device.handle(), &info, nullptr, &semaphore), "making a semaphore");
    return semaphore;
}

} // namespace

SwapchainState judgeSwapchain(VkResult result, const VkExtent2D& made, const VkExtent2D& surface) {
    if (result == VK_ERROR_OUT_OF_DATE_KHR)
        return SwapchainState::Outdated;
    if (result == VK_ERROR_SURFACE_LOST_KHR)
        return SwapchainState::SurfaceLost;
    require(result, "showing a picture");
    const bool isChosen = surface.width == UINT32_MAX;
    const bool isSame = surface.width == made.width && surface.height == made.height;
    return result == VK_SUBOPTIMAL_KHR && !isChosen && !isSame ? SwapchainState::Outdated
                                                               : SwapchainState::Fits;
}

std::optional<VkSurfaceFormatKHR> chooseSurfaceFormat(std::span<const VkSurfaceFormatKHR> formats) {
    for (const VkFormat wanted :
         {VK_FORMAT_B8G8R8A8_UNORM,
          VK_FORMAT_R8G8B8A8_UNORM,
          VK_FORMAT_A2B10G10R10_UNORM_PACK32,
          VK_FORMAT_A2R10G10B10_UNORM_PACK32})
        for (const VkSurfaceFormatKHR& format : formats)
            if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR)
                return format;
    return std::nullopt;
}

core::Result<std::unique_ptr<Swapchain>>
Swapchain::create(Device& device, VkSurfaceKHR surface, const SwapchainDesc& desc) {
    std::unique_ptr<Swapchain> swapchain(new Swapchain(device, surface));
    SHUTTER_TRY(swapchain->chooseFormat());
    for (VkSemaphore& semaphore : swapchain->mAcquired)
        semaphore = createSemaphore(device);
    swapchain->resize(desc);
    return swapchain;
}

Swapchain::~Swapchain() {
    mDevice.collectIdle();
    releaseImages();
    vkDestroySwapchainKHR(mDevice.handle(), mSwapchain, nullptr);
    for (const VkSemaphore semaphore : mAcquired)
        vkDestroySemaphore(mDevice.handle(), semaphore, nullptr);
    vkDestroySurfaceKHR(mDevice.instance(), mSurface, nullptr);
}

core::Status Swapchain::chooseFormat() {
    uint32_t count = 0;
    vkGetPhysicalDeviceSurfaceFormatsKHR(mDevice.physical(), mSurface, &count, nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    vkGetPhysicalDeviceSurfaceFormatsKHR(mDevice.physical(), mSurface, &count, formats.data());
    const auto chosen = chooseSurfaceFormat(formats);
    if (!chosen)
        return core::makeError(
            "{} shows no 8-bit or 10-bit sRGB pictures here", mDevice.info().name
        );
    mFormat = *chosen;
    return {};
}

VkPresentModeKHR Swapchain::chooseMode(bool vsync) const {
    if (vsync)
        return VK_PRESENT_MODE_FIFO_KHR; // every device has it
    uint32_t count = 0;
    vkGetPhysicalDeviceSurfacePresentModesKHR(mDevice.physical(), mSurface, &count, nullptr);
    std::vector<VkPresentModeKHR> modes(count);
    vkGetPhysicalDeviceSurfacePresentModesKHR(mDevice.physical(), mSurface, &count, modes.data());
    for (const auto mode : {VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR})
        if (std::find(modes.begin(), modes.end(), mode) != modes.end())
            return mode;
    return VK_PRESENT_MODE_FIFO_KHR;
}

void Swapchain::releaseImages() {
    mImages.clear();
    mDevice.collectIdle(); // their views, before the swapchain goes
    for (const VkSemaphore semaphore : std::exchange(mDrawn, {}))
        vkDestroySemaphore(mDevice.handle(), semaphore, nullptr);
}

bool Swapchain::resize(const SwapchainDesc& desc) {
    // Images may still be queued for display, which none of our semaphores signals.
    mDevice.collectIdle();
    releaseImages();
    mWanted = desc;
    mDesc = desc;
    mState = SwapchainState::Fits;
    const auto surface = querySurface(mDevice, mSurface);
    if (!surface) {
        mState = SwapchainState::SurfaceLost;
        return false;
    }
    // All ones means that the program chooses the size.
    const bool fixed = surface->currentExtent.width != UINT32_MAX;
    const VkExtent2D wanted = fixed ? surface->currentExtent : VkExtent2D{desc.width, desc.height};
    mDesc.width =
        std::clamp(wanted.width, surface->minImageExtent.width, surface->maxImageExtent.width);
    mDesc.height =
        std::clamp(wanted.height, surface->minImageExtent.height, surface->maxImageExtent.height);
    if (mDesc.width == 0 || mDesc.height == 0)
        return false;
    return createImages(*surface);
}

bool Swapchain::resize(const SwapchainDesc& desc, VkSurfaceKHR surface) {
    mDevice.collectIdle();
    releaseImages();
    vkDestroySwapchainKHR(mDevice.handle(), std::exchange(mSwapchain, VK_NULL_HANDLE), nullptr);
    vkDestroySurfaceKHR(mDevice.instance(), std::exchange(mSurface, surface), nullptr);
    return resize(desc);
}

bool Swapchain::createImages(const VkSurfaceCapabilitiesKHR& surface) {
    mUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
             (surface.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = mSurface;
    info.minImageCount = surface.minImageCount + 1;
    if (surface.maxImageCount > 0)
        info.minImageCount = std::min(info.minImageCount, surface.maxImageCount);
    info.imageFormat = mFormat.format;
    info.imageColorSpace = mFormat.colorSpace;
    info.imageExtent = {mDesc.width, mDesc.height};
    info.imageArrayLayers = 1;
    info.imageUsage = mUsage;
    info.preTransform = surface.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    if (!(surface.supportedCompositeAlpha & info.compositeAlpha))
        info.compositeAlpha = VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = chooseMode(mDesc.vsync);
    info.clipped = VK_FALSE; // pictures may be read back
    info.oldSwapchain = mSwapchain;
    VkSwapchainKHR made = VK_NULL_HANDLE;
    const VkResult result = vkCreateSwapchainKHR(mDevice.handle(), &info, nullptr, &made);
    if (result == VK_ERROR_SURFACE_LOST_KHR) { // since the query
        mState = SwapchainState::SurfaceLost;
        return false;
    }
    require(result, "making a swapchain");
    vkDestroySwapchainKHR(mDevice.handle(), mSwapchain, nullptr);
    mSwapchain = made;

    uint32_t count = 0;
    vkGetSwapchainImagesKHR(mDevice.handle(), mSwapchain, &count, nullptr);
    std::vector<VkImage> images(count);
    vkGetSwapchainImagesKHR(mDevice.handle(), mSwapchain, &count, images.data());
    ImageDesc desc;
    desc.width = mDesc.width;
    desc.height = mDesc.height;
    desc.format = mFormat.format;
    desc.usage = mUsage;
    for (const VkImage image : images) {
        mImages.push_back(Image::adopt(mDevice, "window", image, desc));
        mDrawn.push_back(createSemaphore(mDevice));
    }
    return true;
}

std::optional<SwapchainImage> Swapchain::acquire() {
    // A surface may learn of a new window size later, and not every driver reports that.
    if (mWanted != mDesc)
        noteState(VK_SUBOPTIMAL_KHR);
    if (mImages.empty() || mState != SwapchainState::Fits)
        return std::nullopt;
    SwapchainImage acquired;
    acquired.semaphores.wait = mAcquired[mNextAcquired];
    const VkResult result = vkAcquireNextImageKHR(
        mDevice.handle(),
        mSwapchain,
        UINT64_MAX,
        acquired.semaphores.wait,
        VK_NULL_HANDLE,
        &acquired.index
    );
    if (result < 0) {
        noteState(result);
        return std::nullopt;
    }
    mNextAcquired = (mNextAcquired + 1) % mAcquired.size();
    acquired.image = &mImages[acquired.index];
    acquired.semaphores.signal = mDrawn[acquired.index];
    return acquired;
}

void Swapchain::noteState(VkResult result) {
    VkExtent2D size{mDesc.width, mDesc.height};
    if (result == VK_SUBOPTIMAL_KHR)
        if (const auto surface = querySurface(mDevice, mSurface))
            size = surface->currentExtent;
    mState = judgeSwapchain(result, {mDesc.width, mDesc.height}, size);
}

void Swapchain::present(const SwapchainImage& image) {
    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &image.semaphores.signal;
    info.swapchainCount = 1;
    info.pSwapchains = &mSwapchain;
    info.pImageIndices = &image.index;
    noteState(vkQueuePresentKHR(mDevice.queue(), &info));
}

} // namespace shutter::gpu
