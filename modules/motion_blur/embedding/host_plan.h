// SPDX-License-Identifier: MIT
// Description of a host's future recordings, before there are images: for memory estimates and
// pipelines.
#pragma once

#include "modules/motion_blur/embedding/host_inputs.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace shutter::motion_blur {

/// ShutterBlurPlan.
struct HostPlan {
    MotionBlurSettings settings; ///< without a method: `resolved`
    uint32_t width = 0;
    uint32_t height = 0;
    uint32_t viewCount = 1;
    VkFormat colorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
    VkFormat outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
    VkFormat entityIdFormat = VK_FORMAT_R32_UINT;
    bool areParts = false;
    bool hasVectors = false;
    bool lendsLast = false;
    uint32_t rowCount = 1;
    uint32_t moverCount = 0;
    bool givesDeformedMotion = false;
    uint64_t blendedPixels = 0;
    bool drawsBlended = false;
    uint32_t blendedInstants = 0;
    uint32_t blendedParts = 0;
    bool isBlendedOpacityInAlpha = false;
    bool hasLens = false;
};

/// Inputs as the plan's host would give them, whose handles are of nothing.
struct DryRunInputs {
    /// The next recording sees the world from another place.
    void moveCamera();

    HostInputs inputs;
    std::vector<HostCameraKey> keys;
    std::vector<HostMover> movers;
    std::vector<glm::dmat4> matrices;
};

/// Into place: the inputs point to the other fields.
void fillPlaceholders(const HostPlan& plan, DryRunInputs& dryRun);

} // namespace shutter::motion_blur
