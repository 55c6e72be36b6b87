// SPDX-License-Identifier: MIT
// The C interface: nothing leaves it but results and sentences.
#define SHUTTER_BLUR_BUILDS
#include "modules/motion_blur/c_interface/entity_match.h"
#include "modules/motion_blur/c_interface/shutter_motion_blur.h"
#include "modules/motion_blur/c_interface/structures.h"
#include "modules/motion_blur/embedding/host_features.h"
#include "modules/motion_blur/embedding/one_thread.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace motion_blur = shutter::motion_blur;
namespace core = shutter::core;

struct ShutterBlur {
    mutable motion_blur::OneThread thread;
    std::unique_ptr<motion_blur::EmbeddedMotionBlur> effect;
    uint32_t framesInFlight = 0;
    motion_blur::InputArrays arrays;
    // Storage behind a report's pointers.
    motion_blur::HostReport report;
    std::vector<ShutterBlurPassTime> passes;
    std::vector<ShutterBlurCounter> counters;
};

namespace {

thread_local std::string tMessage;

ShutterBlurResult fail(ShutterBlurResult result, std::string_view message) noexcept {
    try {
        tMessage = message;
    } catch (...) {
        tMessage.clear(); // out of memory: an empty one needs none
    }
    return result;
}

ShutterBlurResult refuse(const core::Error& error) noexcept {
    return fail(SHUTTER_BLUR_ERROR_REFUSED, error.message);
}

ShutterBlurResult finish(const core::Status& status) noexcept {
    return status ? SHUTTER_BLUR_SUCCESS : refuse(status.error());
}

/// Runs code that may throw and converts exceptions to results for C.
template <class Call> ShutterBlurResult guard(const Call& call) noexcept {
    try {
        return call();
    } catch (const std::exception& error) {
        return fail(SHUTTER_BLUR_ERROR_FAILED, error.what());
    } catch (...) {
        return fail(SHUTTER_BLUR_ERROR_FAILED, "motion blur: failed");
    }
}

/// The same for a call of an object, which one thread at a time may be in.
template <class Object, class Call> ShutterBlurResult use(Object* blur, const Call& call) noexcept {
    return guard([&] {
        if (!blur)
            return refuse({"motion blur: blur is null"});
        const motion_blur::OneThread::Call inside(blur->thread);
        const core::Status alone = inside.status();
        return alone ? call() : refuse(alone.error());
    });
}

/// The frame was not recorded: the next one has none before it.
ShutterBlurResult refuseFrame(ShutterBlur& blur, const core::Error& error) {
    for (uint32_t view = 0; view < blur.framesInFlight; ++view)
        (void)blur.effect->closeView(view);
    return refuse(error);
}

} // namespace

uint32_t shutterBlurGetVersion(void) {
    return SHUTTER_BLUR_VERSION;
}

VkBool32 shutterBlurIsCompatible(uint32_t headerVersion) {
    return motion_blur::checkVersion(headerVersion) ? VK_TRUE : VK_FALSE;
}

const char* shutterBlurGetMessage(void) {
    return tMessage.c_str();
}

ShutterBlurResult shutterBlurAddFeatures(VkPhysicalDeviceFeatures2* features) {
    return guard([&] {
        if (!features)
            return refuse({"motion blur: features is null"});
        return finish(motion_blur::addHostFeatures(*features));
    });
}

ShutterBlurResult shutterBlurCheckDevice(VkPhysicalDevice physical, uint32_t queueFamily) {
    return guard([&] {
        if (!physical)
            return refuse({"motion blur: physical is null"});
        return finish(motion_blur::checkHostDevice(physical, queueFamily));
    });
}

ShutterBlurResult shutterBlurMatchEntities(
    const ShutterBlurEntity* before,
    uint32_t beforeCount,
    const ShutterBlurEntity* now,
    uint32_t nowCount,
    double reach,
    uint32_t* indexBefore
) {
    return guard([&] {
        if ((beforeCount > 0 && !before) || (nowCount > 0 && (!now || !indexBefore)))
            return refuse({"motion blur: a list of entities is null, its length is not 0"});
        if (!(reach >= 0.0))
            return refuse({"motion blur: reach is not 0 or more"});
        const std::vector<uint32_t> found =
            motion_blur::matchEntities({before, beforeCount}, {now, nowCount}, reach);
        std::copy(found.begin(), found.end(), indexBefore);
        return SHUTTER_BLUR_SUCCESS;
    });
}

ShutterBlurResult shutterBlurCreate(const ShutterBlurDevice* device, ShutterBlur** blur) {
    return guard([&] {
        if (!blur)
            return refuse({"motion blur: blur is null"});
        *blur = nullptr;
        const auto host = motion_blur::convert(device);
        if (!host)
            return refuse(host.error());
        auto effect = motion_blur::EmbeddedMotionBlur::create(host.value());
        if (!effect)
            return refuse(effect.error());
        auto made = std::make_unique<ShutterBlur>();
        made->effect = std::move(effect).value();
        made->framesInFlight = host.value().framesInFlight;
        *blur = made.release();
        return SHUTTER_BLUR_SUCCESS;
    });
}

void shutterBlurDestroy(ShutterBlur* blur) {
    if (!blur)
        return;
    {
        const motion_blur::OneThread::Call inside(blur->thread); // for messages during destruction
        blur->effect.reset();
    }
    delete blur;
}

