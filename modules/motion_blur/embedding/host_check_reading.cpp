// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_check_reading.h"

#include <algorithm>
#include <cmath>

namespace shutter::motion_blur {

using math::dvec2;

namespace {

/// Cameras of motionDepth are over a frame, and its vectors over an exposure that nobody tells.
void scaleToExposure(std::vector<CheckPoint>& points) {
    std::vector<double> shares;
    for (const CheckPoint& point : points) {
        const double square = glm::dot(point.camera, point.camera);
        if (!point.isSky && square > 1.0)
            shares.push_back(glm::dot(point.motion, point.camera) / square);
    }
    const auto share = takeMedian(shares, kLeastTelling);
    if (share && std::abs(*share) > 0.02 && std::abs(*share) < 1.05)
        for (CheckPoint& point : points)
            point.camera *= std::abs(*share);
}

} // namespace

std::optional<size_t> judge(const Reading& said, const Reading& guess) {
    size_t count = 0;
    size_t explained = 0;
    size_t telling = 0;
    size_t tellingGuess = 0;
    size_t tellingSaid = 0;
    for (size_t i = 0; i < guess.points.size(); ++i) {
        const CheckPoint& point = guess.points[i];
        if (point.isSky)
            continue; // hosts seldom write vectors there
        ++count;
        explained += guess.agreesAt(point);
        const dvec2 apart = guess.differenceOf(point) - said.differenceOf(said.points[i]);
        const double motion = std::max(
            glm::length(guess.cameraOf(point)), glm::length(said.cameraOf(said.points[i]))
        );
        // Where the camera hardly moves, vectors of what moves by itself agree with it once they
        // are made short enough.
        if (motion < 1.0 || glm::length(apart) <= 2.0 * (kTolerancePx + kToleranceShare * motion))
            continue;
        ++telling;
        tellingGuess += guess.agreesAt(point);
        tellingSaid += said.agreesAt(said.points[i]);
    }
    const bool isBetter = count >= kLeastPoints && telling >= std::max(kLeastTelling, count / 20) &&
                          10 * tellingGuess >= 6 * telling && 10 * tellingSaid <= telling &&
                          2 * explained >= count;
    return isBetter ? std::optional(explained) : std::nullopt;
}

Reading read(const CheckedFrame& frame, const CheckFacts& facts) {
    Reading reading;
    reading.points = makePoints(frame, facts);
    reading.haveCamera = facts.isNative || !facts.convention.vectors.lackCamera;
    return reading;
}

Reading readSaid(const CheckedFrame& frame) {
    Reading said = read(frame, frame.facts);
    if (frame.facts.isNative && !frame.facts.hasExposureCameras)
        scaleToExposure(said.points);
    return said;
}

size_t countAgreeing(const Reading& reading) {
    return size_t(std::count_if(
        reading.points.begin(),
        reading.points.end(),
        [&](const CheckPoint& point) { return !point.isSky && reading.agreesAt(point); }
    ));
}

std::optional<double> takeMedian(std::vector<double>& values, size_t least) {
    if (values.size() < least)
        return std::nullopt;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace shutter::motion_blur
