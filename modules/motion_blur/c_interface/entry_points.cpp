// SPDX-License-Identifier: MIT
// The C interface: nothing leaves it but results and sentences.
#define SHUTTER_BLUR_BUILDS
#include "modules/motion_blur/c_interface/shutter_motion_blur.h"
#include "modules/motion_blur/c_interface/structures.h"
#include "modules/motion_blur/embedding/host_features.h"

#include <exception>
#include <memory>
#include <string>
#include <utility>

namespace motion_blur = shutter::motion_blur;
namespace core = shutter::core;

struct ShutterBlur {
    std::unique_ptr<motion_blur::EmbeddedMotionBlur> effect;
    uint32_t framesInFlight = 0;
    motion_blur::InputArrays arrays;
};

static_assert(SHUTTER_BLUR_VERSION == motion_blur::kHeaderVersion, "C and C++ have one version");

namespace {

thread_local std::string tMessage;

ShutterBlurResult fail(ShutterBlurResult result, const char* message) noexcept {
    try {
        tMessage = message;
    } catch (...) {
        tMessage.clear(); // out of memory: an empty one needs none
    }
    return result;
}

ShutterBlurResult refuse(const core::Error& error) noexcept {
    return fail(SHUTTER_BLUR_ERROR_REFUSED, error.message.c_str());
}

ShutterBlurResult finish(const core::Status& status) noexcept {
    return status ? SHUTTER_BLUR_SUCCESS : refuse(status.error());
}

/// Runs what may throw: C has no word for it.
template <class Call> ShutterBlurResult guard(const Call& call) noexcept {
    try {
        return call();
    } catch (const std::exception& error) {
        return fail(SHUTTER_BLUR_ERROR_FAILED, error.what());
    } catch (...) {
        return fail(SHUTTER_BLUR_ERROR_FAILED, "motion blur: failed");
    }
}

core::Status checkNumber(const char* name, uint32_t number, uint32_t count) {
    if (number < count)
        return {};
    return core::makeError("motion blur: {} is {}, framesInFlight {}", name, number, count);
}

/// The frame was not recorded: the next one has none before it.
ShutterBlurResult refuseFrame(ShutterBlur& blur, const core::Error& error) {
    for (uint32_t view = 0; view < blur.framesInFlight; ++view)
        blur.effect->closeView(view);
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
        return finish(
            motion_blur::checkHostDevice(physical, queueFamily, shutter::gpu::RayTier::None)
        );
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
    return guard([&] {
        if (!blur)
            return refuse({"motion blur: blur is null"});
        const auto wanted = motion_blur::convert(settings);
        if (!wanted)
            return refuseFrame(*blur, wanted.error());
        const auto given = motion_blur::convert(inputs, blur->arrays);
        if (!given)
            return refuseFrame(*blur, given.error());
        const core::Status done =
            blur->effect->record(commands, frame, given.value(), wanted.value());
        if (!done && blur->effect->hasLeftAPart())
            return fail(SHUTTER_BLUR_ERROR_FAILED, done.error().message.c_str());
        return finish(done);
    });
}

ShutterBlurResult shutterBlurMarkDone(ShutterBlur* blur, uint32_t frame) {
    return guard([&] {
        if (!blur)
            return refuse({"motion blur: blur is null"});
        if (const core::Status valid = checkNumber("frame", frame, blur->framesInFlight); !valid)
            return refuse(valid.error());
        blur->effect->markDone(frame);
        return SHUTTER_BLUR_SUCCESS;
    });
}

ShutterBlurResult shutterBlurCloseView(ShutterBlur* blur, uint32_t view) {
    return guard([&] {
        if (!blur)
            return refuse({"motion blur: blur is null"});
        if (const core::Status valid = checkNumber("view", view, blur->framesInFlight); !valid)
            return refuse(valid.error());
        blur->effect->closeView(view);
        return SHUTTER_BLUR_SUCCESS;
    });
}

ShutterBlurResult shutterBlurGetMemory(const ShutterBlur* blur, ShutterBlurMemory* memory) {
    return guard([&] {
        if (!blur)
            return refuse({"motion blur: blur is null"});
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
