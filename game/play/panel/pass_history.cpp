// SPDX-License-Identifier: MIT
#include "game/play/panel/pass_history.h"

#include <algorithm>
#include <cmath>

namespace shutter::game {

namespace {

auto at(auto& values, size_t index) {
    return values.begin() + static_cast<std::ptrdiff_t>(index);
}

} // namespace

size_t PassHistory::findOrInsert(const Pass& pass, size_t after) {
    const auto known = std::find(mPasses.begin(), mPasses.end(), pass);
    if (known != mPasses.end())
        return static_cast<size_t>(known - mPasses.begin());
    mPasses.insert(at(mPasses, after), pass);
    for (std::vector<float>& frame : mFrames)
        frame.insert(at(frame, after), 0.0f);
    for (std::vector<bool>& frame : mHas)
        frame.insert(at(frame, after), false);
    return after;
}

void PassHistory::forget(size_t pass) {
    mPasses.erase(at(mPasses, pass));
    for (std::vector<float>& frame : mFrames)
        frame.erase(at(frame, pass));
    for (std::vector<bool>& frame : mHas)
        frame.erase(at(frame, pass));
}

void PassHistory::add(const render::FrameStatistics& statistics) {
    if (mFrames.size() == kFrames) {
        mFrames.pop_front();
        mHas.pop_front();
    }
    mFrames.emplace_back(mPasses.size(), 0.0f);
    mHas.emplace_back(mPasses.size(), false);
    size_t next = 0; // where a pass that is new belongs: behind the one before it
    for (const render::PassTime& pass : statistics.passes) {
        const size_t index = findOrInsert({pass.name, pass.owner}, next);
        next = index + 1;
        mHas.back()[index] = true;
        if (std::isfinite(pass.gpuMilliseconds) && pass.gpuMilliseconds > 0.0)
            mFrames.back()[index] += static_cast<float>(pass.gpuMilliseconds);
    }
    for (size_t pass = mPasses.size(); pass-- > 0;)
        if (std::none_of(mHas.begin(), mHas.end(), [&](const auto& has) { return has[pass]; }))
            forget(pass);
}

float PassHistory::findMedian(size_t pass) const {
    if (mFrames.empty())
        return 0.0f;
    std::vector<float> values;
    for (const std::vector<float>& frame : mFrames)
        values.push_back(frame[pass]);
    const auto middle = at(values, values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace shutter::game
