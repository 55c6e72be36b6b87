// SPDX-License-Identifier: MIT
// Cameras, places and shutters.
#include "tests/conformance/stability/case_lists.h"
#include "tests/conformance/stability/pictures.h"

#include <cmath>
#include <numbers>

namespace shutter::stability {

namespace {

using math::dvec3;

constexpr double kPi = std::numbers::pi;

const View kLit{.background = math::vec3(0.1f, 0.2f, 0.3f), .ambient = math::vec3(0.3f)};

View during(double exposureSeconds) {
    View view = kLit;
    view.exposureSeconds = exposureSeconds;
    return view;
}

/// A sheet flies at the camera and past it: each of its points moves away from the vanishing point,
/// never towards it, whatever of its corners lies behind the camera at shutter close.
core::Result<Measurements> measureNearPlane(gpu::Device& device) {
    SceneBuilder scene = makeEmptyScene();
    // Seen at the raster instant (start) at 0.2 m; 5 m behind the camera at close.
    addShape(
        scene,
        makeSheetShape(0.4, 0.3),
        scene.addWaves(),
        Placement{.position = {0.0, 0.0, -0.2}, .velocity = {0.0, 0.0, 5.2}}
    );
    View view;
    view.phase = scene::ShutterPhase::Start;
    Drawer drawer(device, std::move(scene));
    auto found = measureEveryMethod(drawer, view);
    if (!found)
        return found;
    auto frame = drawer.draw("sharp", view);
    if (!frame)
        return frame.error();
    const image::Image& motion = frame.value().intermediates.at("motion");
    Worst inwards;
    for (uint32_t y = 0; y < view.height; ++y)
        for (uint32_t x = 0; x < view.width; ++x) {
            const math::dvec2 outwards(x + 0.5 - view.width / 2.0, y + 0.5 - view.height / 2.0);
            const math::dvec2 moved(motion.at(x, y, 0), motion.at(x, y, 1));
            // A motion of a pixel or more that does not go outwards.
            const double share =
                glm::dot(moved, outwards) / (glm::length(moved) * glm::length(outwards));
            inwards.add(glm::length(moved) < 1.0 || share < 0.999 ? 1.0 : 0.0);
        }
    found.value().push_back(describe(inwards, "every motion goes outwards", "", 0.0));
    return found;
}

/// The same scene at the origin and far away: the same pixels show the same entities and move the
/// same.
core::Result<Measurements> measureFar(gpu::Device& device, double metres, double motionBound) {
    SceneBuilder near = makeEmptyScene();
    addWallAndSphere(near);
    SceneBuilder far = makeEmptyScene();
    addWallAndSphere(far);
    far.moveAll(dvec3(metres, -0.6 * metres, 0.8 * metres));
    Drawer nearDrawer(device, std::move(near));
    Drawer farDrawer(device, std::move(far));
    auto found = measureEveryMethod(farDrawer, kLit);
    if (!found)
        return found;
    auto expected = nearDrawer.draw("hybrid", kLit);
    auto frame = farDrawer.draw("hybrid", kLit);
    if (!expected || !frame)
        return expected ? frame.error() : expected.error();
    const auto view = [](const auto& drawn, const char* name) -> const image::Image& {
        return drawn.value().intermediates.at(name);
    };
    Worst motion;
    Worst entity;
    Worst color;
    for (uint32_t y = 0; y < kLit.height; ++y)
        for (uint32_t x = 0; x < kLit.width; ++x) {
            const bool same =
                view(frame, "mesh_id").at(x, y, 0) == view(expected, "mesh_id").at(x, y, 0);
            entity.add(same ? 0.0 : 1.0);
            if (!same)
                continue;
            for (uint32_t c = 0; c < 2; ++c)
                motion.add(std::abs(
                    double(view(frame, "motion").at(x, y, c)) -
                    double(view(expected, "motion").at(x, y, c))
                ));
            for (uint32_t c = 0; c < 3; ++c)
                color.add(std::abs(
                    double(frame.value().color.at(x, y, c)) -
                    double(expected.value().color.at(x, y, c))
                ));
        }
    found.value().push_back(describe(entity, "the same entities as at the origin", "", 0.0));
    found.value().push_back(describe(motion, "the same motion as at the origin", "px", motionBound)
    );
    found.value().push_back(
        describe(color, "the same blurred colour as at the origin", "brightness", 1.0 / 255.0)
    );
    return found;
}

/// A spin of whole turns ends where it began: no motion to store, yet every truth blurs.
core::Result<Measurements> measureSpin(gpu::Device& device) {
    Measurements all;
    for (const double turns : {0.6, 1.0, 10.3}) {
        SceneBuilder scene = makeEmptyScene();
        addShape(scene, makeSheetShape(6, 5), scene.addWaves(), Placement{.position = {0, 0, -5}});
        addShape(
            scene,
            makeBoxShape(1.6, 0.3, 0.2),
            scene.addWaves(),
            Placement{.position = {0, 0, -2.5}, .angularVelocity = {0, 0.2, turns * 2.0 * kPi}}
        );
        Drawer drawer(device, std::move(scene));
        auto found = measureEveryMethod(drawer, {});
        if (!found)
            return found;
        for (Measured& row : found.value()) {
            row.check += fmt::format(", {} turns", turns);
            all.push_back(std::move(row));
        }
    }
    return all;
}

void buildSky(SceneBuilder& scene) {
    scene.place(scene.camera, {.angularVelocity = {0.1, 0.5, 0.2}});
}

void buildPan(SceneBuilder& scene) {
    const auto waves = scene.addWaves();
    addShape(scene, makeSheetShape(8, 6), waves, Placement{.position = {0, 0, -5}});
    addShape(scene, makeBoxShape(0.5, 0.5, 0.5), waves, Placement{.position = {-0.4, 0, -2}});
    scene.place(scene.camera, {.angularVelocity = {0.1, 0.6, 0.3}});
}

void buildInside(SceneBuilder& scene) {
    scene::Material inside;
    inside.doubleSided = true;
    addShape(
        scene,
        makeBoxShape(1, 1, 1),
        scene.addMaterial(inside),
        Placement{.velocity = {0.2, 0.1, 0.3}, .angularVelocity = {0.3, 1.0, 0.2}}
    );
    addShape(scene, makeSheetShape(6, 5), scene.addWaves(), Placement{.position = {0, 0, -5}});
}

void buildThroughCamera(SceneBuilder& scene) {
    addShape(scene, makeSheetShape(6, 5), scene.addWaves(), Placement{.position = {0, 0, -5}});
    addShape(
        scene,
        generator::sphere(0.5f, 24, 12),
        scene.addWaves(),
        Placement{.position = {0.1, 0.05, -2.5}, .velocity = {0, 0, 6}}
    );
}

/// A grain of a millimetre close to the camera before a hill of a kilometre.
void buildMillimetresAndKilometres(SceneBuilder& scene) {
    scene.cameraSettings().near = 1e-4;
    const auto waves = scene.addWaves();
    addShape(
        scene,
        generator::sphere(0.001f, 24, 12),
        waves,
        Placement{.position = {0, 0, -0.004}, .velocity = {0.001, 0.0005, 0}}
    );
    addShape(
        scene,
        generator::sphere(1000.0f, 24, 12),
        waves,
        Placement{.position = {300, 100, -4000}, .velocity = {-400, 100, 0}}
    );
}

} // namespace

std::vector<HardCase> listPlaceCases() {
    std::vector<HardCase> cases = {
        {"NearPlane",
         "A vertex crosses the near plane and the camera",
         "A sheet flies at the camera and ends 5 m behind it; its corners have no place in the "
         "picture then.",
         measureNearPlane},
        makeSceneCase(
            "ThroughTheCamera",
            "A sphere flies through the camera",
            "At some instants of the exposure the camera is inside it.",
            buildThroughCamera
        ),
        makeSceneCase(
            "InsideAMover",
            "The camera inside a moving box",
            "A double-sided box turns and moves around the camera.",
            buildInside,
            kLit
        ),
        makeSceneCase(
            "SkyAlone",
            "Sky and nothing",
            "No entity at all under a camera that turns: no depth, and motion everywhere.",
            buildSky,
            kLit
        ),
        makeSceneCase(
            "CameraRotation",
            "A camera turns past a static world",
            "Nothing moves but the camera.",
            buildPan,
            kLit
        ),
        {"Spin",
         "More than half a turn in one exposure",
         "A bar turns 0.6, 1 and 10.3 times: what is stored as motion is not the way.",
         measureSpin},
        {"TenKilometresAway",
         "10 km from the origin",
         "Camera and entities 10 km from the origin, held against the same at the origin.",
         [](gpu::Device& device) { return measureFar(device, 1e4, 1e-3); }},
        {"ThousandKilometresAway",
         "1000 km from the origin",
         "Camera and entities 1000 km from the origin, held against the same at the origin.",
         [](gpu::Device& device) { return measureFar(device, 1e6, 1e-3); }},
        makeSceneCase(
            "MillimetresAndKilometres",
            "Millimetres and kilometres in one scene",
            "A grain of 1 mm at 4 mm before a sphere of 1 km at 4 km, both moving.",
            buildMillimetresAndKilometres
        ),
    };

    struct Shutter {
        const char* name;
        const char* title;
        const char* description;
        View view;
    };

    View hitch = during(10.0);
    hitch.seconds = 10.0;
    for (const Shutter& shutter : {
             Shutter{
                 "NoExposure",
                 "Exposure 0",
                 "Shutter open and close are one instant, as in a paused world.",
                 during(0.0)},
             Shutter{
                 "LongExposure",
                 "Exposure far longer than a frame",
                 "1000 seconds: motion of many screens.",
                 during(1000.0)},
             Shutter{
                 "Hitch", "A frame of 10 seconds", "An exposure of 10 s at the time 10 s.", hitch},
         })
        cases.push_back(makeSceneCase(
            shutter.name,
            shutter.title,
            shutter.description,
            [](SceneBuilder& scene) { addWallAndSphere(scene); },
            shutter.view
        ));
    return cases;
}

} // namespace shutter::stability
