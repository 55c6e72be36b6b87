// SPDX-License-Identifier: MIT
// At which instants a host draws over the blurred picture (HostInputs::drawn).
#pragma once

#include "engine/core/result.h"
#include "modules/motion_blur/embedding/host_inputs.h"
#include "modules/motion_blur/passes/host_blended_pass.h"
#include "modules/motion_blur/settings.h"

namespace shutter::motion_blur {

/// Whether the method provides the surfaces that the host's draws are tested against.
[[nodiscard]] bool findsSurfaces(const HostInputs& inputs, const MotionBlurSettings& settings);

/// \param inputs that checkDrawn() took
/// \param response null: a box
[[nodiscard]] BlendedDraws describeDrawn(
    const HostInputs& inputs,
    const MotionBlurSettings& settings,
    const shader::ResponseTable* response
);

/// \param mostBufferBytes of the device
[[nodiscard]] core::Status checkDrawn(
    const HostInputs& inputs, const MotionBlurSettings& settings, VkDeviceSize mostBufferBytes
);

} // namespace shutter::motion_blur
