// SPDX-License-Identifier: MIT
// What a host hands over: its device once, its images in each frame.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device_select.h"
#include "engine/gpu/frame.h"
#include "engine/graph/graph.h"
#include "engine/math/response.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/embedding/host_convention.h"
#include "modules/motion_blur/embedding/host_image.h"
#include "modules/motion_blur/embedding/host_message.h"
#include "modules/motion_blur/embedding/host_motion.h"
#include "modules/motion_blur/frame_io.h"
#include "modules/motion_blur/host_answers.h"
#include "modules/motion_blur/methods.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace shutter::motion_blur {

/// All handles stay the host's and must outlive the EmbeddedMotionBlur.
struct HostDevice {
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE; ///< made with Vulkan 1.3 and HostFeatures enabled
    uint32_t queueFamily = 0;         ///< of the command buffers; it must run compute shaders
    /// How many recordings the GPU may have before it at once: frames in flight times views, [1,
    /// 64].
    uint32_t framesInFlight = 2;
    bool hasDebugUtils = false; ///< VK_EXT_debug_utils is enabled: objects and passes get names
    /// For methods of RayNeed::Any: which rays of HostFeatures are enabled, and the layout of
    /// HostRays::scene.
    gpu::RayTier rayTier = gpu::RayTier::None;
    VkDescriptorSetLayout sceneLayout = VK_NULL_HANDLE;
    /// With RayTier::Pipeline: the feature rayTracingPipelineTraceRaysIndirect is enabled. Rays are
    /// then launched for masked pixels only, without it for every pixel of the picture.
    bool tracesIndirect = false;
    /// Where pipelines are looked up and kept, so that a host that saves it starts faster the next
    /// time; null: in one that goes with the effect. Not made to be synchronized by its users.
    VkPipelineCache pipelineCache = VK_NULL_HANDLE;
    /// VkApplicationInfo::apiVersion of the instance, to be checked; 0: not said.
    uint32_t apiVersion = 0;
    /// The chain that the device was made with, to be checked; null: not said. Read during create()
    /// only.
    const VkPhysicalDeviceFeatures2* enabledFeatures = nullptr;
    /// record() takes the GPU's times and counts, for EmbeddedMotionBlur::report() and
    /// HostInputs::budget: two timestamps a pass and a few small copies.
    bool measures = false;
    /// Compares the inputs of each recording with one another and with what they must be, and tells
    /// `message` what looks wrong (docs/debugging_integration.md). False costs nothing.
    bool checksInputs = false;
    /// Gets what the checker finds, why a dump failed, and that the effect is destroyed too early.
    HostMessage message;
};

/// What rays meet, in the terms of shaders/render/scene_shared.h: a host that wants methods of
/// RayNeed::Any fills those tables.
struct HostRays {
    /// Custom index of an instance: its mesh id. Null: nothing but sky lies behind what moves.
    VkAccelerationStructureKHR tlas = VK_NULL_HANDLE;
    VkBuffer tlasBuffer = VK_NULL_HANDLE;   ///< that it lies in; null only where tlas is
    VkDescriptorSet scene = VK_NULL_HANDLE; ///< bindless textures, of HostDevice::sceneLayout
    /// shader::FrameConstants, whose entityCount bounds the ids that are looked up.
    VkDeviceAddress frameConstants = 0;
    bool hasBlended = false; ///< blended surfaces may be in the picture
};

/// The images of the frame before, from a host that has them still: what `resolved` and `adaptive`
/// would keep a copy of otherwise. All of the formats and sizes that those of HostInputs may have,
/// except that the motion is in one image with the depth. None of them is written.
struct HostLastFrame {
    HostImage color;       ///< sharp: HostInputs::color of that frame before the blur
    HostImage motionDepth; ///< RGBA32F, of the picture's size
    /// HostInputs::noEntity is its value where nothing is; null where that frame had none.
    HostImage entityId;
};

