// SPDX-License-Identifier: MIT
#include "game/play/pass_groups.h"

#include <algorithm>

namespace shutter::game {

namespace {

constexpr std::string_view kScene[] = {"G-buffer", "bend meshes"};
constexpr std::string_view kDisplay[] = {"tone map", "debug view", "keep picture", "window"};

bool isOneOf(std::span<const std::string_view> names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

} // namespace

PassGroup groupOf(const MethodInfo& method, std::string_view pass) {
    if (isOneOf(kDisplay, pass) || pass.starts_with("readback"))
        return PassGroup::Display;
    switch (method.family) {
    case MethodFamily::Sharp:
        return PassGroup::Scene;
    case MethodFamily::MotionBlur:
        return isOneOf(kScene, pass) ? PassGroup::Scene : PassGroup::Blur;
    case MethodFamily::Accumulate:
    case MethodFamily::Truth:
        break;
    }
    return PassGroup::Blur;
}

double sumBlurMilliseconds(const MethodInfo& method, const render::FrameStatistics& statistics) {
    double sum = 0.0;
    for (const gpu::PassTime& pass : statistics.passes)
        if (groupOf(method, pass.name) == PassGroup::Blur)
            sum += pass.gpuMilliseconds;
    return sum;
}

} // namespace shutter::game
