// SPDX-License-Identifier: MIT
// What a host is going to record, before it has images: for memory and for pipelines.
#pragma once

#include "modules/motion_blur/embedding/host_inputs.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace shutter::motion_blur {

struct HostPlan {
    MotionBlurSettings settings; ///< without a method: `resolved`
    uint32_t width = 0;          ///< of the picture, pixels, [1, 32768]
    uint32_t height = 0;
    uint32_t viewCount = 1; ///< that keep a history of their own, [1, framesInFlight]
    VkFormat colorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
    VkFormat outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT; ///< UNDEFINED: in place
    VkFormat entityIdFormat = VK_FORMAT_R32_UINT;          ///< UNDEFINED: no ids
    bool areParts = false;   ///< color and output are parts or layers of larger images
    bool hasVectors = false; ///< vectors and depth of the host's own in place of motionDepth
    bool lendsLast = false;  ///< HostInputs::last
    uint32_t rowCount = 1;   ///< HostMotion::rowCount
    uint32_t moverCount = 0; ///< movers with transforms, at most
};

/// Inputs as the plan's host would give them, whose handles are of nothing.
struct ImaginedInputs {
    HostInputs inputs;
    std::vector<HostCameraKey> keys;
    std::vector<HostMover> movers;
    std::vector<glm::dmat4> matrices;
};

/// Into place: the inputs point to the other fields.
void imagine(const HostPlan& plan, ImaginedInputs& imagined);

} // namespace shutter::motion_blur
