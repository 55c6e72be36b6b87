// SPDX-License-Identifier: MIT
// The motion blur behind shutter_motion_blur.h: recorded into a host's command buffers, on a
// separate graph that imports the host's images. The same effect as the plugin's. Functions are
// documented there under the same names.
//
// Nothing here throws. One thread at a time may use an object: a call of another one, or from
// within a callback, is refused, except for living() and the destructor.
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
#include "modules/motion_blur/motion_blur.h"
#include "modules/motion_blur/passes/composite.h"

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
class HostUndeclared;

class EmbeddedMotionBlur {
  public:
    /// Errors: a null handle, a feature (host_features.h) that the device lacks, a device that
    /// is out of memory.
    [[nodiscard]] static core::Result<std::unique_ptr<EmbeddedMotionBlur>>
    create(const HostDevice& host);

    /// Bytes: within a tenth of what living() holds once the plan was recorded under each number.
    /// Allocates a few kilobytes for the time of the call. Errors: those of create(), a plan that
    /// cannot be recorded.
    [[nodiscard]] static core::Result<uint64_t>
    estimateMemory(const HostDevice& host, const HostPlan& plan);

    /// The GPU must have finished with all that was recorded.
    ~EmbeddedMotionBlur();
    EmbeddedMotionBlur(const EmbeddedMotionBlur&) = delete;
    EmbeddedMotionBlur& operator=(const EmbeddedMotionBlur&) = delete;

    /// It binds pipelines, set 0 (and 1) and push constants of the compute and ray-tracing bind
    /// points. Error: names the fault; nothing was recorded (see hasLeftAPart()). Methods that read
    /// no raster image, or need time-sampled rays, are errors.
    [[nodiscard]] core::Status record(
        VkCommandBuffer commands,
        uint32_t frame,
        const HostInputs& inputs,
        const MotionBlurSettings& settings
    );

    /// Not the pipelines of rays through HostRays.
    core::Status warmUp(const HostPlan& plan);
    /// The same on a background thread, the only one that the effect ever starts.
    core::Status startWarmUp(const HostPlan& plan);
    /// True: nothing was begun, or it is done.
    [[nodiscard]] core::Result<bool> isWarm();

    /// Error: the GPU has not run the last recording with that number, or measuring is off.
    [[nodiscard]] core::Result<HostReport> report(uint32_t frame) const;

    /// Whether the last record() that returned an error, of memory or the device, left a part of
    /// its commands behind: the command buffer must be reset.
    [[nodiscard]] bool hasLeftAPart() const { return mHasLeftAPart; }

    /// Error: there is no such number.
    core::Status markDone(uint32_t frame);

    /// Error: it is not below framesInFlight.
    core::Status closeView(uint32_t view);

    /// Each recording is written once its frame is complete (markDone, the next recording with its
    /// number, destruction); that call then waits for the disk.
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
    /// Returns the settings under the budget.
    [[nodiscard]] const MotionBlurSettings&
    chooseSettings(uint32_t frame, const HostInputs& inputs, const MotionBlurSettings& settings);
    core::Status record(Frame& frame, View& view, VkCommandBuffer commands);
    /// Declares the whole of a frame.
    void declare(Frame& frame, View& view);
    /// Motion of deforming entities from the host's images; empty: there are none.
    [[nodiscard]] DrawWays prepareWays(const Frame& frame) const;
    /// Where shaders find the shutter's response; 0: it is a box.
    [[nodiscard]] VkDeviceAddress giveResponse(Frame& frame) const;
    /// Imports the images, and declares what makes the effect's inputs of them.
    [[nodiscard]] MotionBlurInputs prepare(Frame& frame) const;
    [[nodiscard]] graph::ImageHandle prepareMotion(Frame& frame) const;
    /// The camera's part of the motion, over the exposure, independent of the vectors.
    [[nodiscard]] graph::ImageHandle
    prepareCameraMotion(Frame& frame, graph::ImageHandle depth) const;
    [[nodiscard]] std::optional<LentRaster> prepareLast(Frame& frame) const;
    /// Draws HostInputs::showsInputs over the picture, and returns it.
    [[nodiscard]] graph::ImageHandle
    showInputs(Frame& frame, const MotionBlurInputs& own, graph::ImageHandle picture) const;
    /// Puts HostInputs::drawn and ::blended over the picture, which is written, and returns it.
    /// \param surfaces MotionBlurOutputs::surfaces
    [[nodiscard]] graph::ImageHandle
    addBlended(Frame& frame, graph::ImageHandle picture, graph::BufferHandle surfaces);
    void deliver(Frame& frame, graph::ImageHandle picture) const;
    [[nodiscard]] InstantMotions describeInstants(Frame& frame, View& view);
    /// Whether the GPU has not yet run the last recording with that number.
    [[nodiscard]] bool isPending(uint32_t frame) const;
    [[nodiscard]] bool hasRun(uint32_t frame) const;
    void recordMark(uint32_t frame, VkCommandBuffer commands);
    core::Status recordOnce(const HostPlan& plan);
    /// Records each kind of frame of those inputs once, and drops it.
    core::Status recordAll(DryRunInputs& dryRun, const MotionBlurSettings& settings, Slot& slot);
    core::Status makePipelines(const HostPlan& plan);
    [[nodiscard]] core::Result<uint64_t> estimate(const HostPlan& plan);
    struct Transients;
    /// Adds those of a frame whose previous frame is known.
    core::Status addTransients(
        DryRunInputs& dryRun, const MotionBlurSettings& settings, Slot& slot, Transients& held
    );

    mutable OneThread mThread;
    HostDevice mHost;
    std::unique_ptr<gpu::Device> mDevice; // before all that is made from it
    uint32_t mTimestampBits = 0;          ///< 0: nothing is measured
    bool mHasRays;
    bool mHasLeftAPart = false;
    bool mReportsMethod = false; ///< the message that the default is gather was sent
    MotionBlur mEffect;
    HostPreparation mPreparation;
    Composite mComposite;
    std::unique_ptr<HostOverlay> mOverlay;
    std::unique_ptr<HostChecker> mChecker;       ///< null: off
    std::unique_ptr<HostUndeclared> mUndeclared; ///< the same
    std::unique_ptr<HostDump> mDump;             ///< null: none was wanted yet
    /// By frame in flight, the number of the last recording of it that the GPU ran.
    gpu::Buffer mMarks;
    std::vector<std::unique_ptr<Slot>> mSlots; ///< one per frame in flight
    std::vector<std::unique_ptr<View>> mViews; ///< as many: frames in flight include views
    HostPlan mWarming;
    std::future<core::Status> mWarmUp; ///< last: it is waited for before other members are
                                       ///< destroyed
};

} // namespace shutter::motion_blur
