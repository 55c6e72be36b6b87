// SPDX-License-Identifier: MIT
#include "tests/gpu/checked_shot.h"

#include "engine/flythrough/flythrough.h"
#include "engine/scene/camera.h"
#include "engine/scene/exposure_motion.h"

#include <fmt/format.h>

#include <filesystem>
#include <unistd.h>
#include <utility>

namespace shutter::test {

namespace {

namespace fs = std::filesystem;

core::Status useCamera(const CheckScene& scene, game::Shot& shot) {
    const auto flight = flythrough::parseFlythrough(scene.keys, "keys");
    if (!flight)
        return flight.error();
    auto& registry = shot.world.registry;
    const auto shutter = registry.get<scene::CameraShutter>(shot.camera);
    shot.camera = flythrough::addFlythroughCamera(shot.world, flight.value());
    registry.add(shot.camera, scene::CameraShutter(shutter));
    if (scene.orthographicYMag == 0.0)
        return {};
    auto& camera = registry.get<scene::Camera>(shot.camera);
    camera.kind = scene::CameraKind::Orthographic;
    camera.yMag = scene.orthographicYMag;
    camera.far = 100.0;
    if (registry.has<scene::LensMotion>(shot.camera))
        registry.remove<scene::LensMotion>(shot.camera);
    return {};
}

} // namespace

core::Result<CheckedShot>
loadCheckedShot(const CheckScene& scene, const math::uvec2& sizePx, double exposureSeconds) {
    fs::path file = fs::path(SHUTTER_SHARED_DIR) / "scenes" / scene.path;
    if (scene.build) {
        file = fs::temp_directory_path() / fmt::format("checker_{}_{}.glb", scene.name, ::getpid());
        if (const std::string error = scene.build().write(file); !error.empty())
            return core::Error{error};
    }
    game::ShotArguments arguments;
    arguments.scene = file.string();
    arguments.unlit = true;
    arguments.shutter = game::makeShutterArguments(exposureSeconds, "end");
    arguments.size = {sizePx.x, sizePx.y};
    CheckedShot made;
    auto options = game::interpret(arguments);
    if (!options)
        return options.error();
    made.options = std::move(options).value();
    auto shot = game::loadShot(made.options);
    if (scene.build)
        fs::remove(file);
    if (!shot)
        return shot.error();
    made.shot = std::move(shot).value();
    SHUTTER_TRY(useCamera(scene, made.shot));
    if (scene.prepare)
        scene.prepare(made.shot.world);
    return made;
}

motion_blur::HostCameras tellCameras(const scene::World& world, const extract::ViewRequest& view) {
    const scene::ExposureMotion moves(world, view.camera, view.exposure);
    const auto& camera = world.registry.get<scene::Camera>(view.camera);
    const auto viewAt = [&](double s) { return glm::inverse(moves.worldFromCamera(s)); };
    const auto clipAt = [&](double s) {
        return extract::makeProjection(camera, moves.cameraYFov(s), view);
    };
    motion_blur::HostCameras cameras;
    cameras.areGiven = true;
    cameras.viewFromWorld = viewAt(1.0);
    cameras.clipFromView = clipAt(1.0);
    cameras.viewFromWorldBefore = viewAt(0.0);
    cameras.clipFromViewBefore = clipAt(0.0);
    return cameras;
}

} // namespace shutter::test
