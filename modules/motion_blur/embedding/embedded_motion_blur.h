// SPDX-License-Identifier: MIT
// The motion blur for an engine that has nothing of this one: made from raw Vulkan handles,
// recorded into the host's own command buffers, from the host's G-buffer into an image of the host.
// The same effect as the plugin's, on a graph of its own that imports those images.
//
// Conventions are those of motion_blur.h. Nothing here throws. Not thread-safe.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "modules/motion_blur/embedding/host_convention.h"
#include "modules/motion_blur/embedding/host_features.h"
#include "modules/motion_blur/embedding/host_image.h"
#include "modules/motion_blur/embedding/host_motion.h"
#include "modules/motion_blur/embedding/host_preparation.h"
#include "modules/motion_blur/embedding/version.h"
#include "modules/motion_blur/motion_blur.h"
#include "modules/motion_blur/own_reveal.h"

#include <cstdint>
#include <memory>
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

/// The first format of each image is its own: what has another one, or is part of a larger image,
/// is copied first.
struct HostInputs {
    uint32_t width = 0; ///< of the picture, pixels, [1, 32768]
    uint32_t height = 0;
    /// RGBA16F, RGBA32F or B10G11R11; sampled. Of the own format and size: transfer source, too; in
    /// place: storage, too.
    HostImage color;
    /// RGBA32F: motion.xy, depth; every value finite; sampled. Null: made of `convention`.
    HostImage motionDepth;
    HostConvention convention; ///< where motionDepth.image is null
    HostImage normal;          ///< RGBA16F, RGBA32F: xyz unit; sampled; for Method::readsNormal
    /// R32_UINT, R16_UINT or R8_UINT, any resolution; sampled; for Method::readsEntityId
    HostImage entityId;
    uint32_t noEntity = 0xFFFFFFFF; ///< value of entityId where nothing is
    /// RGBA16F, RGBA32F or B10G11R11; storage; of the own format and size: transfer target, too.
    /// Null: in place, the blurred picture replaces `color`.
    HostImage output;
    double rasterTime = 1.0;      ///< s of the raster instant: 0 start, 0.5 centre, 1 end
    VkDeviceAddress response = 0; ///< shader::ResponseTable (shutter_response_shared.h); 0: box
    HostRays rays;                ///< for methods of RayNeed::Any, unless `reveal.record` is there
    OwnReveal reveal;        ///< in place of `rays`: needs no tables and no HostDevice::rayTier
    int64_t frameNumber = 0; ///< for InstantNoise::Turning; the next frame has the next number
    HostMotion motion;       ///< for Method::readsInstantMotions; its `view` for all
};

class EmbeddedMotionBlur {
  public:
    /// Errors: a null handle, something of HostFeatures that the device cannot do, a device that
    /// is out of memory, a library of another version than the host's headers.
    [[nodiscard]] static core::Result<std::unique_ptr<EmbeddedMotionBlur>>
    create(const HostDevice& host, uint32_t headerVersion = kHeaderVersion);

    /// The GPU must be done with all that was recorded.
    ~EmbeddedMotionBlur();
    EmbeddedMotionBlur(const EmbeddedMotionBlur&) = delete;
    EmbeddedMotionBlur& operator=(const EmbeddedMotionBlur&) = delete;

    /// Records the effect into `commands`: a command buffer that is being recorded, outside of
    /// rendering, submitted once at most. It binds pipelines, set 0 (and 1) and push constants of
    /// the compute and ray-tracing bind points.
    /// \param frame of [0, framesInFlight). The GPU must be done with what was recorded last under
    /// this number: then the host has waited for it, or never submits it.
    /// Errors name what is wrong, and nothing was recorded; an error that tells of memory or the
    /// device may leave a part, and the command buffer must be reset then.
    /// Methods that read no raster image, or need timed rays, are refused. After an error, the next
    /// frame of the view has none before it, whatever HostMotion::followsLast says.
    [[nodiscard]] core::Status record(
        VkCommandBuffer commands,
        uint32_t frame,
        const HostInputs& inputs,
        const MotionBlurSettings& settings
    );

    /// Whether the last record() that returned an error left a part of its commands behind.
    [[nodiscard]] bool hasLeftAPart() const { return mHasLeftAPart; }

    /// Tells the same of `frame` as recording it anew. To be called for a number that will not be
    /// recorded again (a view was closed, fewer frames are in flight): what was retired after it,
    /// by any frame, is kept until then. Also for a host that wants memory back early: what
    /// resizing left over is destroyed once every frame recorded until then is done. CHECKed.
    void markDone(uint32_t frame);

    /// The view was closed: what is kept of its last raster is destroyed once the frames that may
    /// use it are done. Its number may be used anew. CHECKed: below framesInFlight.
    void closeView(uint32_t view);

    /// Device memory, images and the like that are held now.
    [[nodiscard]] const gpu::LivingObjects& living() const { return mDevice->living(); }

  private:
    struct Slot;
    struct View;
    struct Frame;

    EmbeddedMotionBlur(std::unique_ptr<gpu::Device> device, const HostDevice& host);
    [[nodiscard]] core::Status
    check(const HostImage& image, const HostImageRule& rule, VkExtent2D picture) const;
    [[nodiscard]] core::Status checkMadeMotion(const HostInputs& inputs) const;
    [[nodiscard]] core::Status check(
        VkCommandBuffer commands,
        uint32_t frame,
        const HostInputs& inputs,
        const MotionBlurSettings& settings
    ) const;
    [[nodiscard]] core::Status
    checkMethod(const HostInputs& inputs, const MotionBlurSettings& settings) const;
    core::Status checkAndRecord(
        VkCommandBuffer commands,
        uint32_t frame,
        const HostInputs& inputs,
        const MotionBlurSettings& settings
    );
    core::Status recordInto(
        Slot& slot,
        VkCommandBuffer commands,
        const HostInputs& inputs,
        const MotionBlurSettings& settings
    );
    /// Imports the images, and declares what makes the effect's inputs of them.
    [[nodiscard]] MotionBlurInputs prepare(Frame& frame) const;
    void deliver(Frame& frame, graph::ImageHandle picture) const;
    [[nodiscard]] InstantMotions describeInstants(
        Slot& slot, View& view, const HostInputs& inputs, const MotionBlurSettings& settings
    );

    std::unique_ptr<gpu::Device> mDevice; // before all that is made from it
    bool mHasRays;
    bool mHasLeftAPart = false;
    MotionBlur mEffect;
    HostPreparation mPreparation;
    std::vector<std::unique_ptr<Slot>> mSlots; ///< one a frame in flight
    std::vector<std::unique_ptr<View>> mViews; ///< as many: frames in flight include views
};

} // namespace shutter::motion_blur
