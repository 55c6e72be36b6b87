// SPDX-License-Identifier: MIT
// Where measurements were taken.
#pragma once

#include "engine/gpu/device_select.h"

#include <nlohmann/json_fwd.hpp>

namespace shutter::bench {

/// Processor, cores, memory and operating system.
[[nodiscard]] nlohmann::json describeMachine();

/// Name, driver and API of the Vulkan device.
[[nodiscard]] nlohmann::json describeDevice(const gpu::DeviceInfo& device);

/// The source's revision when the program was built, and whether it had been changed since.
[[nodiscard]] nlohmann::json describeRevision();

/// Now, as ISO 8601 in UTC.
[[nodiscard]] std::string describeNow();

} // namespace shutter::bench