/// The first format of each image is its own: what has another one, or is part of a larger image,
/// is copied first.
struct HostInputs {
    uint32_t width = 0; ///< of the picture, pixels, [1, 32768]
    uint32_t height = 0;
    /// RGBA16F, RGBA32F or B10G11R11; sampled; of the own format and size: transfer source, too; in
    /// place: storage, too.
    HostImage color;
    /// RGBA32F: motion.xy, depth; every value finite; sampled. Null: made of `convention`.
    HostImage motionDepth;
    /// Where motionDepth.image is null. For Method::readsCamera its `cameras` and `scales`, without
    /// perPixel, count beside motionDepth, too, unless rays.frameConstants is given.
    HostConvention convention;
    HostImage normal; ///< RGBA16F, RGBA32F: xyz unit; sampled; for Method::readsNormal
    /// R32_UINT, R16_UINT or R8_UINT, any resolution; sampled; for Method::readsEntityId. Null, for
    /// Method::readsInstantMotions without movers: all but the sky stands still in the world.
    HostImage entityId;
    uint32_t noEntity = 0xFFFFFFFF; ///< value of entityId where nothing is
    /// RGBA16F, RGBA32F or B10G11R11; storage; of the own format and size: transfer target, too.
    /// Null: in place, the blurred picture replaces `color`.
    HostImage output;
    double rasterTime = 1.0; ///< s of the raster instant: 0 start, 0.5 centre, 1 end
    /// The sensor's sensitivity over the exposure, straight between the points: 2 to 64, s rising
    /// from 0 to 1. Read within record() only. Empty: a box, unless there is `response`.
    std::span<const math::ResponsePoint> responsePoints;
    /// In place of the points, a shader::ResponseTable (shutter_response_shared.h) that the host
    /// keeps itself, and HostMotion::response of it; 0: none.
    VkDeviceAddress response = 0;
    HostRays rays;           ///< for methods of RayNeed::Any, unless `reveal.record` is there
    OwnReveal reveal;        ///< in place of `rays`: needs no tables and no HostDevice::rayTier
    OwnSamples samples;      ///< for methods of RayNeed::Query, with settings.raysPerPixel
    int64_t frameNumber = 0; ///< for InstantNoise::Turning; the next frame has the next number
    HostMotion motion;       ///< for Method::readsInstantMotions; its `view` for all
    /// For Method::readsInstantMotions with HostMotion::followsLast: null images: the effect keeps
    /// what it needs of the frame before itself.
    HostLastFrame last;
    /// What the effect may take of a frame; it gives up quality to stay within. Unlimited unless
    /// HostDevice::measures.
    BlurBudget budget;
    bool isOff = false; ///< no blur: `output`, if there is one, gets a copy of `color`
    /// For debugging: panels over the blurred picture show what the effect reads, and what of it
    /// the camera explains (docs/debugging_integration.md). Dumps are without.
    bool showsInputs = false;
    /// For tools: called within record() once the effect's passes are declared, unless `isOff`. It
    /// may declare passes that read what the effect reads and makes, and must not throw.
    std::function<void(graph::Graph&, const MotionBlurInputs&, const MotionBlurOutputs&)> observe;
};

/// Shutter time of the frame before's raster, for HostCameraKey::time: exposures lie
/// 1 / exposureShare apart, of generated frames displayedPerRendered times as much. Below 0 where
/// the exposure is shorter than the time between the frames and rasterTime is 1. An exposureShare
/// below 1e-4 counts as that.
[[nodiscard]] double timeOfFrameBefore(const HostInputs& inputs);

/// What the GPU took for a recording, and what it counted.
struct HostReport {
    std::vector<gpu::PassTime> passes; ///< in the order in which they ran
    double milliseconds = 0.0;         ///< of all passes together, on the GPU
    Counters counters;  ///< "pixels masked", "rays traced", "unresolved samples" and the like
    std::string gaveUp; ///< to stay within HostInputs::budget; empty: nothing
};

} // namespace shutter::motion_blur
