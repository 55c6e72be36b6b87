// SPDX-License-Identifier: MIT
// The C interface's structures as the C++ interface has them.
#pragma once

#include "engine/core/result.h"
#include "modules/motion_blur/c_interface/shutter_motion_blur.h"
#include "modules/motion_blur/embedding/embedded_motion_blur.h"

#include <algorithm>
#include <cstring>
#include <vector>

namespace shutter::motion_blur {

/// A structure of this header or of an older one, whose missing fields are as in `defaults`. New
/// fields come last, and never where an older structure had padding, whose bytes may be anything:
/// where the last field has 4 bytes, the first new one has 8.
template <class T>
[[nodiscard]] core::Result<T> takeStructure(const char* name, const T* given, const T& defaults) {
    if (!given)
        return core::makeError("motion blur: {} is null", name);
    if (given->structBytes <= sizeof(given->structBytes) || given->structBytes > sizeof(T))
        return core::makeError(
            "motion blur: {}.structBytes is {}, it must be {}, or less of an older header",
            name,
            given->structBytes,
            sizeof(T)
        );
    T taken = defaults;
    std::memcpy(&taken, given, given->structBytes);
    return taken;
}

/// Whether a host compiled with a header of this version may use the library: the same major and
/// minor version, and a patch that is not newer. The error names both versions.
[[nodiscard]] core::Status checkVersion(uint32_t headerVersion);

[[nodiscard]] core::Result<HostDevice> convert(const ShutterBlurDevice* given);

struct HostSettings {
    MotionBlurSettings settings;
    bool isOff = false; ///< the preset is "off"
};

/// Null: shutterBlurDefaultSettings().
[[nodiscard]] core::Result<HostSettings> convert(const ShutterBlurSettings* given);

[[nodiscard]] core::Result<HostPlan> convert(const ShutterBlurPlan* given);

/// Storage behind HostInputs; reused from frame to frame to avoid allocations.
struct InputArrays {
    std::vector<HostCameraKey> keys;
    std::vector<HostMover> movers;
    std::vector<glm::dmat4> matrices;
    std::vector<glm::dmat4> viewFromObject;
    std::vector<math::ResponsePoint> response;
};

/// \param arrays must outlive the result
[[nodiscard]] core::Result<HostInputs> convert(const ShutterBlurInputs* given, InputArrays& arrays);

/// Whether a host can run the method through the C interface; `hybrid` and `adaptive`, by its own
/// rays.
[[nodiscard]] bool isForHosts(const Method& method);

} // namespace shutter::motion_blur
