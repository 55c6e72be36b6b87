// SPDX-License-Identifier: MIT
// How the motion blur tells a host what no call returns.
#pragma once

#include <functional>
#include <string_view>

namespace shutter::motion_blur {

/// One sentence for the person who writes the host, without a full stop. It is called within the
/// calls of EmbeddedMotionBlur (record, markDone, the destructor), must call none of them, and must
/// not throw.
using HostMessage = std::function<void(std::string_view)>;

} // namespace shutter::motion_blur
