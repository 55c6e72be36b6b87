// SPDX-License-Identifier: MIT
#include "assets/generator/scaling_scenes.h"
#include "assets/generator/scenes.h"
#include "game/bench/suites/suite.h"

#include <array>
#include <initializer_list>

namespace shutter::bench {

namespace {

/// A case of a scaling axis; `name` ends in the point's label.
Case makeCase(const std::string& name, std::function<generator::GltfWriter()> build) {
    Case shot;
    shot.name = name;
    shot.title = name;
    shot.shot.camera = generator::kScalingCamera;
    shot.shot.time = generator::kScalingSeconds;
    shot.shot.shutter =
        game::makeShutterArguments(generator::kScalingExposureSeconds, generator::kScalingPhase);
    shot.writeScene = makeWriter(std::move(build));
    return shot;
}

ScalingAxis makeResolutionAxis() {
    struct Size {
        uint32_t width;
        uint32_t height;
        const char* label;
    };

    constexpr std::array kSizes = {
        Size{640, 360, "360p"},
        Size{960, 540, "540p"},
        Size{1280, 720, "720p"},
        Size{1920, 1080, "1080p"},
        Size{2560, 1440, "1440p"},
        Size{3840, 2160, "4K"},
    };
    ScalingAxis axis{"resolution", "Resolution", "pixels", {}};
    for (const Size& size : kSizes) {
        Case shot = makeCase(fmt::format("resolution-{}", size.label), &generator::buildVaseScene);
        shot.size = {size.width, size.height};
        axis.points.push_back({double(size.width) * size.height, size.label, std::move(shot)});
    }
    return axis;
}

/// \param name of the axis, and its unit
ScalingAxis makeCountAxis(
    const char* name,
    const char* title,
    std::initializer_list<int> counts,
    generator::GltfWriter (*build)(int)
) {
    ScalingAxis axis{name, title, name, {}};
    for (const int count : counts)
        axis.points.push_back(
            {double(count),
             std::to_string(count),
             makeCase(fmt::format("{}-{}", name, count), [=] { return build(count); })}
        );
    return axis;
}

ScalingAxis makeMovingShareAxis() {
    ScalingAxis axis{"moving-share", "Moving share of the screen", "%", {}};
    for (int percent : {0, 5, 10, 25, 50, 75, 100})
        axis.points.push_back(
            {double(percent),
             fmt::format("{} %", percent),
             makeCase(
                 fmt::format("moving-{}", percent),
                 [percent] { return generator::buildMovingShareScene(float(percent) / 100.0f); }
             )}
        );
    return axis;
}

ScalingAxis makeExposureAxis() {
    ScalingAxis axis{"exposure", "Exposure, times 1/60 s", "x", {}};
    for (int times : {1, 2, 4, 8}) {
        Case shot = makeCase(fmt::format("exposure-{}", times), &generator::buildVaseScene);
        shot.shot.shutter.shutter.exposureSeconds = times * generator::kScalingExposureSeconds;
        axis.points.push_back({double(times), fmt::format("x{}", times), std::move(shot)});
    }
    return axis;
}

} // namespace

Suite makeScalingSuite() {
    Suite suite;
    suite.name = "scaling";
    suite.repeats = 3;
    suite.limitSeconds = 30.0;
    suite.axes = {
        makeResolutionAxis(),
        makeCountAxis(
            "entities", "Moving entities", {1, 10, 100, 1000, 10000}, &generator::buildEntitiesScene
        ),
        makeCountAxis("bodies", "Walking bodies", {0, 1, 10, 50, 200}, &generator::buildCrowdScene),
        makeCountAxis(
            "triangles",
            "Triangles",
            {10'000, 31'623, 100'000, 316'228, 1'000'000},
            &generator::buildTrianglesScene
        ),
        makeMovingShareAxis(),
        makeExposureAxis()};
    return suite;
}

} // namespace shutter::bench
