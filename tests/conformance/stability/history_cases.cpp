// SPDX-License-Identifier: MIT
// What has no past in a frame, and frames of no and of great length. Each picture must be that of a
// scene in which nothing of the kind happened.
#include "engine/scene/history.h"
#include "tests/conformance/stability/case_lists.h"
#include "tests/conformance/stability/pictures.h"

#include <functional>
#include <string>
#include <utility>

namespace shutter::stability {

namespace {

using math::dvec3;

/// Inside the frame in each phase of the shutter: shortly before the raster instant.
constexpr double kEvent = -0.01;
/// As the shutter opens: what appears later is there for the rest of the exposure alone.
constexpr double kOpening = -0.4999;

const View kView{.background = math::vec3(0.1f, 0.2f, 0.3f), .ambient = math::vec3(0.3f)};

/// A change to the stage. \param sphere its mover
using Change = std::function<void(SceneBuilder& scene, ecs::Entity sphere)>;

/// Every method's pictures by `drawer`, held against the sharp one by `expected`. \param check what
/// the row of the comparison is called
core::Result<Measurements>
measureAgainstSharp(Drawer& drawer, const View& view, Drawer& expected, std::string check) {
    auto found = measureEveryMethod(drawer, view);
    if (!found)
        return found;
    const auto sharp = expected.draw("sharp", kView);
    if (!sharp)
        return sharp.error();
    Worst worst;
    for (const game::MethodInfo& method : game::listMethods()) {
        const auto frame = drawer.draw(method.name, view);
        if (!frame)
            return frame.error();
        addDifference(worst, frame.value().color, sharp.value().color, method.name);
    }
    // Rays shade at their own hit, a few float steps from the raster's place.
    found.value().push_back(describe(worst, std::move(check), "brightness", 1.0 / 255.0));
    return found;
}

/// The pictures of the changed stage against the sharp picture of another one.
core::Result<Measurements> measureChange(
    gpu::Device& device, const Change& happened, const Change& instead, const View& view
) {
    SceneBuilder scene = makeEmptyScene();
    happened(scene, addWallAndSphere(scene));
    SceneBuilder other = makeEmptyScene();
    instead(other, addWallAndSphere(other));
    Drawer drawer(device, std::move(scene));
    Drawer otherDrawer(device, std::move(other));
    return measureAgainstSharp(drawer, view, otherDrawer, "the sharp picture, by every method");
}

HardCase makeCase(
    const char* name,
    const char* title,
    const char* description,
    Change happened,
    Change instead = [](SceneBuilder&, ecs::Entity) {},
    View view = kView
) {
    return {name, title, description, [=](gpu::Device& device) {
                return measureChange(device, happened, instead, view);
            }};
}

math::Transform elsewhere() {
    math::Transform transform;
    transform.translation = {-0.6, 0.3, -2.2};
    return transform;
}

void teleportSphere(SceneBuilder& scene, ecs::Entity sphere) {
    scene::teleport(scene.world, sphere, elsewhere(), kEvent);
}

/// Another view: a step aside and a turn.
void cutCamera(SceneBuilder& scene) {
    math::Transform transform;
    transform.translation = {0.4, 0.2, 0.3};
    transform.rotation = glm::angleAxis(0.3, dvec3(0, 1, 0));
    scene::cutTo(scene.world, scene.camera, transform, kEvent);
}

/// The sphere is gone, and so is its light on the picture.
core::Result<Measurements> measureDespawn(gpu::Device& device) {
    SceneBuilder scene = makeEmptyScene();
    const ecs::Entity sphere = addWallAndSphere(scene);
    Drawer drawer(device, std::move(scene));
    // Drawn once with it: whatever the renderer keeps of a frame must not come back.
    if (auto before = drawer.draw("hybrid", kView); !before)
        return before.error();
    scene::despawn(drawer.world(), sphere);
    SceneBuilder without = makeEmptyScene();
    const ecs::Entity other = addWallAndSphere(without);
    scene::hide(without.world, other);
    Drawer otherDrawer(device, std::move(without));
    return measureAgainstSharp(
        drawer, kView, otherDrawer, "no hole and no trace of it, by every method"
    );
}

/// A hitch of 10 s with a capped shutter is a frame of the reference's length.
core::Result<Measurements> measureCappedHitch(gpu::Device& device) {
    SceneBuilder scene = makeEmptyScene();
    addWallAndSphere(scene);
    Drawer drawer(device, std::move(scene));
    View hitch = kView;
    hitch.mode = scene::ShutterMode::Capped;
    hitch.frameSeconds = 10.0;
    auto found = measureEveryMethod(drawer, hitch);
    if (!found)
        return found;
    View reference = hitch;
    reference.frameSeconds = 1.0 / scene::CameraShutter{}.referenceFps;
    Worst worst;
    for (const game::MethodInfo& method : game::listMethods()) {
        const auto frame = drawer.draw(method.name, hitch);
        const auto expected = drawer.draw(method.name, reference);
        if (!frame || !expected)
            return frame ? expected.error() : frame.error();
        addDifference(worst, frame.value().color, expected.value().color, method.name);
    }
    found.value().push_back(
        describe(worst, "as at the reference rate, by every method", "brightness", 0.0)
    );
    return found;
}

} // namespace

std::vector<HardCase> listHistoryCases() {
    View paused = kView;
    paused.frameSeconds = 0.0;
    return {
        makeCase(
            "Spawn",
            "An entity that was just made",
            "The mover appears as the shutter opens: nothing streaks in from anywhere.",
            [](SceneBuilder& scene, ecs::Entity sphere) {
                scene::appear(scene.world, sphere, kOpening);
            }
        ),
        {"Despawn",
         "An entity that was just destroyed",
         "The mover is gone, after a frame that showed it.",
         measureDespawn},
        makeCase(
            "Teleport",
            "A teleport within the exposure",
            "The mover is put elsewhere within the frame: no streak from its old place.",
            teleportSphere,
            teleportSphere
        ),
        makeCase(
            "CameraCut",
            "A camera cut within the exposure",
            "The camera is put elsewhere while the sphere moves: the whole picture stands still.",
            [](SceneBuilder& scene, ecs::Entity) { cutCamera(scene); },
            [](SceneBuilder& scene, ecs::Entity) { cutCamera(scene); }
        ),
        makeCase(
            "WorldBegins",
            "The first frame of a world",
            "The world was loaded within the frame: it has no past.",
            [](SceneBuilder& scene, ecs::Entity) { scene.world.startSeconds = kEvent; }
        ),
        makeCase(
            "Paused",
            "A frame of no length",
            "The frame time is 0: a paused world does not move, whatever the exposure.",
            [](SceneBuilder&, ecs::Entity) {},
            [](SceneBuilder&, ecs::Entity) {},
            paused
        ),
        {"CappedHitch",
         "A frame of 10 seconds, capped",
         "The shutter stays open for its angle at the reference rate, not for half of 10 s.",
         measureCappedHitch},
    };
}

} // namespace shutter::stability
