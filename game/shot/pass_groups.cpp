// SPDX-License-Identifier: MIT
#include "game/shot/pass_groups.h"

namespace shutter::game {

PassGroup groupOf(const MethodInfo& method, render::PassOwner owner) {
    if (owner == render::PassOwner::Display)
        return PassGroup::Display;
    switch (method.family) {
    case MethodFamily::Sharp:
        return PassGroup::Scene;
    case MethodFamily::MotionBlur:
        return owner == render::PassOwner::Scene ? PassGroup::Scene : PassGroup::Blur;
    case MethodFamily::Accumulate:
    case MethodFamily::Truth:
        break;
    }
    return PassGroup::Blur;
}

double sumBlurMilliseconds(const MethodInfo& method, const render::FrameStatistics& statistics) {
    double sum = 0.0;
    for (const render::PassTime& pass : statistics.passes)
        if (groupOf(method, pass.owner) == PassGroup::Blur)
            sum += pass.gpuMilliseconds;
    return sum;
}

double sumFrameMilliseconds(const render::FrameStatistics& statistics) {
    double sum = 0.0;
    for (const render::PassTime& pass : statistics.passes)
        if (pass.owner != render::PassOwner::Display)
            sum += pass.gpuMilliseconds;
    return sum;
}

} // namespace shutter::game
