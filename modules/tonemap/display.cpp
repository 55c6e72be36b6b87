// SPDX-License-Identifier: MIT
#include "modules/tonemap/display.h"

#include "engine/core/check.h"
#include "shaders/tonemap/tonemap.glsl"

#include <cmath>
#include <cstddef>

namespace shutter::tonemap {

image::Image computeDisplayImage(const image::Image& linear, const TonemapSettings& settings) {
    SHUTTER_CHECK(linear.channels == 1 || linear.channels == 3, "{} channels", linear.channels);
    const size_t channels = linear.channels;
    SHUTTER_CHECK_EQ(linear.pixels.size(), size_t(linear.width) * linear.height * channels);
    const float gain = computeGain(settings);
    image::Image display = linear;
    for (size_t i = 0; i < linear.pixels.size(); i += channels) {
        const float* in = linear.pixels.data() + i;
        const glm::vec3 stored(in[0], in[channels == 3 ? 1 : 0], in[channels == 3 ? 2 : 0]);
        // Infinity would become NaN in the operator.
        glm::vec3 color = glm::clamp(stored * gain, 0.0f, shader::kMaxColor);
        if (settings.op == Operator::Neutral)
            color = shader::toneMapNeutral(color);
        color = shader::encodeSrgb3(color);
        const bool hasNan = std::isnan(stored.x) || std::isnan(stored.y) || std::isnan(stored.z);
        for (size_t c = 0; c < channels; ++c)
            display.pixels[i + c] = hasNan ? std::nanf("") : color[int(c)];
    }
    return display;
}

} // namespace shutter::tonemap
