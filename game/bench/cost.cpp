// SPDX-License-Identifier: MIT
#include "game/bench/cost.h"

namespace shutter::bench {

bool isCounted(std::string_view pass) {
    return pass != "tone map" && !pass.starts_with("readback");
}

bool isEffect(const game::MethodInfo& method, std::string_view pass) {
    if (!isCounted(pass))
        return false;
    switch (method.family) {
    case game::MethodFamily::Sharp:
        return false;
    case game::MethodFamily::MotionBlur:
        return pass != "G-buffer";
    default:
        return true;
    }
}

double computeFrameTime(const Sample& sample) {
    double sum = 0.0;
    for (const PassSample& pass : sample.passes)
        if (isCounted(pass.name))
            sum += pass.milliseconds;
    return sum;
}

double computeEffectTime(const game::MethodInfo& method, const Sample& sample) {
    double sum = 0.0;
    for (const PassSample& pass : sample.passes)
        if (isEffect(method, pass.name))
            sum += pass.milliseconds;
    return sum;
}

} // namespace shutter::bench
