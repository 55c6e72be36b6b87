// SPDX-License-Identifier: MIT
#include "game/shot/clips.h"

#include "engine/core/log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <numeric>
#include <set>
#include <system_error>
#include <utility>

namespace shutter::game {

namespace {

/// Clips that a warning names; there may be thousands.
constexpr size_t kMaxNamed = 8;

/// An entity, and which of its animated properties: an AnimationPath, or kWeights.
using Property = std::pair<uint32_t, uint32_t>;
constexpr uint32_t kWeights = 3;

/// By clip: the properties that it drives.
std::vector<std::set<Property>> collectProperties(const scene::World& world) {
    std::vector<std::set<Property>> moved(world.assets.clips.size());
    for (auto [entity, animated] : world.registry.view<scene::Animated>())
        for (const auto& [clip, channel] : animated.channels)
            moved.at(clip).emplace(
                entity.index,
                static_cast<uint32_t>(world.assets.clips[clip].channels.at(channel).path)
            );
    for (auto [entity, morph] : world.registry.view<scene::MorphWeights>())
        for (const auto& [clip, channel] : morph.channels)
            moved.at(clip).emplace(entity.index, kWeights);
    return moved;
}

std::string
joinClips(const scene::World& world, const std::vector<uint32_t>& clips, size_t most = kMaxNamed) {
    std::vector<std::string> names;
    for (size_t i = 0; i < std::min(clips.size(), most); ++i)
        names.push_back(describeClip(world, clips[i]));
    if (clips.size() > most)
        names.push_back(fmt::format("{} more", clips.size() - most));
    return fmt::format("{}", fmt::join(names, ", "));
}

/// Those that move what one before them in the list moves that does not itself rest; in order of
/// the file.
std::vector<uint32_t> findResting(const scene::World& world, const std::vector<uint32_t>& inOrder) {
    const std::vector<std::set<Property>> moved = collectProperties(world);
    std::set<Property> taken;
    std::vector<uint32_t> resting;
    for (const uint32_t clip : inOrder) {
        const std::set<Property>& own = moved[clip];
        if (std::any_of(own.begin(), own.end(), [&](const Property& property) {
                return taken.contains(property);
            }))
            resting.push_back(clip);
        else
            taken.insert(own.begin(), own.end());
    }
    std::sort(resting.begin(), resting.end());
    return resting;
}

/// From the one that plays in any case: the clip of a flight, then the last of the file.
std::vector<uint32_t> rankClips(const scene::World& world, std::optional<uint32_t> flying) {
    std::vector<uint32_t> ranks;
    if (flying)
        ranks.push_back(*flying);
    for (auto clip = static_cast<uint32_t>(world.assets.clips.size()); clip-- > 0;)
        if (clip != flying)
            ranks.push_back(clip);
    return ranks;
}

std::string describeResting(const scene::World& world, const std::vector<uint32_t>& resting) {
    if (resting.empty())
        return {};
    return fmt::format(
        "{} of its {} clips {} not play, as a later one moves the same nodes: {}; --clip chooses",
        resting.size(),
        world.assets.clips.size(),
        resting.size() == 1 ? "does" : "do",
        joinClips(world, resting)
    );
}

core::Status selectNamed(scene::World& world, const ShotOptions& options) {
    std::set<uint32_t> chosen;
    for (const std::string& wanted : options.clips) {
        if (wanted == "none")
            continue;
        const std::vector<uint32_t> found = findClips(world, wanted);
        if (found.empty())
            return core::makeError(
                "{}: --clip '{}' is none of its clips ({})",
                options.scene.string(),
                wanted,
                listClips(world)
            );
        chosen.insert(found.begin(), found.end());
    }
    world.playback.activeClips.assign(world.assets.clips.size(), false);
    for (const uint32_t clip : chosen)
        world.playback.activeClips[clip] = true;
    const std::vector<uint32_t> playing(chosen.rbegin(), chosen.rend());
    const std::vector<uint32_t> contested = findResting(world, playing);
    if (!contested.empty())
        core::logWarning(
            "{}: --clip: {} {} nodes that a later chosen clip moves, and which counts there; an "
            "index chooses one clip",
            options.scene.string(),
            joinClips(world, contested),
            contested.size() == 1 ? "moves" : "move"
        );
    return {};
}

} // namespace

std::string describeClip(const scene::World& world, uint32_t clip) {
    const std::string& name = world.assets.clips[clip].name;
    return name.empty() ? fmt::format("{} without a name", clip)
                        : fmt::format("{} '{}'", clip, name);
}

std::string listClips(const scene::World& world) {
    std::vector<uint32_t> all(world.assets.clips.size());
    std::iota(all.begin(), all.end(), 0u);
    return all.empty() ? "it has none" : joinClips(world, all, all.size());
}

std::vector<uint32_t> findClips(const scene::World& world, std::string_view wanted) {
    const auto& clips = world.assets.clips;
    std::vector<uint32_t> found;
    if (wanted.empty())
        return found;
    for (uint32_t clip = 0; clip < clips.size(); ++clip)
        if (clips[clip].name == wanted)
            found.push_back(clip);
    uint32_t index = 0;
    const char* end = wanted.data() + wanted.size();
    const auto [read, problem] = std::from_chars(wanted.data(), end, index);
    if (found.empty() && problem == std::errc() && read == end && index < clips.size())
        found.push_back(index);
    return found;
}

std::string describeRestingClips(const scene::World& world) {
    return describeResting(world, findResting(world, rankClips(world, {})));
}

core::Status
selectClips(scene::World& world, const ShotOptions& options, std::optional<uint32_t> flying) {
    world.playback.loop = options.loop;
    if (!options.clips.empty())
        return selectNamed(world, options);
    world.playback.activeClips.assign(world.assets.clips.size(), true);
    const std::vector<uint32_t> resting = findResting(world, rankClips(world, flying));
    for (const uint32_t clip : resting)
        world.playback.activeClips[clip] = false;
    if (!resting.empty())
        core::logWarning("{}: {}", options.scene.string(), describeResting(world, resting));
    return {};
}

} // namespace shutter::game
