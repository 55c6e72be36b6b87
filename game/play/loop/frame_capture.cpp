// SPDX-License-Identifier: MIT
#include "game/play/loop/frame_capture.h"

#include <fmt/format.h>

#include <cstdint>
#include <dlfcn.h>

namespace shutter::game {

namespace {

constexpr int kApiVersion = 10000; ///< eRENDERDOC_API_Version_1_0_0, which later ones contain

/// RENDERDOC_API_1_0_0: pointers to functions, of which those that are called have their types.
struct CaptureApi {
    void* before[13]; ///< GetAPIVersion to GetCaptureFilePathTemplate
    uint32_t (*countCaptures)();
    uint32_t (*getCapture)(uint32_t index, char* file, uint32_t* bytes, uint64_t* timestamp);
    void* between[4]; ///< TriggerCapture to SetActiveWindow
    void (*startFrameCapture)(void* device, void* window);
    uint32_t (*isFrameCapturing)();
    uint32_t (*endFrameCapture)(void* device, void* window);
};

/// Null unless RenderDoc is in the process: loading it now would be too late for the device there
/// is.
const CaptureApi* findApi() {
    using GetApi = int (*)(int version, void** api);
    static const CaptureApi* const kApi = []() -> const CaptureApi* {
        void* const library = dlopen("librenderdoc.so", RTLD_NOW | RTLD_NOLOAD);
        if (!library)
            return nullptr;
        const auto getApi = reinterpret_cast<GetApi>(dlsym(library, "RENDERDOC_GetAPI"));
        void* api = nullptr;
        if (!getApi || getApi(kApiVersion, &api) != 1)
            return nullptr;
        return static_cast<const CaptureApi*>(api);
    }();
    return kApi;
}

std::string findNewestCapture(const CaptureApi& api) {
    const uint32_t count = api.countCaptures();
    uint32_t bytes = 0; // with the zero at the end
    if (count == 0 || api.getCapture(count - 1, nullptr, &bytes, nullptr) != 1 || bytes == 0)
        return {};
    std::string file(bytes, '\0');
    if (api.getCapture(count - 1, file.data(), &bytes, nullptr) != 1)
        return {};
    return file.c_str();
}

} // namespace

std::string FrameCapture::request() {
    if (!findApi())
        return "no capture: RenderDoc is not in this program; start it with 'renderdoccmd capture' "
               "or from RenderDoc's window";
    mState = State::Requested;
    return {};
}

void FrameCapture::begin() {
    if (mState != State::Requested)
        return;
    // Null: the device and the window there are.
    findApi()->startFrameCapture(nullptr, nullptr);
    mState = State::UnderWay;
}

std::string FrameCapture::end() {
    if (mState != State::UnderWay)
        return {};
    mState = State::Idle;
    const CaptureApi& api = *findApi();
    if (api.endFrameCapture(nullptr, nullptr) != 1)
        return "RenderDoc captured nothing of this frame";
    return fmt::format("captured {}", findNewestCapture(api));
}

} // namespace shutter::game
