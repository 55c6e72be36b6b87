// SPDX-License-Identifier: MIT
// shutter_motion_blur.h for C++17: an object that destroys itself, structures that start with their
// defaults, and results that carry the error's sentence. Fields and calls are documented there;
// this adds none. It throws no exceptions and needs no RTTI.
//
//     auto blur = shutter::MotionBlur::create({physical, device, queueFamily, framesInFlight});
//     if (!blur)
//         log(blur.message());
#ifndef SHUTTER_MOTION_BLUR_HPP
#define SHUTTER_MOTION_BLUR_HPP

#include <shutter_motion_blur.h>

#include <cstdint>
#include <iterator>
#include <memory>
#include <string>
#include <utility>

namespace shutter {

/// Result of a call: true, or an error and the sentence that names the fault.
class [[nodiscard]] BlurStatus {
  public:
    /// Of the C call that has just returned `code` on this thread.
    explicit BlurStatus(ShutterBlurResult code)
        : mCode(code), mMessage(code == SHUTTER_BLUR_SUCCESS ? "" : shutterBlurGetMessage()) {}

    explicit operator bool() const { return mCode == SHUTTER_BLUR_SUCCESS; }

    ShutterBlurResult code() const { return mCode; }

    const std::string& message() const { return mMessage; } ///< empty: no error

  private:
    ShutterBlurResult mCode;
    std::string mMessage;
};

/// The same with a value, which after an error is as T{} makes it.
template <class T> class [[nodiscard]] BlurResult : public BlurStatus {
  public:
    BlurResult(ShutterBlurResult code, T value) : BlurStatus(code), mValue(std::move(value)) {}

    T& operator*() & { return mValue; }

    const T& operator*() const& { return mValue; }

    T&& operator*() && { return std::move(mValue); }

    T* operator->() { return &mValue; }

    const T* operator->() const { return &mValue; }

  private:
    T mValue;
};

/// Callables are stored by reference: they must outlive the object that they are passed to, and
/// must not throw. Arrays are referenced, too, and read during the call only.
namespace blur_detail {

template <class Call> void* erase(Call& call) {
    return const_cast<void*>(static_cast<const void*>(std::addressof(call)));
}

template <class Call, class Argument> void invoke(void* call, Argument argument) {
    (*static_cast<Call*>(call))(argument);
}

template <class Array, class Pointer>
void point(Array& array, Pointer& pointer, std::uint32_t& count) {
    pointer = std::data(array);
    count = static_cast<std::uint32_t>(std::size(array));
}

} // namespace blur_detail

struct BlurDevice : ShutterBlurDevice {
    BlurDevice() : ShutterBlurDevice(shutterBlurDefaultDevice()) {}

    BlurDevice(
        VkPhysicalDevice from, VkDevice vkHandle, std::uint32_t family, std::uint32_t frames = 2
    )
        : BlurDevice() {
        physical = from;
        device = vkHandle;
        queueFamily = family;
        framesInFlight = frames;
    }

    /// `call(const char* sentence)`, which must outlive the MotionBlur.
    template <class Call> void setMessage(Call& call) {
        message = blur_detail::invoke<Call, const char*>;
        messageUser = blur_detail::erase(call);
    }
};

struct BlurSettings : ShutterBlurSettings {
    /// Null: the default method.
    explicit BlurSettings(const char* named = nullptr)
        : ShutterBlurSettings(shutterBlurDefaultSettings()) {
        method = named;
    }

    /// An array of ShutterBlurValue.
    template <class Array> void setValues(Array& array) {
        blur_detail::point(array, values, valueCount);
    }
};

struct BlurUse : ShutterBlurUse {
    constexpr BlurUse(
        VkImageLayout in = VK_IMAGE_LAYOUT_UNDEFINED,
        VkPipelineStageFlags2 by = 0,
        VkAccessFlags2 doing = 0
    )
        : ShutterBlurUse{in, by, doing} {}
};

struct BlurImage : ShutterBlurImage {
    BlurImage() : ShutterBlurImage() {}

    BlurImage(VkImage vkHandle, BlurUse last, BlurUse next, VkFormat made = VK_FORMAT_UNDEFINED)
        : ShutterBlurImage() {
        image = vkHandle;
        before = last;
        after = next;
        format = made;
    }
};

struct BlurInputs : ShutterBlurInputs {
    BlurInputs() : ShutterBlurInputs(shutterBlurDefaultInputs()) {}

    BlurInputs(std::uint32_t pictureWidth, std::uint32_t pictureHeight) : BlurInputs() {
        width = pictureWidth;
        height = pictureHeight;
    }

    /// An array of ShutterBlurCameraKey.
    template <class Array> void setKeys(Array& array) { blur_detail::point(array, keys, keyCount); }

    /// An array of ShutterBlurMover.
    template <class Array> void setMovers(Array& array) {
        blur_detail::point(array, movers, moverCount);
    }

    /// An array of uint32_t.
    template <class Array> void setViewModelRows(Array& array) {
        blur_detail::point(array, viewModelRows, viewModelRowCount);
    }

