// SPDX-License-Identifier: MIT
#include "game/shot/flight.h"

#include "engine/scene/world.h"
#include "game/shot/shot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

namespace shutter::game {

namespace {

using core::makeError;

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

std::optional<uint32_t> findClip(const scene::World& world, const std::string& name) {
    for (uint32_t i = 0; i < world.assets.clips.size(); ++i)
        if (world.assets.clips[i].name == name)
            return i;
    return std::nullopt;
}

} // namespace

core::Status planFrames(const char* option, double first, double last, ShotOptions& options) {
    const double fps = options.fps;
    if (!(last - first < kMaxFrames))
        return makeError("{}: {} frames are too many", option, last - first + 1.0);
    // Written so that NaN fails.
    if (!(std::max(std::abs(first), std::abs(last)) / fps <= kMaxSeconds))
        return makeError(
            "{}: frames {}:{} at {} a second lie beyond {} seconds",
            option,
            first,
            last,
            fps,
            kMaxSeconds
        );
    if (!(std::max(std::abs(first), std::abs(last)) < double(std::numeric_limits<int>::max())))
        return makeError("{}: frames {:.0f}:{:.0f} have no numbers", option, first, last);
    options.firstFrame = int(first);
    options.frameTimes.clear();
    for (double frame = first; frame <= last; ++frame)
        options.frameTimes.push_back(frame / fps);
    return {};
}

core::Status planWholeFlight(double from, double to, ShotOptions& options) {
    const double first = std::ceil(from * options.fps - kFrameSlack);
    const double last = std::max(std::floor(to * options.fps + kFrameSlack), first);
    return planFrames("--flythrough", first, last, options);
}

core::Result<ecs::Entity> chooseClipCamera(scene::World& world, const ShotOptions& options) {
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

core::Status planClipFrames(const scene::World& world, ShotOptions& options) {
    if (options.flythroughClip.empty() || !options.frameTimes.empty())
        return {};
    const auto clip = findClip(world, options.flythroughClip);
    SHUTTER_CHECK(clip.has_value(), "the clip was found before");
    return planWholeFlight(0.0, world.assets.clips[*clip].duration, options);
}

} // namespace shutter::game
