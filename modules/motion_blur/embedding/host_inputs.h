// SPDX-License-Identifier: MIT
// Inputs of a host: its device once, its images in each frame. Fields without a comment are
// documented under the same name in shutter_motion_blur.h.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device_select.h"
#include "engine/gpu/frame.h"
#include "engine/graph/graph.h"
#include "engine/math/response.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/embedding/host_convention.h"
#include "modules/motion_blur/embedding/host_image.h"
#include "modules/motion_blur/embedding/host_motion.h"
#include "modules/motion_blur/embedding/host_transfer.h"
#include "modules/motion_blur/frame_io.h"
#include "modules/motion_blur/host_answers.h"
#include "modules/motion_blur/methods.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::motion_blur {

/// One sentence for the person who writes the host, without a full stop. It is called within the
/// calls of EmbeddedMotionBlur (record, markDone, the destructor), must call none of them, and must
/// not throw.
using HostMessage = std::function<void(std::string_view)>;

/// All handles stay the host's and must outlive the EmbeddedMotionBlur.
struct HostDevice {
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    uint32_t queueFamily = 0;
    uint32_t framesInFlight = 2;
    bool hasDebugUtils = false;
    /// For methods of RayNeed::Any: which rays are enabled, and the layout of HostRays::scene.
    gpu::RayTier rayTier = gpu::RayTier::None;
    VkDescriptorSetLayout sceneLayout = VK_NULL_HANDLE;
    bool tracesIndirect = false;
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;
    uint32_t apiVersion = 0;
    const VkPhysicalDeviceFeatures2* enabledFeatures = nullptr;
    bool measures = false;
    bool checksInputs = false;
    HostMessage message;
};

/// What rays meet, in the terms of shaders/render/scene_shared.h: a host that wants methods of
/// RayNeed::Any fills those tables.
struct HostRays {
    /// Custom index of an instance: its mesh id. Null: only sky lies behind movers.
    VkAccelerationStructureKHR tlas = VK_NULL_HANDLE;
    VkBuffer tlasBuffer = VK_NULL_HANDLE;   ///< that it lies in; null only where tlas is
    VkDescriptorSet scene = VK_NULL_HANDLE; ///< bindless textures, of HostDevice::sceneLayout
    /// shader::FrameConstants; entityCount limits valid ids.
    VkDeviceAddress frameConstants = 0;
    bool hasBlended = false; ///< blended surfaces may be in the picture
};

/// ShutterBlurInputs::lastColor and those with it.
struct HostLastFrame {
    HostImage color;
    HostImage motionDepth;
    HostImage entityId;
};

/// The first format listed for each image is native: images of another format, or that are part of
/// a larger image, are copied first.
struct HostInputs {
    uint32_t width = 0;
    uint32_t height = 0;
    HostImage color;
    HostImage motionDepth; ///< null: made of `convention`
    /// Used if motionDepth.image is null. For Method::readsCamera its `cameras` and `scales`,
    /// without perPixel, are also used with motionDepth, unless rays.frameConstants is given.
    HostConvention convention;
    HostImage normal;
    HostImage entityId;
    uint32_t noEntity = 0xFFFFFFFF;
    HostImage output;
    HostTransfer transfer; ///< of `color`, last.color and `output`
    double rasterTime = 1.0;
    std::span<const math::ResponsePoint> responsePoints; ///< empty: a box, unless `response`
    /// In place of the points, a shader::ResponseTable (shutter_response_shared.h) that the host
    /// keeps itself, and HostMotion::response of it; 0: none.
    VkDeviceAddress response = 0;
    HostRays rays;           ///< for methods of RayNeed::Any, unless `reveal.record` is there
    HostReveal reveal;       ///< in place of `rays`: needs no tables and no HostDevice::rayTier
    HostSamples samples;     ///< for methods of RayNeed::Query, with settings.raysPerPixel
    int64_t frameNumber = 0; ///< for InstantNoise::PerFrame
    HostMotion motion;       ///< for Method::readsInstantMotions; its `view` for all
    HostLastFrame last;
    HostImage deformedMotion;
    HostImage lastDeformedMotion; ///< with and without `last`
    HostImage blended;            ///< counts with isOff, as `drawn` does
    HostBlended drawn;            ///< under `blended`
    BlurBudget budget;            ///< unlimited unless HostDevice::measures
    bool isOff = false;           ///< no blur: `output`, if there is one, gets a copy of `color`
    bool showsInputs = false;
    /// For tools: called within record() once the effect's passes are declared, unless `isOff`. It
    /// may declare passes that read the effect's inputs and outputs, and must not throw.
    std::function<void(graph::Graph&, const MotionBlurInputs&, const MotionBlurOutputs&)> observe;
};

/// shutterBlurGetTimeBefore().
[[nodiscard]] double timeOfFrameBefore(const HostInputs& inputs);

/// ShutterBlurReport.
struct HostReport {
    std::vector<gpu::PassTime> passes;
    double milliseconds = 0.0;
    Counters counters;
    std::string droppedQuality;
};

} // namespace shutter::motion_blur
