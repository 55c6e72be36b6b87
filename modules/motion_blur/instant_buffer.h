// SPDX-License-Identifier: MIT
// math::InstantLayers on the device.
#pragma once

#include "engine/gpu/memory.h"
#include "engine/math/layer_tables.h"

namespace shutter::motion_blur {

/// Writes all tables into the buffer, which is made anew where they do not fit. The GPU must be
/// done with what it held. Throws gpu::DeviceError where there is no memory.
/// \return address of shader::InstantMotions
[[nodiscard]] VkDeviceAddress
writeInstantLayers(gpu::Device& device, const math::InstantLayers& layers, gpu::Buffer& buffer);

} // namespace shutter::motion_blur
