// SPDX-License-Identifier: MIT
// Asks a host for what it did not say of its images, which is what lets it be checked.
#pragma once

#include "engine/gpu/vulkan.h"
#include "modules/motion_blur/embedding/host_inputs.h"

#include <cstdint>

namespace shutter::motion_blur {

class HostUnsaid {
  public:
    /// \param device of the host's images
    explicit HostUnsaid(VkDevice device) : mDevice(device) {}

    /// Tells what is not said of images that are given, each once.
    void ask(const HostInputs& inputs, const HostMessage& message);

  private:
    VkDevice mDevice;
    uint32_t mAsked = 0;       ///< a bit for each image whose usage or samples were asked for
    uint32_t mExtentAsked = 0; ///< the same for its extent
};

} // namespace shutter::motion_blur