const char* shutterBlurGetMethod(uint32_t index) {
    for (const motion_blur::Method* method : motion_blur::listMethods())
        if (motion_blur::isForHosts(*method) && index-- == 0)
            return method->name;
    return nullptr;
}

ShutterBlurResult shutterBlurRecord(
    ShutterBlur* blur,
    VkCommandBuffer commands,
    uint32_t frame,
    const ShutterBlurInputs* inputs,
    const ShutterBlurSettings* settings
) {
    return use(blur, [&] {
        const auto wanted = motion_blur::convert(settings);
        if (!wanted)
            return refuseFrame(*blur, wanted.error());
        auto given = motion_blur::convert(inputs, blur->arrays);
        if (!given)
            return refuseFrame(*blur, given.error());
        given.value().isOff = wanted.value().isOff;
        const core::Status done =
            blur->effect->record(commands, frame, given.value(), wanted.value().settings);
        if (!done && blur->effect->hasLeftAPart())
            return fail(SHUTTER_BLUR_ERROR_FAILED, done.error().message);
        return finish(done);
    });
}

ShutterBlurResult shutterBlurMarkDone(ShutterBlur* blur, uint32_t frame) {
    return use(blur, [&] { return finish(blur->effect->markDone(frame)); });
}

ShutterBlurResult shutterBlurCloseView(ShutterBlur* blur, uint32_t view) {
    return use(blur, [&] { return finish(blur->effect->closeView(view)); });
}

ShutterBlurResult shutterBlurDump(ShutterBlur* blur, const char* folder, uint32_t frames) {
    return use(blur, [&] {
        if (!folder)
            return refuse({"motion blur: folder is null"});
        return finish(blur->effect->dump(folder, frames));
    });
}

ShutterBlurResult shutterBlurGetMemory(const ShutterBlur* blur, ShutterBlurMemory* memory) {
    return use(blur, [&] {
        const ShutterBlurMemory none = shutterBlurDefaultMemory();
        auto taken = motion_blur::takeStructure<ShutterBlurMemory>("memory", memory, none);
        if (!taken)
            return refuse(taken.error());
        taken.value().blockCount = blur->effect->living().memoryBlocks;
        taken.value().bytes = blur->effect->living().memoryBytes;
        std::memcpy(memory, &taken.value(), memory->structBytes);
        return SHUTTER_BLUR_SUCCESS;
    });
}

ShutterBlurResult
shutterBlurGetReport(ShutterBlur* blur, uint32_t frame, ShutterBlurReport* report) {
    return use(blur, [&] {
        auto taken = motion_blur::takeStructure<ShutterBlurReport>(
            "report", report, shutterBlurDefaultReport()
        );
        if (!taken)
            return refuse(taken.error());
        auto found = blur->effect->report(frame);
        if (!found)
            return refuse(found.error());
        blur->report = std::move(found).value();
        blur->passes.clear();
        for (const auto& pass : blur->report.passes)
            blur->passes.push_back({pass.name.c_str(), pass.gpuMilliseconds, pass.cpuMilliseconds});
        blur->counters.clear();
        for (const auto& [name, value] : blur->report.counters)
            blur->counters.push_back({name.c_str(), value});
        ShutterBlurReport& reported = taken.value();
        reported.passCount = static_cast<uint32_t>(blur->passes.size());
        reported.passes = blur->passes.data();
        reported.counterCount = static_cast<uint32_t>(blur->counters.size());
        reported.counters = blur->counters.data();
        reported.gpuMilliseconds = blur->report.milliseconds;
        reported.droppedQuality = blur->report.droppedQuality.c_str();
        std::memcpy(report, &reported, report->structBytes);
        return SHUTTER_BLUR_SUCCESS;
    });
}

ShutterBlurResult shutterBlurEstimateMemory(
    const ShutterBlurDevice* device, const ShutterBlurPlan* plan, uint64_t* bytes
) {
    return guard([&] {
        if (!bytes)
            return refuse({"motion blur: bytes is null"});
        const auto host = motion_blur::convert(device);
        if (!host)
            return refuse(host.error());
        const auto wanted = motion_blur::convert(plan);
        if (!wanted)
            return refuse(wanted.error());
        const auto needed =
            motion_blur::EmbeddedMotionBlur::estimateMemory(host.value(), wanted.value());
        if (!needed)
            return refuse(needed.error());
        *bytes = needed.value();
        return SHUTTER_BLUR_SUCCESS;
    });
}

ShutterBlurResult shutterBlurWarmUp(ShutterBlur* blur, const ShutterBlurPlan* plan) {
    return use(blur, [&] {
        const auto wanted = motion_blur::convert(plan);
        return wanted ? finish(blur->effect->warmUp(wanted.value())) : refuse(wanted.error());
    });
}

ShutterBlurResult shutterBlurStartWarmUp(ShutterBlur* blur, const ShutterBlurPlan* plan) {
    return use(blur, [&] {
        const auto wanted = motion_blur::convert(plan);
        return wanted ? finish(blur->effect->startWarmUp(wanted.value())) : refuse(wanted.error());
    });
}

ShutterBlurResult shutterBlurIsWarm(ShutterBlur* blur, VkBool32* isWarm) {
    return use(blur, [&] {
        if (!isWarm)
            return refuse({"motion blur: isWarm is null"});
        const auto known = blur->effect->isWarm();
        if (!known)
            return refuse(known.error());
        *isWarm = known.value() ? VK_TRUE : VK_FALSE;
        return SHUTTER_BLUR_SUCCESS;
    });
}
