// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_ways.h"

#include "engine/math/layer_tables.h"

#include <algorithm>
#include <cmath>

namespace shutter::motion_blur {

namespace {

using math::dmat4;
using math::dvec4;

/// An element below this share of its row's largest counts as 0, since hosts multiply their
/// matrices in single precision.
constexpr double kRounding = 1.0e-6;

dvec4 lastRow(const dmat4& matrix) {
    return {matrix[0].w, matrix[1].w, matrix[2].w, matrix[3].w};
}

/// Whether only that element of the row is not 0, to rounding.
bool isAlone(const dvec4& row, int element) {
    const double limit = kRounding * std::abs(row[element]);
    for (int i = 0; i < 4; ++i)
        if (i != element && !(std::abs(row[i]) <= limit))
            return false;
    return std::abs(row[element]) > 0.0;
}

void setLastRow(dmat4& matrix, const dvec4& row) {
    for (int column = 0; column < 4; ++column)
        matrix[column].w = row[column];
}

} // namespace

dmat4 HostCamera::pictureFromWorld(const math::uvec2& sizePx) const {
    return math::pictureFromView(clipFromView, sizePx, math::dvec2(0.0)) * viewFromWorld;
}

bool isAffine(const dmat4& matrix) {
    const dvec4 row = lastRow(matrix);
    return isAlone(row, 3) && std::abs(row.w - 1.0) <= kRounding;
}

std::optional<HostCamera> normalize(const HostCameraKey& key, bool aheadIsPlusZ) {
    HostCamera camera{key.viewFromWorld, key.clipFromView};
    if (aheadIsPlusZ) {
        for (int column = 0; column < 4; ++column)
            camera.viewFromWorld[column].z = -camera.viewFromWorld[column].z;
        camera.clipFromView[2] = -camera.clipFromView[2];
    }
    const dvec4 row = lastRow(camera.clipFromView);
    if (isAlone(row, 2) && row.z < 0.0) {
        camera.clipFromView /= -row.z;
        setLastRow(camera.clipFromView, {0.0, 0.0, -1.0, 0.0});
        return camera;
    }
    if (isAlone(row, 3) && row.w > 0.0) {
        camera.isPerspective = false;
        camera.clipFromView /= row.w;
        setLastRow(camera.clipFromView, {0.0, 0.0, 0.0, 1.0});
        return camera;
    }
    return std::nullopt;
}

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
    // A static camera stays bit-identical, which marks the picture as static.
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
