// SPDX-License-Identifier: MIT
// How a host's images store colours.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/vulkan.h"
#include "shaders/common/transfer.glsl"

#include <cstdint>
#include <optional>

namespace shutter::motion_blur {

/// ShutterBlurInputs::transfer and the fields with it.
struct HostTransfer {
    uint32_t curve = shader::kTransferLinear;
    double power = 2.2;
    double scale = 1.0;
};

/// One sentence that names the field which is wrong.
[[nodiscard]] core::Status checkTransfer(const HostTransfer& transfer);

/// From what a shader samples of an image of that format to light: the device decodes sRGB itself.
[[nodiscard]] shader::Transfer decodingOf(const HostTransfer& transfer, VkFormat format);
/// From light to what is stored in an image of that format.
[[nodiscard]] shader::Transfer encodingOf(const HostTransfer& transfer, VkFormat format);

/// Light is the value itself.
[[nodiscard]] bool isIdentity(const shader::Transfer& transfer);

/// How texels of that format lie in words (deliver_shared.h); nothing: it is written as a storage
/// image.
[[nodiscard]] std::optional<uint32_t> packingOf(VkFormat format);

} // namespace shutter::motion_blur
