// SPDX-License-Identifier: MIT
// The motion blur for an engine that has nothing of this one: made from raw Vulkan handles,
// recorded into the host's own command buffers, from the host's G-buffer into an image of the host.
// The same effect as the plugin's, on a graph of its own that imports those images.
//
// Conventions are those of frame_io.h. Nothing here throws. One thread at a time may use an
// object: a call of another one, or from within a callback, is refused, except for living() and the
// destructor.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "modules/motion_blur/embedding/host_features.h"
#include "modules/motion_blur/embedding/host_input_check.h"
#include "modules/motion_blur/embedding/host_inputs.h"
#include "modules/motion_blur/embedding/host_plan.h"
#include "modules/motion_blur/embedding/host_preparation.h"
#include "modules/motion_blur/embedding/one_thread.h"
#include "modules/motion_blur/embedding/version.h"
#include "modules/motion_blur/motion_blur.h"

#include <cstdint>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <vector>

namespace shutter::motion_blur {

class HostChecker;
class HostDump;
class HostOverlay;
class HostUnsaid;

class EmbeddedMotionBlur {
  public:
    /// Errors: a null handle, something of HostFeatures that the device cannot do, a device that
    /// is out of memory, a library of another version than the host's headers.
    [[nodiscard]] static core::Result<std::unique_ptr<EmbeddedMotionBlur>>
    create(const HostDevice& host, uint32_t headerVersion = kHeaderVersion);

    /// Device memory, bytes, that an effect made for `host` will hold once it has recorded the plan
    /// under each of its numbers: within a tenth of what living() tells then. Allocates a few
    /// kilobytes for the time of the call. Errors: those of create(), a plan that cannot be
    /// recorded.
    [[nodiscard]] static core::Result<uint64_t>
    estimateMemory(const HostDevice& host, const HostPlan& plan);

    /// The GPU must be done with all that was recorded.
    ~EmbeddedMotionBlur();
    EmbeddedMotionBlur(const EmbeddedMotionBlur&) = delete;
    EmbeddedMotionBlur& operator=(const EmbeddedMotionBlur&) = delete;

    /// Records the effect into `commands`: a command buffer that is being recorded, outside of
    /// rendering, submitted once at most. It binds pipelines, set 0 (and 1) and push constants of
    /// the compute and ray-tracing bind points.
    /// \param frame of [0, framesInFlight). The GPU must be done with what was recorded last under
    /// this number, and the host has waited for it; markDone() tells of one that is never
    /// submitted. Refused while the GPU has not run it. Errors name what is wrong, and nothing was
    /// recorded; an error that tells of memory or the device may leave a part, and the command
    /// buffer must be reset then. Methods that read no raster image, or need timed rays, are
    /// refused. Without a method, `resolved` draws or, where HostMotion::keys is empty, `gather`,
    /// which HostDevice::message tells once. After an error, the next frame of the view has none
    /// before it, whatever HostMotion::followsLast says.
    [[nodiscard]] core::Status record(
        VkCommandBuffer commands,
        uint32_t frame,
        const HostInputs& inputs,
        const MotionBlurSettings& settings
    );

    /// Makes the pipelines that recording the plan needs, so that record() makes none: tens to
    /// hundreds of milliseconds without a pipeline cache. Not those of rays through HostRays.
    core::Status warmUp(const HostPlan& plan);
    /// The same on a thread of its own, the only one that the effect ever starts. The device must
    /// be there until isWarm() says so, or the effect is destroyed, which waits for the thread.
    core::Status startWarmUp(const HostPlan& plan);
    /// Whether what startWarmUp() began is done. The call that finds it done takes a few
    /// milliseconds: it takes the pipelines over from the cache. True: nothing was begun.
    [[nodiscard]] core::Result<bool> isWarm();

    /// Times and counters of what was recorded last under the number. With HostDevice::measures.
    /// Error: the GPU has not run it.
    [[nodiscard]] core::Result<HostReport> report(uint32_t frame) const;

    /// Whether the last record() that returned an error left a part of its commands behind.
    [[nodiscard]] bool hasLeftAPart() const { return mHasLeftAPart; }

    /// The GPU is done with `frame`, or will never see it. To be called for a recording that was
    /// dropped, and for a number that will not be recorded again (a view was closed, fewer frames
    /// are in flight): what was retired after it, by any frame, is kept until then. Also for a host
    /// that wants memory back early: what resizing left over is destroyed once every frame recorded
    /// until then is done. Error: there is no such number.
    core::Status markDone(uint32_t frame);

