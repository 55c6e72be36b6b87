// SPDX-License-Identifier: MIT
// Truth pictures that `shutter bench` keeps from one run to the next.
#pragma once

#include "engine/image/image.h"

#include <cstdint>
#include <filesystem>
#include <optional>

namespace shutter::bench {

/// The picture that `file` keeps; nothing where there is none. One that cannot be read, or of
/// another size or kind than the truth of a case has, counts as none, with a warning: the truth is
/// drawn anew and replaces it.
[[nodiscard]] std::optional<image::Image>
readCachedTruth(const std::filesystem::path& file, uint32_t width, uint32_t height);

} // namespace shutter::bench
