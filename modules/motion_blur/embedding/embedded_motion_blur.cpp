// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/embedded_motion_blur.h"

#include "engine/core/log.h"
#include "engine/gpu/vulkan.h"
#include "modules/motion_blur/embedding/check/checker.h"
#include "modules/motion_blur/embedding/embedded_parts.h"
#include "modules/motion_blur/embedding/host_dump.h"
#include "modules/motion_blur/embedding/host_keys.h"
#include "modules/motion_blur/embedding/host_overlay.h"

#include <fmt/format.h>

#include <array>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace shutter::motion_blur {

namespace {

using core::makeError;

constexpr uint32_t kMaxFrames = kMaxSlots;

uint32_t findTimestampBits(VkPhysicalDevice device, uint32_t queueFamily) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    return families[queueFamily].timestampValidBits;
}

core::Status checkHost(const HostDevice& host) {
    if (!host.physical || !host.device)
        return makeError(
            "motion blur: ShutterBlurDevice::{} is null", host.physical ? "device" : "physical"
        );
    if (host.framesInFlight < 1 || host.framesInFlight > kMaxFrames)
        return makeError(
            "motion blur: framesInFlight is {}, it must be 1 to {}", host.framesInFlight, kMaxFrames
        );
    if (host.apiVersion != 0 && host.apiVersion < VK_API_VERSION_1_3)
        return makeError(
            "motion blur: apiVersion is {}.{}, the instance must be made for Vulkan 1.3",
            VK_API_VERSION_MAJOR(host.apiVersion),
            VK_API_VERSION_MINOR(host.apiVersion)
        );
    if (host.rayTier != gpu::RayTier::None && !host.sceneLayout)
        return makeError("motion blur: sceneLayout is null, although rayTier requires rays");
    if (host.enabledFeatures)
        SHUTTER_TRY(checkEnabledFeatures(*host.enabledFeatures));
    SHUTTER_TRY(checkHostDevice(host.physical, host.queueFamily));
    if (host.measures && findTimestampBits(host.physical, host.queueFamily) == 0)
        return makeError(
            "motion blur: measures is true, but queueFamily {} takes no timestamps",
            host.queueFamily
        );
    return {};
}

} // namespace

core::Result<std::unique_ptr<EmbeddedMotionBlur>> EmbeddedMotionBlur::create(const HostDevice& host
) {
    const core::Status able = checkHost(host);
    if (!able)
        return able.error();
    try {
        auto device = gpu::Device::adopt(
            {.physical = host.physical,
             .device = host.device,
             .rayTier = host.rayTier,
             .tracesIndirect = host.tracesIndirect,
             .hasDebugUtils = host.hasDebugUtils,
             .controlsSubgroupSize =
                 host.enabledFeatures && enablesSubgroupSizes(*host.enabledFeatures),
             .pipelineCache = host.pipelineCache}
        );
        if (!device)
            return device.error();
        return std::unique_ptr<EmbeddedMotionBlur>(
            new EmbeddedMotionBlur(std::move(device).value(), host)
        );
    } catch (const gpu::DeviceError& error) {
        return core::Error{error.what()};
    } catch (const std::bad_alloc&) {
        return makeError("motion blur: out of main memory");
    }
}

EmbeddedMotionBlur::EmbeddedMotionBlur(std::unique_ptr<gpu::Device> device, const HostDevice& host)
    : mHost(host), mDevice(std::move(device)),
      mTimestampBits(host.measures ? findTimestampBits(host.physical, host.queueFamily) : 0),
      mHasRays(host.rayTier != gpu::RayTier::None),
      mEffect(*mDevice, mHasRays ? host.sceneLayout : VK_NULL_HANDLE), mPreparation(*mDevice),
      mComposite(*mDevice), mOverlay(std::make_unique<HostOverlay>(*mDevice)),
      mMarks(
          *mDevice, "marks", host.framesInFlight * sizeof(uint32_t), 0, gpu::MemoryUse::Readback
      ) {
    mHost.enabledFeatures = nullptr; // the host may take it back now
    mMarks.writeZeros();
    for (uint32_t i = 0; i < host.framesInFlight; ++i) {
        mSlots.push_back(std::make_unique<Slot>(*mDevice, mTimestampBits));
        mViews.push_back(std::make_unique<View>(*mDevice));
    }
    if (!host.checksInputs)
        return;
    mChecker = std::make_unique<HostChecker>(*mDevice, host.framesInFlight, host.message);
    mUndeclared = std::make_unique<HostUndeclared>(host.device);
}

void EmbeddedMotionBlur::warn(const std::string& sentence) const {
    if (mHost.message)
        mHost.message(sentence);
    else
        core::logWarning("{}", sentence);
}

