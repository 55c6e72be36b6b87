// SPDX-License-Identifier: MIT
// Pictures on a window: images that the window system lends, one at a time.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace shutter::gpu {

struct SwapchainDesc {
    uint32_t width = 1;  ///< pixels; clamped to what the surface takes
    uint32_t height = 1; ///< pixels
    bool vsync = true;   ///< false: pictures are shown at once (mailbox, else immediate)
};

/// An image of the window to draw a frame on.
struct SwapchainImage {
    const Image* image = nullptr; ///< contents undefined; to be left in PRESENT_SRC layout
    uint32_t index = 0;           ///< for present()
    SubmitSemaphores semaphores;  ///< of the submission that draws on it
};

/// The images are 8-bit, not converted on writing: who draws encodes for the display. They can be
/// drawn on and copied from.
class Swapchain {
  public:
    /// \param surface that the device was chosen for (Device::takeSurface); taken over, destroyed
    /// with this
    /// Error: the device has no format for it.
    [[nodiscard]] static core::Result<std::unique_ptr<Swapchain>>
    create(Device& device, VkSurfaceKHR surface, const SwapchainDesc& desc);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    /// Makes it anew for another size or mode; waits for the device. False where the window has no
    /// area now: then nothing can be acquired until it has one.
    bool resize(const SwapchainDesc& desc);

    /// Nothing where the images no longer fit the window, or there are none: resize() first. Of
    /// what was drawn on images acquired before, the GPU must be done with all but the last
    /// kMaxFramesInFlight - 1.
    [[nodiscard]] std::optional<SwapchainImage> acquire();

    /// Shows an image once its submission's semaphore is signalled. False: resize() before the next
    /// acquire().
    bool present(const SwapchainImage& image);

    [[nodiscard]] const SwapchainDesc& desc() const { return mDesc; } ///< what was made

    [[nodiscard]] VkFormat format() const { return mFormat.format; }

    /// False: pictures cannot be copied from (readback).
    [[nodiscard]] bool canBeRead() const { return mUsage & VK_IMAGE_USAGE_TRANSFER_SRC_BIT; }

  private:
    Swapchain(Device& device, VkSurfaceKHR surface) : mDevice(device), mSurface(surface) {}

    core::Status chooseFormat();
    [[nodiscard]] VkPresentModeKHR chooseMode(bool vsync) const;
    void createImages(const VkSurfaceCapabilitiesKHR& surface);
    void releaseImages();

    Device& mDevice;
    VkSurfaceKHR mSurface;
    VkSurfaceFormatKHR mFormat{};
    VkImageUsageFlags mUsage = 0;
    SwapchainDesc mDesc;
    VkSwapchainKHR mSwapchain = VK_NULL_HANDLE;
    std::vector<Image> mImages;
    std::vector<VkSemaphore> mDrawn; ///< one an image: its submission is done
    std::array<VkSemaphore, kMaxFramesInFlight> mAcquired{}; ///< used in turns
    size_t mNextAcquired = 0;
};

} // namespace shutter::gpu