    /// An array of ShutterBlurResponsePoint.
    template <class Array> void setResponse(Array& array) {
        blur_detail::point(array, responsePoints, responsePointCount);
    }

    /// `call(const ShutterBlurRevealTask* task)`, for "hybrid".
    template <class Call> void setReveal(Call& call) {
        recordReveal = blur_detail::invoke<Call, const ShutterBlurRevealTask*>;
        revealUser = blur_detail::erase(call);
    }

    /// `call(const ShutterBlurSampleTask* task)`, for "adaptive".
    template <class Call> void setSamples(Call& call) {
        recordSamples = blur_detail::invoke<Call, const ShutterBlurSampleTask*>;
        samplesUser = blur_detail::erase(call);
    }

    /// `call(const ShutterBlurBlendedTask* task)`.
    template <class Call> void setBlended(Call& call) {
        recordBlended = blur_detail::invoke<Call, const ShutterBlurBlendedTask*>;
        blendedUser = blur_detail::erase(call);
    }

    double timeBefore() const { return shutterBlurGetTimeBefore(this); }
};

struct BlurPlan : ShutterBlurPlan {
    BlurPlan() : ShutterBlurPlan(shutterBlurDefaultPlan()) {}
};

/// A matrix of floats or doubles, column by column, into one of the structures above.
template <class Number> void setMatrix(double (&matrix)[16], const Number* columns) {
    for (int i = 0; i < 16; ++i)
        matrix[i] = static_cast<double>(columns[i]);
}

/// Owns a ShutterBlur. One that is empty, since it was moved from or never created, refuses calls.
class MotionBlur {
  public:
    MotionBlur() = default;

    static BlurStatus addFeatures(VkPhysicalDeviceFeatures2& features) {
        return BlurStatus(shutterBlurAddFeatures(&features));
    }

    static BlurStatus checkDevice(VkPhysicalDevice physical, std::uint32_t queueFamily) {
        return BlurStatus(shutterBlurCheckDevice(physical, queueFamily));
    }

    static BlurResult<MotionBlur> create(const BlurDevice& device) {
        MotionBlur made;
        ShutterBlur* blur = nullptr;
        const ShutterBlurResult code = shutterBlurCreate(&device, &blur);
        made.mBlur.reset(blur);
        return {code, std::move(made)};
    }

    /// Bytes.
    static BlurResult<std::uint64_t>
    estimateMemory(const BlurDevice& device, const ShutterBlurPlan& plan) {
        std::uint64_t bytes = 0;
        const ShutterBlurResult code = shutterBlurEstimateMemory(&device, &plan, &bytes);
        return {code, bytes};
    }

    explicit operator bool() const { return mBlur != nullptr; }

    /// For the C functions; it stays this object's.
    ShutterBlur* handle() const { return mBlur.get(); }

    BlurStatus record(
        VkCommandBuffer commands,
        std::uint32_t frame,
        const ShutterBlurInputs& inputs,
        const ShutterBlurSettings& settings = BlurSettings()
    ) {
        return BlurStatus(shutterBlurRecord(handle(), commands, frame, &inputs, &settings));
    }

    BlurStatus markDone(std::uint32_t frame) {
        return BlurStatus(shutterBlurMarkDone(handle(), frame));
    }

    BlurStatus closeView(std::uint32_t view) {
        return BlurStatus(shutterBlurCloseView(handle(), view));
    }

    /// Its pointers are valid until the object's next call.
    BlurResult<ShutterBlurReport> report(std::uint32_t frame) {
        ShutterBlurReport made = shutterBlurDefaultReport();
        const ShutterBlurResult code = shutterBlurGetReport(handle(), frame, &made);
        return {code, made};
    }

    BlurResult<ShutterBlurMemory> memory() const {
        ShutterBlurMemory made = shutterBlurDefaultMemory();
        const ShutterBlurResult code = shutterBlurGetMemory(handle(), &made);
        return {code, made};
    }

    BlurStatus warmUp(const ShutterBlurPlan& plan) {
        return BlurStatus(shutterBlurWarmUp(handle(), &plan));
    }

    BlurStatus startWarmUp(const ShutterBlurPlan& plan) {
        return BlurStatus(shutterBlurStartWarmUp(handle(), &plan));
    }

    /// The value is the answer; the result is whether it is known.
    BlurResult<bool> isWarm() {
        VkBool32 warm = VK_FALSE;
        const ShutterBlurResult code = shutterBlurIsWarm(handle(), &warm);
        return {code, warm != VK_FALSE};
    }

    BlurStatus dump(const char* folder, std::uint32_t frames) {
        return BlurStatus(shutterBlurDump(handle(), folder, frames));
    }

  private:
    struct Destroy {
        void operator()(ShutterBlur* blur) const { shutterBlurDestroy(blur); }
    };

    std::unique_ptr<ShutterBlur, Destroy> mBlur;
};

} // namespace shutter

#endif
