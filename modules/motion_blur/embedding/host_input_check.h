// SPDX-License-Identifier: MIT
// Validates a host's inputs of a recording. Error: one sentence.
#pragma once

#include "engine/core/result.h"
#include "modules/motion_blur/embedding/host_inputs.h"
#include "modules/motion_blur/embedding/host_instants.h"
#include "modules/motion_blur/settings.h"

#include <vector>

namespace shutter::motion_blur {

inline constexpr VkFormat kHostColorFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat kHostMotionFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
inline constexpr VkFormat kHostIdFormat = VK_FORMAT_R32_UINT;

extern const HostImageRule kMotionRule; ///< HostInputs::motionDepth
extern const HostImageRule kNormalRule;
extern const HostImageRule kIdRule;
extern const HostImageRule kLastColorRule; ///< HostLastFrame
extern const HostImageRule kLastMotionRule;
extern const HostImageRule kLastIdRule;
extern const HostImageRule kDeformedRule;
extern const HostImageRule kLastDeformedRule;
extern const HostImageRule kBlendedRule;

/// The image of ids is the stencil of the one of depth.
[[nodiscard]] bool sharesDepth(const HostInputs& inputs);

[[nodiscard]] HostImageRule colorRule(const HostInputs& inputs);
[[nodiscard]] HostImageRule outputRule(const HostInputs& inputs);

[[nodiscard]] VkExtent2D pictureOf(const HostInputs& inputs);

/// There are no ids, and nothing moves by itself: all but the sky is one entity, of row 0.
[[nodiscard]] bool isOneWorld(const HostInputs& inputs);

/// HostInputs::motion as it counts: of one world there is one row, and at a cut
/// (HostScales::isCut, where the convention counts) the raster's key alone.
/// \param movers is filled where the result needs it, and must outlive that
[[nodiscard]] HostMotion countedMotion(const HostInputs& inputs, std::vector<HostMover>& movers);

/// ShutterBlurInputs::viewModel marks pixels by their depth.
[[nodiscard]] bool hasViewModel(const HostInputs& inputs);

/// The part of the image that is used is one that the effect may read, write and copy itself.
[[nodiscard]] bool isNativeImage(const HostImage& image, VkFormat format, VkExtent2D picture);

/// The same for colours, which must be light.
[[nodiscard]] bool
isNativeColor(const HostImage& image, const HostTransfer& transfer, VkExtent2D picture);

/// Samples have places of the lens, which is open and which the method reads.
[[nodiscard]] bool seesThroughLens(const HostInputs& inputs, const MotionBlurSettings& settings);

[[nodiscard]] HostMotionFrame
describeFrame(const HostInputs& inputs, const MotionBlurSettings& settings);

/// The host's declarations at the creation of the effect.
struct HostAbilities {
    ImageLimits images;
    bool hasRays = false; ///< HostDevice::rayTier is not None
    bool measures = false;
    uint32_t framesInFlight = 1;
    VkDeviceSize mostBufferBytes = 0; ///< VkPhysicalDeviceLimits::maxStorageBufferRange
};

[[nodiscard]] core::Status checkInputs(
    const HostInputs& inputs, const MotionBlurSettings& settings, const HostAbilities& host
);

} // namespace shutter::motion_blur
