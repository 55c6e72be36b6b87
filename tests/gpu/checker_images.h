// SPDX-License-Identifier: MIT
// The images of a frame that a host hands to the checker of inputs.
#pragma once

#include "tests/gpu/checker_host.h"
#include "tests/gpu/host_texels.h"
#include "tests/gpu/layered_image.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <vector>

namespace shutter::test {

class CheckedImages {
  public:
    CheckedImages(gpu::Device& device, const GivenFrame& given)
        : mDevice(device), mPlacing(given) {}

    /// Fills the inputs in with images.
    void describe(GivenFrame& given);

    /// Uploads the texels.
    void record(VkCommandBuffer commands) const;

  private:
    struct Layered {
        std::unique_ptr<TwoLayers> image;
        gpu::Buffer texels;
        gpu::Buffer rubbish;
        uint32_t layer;
    };

    /// \param texels of kCheckedWidth x kCheckedHeight, `texelBytes` each
    /// \param coarseness so many times fewer columns and rows
    motion_blur::HostImage make(
        VkFormat format, std::span<const std::byte> texels, size_t texelBytes, uint32_t coarseness
    );
    motion_blur::HostImage
    makeLayer(VkFormat format, VkExtent2D extent, std::span<const std::byte> texels);

    gpu::Device& mDevice;
    const GivenFrame& mPlacing;
    std::deque<HostTexels> mTexels;
    std::deque<Layered> mLayered;
};

} // namespace shutter::test
