// SPDX-License-Identifier: MIT
// Camera keys of a host that has given its two cameras instead.
#pragma once

#include "modules/motion_blur/embedding/host_inputs.h"
#include "modules/motion_blur/settings.h"

#include <array>

namespace shutter::motion_blur {

/// Whether keys are made of HostConvention::cameras: there are none, and the method reads them.
/// Without a method, a host that has vectors and no movers has something that moves by its vectors
/// alone. \param wanted before complete()
[[nodiscard]] bool derivesKeys(const HostInputs& inputs, const MotionBlurSettings& wanted);

/// Why there are no keys, given or derived, where no method is set.
[[nodiscard]] const char* describeMissingKeys(const HostInputs& inputs);

/// The frame before at timeOfFrameBefore() and this one at rasterTime, both with this frame's
/// jitter.
[[nodiscard]] std::array<HostCameraKey, 2> deriveKeys(const HostInputs& inputs);

} // namespace shutter::motion_blur
