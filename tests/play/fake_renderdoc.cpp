// SPDX-License-Identifier: MIT
// Stands in for RenderDoc's library: has the functions of the in-application API that `shutter
// play` calls, and writes down that they were called to the file that SHUTTER_CAPTURE_LOG names.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

constexpr const char* kFile = "/captures/rally_frame7.rdc";
uint32_t captureCount = 0;

void note(const char* call) {
    const char* path = std::getenv("SHUTTER_CAPTURE_LOG");
    if (std::FILE* log = path ? std::fopen(path, "a") : nullptr) {
        std::fprintf(log, "%s\n", call);
        std::fclose(log);
    }
}

uint32_t countCaptures() {
    return captureCount;
}

uint32_t getCapture(uint32_t index, char* file, uint32_t* bytes, uint64_t*) {
    if (index >= captureCount)
        return 0;
    if (bytes)
        *bytes = static_cast<uint32_t>(std::strlen(kFile)) + 1;
    if (file)
        std::strcpy(file, kFile);
    return 1;
}

void startFrameCapture(void*, void*) {
    note("start");
}

uint32_t endFrameCapture(void*, void*) {
    note("end");
    ++captureCount;
    return 1;
}

/// Who calls one of the others has the table's order wrong.
void refuse() {
    note("another function");
    std::abort();
}

} // namespace

extern "C" [[gnu::visibility("default")]] int RENDERDOC_GetAPI(int version, void** api) {
    // The order of RENDERDOC_API_1_0_0 (renderdoc_app.h).
    static void* table[22];
    for (void*& entry : table)
        entry = reinterpret_cast<void*>(&refuse);
    table[13] = reinterpret_cast<void*>(&countCaptures);
    table[14] = reinterpret_cast<void*>(&getCapture);
    table[19] = reinterpret_cast<void*>(&startFrameCapture);
    table[21] = reinterpret_cast<void*>(&endFrameCapture);
    *api = table;
    return version == 10000 ? 1 : 0;
}
