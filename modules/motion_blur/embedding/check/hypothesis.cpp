// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/check/hypothesis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace shutter::motion_blur {

using math::dvec2;

namespace {

/// Cameras of motionDepth span a frame, its vectors an exposure of unknown length.
void scaleToExposure(std::vector<CheckPoint>& points) {
    std::vector<double> shares;
    for (const CheckPoint& point : points) {
        const double square = glm::dot(point.camera, point.camera);
        if (!point.isSky && square > 1.0)
            shares.push_back(glm::dot(point.motion, point.camera) / square);
    }
    const auto share = takeMedian(shares, kMinInformative);
    if (share && std::abs(*share) > 0.02 && std::abs(*share) < 1.05)
        for (CheckPoint& point : points)
            point.camera *= std::abs(*share);
}

} // namespace

std::optional<size_t> judge(const Hypothesis& declared, const Hypothesis& candidate) {
    size_t count = 0;
    size_t explained = 0;
    size_t informative = 0;
    size_t informativeCandidate = 0;
    size_t informativeDeclared = 0;
    for (size_t i = 0; i < candidate.points.size(); ++i) {
        const CheckPoint& point = candidate.points[i];
        if (point.isSky)
            continue; // hosts seldom write vectors there
        ++count;
        explained += candidate.agreesAt(point);
        const dvec2 apart =
            candidate.differenceOf(point) - declared.differenceOf(declared.points[i]);
        const double motion = std::max(
            glm::length(candidate.cameraOf(point)),
            glm::length(declared.cameraOf(declared.points[i]))
        );
        // With little camera motion, movers' vectors agree with it if scaled down enough.
        if (motion < 1.0 || glm::length(apart) <= 2.0 * (kTolerancePx + kToleranceShare * motion))
            continue;
        ++informative;
        informativeCandidate += candidate.agreesAt(point);
        informativeDeclared += declared.agreesAt(declared.points[i]);
    }
    const bool isBetter = count >= kMinPoints &&
                          informative >= std::max(kMinInformative, count / 20) &&
                          10 * informativeCandidate >= 6 * informative &&
                          10 * informativeDeclared <= informative && 2 * explained >= count;
    return isBetter ? std::optional(explained) : std::nullopt;
}

Hypothesis read(const CheckedFrame& frame, const CheckFacts& facts) {
    Hypothesis hypothesis;
    hypothesis.points = makePoints(frame, facts);
    hypothesis.haveCamera = facts.isNative || !facts.convention.vectors.lackCamera;
    return hypothesis;
}

Hypothesis readDeclared(const CheckedFrame& frame) {
    Hypothesis declared = read(frame, frame.facts);
    if (frame.facts.isNative && !frame.facts.hasExposureCameras)
        scaleToExposure(declared.points);
    return declared;
}

size_t countAgreeing(const Hypothesis& hypothesis) {
    return size_t(std::count_if(
        hypothesis.points.begin(),
        hypothesis.points.end(),
        [&](const CheckPoint& point) { return !point.isSky && hypothesis.agreesAt(point); }
    ));
}

std::optional<double> takeMedian(std::vector<double>& values, size_t least) {
    if (values.size() < least)
        return std::nullopt;
    const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

namespace {

using math::dvec2;

constexpr int kSteps = 12;       ///< either way
constexpr double kFactor = 1.08; ///< from step to step: 0.4 to 2.5
constexpr int kFinerSteps = 5;   ///< either way, of a sixth

double degreesOf(double focal) {
    return glm::degrees(2.0 * std::atan(1.0 / focal));
}

} // namespace

dvec2 fitLens(const std::function<double(const dvec2&)>& cost) {
    dvec2 best(1.0);
    double least = HUGE_VAL;
    const auto visit = [&](const dvec2& scale) {
        const double value = cost(scale);
        if (value < least) {
            least = value;
            best = scale;
        }
    };
    for (const dvec2 axes : {dvec2(1.0), dvec2(1.0, 0.0), dvec2(0.0, 1.0)})
        for (int step = -kSteps; step <= kSteps; ++step)
            visit(glm::pow(dvec2(kFactor), double(step) * axes));
    const dvec2 coarse = best;
    const dvec2 axes(coarse.x != 1.0 ? 1.0 : 0.0, coarse.y != 1.0 ? 1.0 : 0.0);
    for (int step = -kFinerSteps; step <= kFinerSteps; ++step)
        visit(coarse * glm::pow(dvec2(kFactor), double(step) / 6.0 * axes));
    return best;
}

CheckFacts scaleLens(const CheckFacts& facts, const dvec2& scale) {
    CheckFacts scaled = facts;
    HostCameras& cameras = scaled.convention.cameras;
    for (math::dmat4* clip : {&cameras.clipFromView, &cameras.clipFromViewBefore})
        for (int column = 0; column < 4; ++column)
            for (int axis = 0; axis < 2; ++axis)
                (*clip)[column][axis] *= scale[axis];
    return scaled;
}

std::string describeLens(const CheckFacts& facts, const dvec2& scale) {
    const HostCamera camera = findCamera(facts, false).value();
    const dvec2 declared(std::abs(camera.clipFromView[0].x), std::abs(camera.clipFromView[1].y));
    const dvec2 fitted = declared * scale;
    if (scale.x != scale.y)
        return fmt::format(
            "cameras.clipFromView had an aspect ratio of {:.3g} in place of {:.3g}",
            fitted.y / fitted.x,
            declared.y / declared.x
        );
    if (camera.isPerspective)
        return fmt::format(
            "cameras.clipFromView had a field of view of {:.3g} degrees from top to bottom in "
            "place "
            "of {:.3g}",
            degreesOf(fitted.y),
            degreesOf(declared.y)
        );
    return fmt::format(
        "cameras.clipFromView showed {:.3g} m from top to bottom in place of {:.3g}",
        2.0 / fitted.y,
        2.0 / declared.y
    );
}

} // namespace shutter::motion_blur
