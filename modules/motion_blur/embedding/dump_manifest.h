// SPDX-License-Identifier: MIT
// What a host said of a recording, as JSON: what a dump has beside its images.
#pragma once

#include "modules/motion_blur/embedding/embedded_motion_blur.h"
#include "modules/motion_blur/settings.h"

#include <nlohmann/json.hpp>

namespace shutter::motion_blur {

/// \param isPacked HostInputs::motionDepth counts, not the convention
/// \param hasResponse the dump holds the table of the shutter's response
[[nodiscard]] nlohmann::ordered_json describeInputs(
    const HostInputs& inputs, const MotionBlurSettings& settings, bool isPacked, bool hasResponse
);

} // namespace shutter::motion_blur
