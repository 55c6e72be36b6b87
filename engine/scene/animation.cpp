// SPDX-License-Identifier: MIT
#include "engine/scene/animation.h"

#include "engine/core/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>

namespace shutter::scene {

using math::dquat;
using math::dvec3;
using math::dvec4;

namespace {

constexpr size_t kPathCount = 3; // of AnimationPath

dquat toQuat(const dvec4& xyzw) {
    return dquat(xyzw.w, xyzw.x, xyzw.y, xyzw.z);
}

dvec4 toVec4(const dquat& rotation) {
    return dvec4(rotation.x, rotation.y, rotation.z, rotation.w);
}

/// Unit length for rotations; a quaternion of length 0 becomes the identity.
dvec4 finishValue(AnimationPath path, const dvec4& value) {
    return path == AnimationPath::Rotation ? toVec4(glm::normalize(toQuat(value))) : value;
}

dvec4 valueOfKey(const AnimationChannel& channel, size_t key) {
    const bool cubic = channel.interpolation == Interpolation::CubicSpline;
    return dvec4(channel.values[cubic ? 3 * key + 1 : key]);
}

dvec4 sampleLinear(const AnimationChannel& channel, size_t key, double share) {
    const dvec4 from = valueOfKey(channel, key);
    const dvec4 to = valueOfKey(channel, key + 1);
    if (channel.path != AnimationPath::Rotation)
        return glm::mix(from, to, share);
    // glm::slerp takes the shorter of the two arcs.
    return toVec4(glm::slerp(glm::normalize(toQuat(from)), glm::normalize(toQuat(to)), share));
}

/// Tangents of the file are per second.
dvec4 sampleCubic(const AnimationChannel& channel, size_t key, double share, double interval) {
    return interpolateHermite<dvec4>(
        {valueOfKey(channel, key),
         interval * dvec4(channel.values[3 * key + 2]),
         valueOfKey(channel, key + 1),
         interval * dvec4(channel.values[3 * (key + 1)])},
        share
    );
}

} // namespace

double clipSeconds(const AnimationClip& clip, bool loop, double seconds) {
    if (!loop || !(clip.duration > 0.0))
        return seconds;
    const double remainder = std::fmod(seconds, clip.duration);
    return remainder < 0.0 ? remainder + clip.duration : remainder;
}

bool isActive(const Playback& playback, uint32_t clip) {
    return clip >= playback.activeClips.size() || playback.activeClips[clip];
}

dvec4 sampleChannel(const AnimationChannel& channel, double seconds) {
    const size_t keyCount = channel.times.size();
    const bool cubic = channel.interpolation == Interpolation::CubicSpline;
    SHUTTER_CHECK(keyCount > 0, "an animation channel of node {} has no keys", channel.node);
    SHUTTER_CHECK_EQ(channel.values.size(), keyCount * (cubic ? 3 : 1));

    // Written so that NaN falls to the first key.
    if (!(seconds > double{channel.times.front()}))
        return finishValue(channel.path, valueOfKey(channel, 0));
    if (seconds >= double{channel.times.back()})
        return finishValue(channel.path, valueOfKey(channel, keyCount - 1));

    const auto next = std::upper_bound(channel.times.begin(), channel.times.end(), seconds);
    const auto key = static_cast<size_t>(std::distance(channel.times.begin(), next)) - 1;
    const double start = channel.times[key];
    const double interval = double{channel.times[key + 1]} - start;
    const double share = (seconds - start) / interval;
    dvec4 value;
    switch (channel.interpolation) {
    case Interpolation::Step:
        value = valueOfKey(channel, key);
        break;
    case Interpolation::Linear:
        value = sampleLinear(channel, key, share);
        break;
    case Interpolation::CubicSpline:
        value = sampleCubic(channel, key, share, interval);
        break;
    }
    return finishValue(channel.path, value);
}

math::Transform sampleAnimated(
    const Assets& assets,
    const Playback& playback,
    const Animated& animated,
    const math::Transform& rest,
    double seconds
) {
    // Who drives each property is settled first, so that only the winners are sampled.
    std::array<std::optional<Animated::Channel>, kPathCount> drivers;
    for (const Animated::Channel& reference : animated.channels) {
        SHUTTER_CHECK(reference.clip < assets.clips.size(), "no clip {}", reference.clip);
        const AnimationClip& clip = assets.clips[reference.clip];
        SHUTTER_CHECK(
            reference.channel < clip.channels.size(),
            "clip '{}' has no channel {}",
            clip.name,
            reference.channel
        );
        if (!isActive(playback, reference.clip))
            continue;
        auto& driver = drivers[static_cast<size_t>(clip.channels[reference.channel].path)];
        if (!driver || reference.clip >= driver->clip)
            driver = reference;
    }

    math::Transform pose = rest;
    for (const std::optional<Animated::Channel>& driver : drivers) {
        if (!driver)
            continue;
        const AnimationClip& clip = assets.clips[driver->clip];
        const AnimationChannel& channel = clip.channels[driver->channel];
        const dvec4 value = sampleChannel(channel, clipSeconds(clip, playback.loop, seconds));
        switch (channel.path) {
        case AnimationPath::Translation:
            pose.translation = dvec3(value);
            break;
        case AnimationPath::Rotation:
            pose.rotation = toQuat(value);
            break;
        case AnimationPath::Scale:
            pose.scale = dvec3(value);
            break;
        }
    }
    return pose;
}

} // namespace shutter::scene
