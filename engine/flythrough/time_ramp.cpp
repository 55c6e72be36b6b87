// SPDX-License-Identifier: MIT
#include "engine/flythrough/time_ramp.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace shutter::flythrough {

namespace {

/// Film time that a span of the scene's takes whose scale is `scale` at its beginning.
double filmOfSpan(double scale, double slope, double sceneSeconds) {
    const double growth = slope * sceneSeconds / scale;
    // log(1 + x) / x, which is 1 for x = 0.
    const double share = std::abs(growth) > 1.0e-12 ? std::log1p(growth) / growth : 1.0;
    return sceneSeconds / scale * share;
}

/// The inverse of filmOfSpan().
double sceneOfSpan(double scale, double slope, double filmSeconds) {
    const double growth = slope * filmSeconds;
    const double share = std::abs(growth) > 1.0e-12 ? std::expm1(growth) / growth : 1.0;
    return filmSeconds * scale * share;
}

} // namespace

TimeRamp::TimeRamp(const Flythrough& flythrough) {
    for (const FlythroughKey& key : flythrough.keys)
        if (key.timeScale)
            mKeys.push_back({key.seconds, *key.timeScale, 0.0});
    for (size_t i = 1; i < mKeys.size(); ++i)
        mKeys[i].film =
            mKeys[i - 1].film +
            filmOfSpan(mKeys[i - 1].scale, slopeAfter(i - 1), mKeys[i].scene - mKeys[i - 1].scene);
    const double atZero = mKeys.empty() ? 0.0 : filmFromScene(0.0);
    for (Key& key : mKeys)
        key.film -= atZero;
}

double TimeRamp::scaleAt(double sceneSeconds) const {
    if (mKeys.empty())
        return 1.0;
    const size_t at = findKey(&Key::scene, sceneSeconds);
    if (sceneSeconds <= mKeys[at].scene)
        return mKeys[at].scale;
    return mKeys[at].scale + slopeAfter(at) * (sceneSeconds - mKeys[at].scene);
}

double TimeRamp::filmFromScene(double sceneSeconds) const {
    if (mKeys.empty())
        return sceneSeconds;
    const size_t at = findKey(&Key::scene, sceneSeconds);
    const Key& key = mKeys[at];
    // Before the first key the scale stays the same.
    const double slope = sceneSeconds < key.scene ? 0.0 : slopeAfter(at);
    return key.film + filmOfSpan(key.scale, slope, sceneSeconds - key.scene);
}

double TimeRamp::sceneFromFilm(double filmSeconds) const {
    if (mKeys.empty())
        return filmSeconds;
    const size_t at = findKey(&Key::film, filmSeconds);
    const Key& key = mKeys[at];
    const double slope = filmSeconds < key.film ? 0.0 : slopeAfter(at);
    return key.scene + sceneOfSpan(key.scale, slope, filmSeconds - key.film);
}

scene::ExposureInterval TimeRamp::computeExposure(
    const scene::CameraShutter& shutter, double sceneSeconds, double filmFrameSeconds
) const {
    if (mKeys.empty())
        return scene::computeExposure(shutter, sceneSeconds, filmFrameSeconds);
    const double film = filmFromScene(sceneSeconds);
    scene::ExposureInterval exposure = scene::computeExposure(shutter, film, filmFrameSeconds);
    exposure.frameSeconds =
        std::max(sceneSeconds - sceneFromFilm(film - exposure.frameSeconds), 0.0);
    exposure.open = std::min(sceneFromFilm(exposure.open), sceneSeconds);
    exposure.close = std::max(sceneFromFilm(exposure.close), sceneSeconds);
    exposure.raster = sceneSeconds;
    if (exposure.close > exposure.open)
        exposure.rasterTime = (sceneSeconds - exposure.open) / (exposure.close - exposure.open);
    return exposure;
}

size_t TimeRamp::findKey(double Key::*time, double seconds) const {
    const auto next = std::upper_bound(
        mKeys.begin(),
        mKeys.end(),
        seconds,
        [time](double wanted, const Key& key) { return wanted < key.*time; }
    );
    return next == mKeys.begin() ? 0 : size_t(next - mKeys.begin()) - 1;
}

double TimeRamp::slopeAfter(size_t key) const {
    if (key + 1 >= mKeys.size())
        return 0.0;
    return (mKeys[key + 1].scale - mKeys[key].scale) / (mKeys[key + 1].scene - mKeys[key].scene);
}

} // namespace shutter::flythrough
