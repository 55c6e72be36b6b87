// SPDX-License-Identifier: MIT
#include "engine/gpu/pipeline_cache.h"
#include "tests/fuzz/fuzz_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace shutter;
    const gpu::PipelineCacheOwner owner{.vendorId = 0x10005, .deviceId = 0, .uuid = {}};
    const auto unpacked = gpu::unpackPipelineCache({data, size}, owner);
    if (unpacked && unpacked.value())
        SHUTTER_CHECK(unpacked.value()->size() < size, "{} bytes", unpacked.value()->size());
    // A file with a valid checksum reaches the driver only if that driver wrote it.
    const auto file = gpu::packPipelineCache({data, size});
    const auto again = gpu::unpackPipelineCache(file, owner);
    SHUTTER_CHECK(again.ok(), "what was packed is refused");
    SHUTTER_CHECK(!again.value() || again.value()->size() == size, "not what was packed");
    return 0;
}
