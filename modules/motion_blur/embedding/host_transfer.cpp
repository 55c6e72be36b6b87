// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_transfer.h"

#include "shaders/motion_blur/deliver_shared.h"

namespace shutter::motion_blur {

namespace {

using core::makeError;

constexpr double kMaxPower = 3.0; ///< beyond it, half floats lose the dark values of 8 bits
constexpr double kMaxScale = 16.0;
constexpr shader::Transfer kIdentity{shader::kTransferLinear, 1.0f, 1.0f};

bool isSrgb(VkFormat format) {
    return format == VK_FORMAT_R8G8B8A8_SRGB || format == VK_FORMAT_B8G8R8A8_SRGB;
}

shader::Transfer convert(const HostTransfer& transfer) {
    return {transfer.curve, float(transfer.power), float(transfer.scale)};
}

} // namespace

core::Status checkTransfer(const HostTransfer& transfer) {
    if (transfer.curve > shader::kTransferPower)
        return makeError(
            "motion blur: transfer is {}, it must be 0 (linear), 1 (sRGB) or 2 (power)",
            transfer.curve
        );
    if (transfer.curve == shader::kTransferPower &&
        !(transfer.power >= 1.0 && transfer.power <= kMaxPower))
        return makeError(
            "motion blur: transferPower is {}, it must be 1 to {}", transfer.power, kMaxPower
        );
    if (!(transfer.scale >= 1.0 / kMaxScale && transfer.scale <= kMaxScale))
        return makeError(
            "motion blur: transferScale is {}, it must be {} to {}",
            transfer.scale,
            1.0 / kMaxScale,
            kMaxScale
        );
    return {};
}

shader::Transfer decodingOf(const HostTransfer& transfer, VkFormat format) {
    return isSrgb(format) ? kIdentity : convert(transfer);
}

shader::Transfer encodingOf(const HostTransfer& transfer, VkFormat format) {
    if (isSrgb(format))
        return {shader::kTransferSrgb, 1.0f, 1.0f};
    return convert(transfer);
}

bool isIdentity(const shader::Transfer& transfer) {
    return transfer.curve == shader::kTransferLinear && transfer.scale == 1.0f;
}

std::optional<uint32_t> packingOf(VkFormat format) {
    switch (format) {
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SRGB:
        return shader::kPackRgba8;
    case VK_FORMAT_B8G8R8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_SRGB:
        return shader::kPackBgra8;
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
        return shader::kPackRgb10a2;
    case VK_FORMAT_A2R10G10B10_UNORM_PACK32:
        return shader::kPackBgr10a2;
    case VK_FORMAT_R16G16B16A16_UNORM:
        return shader::kPackRgba16;
    default:
        return std::nullopt;
    }
}

} // namespace shutter::motion_blur