    /// The view was closed: what is kept of its last raster is destroyed once the frames that may
    /// use it are done. Its number may be used anew. Error: it is not below framesInFlight.
    core::Status closeView(uint32_t view);

    /// Writes the inputs, settings and pictures of the next `frames` recordings to a folder, for
    /// `shutter replay`: each once its frame is done (markDone, recording its number anew,
    /// destruction), which then waits for the disk. The first recording of a view uses no history,
    /// so that the dump holds all that its picture depends on. What goes wrong afterwards,
    /// HostDevice::message tells, and the dump ends.
    /// \param frames [1, 9999]
    /// Error: the folder cannot be made or holds a dump, or the last one is not complete.
    [[nodiscard]] core::Status dump(const std::filesystem::path& folder, uint32_t frames);

    /// Device memory, images and the like that are held now.
    [[nodiscard]] const gpu::LivingObjects& living() const { return mDevice->living(); }

  private:
    struct Slot;
    struct View;
    struct Frame;

    EmbeddedMotionBlur(std::unique_ptr<gpu::Device> device, const HostDevice& host);
    [[nodiscard]] core::Status check(
        VkCommandBuffer commands,
        uint32_t frame,
        const HostInputs& inputs,
        const MotionBlurSettings& settings
    ) const;
    [[nodiscard]] HostAbilities abilities() const;
    core::Status checkAndRecord(
        VkCommandBuffer commands,
        uint32_t frame,
        const HostInputs& inputs,
        const MotionBlurSettings& settings
    );
    core::Status finishFrame(uint32_t frame);
    /// To the host's message, or the log.
    void warn(const std::string& sentence) const;
    /// What the budget leaves of the settings.
    [[nodiscard]] const MotionBlurSettings&
    chooseSettings(uint32_t frame, const HostInputs& inputs, const MotionBlurSettings& settings);
    core::Status record(Frame& frame, View& view, VkCommandBuffer commands);
    /// Declares the whole of a frame.
    void declare(Frame& frame, View& view);
    /// Where shaders find the shutter's response; 0: it is a box.
    [[nodiscard]] VkDeviceAddress giveResponse(Frame& frame) const;
    /// Imports the images, and declares what makes the effect's inputs of them.
    [[nodiscard]] MotionBlurInputs prepare(Frame& frame) const;
    [[nodiscard]] graph::ImageHandle prepareMotion(Frame& frame) const;
    /// The camera's part of the motion, over the exposure, whatever the vectors hold.
    [[nodiscard]] graph::ImageHandle
    prepareCameraMotion(Frame& frame, graph::ImageHandle depth) const;
    [[nodiscard]] std::optional<LentRaster> prepareLast(Frame& frame) const;
    /// Draws HostInputs::showsInputs over the picture, and returns it.
    [[nodiscard]] graph::ImageHandle
    showInputs(Frame& frame, const MotionBlurInputs& own, graph::ImageHandle picture) const;
    void deliver(Frame& frame, graph::ImageHandle picture) const;
    [[nodiscard]] InstantMotions describeInstants(Frame& frame, View& view);
    /// Whether the GPU has not run what was recorded last under the number.
    [[nodiscard]] bool isPending(uint32_t frame) const;
    [[nodiscard]] bool hasRun(uint32_t frame) const;
    void recordMark(uint32_t frame, VkCommandBuffer commands);
    core::Status recordOnce(const HostPlan& plan);
    core::Status makePipelines(const HostPlan& plan);
    [[nodiscard]] core::Result<uint64_t> estimate(const HostPlan& plan);

    mutable OneThread mThread;
    HostDevice mHost;
    std::unique_ptr<gpu::Device> mDevice; // before all that is made from it
    uint32_t mTimestampBits = 0;          ///< 0: nothing is measured
    bool mHasRays;
    bool mHasLeftAPart = false;
    bool mTellsMethod = false; ///< the host was told that its default is gather
    MotionBlur mEffect;
    HostPreparation mPreparation;
    std::unique_ptr<HostOverlay> mOverlay;
    std::unique_ptr<HostChecker> mChecker; ///< null: off
    std::unique_ptr<HostUnsaid> mUnsaid;   ///< the same
    std::unique_ptr<HostDump> mDump;       ///< null: none was wanted yet
    /// By frame in flight, the number of the last recording of it that the GPU ran.
    gpu::Buffer mMarks;
    std::vector<std::unique_ptr<Slot>> mSlots; ///< one a frame in flight
    std::vector<std::unique_ptr<View>> mViews; ///< as many: frames in flight include views
    HostPlan mWarming;
    std::future<core::Status> mWarmUp; ///< last: it is waited for before all else goes
};

} // namespace shutter::motion_blur
