// SPDX-License-Identifier: MIT
#include "game/shot/shot.h"

#include "engine/core/log.h"
#include "engine/flythrough/time_ramp.h"
#include "engine/gltf/gltf_loader.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/camera.h"
#include "engine/scene/lens.h"
#include "engine/scene/world.h"
#include "game/shot/clips.h"
#include "game/shot/picture_features.h"
#include "game/shot/surroundings.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <system_error>
#include <vector>

namespace shutter::game {

namespace {

using core::makeError;

std::string nameOf(const scene::World& world, ecs::Entity entity) {
    const auto* name = world.registry.find<scene::Name>(entity);
    return name ? name->value : std::string();
}

double findFramingTime(const ShotOptions& options) {
    return options.framingSeconds.value_or(options.frameTimes.front());
}

core::Result<ecs::Entity> chooseCamera(scene::World& world, const ShotOptions& options) {
    if (options.flythrough)
        return flythrough::addFlythroughCamera(world, *options.flythrough);
    if (!options.flythroughClip.empty())
        return chooseClipCamera(world, options);
    return findCamera(world, options);
}

/// A scene without lights gets a sun from above left of the world's axes.
void lightUnlitScene(scene::World& world) {
    for (auto [entity, light] : world.registry.view<scene::Light>()) {
        (void)entity;
        (void)light;
        return;
    }
    const ecs::Entity sun = world.registry.create();
    scene::Light light;
    light.kind = scene::LightKind::Directional;
    light.intensity = 3.0f;
    world.registry.add(sun, light);
    math::Transform transform;
    transform.rotation = math::dquat(math::dvec3(-0.9, 0.5, 0.0));
    world.registry.add(sun, scene::LocalTransform{transform});
}

/// The frame times that are nearest to a flight's ends may be off by a rounding.
constexpr double kFrameSlack = 1.0e-6;
constexpr int kMaxFrames = 1000000;

/// Clips that move the camera or one of its parents.
std::set<uint32_t> listClipsOf(const scene::World& world, ecs::Entity camera) {
    std::set<uint32_t> clips;
    (void)scene::findUpwards(world, camera, [&](ecs::Entity at) {
        if (const auto* animated = world.registry.find<scene::Animated>(at))
            for (const scene::Animated::Channel& channel : animated->channels)
                clips.insert(channel.clip);
        return false;
    });
    return clips;
}

/// Error: --camera names none of the cameras.
core::Result<ecs::Entity> findNamedCamera(const scene::World& world, const ShotOptions& options) {
    const std::string& wanted = options.camera;
    std::string names;
    for (size_t i = 0; i < world.cameras.size(); ++i) {
        const std::string& name = world.registry.get<scene::Camera>(world.cameras[i]).name;
        const std::string entityName = nameOf(world, world.cameras[i]);
        if (name == wanted || entityName == wanted)
            return world.cameras[i];
        names += fmt::format("{}{}: {}", i ? ", " : "", i, name.empty() ? entityName : name);
    }
    size_t index = 0;
    const auto [end, problem] =
        std::from_chars(wanted.data(), wanted.data() + wanted.size(), index);
    if (problem == std::errc() && end == wanted.data() + wanted.size() &&
        index < world.cameras.size())
        return world.cameras[index];
    return makeError(
        "{}: --camera '{}' is none of its cameras ({})",
        options.scene.string(),
        wanted,
        names.empty() ? "it has none" : names
    );
}

/// A clip and the camera that it moves.
struct ClipFlight {
    uint32_t clip = 0;
    ecs::Entity camera;
};

/// Finds the first clip that --flythrough names and that moves --camera's camera, or any.
core::Result<ClipFlight> findClipFlight(const scene::World& world, const ShotOptions& options) {
    const std::vector<uint32_t> clips = findClips(world, options.flythroughClip);
    if (clips.empty())
        return makeError(
            "{}: --flythrough clip:{} is none of its clips ({})",
            options.scene.string(),
            options.flythroughClip,
            listClips(world)
        );
    std::vector<ecs::Entity> cameras = world.cameras;
    if (!options.camera.empty()) {
        auto named = findNamedCamera(world, options);
        if (!named)
            return named.error();
        cameras = {named.value()};
    }
    for (const uint32_t clip : clips)
        for (const ecs::Entity camera : cameras)
            if (listClipsOf(world, camera).contains(clip))
                return ClipFlight{clip, camera};
    return makeError(
        "{}: --flythrough clip:{} moves {}",
        options.scene.string(),
        options.flythroughClip,
        options.camera.empty() ? "no camera" : fmt::format("no camera '{}'", options.camera)
    );
}

/// Gives the camera the lens that the options name. Error: it has none that they could change.
core::Status setLens(scene::World& world, ecs::Entity camera, const ShotOptions& options) {
    // A player's cameras get their lenses later, and any of them may be looked through.
    const bool focuses =
        options.focusDistance || (options.usesLens && !options.focusEntity.empty());
    if (!options.fStop && !focuses)
        return {};
    const char* option = options.fStop ? "--fstop" : nameFocusOption(options);
    const bool closes = options.fStop == 0.0 && !focuses;
    if (closes && !scene::hasLens(world, camera))
        return {};
    if (world.registry.get<scene::Camera>(camera).kind == scene::CameraKind::Orthographic)
        return makeError("{}: an orthographic camera has no focal length, so no lens", option);
    const auto* own = world.registry.find<scene::CameraLens>(camera);
    scene::CameraLens lens = own ? *own : scene::CameraLens{};
    lens.fStop = options.fStop.value_or(lens.fStop);
    lens.focusDistance = options.focusDistance.value_or(lens.focusDistance);
    world.registry.add(camera, lens);
    if (options.focusDistance)
        world.registry.remove<scene::AutoFocus>(camera);
    if (auto* motion = world.registry.find<scene::FocusMotion>(camera))
        for (scene::FocusKey& key : motion->keys) {
            if (options.fStop)
                key.fStop.reset();
            if (options.focusDistance)
                key.focusDistance.reset();
        }
    if (focuses && !options.fStop && lens.fStop == 0.0 && !scene::hasLens(world, camera))
        return makeError("{} needs --fstop: the camera is a pinhole", option);
    return {};
}

} // namespace

const char* nameFocusOption(const ShotOptions& options) {
    return options.focusEntity.empty() ? "--focus" : "--focus-entity";
}

core::Status focusOnEntity(
    scene::World& world, ecs::Entity camera, const ShotOptions& options, const std::string& source
) {
    if (options.focusEntity.empty())
        return {};
    std::vector<ecs::Entity> named;
    for (auto [entity, name] : world.registry.view<const scene::Name>())
        if (name.value == options.focusEntity)
            named.push_back(entity);
    if (named.size() != 1)
        return makeError(
            "{}: --focus-entity '{}' is the name of {}",
            source,
            options.focusEntity,
            named.empty() ? "no node" : "several nodes"
        );
    std::vector<ecs::Entity> cameras = world.cameras;
    cameras.push_back(camera);
    for (const ecs::Entity one : cameras) {
        const auto* own = world.registry.find<scene::AutoFocus>(one);
        scene::AutoFocus focus = own ? *own : scene::AutoFocus{};
        focus.target = named.front();
        world.registry.add(one, focus);
        if (auto* motion = world.registry.find<scene::FocusMotion>(one))
            for (scene::FocusKey& key : motion->keys)
                key.focusDistance.reset();
    }
    return {};
}

core::Result<ecs::Entity> findCamera(scene::World& world, const ShotOptions& options) {
    if (!options.camera.empty())
        return findNamedCamera(world, options);
    if (!world.cameras.empty())
        return world.cameras.front();
    const double aspect = double(options.width) / options.height;
    return scene::addFramingCamera(world, aspect, findFramingTime(options));
}

core::Result<Shot> loadShot(const ShotOptions& options) {
    auto loaded = gltf::loadGltf(options.scene, {.reach = options.reach}, listExtraReaders());
    if (!loaded)
        return loaded.error();
    for (const std::string& warning : loaded.value().warnings)
        core::logWarning("{}: {}", options.scene.string(), warning);
    Shot shot;
    shot.world = std::move(loaded.value().world);
    std::optional<uint32_t> flying;
    if (!options.flythroughClip.empty()) {
        const auto flight = findClipFlight(shot.world, options);
        if (!flight)
            return flight.error();
        flying = flight.value().clip;
    }
    SHUTTER_TRY(selectClips(shot.world, options, flying));
    const bool hasCamera = !shot.world.cameras.empty() || options.flythrough;
    auto camera = chooseCamera(shot.world, options);
    if (!camera)
        return camera.error();
    shot.camera = camera.value();
    if (!hasCamera)
        shot.framedAt = findFramingTime(options);
    shot.world.registry.add(shot.camera, options.shutter);
    SHUTTER_TRY(focusOnEntity(shot.world, shot.camera, options, options.scene.string()));
    SHUTTER_TRY(setLens(shot.world, shot.camera, options));
    if (!options.fStop && shot.world.registry.has<scene::FocusMotion>(shot.camera) &&
        !scene::hasLens(shot.world, shot.camera))
        core::logWarning("focusDistance of the flythrough has no effect without fStop: the camera "
                         "is a pinhole");
    // An environment picture lights a scene; a sky follows the scene's sun.
    if (options.environment.empty() && !shot.world.assets.environment)
        lightUnlitScene(shot.world);
    SHUTTER_TRY(addSurroundings(shot.world, options));
    return shot;
}

extract::ViewRequest makeView(const Shot& shot, const ShotOptions& options, double seconds) {
    extract::ViewRequest view;
    view.camera = shot.camera;
    view.exposure = computeExposure(
        options, shot.world.registry.get<scene::CameraShutter>(shot.camera), seconds
    );
    view.width = options.width;
    view.height = options.height;
    view.frameFit = options.picture.frameFit;
    view.background = options.background;
    view.ambient = options.ambient;
    view.unlit = options.unlit;
    view.unseenMatters = unseenMatters(options.picture.features);
    return view;
}

scene::ExposureInterval
computeExposure(const ShotOptions& options, scene::CameraShutter shutter, double seconds) {
    if (!options.flythrough)
        return scene::computeExposure(shutter, seconds, options.frameSeconds);
    if (options.isFlythroughShutter)
        flythrough::applyShutter(*options.flythrough, seconds, shutter);
    return flythrough::TimeRamp(*options.flythrough)
        .computeExposure(shutter, seconds, options.frameSeconds);
}

core::Status planFrames(const char* option, double first, double last, ShotOptions& options) {
    const core::FrameRate& fps = options.fps;
    if (!(last - first < kMaxFrames))
        return makeError("{}: {} frames are too many", option, last - first + 1.0);
    // Written so that NaN fails.
    if (!(fps.secondsOf(std::max(std::abs(first), std::abs(last))) <= kMaxSeconds))
        return makeError(
            "{}: frames {}:{} at {} a second lie beyond {} seconds",
            option,
            first,
            last,
            core::describe(fps),
            kMaxSeconds
        );
    if (!(std::max(std::abs(first), std::abs(last)) < double(std::numeric_limits<int>::max())))
        return makeError("{}: frames {:.0f}:{:.0f} have no numbers", option, first, last);
    options.firstFrame = int(first);
    options.frameTimes.clear();
    for (double frame = first; frame <= last; ++frame)
        options.frameTimes.push_back(fps.secondsOf(frame));
    if (!options.flythrough)
        return {};
    const flythrough::TimeRamp ramp(*options.flythrough);
    for (double& seconds : options.frameTimes) {
        seconds = ramp.sceneFromFilm(seconds);
        if (!(std::abs(seconds) <= kMaxSeconds))
            return makeError(
                "{}: by the flythrough's timeScale, frames {}:{} lie beyond {} seconds of the "
                "scene",
                option,
                first,
                last,
                kMaxSeconds
            );
    }
    return {};
}

core::Status planWholeFlight(double from, double to, ShotOptions& options) {
    if (options.flythrough) {
        const flythrough::TimeRamp ramp(*options.flythrough);
        from = ramp.filmFromScene(from);
        to = ramp.filmFromScene(to);
    }
    const double first = std::ceil(from * options.fps.perSecond() - kFrameSlack);
    const double last = std::max(std::floor(to * options.fps.perSecond() + kFrameSlack), first);
    return planFrames("--flythrough", first, last, options);
}

core::Result<ecs::Entity> chooseClipCamera(scene::World& world, const ShotOptions& options) {
    const auto flight = findClipFlight(world, options);
    if (!flight)
        return flight.error();
    const auto [clip, camera] = flight.value();
    for (const uint32_t other : listClipsOf(world, camera))
        world.playback.activeClips[other] = other == clip;
    return camera;
}

core::Status planClipFrames(const scene::World& world, ShotOptions& options) {
    if (options.flythroughClip.empty() || !options.frameTimes.empty())
        return {};
    const auto flight = findClipFlight(world, options);
    SHUTTER_CHECK(flight.ok(), "the clip was found before");
    return planWholeFlight(0.0, world.assets.clips[flight.value().clip].duration, options);
}

} // namespace shutter::game
