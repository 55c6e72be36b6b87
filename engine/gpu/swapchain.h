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
#include <span>
#include <vector>

namespace shutter::gpu {

struct SwapchainDesc {
    uint32_t width = 1;  ///< pixels; clamped to the surface's limits
    uint32_t height = 1; ///< pixels
    bool vsync = true;   ///< false: pictures are shown at once (mailbox, else immediate)

    bool operator==(const SwapchainDesc&) const = default;
};

/// State of a swapchain after a call to the window system.
enum class SwapchainState : uint8_t {
    Fits,
    Outdated,    ///< must be recreated before the next image
    SurfaceLost, ///< so is the surface
};

/// \param result of acquiring or presenting an image
/// \param made size of the images
/// \param surface size that the surface has now, all ones where the program chooses it. Drivers may
/// report a swapchain as suboptimal for reasons that recreating it does not remove (rotation,
/// composition): only a changed size counts. Throws DeviceError for unexpected results.
[[nodiscard]] SwapchainState
judgeSwapchain(VkResult result, const VkExtent2D& made, const VkExtent2D& surface);

/// Selects the format for display among those of a surface: 8 bits per channel before 10, which is
/// all that some 30-bit displays list; never an sRGB format, which converts on writing.
[[nodiscard]] std::optional<VkSurfaceFormatKHR>
chooseSurfaceFormat(std::span<const VkSurfaceFormatKHR> formats);

/// An image of the window to draw a frame on.
struct SwapchainImage {
    const Image* image = nullptr; ///< contents undefined; to be left in PRESENT_SRC layout
    uint32_t index = 0;           ///< for present()
    SubmitSemaphores semaphores;  ///< of the submission that draws on it
};

/// The images have 8 or 10 bits per channel without conversion on writing: the drawing pass encodes
/// for the display. They can be drawn on and copied from.
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

    /// Recreates it for another size or mode; waits for the device. False if the window has no
    /// area: then nothing can be acquired until it has one.
    bool resize(const SwapchainDesc& desc);
    /// The same on another surface of the window, which is taken over: the former was lost.
    bool resize(const SwapchainDesc& desc, VkSurfaceKHR surface);

    /// Nothing if the images no longer fit the window (state()), or there are none: call resize()
    /// first. The GPU must have finished the draws to all earlier images but the last
    /// kMaxFramesInFlight - 1.
    [[nodiscard]] std::optional<SwapchainImage> acquire();

    /// Shows an image once its submission's semaphore is signalled, and notes the state().
    void present(const SwapchainImage& image);

    /// Whether acquire() may give an image.
    [[nodiscard]] bool hasImages() const {
        return !mImages.empty() && mState == SwapchainState::Fits;
    }

    /// As the window system answered last.
    [[nodiscard]] SwapchainState state() const { return mState; }

    /// The last request to resize(). The surface may impose another size; that is no reason to
    /// recreate the same images.
    [[nodiscard]] const SwapchainDesc& wanted() const { return mWanted; }

    [[nodiscard]] const SwapchainDesc& desc() const { return mDesc; } ///< the actual properties

    [[nodiscard]] VkFormat format() const { return mFormat.format; }

    /// False: pictures cannot be copied from (readback).
    [[nodiscard]] bool canBeRead() const { return mUsage & VK_IMAGE_USAGE_TRANSFER_SRC_BIT; }

  private:
    Swapchain(Device& device, VkSurfaceKHR surface) : mDevice(device), mSurface(surface) {}

    core::Status chooseFormat();
    [[nodiscard]] VkPresentModeKHR chooseMode(bool vsync) const;
    /// False: the surface was lost since the query.
    bool createImages(const VkSurfaceCapabilitiesKHR& surface);
    void releaseImages();
    void noteState(VkResult result);

    Device& mDevice;
    VkSurfaceKHR mSurface;
    VkSurfaceFormatKHR mFormat{};
    VkImageUsageFlags mUsage = 0;
    SwapchainDesc mWanted;
    SwapchainDesc mDesc;
    SwapchainState mState = SwapchainState::Fits;
    VkSwapchainKHR mSwapchain = VK_NULL_HANDLE;
    std::vector<Image> mImages;
    std::vector<VkSemaphore> mDrawn; ///< one per image: its submission is complete
    std::array<VkSemaphore, kMaxFramesInFlight> mAcquired{}; ///< used in turns
    size_t mNextAcquired = 0;
};

} // namespace shutter::gpu