EmbeddedMotionBlur::~EmbeddedMotionBlur() {
    const OneThread::Call call(mThread); // callbacks must not call back into this object
    for (uint32_t frame = 0; frame < mSlots.size(); ++frame)
        if (isPending(frame))
            warn(fmt::format(
                "motion blur: destroyed while frame {} is pending on the GPU; if it was never "
                "submitted, shutterBlurMarkDone must say so",
                frame
            ));
    if (mChecker)
        mChecker->finishAll();
    if (mDump)
        mDump->finishAll();
}

core::Status EmbeddedMotionBlur::dump(const std::filesystem::path& folder, uint32_t frames) {
    const OneThread::Call call(mThread);
    SHUTTER_TRY(call.status());
    if (!mDump)
        mDump = std::make_unique<HostDump>(*mDevice, uint32_t(mSlots.size()), mHost.message);
    return mDump->start(folder, frames);
}

core::Status EmbeddedMotionBlur::record(
    VkCommandBuffer commands,
    uint32_t frame,
    const HostInputs& inputs,
    const MotionBlurSettings& settings
) {
    const OneThread::Call call(mThread);
    SHUTTER_TRY(call.status()); // before anything is touched
    core::Status done = checkAndRecord(commands, frame, inputs, settings);
    // The view has no such frame, or not a whole one.
    if (!done && inputs.motion.view < mViews.size())
        mViews[inputs.motion.view]->last.reset();
    return done;
}

core::Status EmbeddedMotionBlur::checkAndRecord(
    VkCommandBuffer commands,
    uint32_t frame,
    const HostInputs& given,
    const MotionBlurSettings& wanted
) {
    mHasLeftAPart = false;
    std::array<HostCameraKey, 2> keys;
    std::optional<HostInputs> changed;
    if (isJump(given.convention.cameras))
        changed.emplace(given).convention.scales.isCut = true;
    if (derivesKeys(given, wanted)) {
        if (!changed)
            changed.emplace(given);
        keys = deriveKeys(*changed);
        changed->motion.keys = keys;
    }
    const HostInputs& inputs = changed ? *changed : given;
    const bool knowsMotions = !inputs.motion.keys.empty();
    const MotionBlurSettings settings = complete(wanted, knowsMotions);
    try {
        SHUTTER_TRY(check(commands, frame, inputs, settings));
        if (mUndeclared)
            mUndeclared->report(inputs, mHost.message); // before the driver meets the images
        SHUTTER_TRY(finishFrame(frame));
        mHasLeftAPart = true;
        if (!wanted.method && !knowsMotions && !inputs.isOff &&
            !std::exchange(mReportsMethod, true))
            warn(fmt::format(
                "motion blur: {}, so the default method is gather in place of resolved",
                describeMissingKeys(inputs)
            ));
        Slot& slot = *mSlots[frame];
        const MotionBlurSettings chosen = chooseSettings(frame, inputs, settings);
        graph::Graph graph;
        Frame recording{frame, slot, graph, inputs, chosen, mTimestampBits > 0};
        recording.isHosts = true;
        const core::Status done = record(recording, *mViews[inputs.motion.view], commands);
        if (!done) {
            slot.level.reset();
            if (mChecker)
                mChecker->drop(frame);
            if (mDump)
                mDump->drop(frame);
            return done;
        }
        slot.counts = recording.wantsCounters && !inputs.isOff;
        recordMark(frame, commands);
        slot.handedOver = mDevice->handOver();
        mHasLeftAPart = false;
        return {};
    } catch (const gpu::DeviceError& error) {
        return core::Error{error.what()};
    } catch (const std::bad_alloc&) {
        return makeError("motion blur: out of main memory");
    }
}

core::Status EmbeddedMotionBlur::markDone(uint32_t frame) {
    const OneThread::Call call(mThread);
    SHUTTER_TRY(call.status());
    return finishFrame(frame);
}

core::Status EmbeddedMotionBlur::finishFrame(uint32_t frame) {
    if (frame >= mSlots.size())
        return makeError("motion blur: frame is {}, framesInFlight {}", frame, mSlots.size());
    if (mChecker)
        mChecker->finish(frame);
    if (mDump)
        mDump->finish(frame);
    mDevice->markDone(mSlots[frame]->handedOver);
    mSlots[frame]->isCompletionKnown = true;
    return {};
}

core::Status EmbeddedMotionBlur::closeView(uint32_t view) {
    const OneThread::Call call(mThread);
    SHUTTER_TRY(call.status());
    if (view >= mViews.size())
        return makeError("motion blur: view is {}, framesInFlight {}", view, mViews.size());
    mViews[view]->forget();
    if (mChecker)
        mChecker->forget(view);
    return {};
}

