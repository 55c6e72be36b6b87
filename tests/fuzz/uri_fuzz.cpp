// SPDX-License-Identifier: MIT
#include "engine/io/uri.h"
#include "tests/fuzz/fuzz_file.h"

namespace io = shutter::io;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const std::string_view uri = shutter::fuzz::asText(data, size);
    if (const auto bytes = io::decodeDataUri(uri))
        SHUTTER_CHECK(bytes.value().size() <= size, "{} bytes", bytes.value().size());
    if (const auto file = io::resolveUri("", uri))
        SHUTTER_CHECK(io::liesInside("", file.value()), "'{}'", file.value().string());
    (void)io::resolveUri("", uri, io::Reach::Anywhere);
    return 0;
}
