// SPDX-License-Identifier: MIT
#include "engine/scene/clip_jumps.h"

#include "engine/scene/path.h"
#include "engine/scene/placing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace shutter::scene {

namespace {

/// Farther than rounding takes a time on its way into the clip (clipSeconds()).
double slackAt(double seconds, double duration) {
    return 16.0 * std::numeric_limits<double>::epsilon() *
           std::max(std::abs(seconds), std::abs(duration));
}

/// Keys of one property.
struct Keys {
    std::span<const float> times;
    std::span<const float> values; ///< as many for each key
    Interpolation interpolation = Interpolation::Linear;

    [[nodiscard]] bool change(size_t key) const {
        const size_t width = values.size() / times.size();
        const auto after = values.subspan(key * width, width);
        return !std::equal(after.begin(), after.end(), values.begin() + (key - 1) * width);
    }
};

class Finder {
  public:
    Finder(const Playback& playback, const TimeSpan& span, double longestSeconds)
        : mPlayback(playback), mSpan(span), mLongestSeconds(longestSeconds) {}

    [[nodiscard]] std::vector<Jump> find(const AnimationClip& clip, const Keys& keys) const {
        std::vector<Jump> jumps;
        if (keys.times.size() < 2)
            return jumps;
        if (!mPlayback.loop || !(clip.duration > 0.0)) {
            addRound(keys, 0.0, clip.duration, jumps);
            return jumps;
        }
        if ((mSpan.until - mSpan.after) / clip.duration > ClipJumps::kMaxRounds)
            return jumps;
        const double first = std::floor(mSpan.after / clip.duration);
        const double last = std::floor(mSpan.until / clip.duration);
        for (double round = first; round <= last; ++round) {
            const double start = round * clip.duration;
            addRound(keys, start, clip.duration, jumps);
            add({start, start}, clip.duration, jumps);
        }
        return jumps;
    }

  private:
    /// \param start of the clip's time, seconds
    void addRound(const Keys& keys, double start, double duration, std::vector<Jump>& jumps) const {
        const auto first = std::lower_bound(
            keys.times.begin() + 1,
            keys.times.end(),
            mSpan.after - start - mLongestSeconds - slackAt(start, duration),
            [](float time, double wanted) { return double{time} < wanted; }
        );
        for (auto key = static_cast<size_t>(first - keys.times.begin()); key < keys.times.size();
             ++key) {
            const double at = start + double{keys.times[key]};
            const double before = start + double{keys.times[key - 1]};
            if (before > mSpan.until)
                break;
            if (!keys.change(key))
                continue;
            if (keys.interpolation == Interpolation::Step)
                add({at, at}, duration, jumps);
            else if (at - before <= mLongestSeconds)
                add({before, at}, duration, jumps);
        }
    }

    void add(const Jump& exact, double duration, std::vector<Jump>& jumps) const {
        const Jump jump{
            exact.before - slackAt(exact.before, duration),
            exact.after + slackAt(exact.after, duration)};
        if (jump.after >= mSpan.after && jump.before <= mSpan.until)
            jumps.push_back(jump);
    }

    const Playback& mPlayback;
    TimeSpan mSpan;
    double mLongestSeconds;
};

std::span<const float> flatten(const std::vector<math::vec4>& values) {
    static_assert(sizeof(math::vec4) == 4 * sizeof(float));
    if (values.empty())
        return {};
    return {&values.front().x, 4 * values.size()};
}

/// The clip of a channel, where it plays.
const AnimationClip* clipOf(const World& world, const Animated::Channel& reference) {
    return isActive(world.playback, reference.clip) ? &world.assets.clips.at(reference.clip)
                                                    : nullptr;
}

std::vector<Jump> findOwnJumps(const World& world, const Animated& animated, const Finder& finder) {
    std::vector<Jump> jumps;
    for (const Animated::Channel& reference : animated.channels)
        if (const AnimationClip* clip = clipOf(world, reference)) {
            const AnimationChannel& channel = clip->channels.at(reference.channel);
            const auto found =
                finder.find(*clip, {channel.times, flatten(channel.values), channel.interpolation});
            jumps.insert(jumps.end(), found.begin(), found.end());
        }
    return jumps;
}

} // namespace

std::vector<Jump> findPlaceJumps(
    const World& world, ecs::Entity entity, const TimeSpan& span, double longestSeconds
) {
    const Finder finder(world.playback, span, longestSeconds);
    std::vector<Jump> jumps;
    (void)findUpwards(world, entity, [&](ecs::Entity at) {
        if (const auto* animated = findPlacing<Animated>(world.registry, at)) {
            const auto found = findOwnJumps(world, *animated, finder);
            jumps.insert(jumps.end(), found.begin(), found.end());
        }
        if (const auto* path = findPlacing<PathMotion>(world.registry, at))
            for (const PathKey& key : path->keys)
                if (key.cut && span.contains(key.seconds))
                    jumps.push_back({std::nextafter(key.seconds, span.after), key.seconds});
        return false;
    });
    std::sort(jumps.begin(), jumps.end());
    return jumps;
}

ClipJumps::ClipJumps(const World& world, const TimeSpan& span, double longestSeconds) {
    const Finder finder(world.playback, span, longestSeconds);
    const auto add = [&](Jumps& known, ecs::Entity entity, std::vector<Jump> found) {
        if (found.empty())
            return;
        std::vector<Jump>& jumps = known[entity.index];
        jumps.insert(jumps.end(), found.begin(), found.end());
    };
    for (auto [entity, animated] : world.registry.view<Animated>())
        add(mPlaces, entity, findOwnJumps(world, animated, finder));
    for (auto [entity, morph] : world.registry.view<MorphWeights>())
        for (const Animated::Channel& reference : morph.channels)
            if (const AnimationClip* clip = clipOf(world, reference)) {
                const WeightChannel& channel = clip->weightChannels.at(reference.channel);
                const Keys keys{channel.times, channel.values, channel.interpolation};
                add(mShapes, entity, finder.find(*clip, keys));
            }
}

void ClipJumps::addPlaces(const World& world, ecs::Entity entity, std::vector<Jump>& jumps) const {
    (void)findUpwards(world, entity, [&](ecs::Entity at) {
        const auto found = mPlaces.find(at.index);
        if (found != mPlaces.end())
            jumps.insert(jumps.end(), found->second.begin(), found->second.end());
        return false;
    });
}

std::vector<Jump> ClipJumps::of(const World& world, ecs::Entity entity) const {
    std::vector<Jump> jumps;
    if (const auto* skinned = world.registry.find<Skinned>(entity))
        for (const ecs::Entity joint : skinned->joints)
            addPlaces(world, joint, jumps);
    else
        addPlaces(world, entity, jumps);
    if (const auto found = mShapes.find(entity.index); found != mShapes.end())
        jumps.insert(jumps.end(), found->second.begin(), found->second.end());
    // The joints of a skin often have all their keys at the same times.
    std::sort(jumps.begin(), jumps.end());
    jumps.erase(std::unique(jumps.begin(), jumps.end()), jumps.end());
    return jumps;
}

} // namespace shutter::scene