bool EmbeddedMotionBlur::hasRun(uint32_t frame) const {
    const Slot& slot = *mSlots[frame];
    return slot.recordings > 0 &&
           static_cast<const uint32_t*>(mMarks.mapped())[frame] == slot.recordings;
}

bool EmbeddedMotionBlur::isPending(uint32_t frame) const {
    return !mSlots[frame]->isCompletionKnown && !hasRun(frame);
}

void EmbeddedMotionBlur::recordMark(uint32_t frame, VkCommandBuffer commands) {
    Slot& slot = *mSlots[frame];
    slot.isCompletionKnown = false;
    constexpr VkDeviceSize kBytes = sizeof(uint32_t);
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    // After all that was recorded: the host's stages behind the images may be others than this
    // one's.
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    vkCmdPipelineBarrier2(commands, &dependency);
    vkCmdFillBuffer(commands, mMarks.handle(), frame * kBytes, kBytes, ++slot.recordings);
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
    vkCmdPipelineBarrier2(commands, &dependency);
}

HostAbilities EmbeddedMotionBlur::abilities() const {
    return {
        {mHost.physical, mHost.device, mDevice->limits().maxImageDimension2D},
        mHasRays,
        mTimestampBits > 0,
        mHost.framesInFlight,
        mDevice->limits().maxStorageBufferRange};
}

core::Status EmbeddedMotionBlur::check(
    VkCommandBuffer commands,
    uint32_t frame,
    const HostInputs& inputs,
    const MotionBlurSettings& settings
) const {
    if (!commands)
        return makeError("motion blur: the command buffer is null");
    if (frame >= mSlots.size())
        return makeError("motion blur: frame is {}, framesInFlight {}", frame, mSlots.size());
    if (isPending(frame))
        return makeError(
            "motion blur: frame {} was recorded before, and the GPU has not run that: wait for it, "
            "give each view of a frame a number of its own, or call shutterBlurMarkDone if it is "
            "never "
            "submitted",
            frame
        );
    return checkInputs(inputs, settings, abilities());
}

const MotionBlurSettings& EmbeddedMotionBlur::chooseSettings(
    uint32_t frame, const HostInputs& inputs, const MotionBlurSettings& settings
) {
    const uint32_t number = inputs.motion.view;
    View& view = *mViews[number];
    Slot& slot = *mSlots[frame];
    slot.droppedQuality.clear();
    const bool isNew = !view.budget || view.wanted != settings ||
                       view.budget->budget().milliseconds != inputs.budget.milliseconds;
    // Before the slot is recorded again: its times are still those of the last recording.
    for (uint32_t i = 0; i < mSlots.size(); ++i) {
        Slot& done = *mSlots[i];
        if (!done.level || done.view != number || !hasRun(i))
            continue;
        double milliseconds = 0.0;
        for (const gpu::PassTime& pass : done.frame->findTimes())
            milliseconds += pass.gpuMilliseconds;
        if (!isNew && milliseconds > 0.0)
            view.budget->observe(*done.level, milliseconds);
        done.level.reset();
    }
    if (inputs.isOff || inputs.budget.isUnlimited()) {
        view.budget.reset();
        return settings;
    }
    if (isNew) {
        view.budget.emplace(inputs.budget, settings);
        view.wanted = settings;
        for (const auto& other : mSlots)
            if (other->view == number)
                other->level.reset(); // of the ladder before
    }
    slot.view = number;
    slot.level = view.budget->level();
    slot.droppedQuality = view.budget->current().droppedQuality;
    return view.budget->current().settings;
}

core::Result<HostReport> EmbeddedMotionBlur::report(uint32_t frame) const {
    const OneThread::Call call(mThread);
    SHUTTER_TRY(call.status());
    if (frame >= mSlots.size())
        return makeError("motion blur: frame is {}, framesInFlight {}", frame, mSlots.size());
    if (mTimestampBits == 0)
        return makeError("motion blur: ShutterBlurDevice::measures is false, so there is no report"
        );
    if (!hasRun(frame))
        return makeError("motion blur: the GPU has not run frame {}", frame);
    const Slot& slot = *mSlots[frame];
    HostReport report;
    report.passes = slot.frame->findTimes();
    for (const gpu::PassTime& pass : report.passes)
        report.milliseconds += pass.gpuMilliseconds;
    if (slot.counts)
        report.counters = mEffect.counters(frame);
    report.droppedQuality = slot.droppedQuality;
    return report;
}

} // namespace shutter::motion_blur
