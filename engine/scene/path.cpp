// SPDX-License-Identifier: MIT
#include "engine/scene/path.h"

#include "engine/core/check.h"
#include "engine/scene/look_at.h"

#include <cmath>
#include <cstddef>
#include <functional>

namespace shutter::scene {

using math::dquat;
using math::dvec3;
using math::dvec4;

namespace {

bool isFinite(const dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class Value>
Value interpolate(
    const PathMotion& path, const KeyPlace& place, const std::function<Value(size_t)>& valueAt
) {
    return interpolateAtPlace<Value>(path.keys, path.interpolation, place, valueAt);
}

dvec4 toVector(const dquat& q) {
    return {q.x, q.y, q.z, q.w};
}

dquat toRotation(const dvec4& v) {
    return glm::normalize(dquat(v.w, v.x, v.y, v.z));
}

/// A key's rotation as seen from key `from`: of a rotation's two signs the one nearer to that of
/// the key before it on the way, so that the curve takes the shorter turns.
dvec4 alignRotation(const std::vector<PathKey>& keys, size_t from, size_t key) {
    dvec4 value = toVector(*keys[from].rotation);
    for (size_t at = from; at != key;) {
        at = key > at ? at + 1 : at - 1;
        const dvec4 next = toVector(*keys[at].rotation);
        value = glm::dot(value, next) < 0.0 ? -next : next;
    }
    return value;
}

dquat sampleRotation(const PathMotion& path, const KeyPlace& place) {
    const std::vector<PathKey>& keys = path.keys;
    if (path.interpolation == PathInterpolation::Linear && place.share > 0.0) {
        const dquat from = *keys[place.key].rotation;
        const dquat to = *keys[place.key + 1].rotation;
        if (to == from || to == -from) // a hold, to the bit
            return glm::normalize(from);
        return glm::slerp(glm::normalize(from), glm::normalize(to), place.share);
    }
    return toRotation(interpolate<dvec4>(path, place, [&](size_t key) {
        return alignRotation(keys, place.key, key);
    }));
}

core::Status validateKey(const PathMotion& path, size_t i) {
    const PathKey& key = path.keys[i];
    if (!std::isfinite(key.seconds))
        return core::makeError("path: the time of key {} is {}", i, key.seconds);
    if (i > 0 && !(key.seconds > path.keys[i - 1].seconds))
        return core::makeError(
            "path: key {} at {} s does not come after the one before, at {} s",
            i,
            key.seconds,
            path.keys[i - 1].seconds
        );
    if (!isFinite(key.position))
        return core::makeError("path: the position of key {} is not finite", i);
    if (key.rotation && key.lookAt)
        return core::makeError("path: key {} has a rotation and a place to look at", i);
    if (key.rotation.has_value() != path.keys[0].rotation.has_value() ||
        key.lookAt.has_value() != path.keys[0].lookAt.has_value())
        return core::makeError("path: key {} tells its direction in another way than key 0", i);
    // Written so that NaN fails.
    if (key.rotation && !(std::abs(glm::length(*key.rotation) - 1.0) < 1.0e-3))
        return core::makeError("path: the rotation of key {} is not of length 1", i);
    if (key.lookAt && !isFinite(*key.lookAt))
        return core::makeError("path: the place that key {} looks at is not finite", i);
    return {};
}

} // namespace

core::Status validatePath(const PathMotion& path) {
    if (path.keys.empty())
        return core::makeError("path: it has no keys");
    for (size_t i = 0; i < path.keys.size(); ++i)
        SHUTTER_TRY(validateKey(path, i));
    if (!isFinite(path.up) || !(glm::length(path.up) > 0.0))
        return core::makeError("path: up has no direction");
    return {};
}

math::Transform samplePath(const PathMotion& path, const math::Transform& rest, double seconds) {
    SHUTTER_CHECK(!path.keys.empty(), "a path without keys");
    const std::vector<PathKey>& keys = path.keys;
    const KeyPlace place = findKeyPlace(keys, path.ease, seconds);
    math::Transform pose = rest;
    pose.translation =
        interpolate<dvec3>(path, place, [&](size_t key) { return keys[key].position; });
    if (keys.front().rotation)
        pose.rotation = sampleRotation(path, place);
    if (keys.front().lookAt) {
        const dvec3 target =
            interpolate<dvec3>(path, place, [&](size_t key) { return *keys[key].lookAt; });
        pose.rotation = lookAlongPath(path, place, target - pose.translation);
    }
    return pose;
}

bool hasCutWithin(const PathMotion& path, double from, double to) {
    return hasCutKeyWithin(path.keys, from, to);
}

} // namespace shutter::scene
