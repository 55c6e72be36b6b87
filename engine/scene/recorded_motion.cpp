// SPDX-License-Identifier: MIT
#include "engine/scene/recorded_motion.h"

#include "engine/core/check.h"
#include "engine/scene/path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace shutter::scene {

namespace {

using math::Transform;

bool isFinitePose(const Transform& pose) {
    Transform unscaled = pose;
    unscaled.scale = math::dvec3(1.0);
    return math::isFinite(math::computeMatrix(unscaled));
}

bool isAt(const PathKey& key, const Transform& pose) {
    return key.position == pose.translation && *key.rotation == pose.rotation;
}

bool isSamePlace(const PathKey& a, const PathKey& b) {
    return a.position == b.position && *a.rotation == *b.rotation;
}

PathKey makeKey(const Transform& pose, double seconds, bool cut) {
    PathKey key;
    key.seconds = seconds;
    key.position = pose.translation;
    key.rotation = pose.rotation;
    key.cut = cut;
    return key;
}

/// Counts keys that no time from `horizon` on needs: all before the last one at or before it.
size_t countOutdated(const std::vector<PathKey>& keys, double horizon) {
    const auto later =
        std::upper_bound(keys.begin(), keys.end(), horizon, [](double seconds, const PathKey& key) {
            return seconds < key.seconds;
        });
    const auto known = static_cast<size_t>(later - keys.begin());
    return known > 0 ? known - 1 : 0;
}

void dropOutdated(std::vector<PathKey>& keys, double horizon) {
    const size_t outdated = countOutdated(keys, horizon);
    // Erased in batches: the remaining keys move to the front once in as many steps as there are
    // keys.
    if (2 * outdated + 1 >= keys.size() && outdated > 0)
        keys.erase(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(outdated));
    // At rest for the whole reach.
    if (keys.size() == 2 && keys.front().seconds <= horizon && !keys.back().cut &&
        isSamePlace(keys.front(), keys.back()))
        keys.pop_back();
}

/// Returns how far back the entity's placement is needed.
double findReach(const World& world, ecs::Entity entity) {
    double longest = 0.0;
    for (auto [carried, past] : world.registry.view<NeedsPast>())
        if (past.seconds > longest &&
            findUpwards(world, carried, [&](ecs::Entity at) { return at == entity; }) == entity)
            longest = past.seconds;
    return kRecordedSeconds + longest;
}

void start(World& world, ecs::Entity entity, const PathKey& key) {
    PathMotion path;
    path.interpolation = PathInterpolation::Linear;
    path.keys.push_back(key);
    world.registry.add(entity, std::move(path));
    world.registry.add(entity, RecordedMotion{key.seconds});
}

void record(World& world, ecs::Entity entity, const PathKey& key, const Transform& pose) {
    ecs::Registry& registry = world.registry;
    SHUTTER_CHECK(
        std::isfinite(key.seconds) && isFinitePose(pose),
        "a pose of {} that is not finite, at {} seconds",
        entity,
        key.seconds
    );
    if (!registry.has<RecordedMotion>(entity)) {
        start(world, entity, key);
        return;
    }
    double& last = registry.get<RecordedMotion>(entity).seconds;
    SHUTTER_CHECK(
        key.seconds > last, "{} recorded at {} seconds after {}", entity, key.seconds, last
    );
    const double before = std::exchange(last, key.seconds);
    const auto& known = std::as_const(registry).get<PathMotion>(entity).keys;
    const bool rests = !key.cut && isAt(known.back(), pose);
    if (rests && known.size() == 1)
        return;
    std::vector<PathKey>& keys = registry.get<PathMotion>(entity).keys;
    // It rested, for which no keys were kept, until the step before this one.
    if (keys.back().seconds < before) {
        PathKey rested = keys.back();
        rested.seconds = before;
        rested.cut = false;
        keys.push_back(rested);
    }
    const bool restedBefore =
        keys.size() > 1 && !keys.back().cut && isSamePlace(keys[keys.size() - 2], keys.back());
    if (rests && restedBefore)
        keys.back().seconds = key.seconds;
    else
        keys.push_back(key);
    dropOutdated(keys, key.seconds - findReach(world, entity));
}

} // namespace

void recordMotion(World& world, ecs::Entity entity, const Transform& pose, double seconds) {
    record(world, entity, makeKey(pose, seconds, false), pose);
}

void recordJump(World& world, ecs::Entity entity, const Transform& pose, double seconds) {
    record(world, entity, makeKey(pose, seconds, true), pose);
}

} // namespace shutter::scene
