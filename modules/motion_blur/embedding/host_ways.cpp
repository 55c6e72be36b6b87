// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_ways.h"

#include <algorithm>

namespace shutter::motion_blur {

using math::dmat4;

BetweenKeys locate(std::span<const HostCameraKey> keys, double time) {
    const auto after =
        std::upper_bound(keys.begin(), keys.end(), time, [](double t, const HostCameraKey& key) {
            return t < key.time;
        });
    const size_t next = size_t(after - keys.begin());
    if (next == 0)
        return {};
    if (next == keys.size() || keys[next - 1].time == time)
        return {next - 1, next - 1, 0.0};
    const double span = keys[next].time - keys[next - 1].time;
    return {next - 1, next, (time - keys[next - 1].time) / span};
}

CameraWay::CameraWay(std::span<const HostCameraKey> keys, bool aheadIsPlusZ) {
    for (const HostCameraKey& key : keys) {
        mCameras.push_back(normalize(key, aheadIsPlusZ).value());
        mPoses.push_back(math::takeApart(glm::inverse(mCameras.back().viewFromWorld)));
    }
}

HostCamera CameraWay::at(const BetweenKeys& place) const {
    HostCamera camera = mCameras[place.from];
    const HostCamera& to = mCameras[place.to];
    camera.clipFromView += (to.clipFromView - camera.clipFromView) * place.share;
    // One that stands still keeps its bits, which tell that nothing before it moves.
    if (camera.viewFromWorld != to.viewFromWorld)
        camera.viewFromWorld =
            glm::inverse(math::interpolate(mPoses[place.from], mPoses[place.to], place.share));
    return camera;
}

MoverWay::MoverWay(std::span<const dmat4> keys) : mFirst(keys.front()) {
    mIsStill =
        std::all_of(keys.begin(), keys.end(), [&](const dmat4& key) { return key == mFirst; });
    if (mIsStill)
        return;
    for (const dmat4& key : keys)
        mPoses.push_back(math::takeApart(key));
}

dmat4 MoverWay::at(const BetweenKeys& place) const {
    if (mIsStill)
        return mFirst;
    return math::interpolate(mPoses[place.from], mPoses[place.to], place.share);
}

} // namespace shutter::motion_blur
