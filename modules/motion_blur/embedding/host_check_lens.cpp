// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_check_lens.h"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>

namespace shutter::motion_blur {

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
    const dvec2 said(std::abs(camera.clipFromView[0].x), std::abs(camera.clipFromView[1].y));
    const dvec2 fitted = said * scale;
    if (scale.x != scale.y)
        return fmt::format(
            "cameras.clipFromView had an aspect ratio of {:.3g} in place of {:.3g}",
            fitted.y / fitted.x,
            said.y / said.x
        );
    if (camera.isPerspective)
        return fmt::format(
            "cameras.clipFromView had a field of view of {:.3g} degrees from top to bottom in "
            "place "
            "of {:.3g}",
            degreesOf(fitted.y),
            degreesOf(said.y)
        );
    return fmt::format(
        "cameras.clipFromView showed {:.3g} m from top to bottom in place of {:.3g}",
        2.0 / fitted.y,
        2.0 / said.y
    );
}

} // namespace shutter::motion_blur
