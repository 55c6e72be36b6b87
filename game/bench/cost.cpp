// SPDX-License-Identifier: MIT
#include "game/bench/cost.h"

#include "game/shot/pass_groups.h"

namespace shutter::bench {

double computeFrameTime(const Sample& sample) {
    double sum = 0.0;
    for (const PassSample& pass : sample.passes)
        if (pass.owner != render::PassOwner::Display)
            sum += pass.milliseconds;
    return sum;
}

double computeEffectTime(const game::MethodInfo& method, const Sample& sample) {
    double sum = 0.0;
    for (const PassSample& pass : sample.passes)
        if (game::groupOf(method, pass.owner) == game::PassGroup::Blur)
            sum += pass.milliseconds;
    return sum;
}

} // namespace shutter::bench
