// SPDX-License-Identifier: MIT
#include "game/bench/linear_picture.h"

#include "engine/core/check.h"

namespace shutter::bench {

image::Image packLinearPicture(const image::Image& color, const image::Image& errorMap) {
    constexpr uint32_t kColors = 3;
    const bool hasErrors = errorMap.width > 0;
    SHUTTER_CHECK(color.channels >= kColors, "{} channels", color.channels);
    SHUTTER_CHECK(
        !hasErrors || (errorMap.width == color.width && errorMap.height == color.height),
        "an error map of {}x{} for a picture of {}x{}",
        errorMap.width,
        errorMap.height,
        color.width,
        color.height
    );
    image::Image packed(color.width, color.height, hasErrors ? kColors + 1 : kColors);
    packed.channelNames = {"R", "G", "B"};
    if (hasErrors)
        packed.channelNames.emplace_back("flip");
    for (uint32_t y = 0; y < color.height; ++y)
        for (uint32_t x = 0; x < color.width; ++x) {
            for (uint32_t c = 0; c < kColors; ++c)
                packed.at(x, y, c) = color.at(x, y, c);
            if (hasErrors)
                packed.at(x, y, kColors) = errorMap.at(x, y, 0);
        }
    return packed;
}

} // namespace shutter::bench
