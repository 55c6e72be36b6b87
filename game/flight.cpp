// SPDX-License-Identifier: MIT
#include "game/flight.h"

#include "engine/io/content_hash.h"
#include "engine/scene/ancestors.h"
#include "game/shot.h"

#include <cmath>
#include <optional>
#include <set>

namespace shutter::game {

namespace {

using core::makeError;
using core::Status;

/// The frame times that are nearest to a flight's ends may be off by a rounding.
constexpr double kFrameSlack = 1.0e-6;

/// Every frame whose time lies in the flight, both ends included; at least one.
Status planWholeFlight(double from, double to, RenderOptions& options) {
    const double first = std::ceil(from * options.fps - kFrameSlack);
    const double last = std::max(std::floor(to * options.fps + kFrameSlack), first);
    return planFrames("--flythrough", first, last, options);
}

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

std::optional<uint32_t> findClip(const scene::World& world, const std::string& name) {
    for (uint32_t i = 0; i < world.assets.clips.size(); ++i)
        if (world.assets.clips[i].name == name)
            return i;
    return std::nullopt;
}

} // namespace

Status loadFlythrough(const RenderArguments& arguments, RenderOptions& options) {
    if (arguments.flythrough.empty() || !options.flythroughClip.empty())
        return {};
    auto read = flythrough::readFlythrough(arguments.flythrough);
    if (!read)
        return makeError("--flythrough: {}", read.error().message);
    auto hash = io::computeFileHash(arguments.flythrough);
    if (!hash)
        return makeError("--flythrough: {}", hash.error().message);
    options.flythroughHash = hash.value();
    options.flythrough = std::move(read).value();
    const flythrough::Flythrough& flight = *options.flythrough;
    if (!arguments.isFpsTyped) {
        options.fps = flight.fps;
        options.frameSeconds = 1.0 / options.fps;
    }
    if (!arguments.frames.empty()) {
        const int first = options.firstFrame;
        return planFrames(
            "--frames", first, first + double(options.frameTimes.size()) - 1.0, options
        );
    }
    return planWholeFlight(flight.keys.front().seconds, flight.keys.back().seconds, options);
}

core::Result<ecs::Entity> chooseClipCamera(scene::World& world, const RenderOptions& options) {
    const std::string& name = options.flythroughClip;
    const auto clip = findClip(world, name);
    if (!clip) {
        std::string names;
        for (const scene::AnimationClip& each : world.assets.clips)
            names += (names.empty() ? "" : ", ") + each.name;
        return makeError(
            "{}: --flythrough clip:{} is none of its clips ({})",
            options.scene.string(),
            name,
            names.empty() ? "it has none" : names
        );
    }
    std::optional<ecs::Entity> found;
    if (!options.camera.empty()) {
        auto named = findCamera(world, options);
        if (!named)
            return named;
        if (listClipsOf(world, named.value()).contains(*clip))
            found = named.value();
    } else {
        for (const ecs::Entity camera : world.cameras)
            if (!found && listClipsOf(world, camera).contains(*clip))
                found = camera;
    }
    if (!found)
        return makeError(
            "{}: --flythrough clip:{} moves {}",
            options.scene.string(),
            name,
            options.camera.empty() ? "no camera" : fmt::format("no camera '{}'", options.camera)
        );
    for (const uint32_t other : listClipsOf(world, *found))
        world.playback.activeClips[other] = other == *clip;
    return *found;
}

Status planClipFrames(const scene::World& world, RenderOptions& options) {
    if (options.flythroughClip.empty() || !options.frameTimes.empty())
        return {};
    const auto clip = findClip(world, options.flythroughClip);
    SHUTTER_CHECK(clip.has_value(), "the clip was found before");
    return planWholeFlight(0.0, world.assets.clips[*clip].duration, options);
}

} // namespace shutter::game
