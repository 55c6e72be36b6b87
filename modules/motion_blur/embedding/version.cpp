// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/version.h"

#include <string>

namespace shutter::motion_blur {

namespace {

std::string describeVersion(uint32_t version) {
    return fmt::format("{}.{}.{}", version >> 22, version >> 12 & 0x3FF, version & 0xFFF);
}

} // namespace

core::Status checkVersion(uint32_t headerVersion) {
    constexpr uint32_t kPatch = 0xFFF;
    if (headerVersion >> 12 == kHeaderVersion >> 12 &&
        (headerVersion & kPatch) <= (kHeaderVersion & kPatch))
        return {};
    return core::makeError(
        "motion blur: the host was compiled with headers of version {}, the library is {}",
        describeVersion(headerVersion),
        describeVersion(kHeaderVersion)
    );
}

} // namespace shutter::motion_blur
