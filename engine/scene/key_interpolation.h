// SPDX-License-Identifier: MIT
// Interpolation between keys of rising times, shared by paths and lenses. A key has `seconds` and
// `cut`; a shot is the span between two cuts.
#pragma once

#include "engine/scene/animation.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace shutter::scene {

enum class PathInterpolation : uint8_t {
    Linear,    ///< straight from key to key, rotations by slerp; corners at keys
    CatmullRom ///< a smooth curve through the keys (Catmull and Rom 1974), of continuous velocity
};

enum class PathEase : uint8_t {
    None, ///< starts and stops at full speed
    InOut ///< from rest to rest over each shot: 3 x^2 - 2 x^3 of its time
};

/// Keys [first, last] between two cuts.
struct KeyShot {
    size_t first = 0;
    size_t last = 0;
};

/// Where a time lies in its shot.
struct KeyPlace {
    KeyShot shot;
    size_t key = 0;     ///< the key before
    double share = 0.0; ///< of the way to the next, [0, 1]; 0 where there is none
};

/// The last key at or before `seconds`, or the first.
template <class Key> [[nodiscard]] size_t findKey(const std::vector<Key>& keys, double seconds) {
    const auto next =
        std::upper_bound(keys.begin(), keys.end(), seconds, [](double time, const Key& key) {
            return time < key.seconds;
        });
    return next == keys.begin() ? 0 : static_cast<size_t>(next - keys.begin()) - 1;
}

template <class Key> [[nodiscard]] KeyShot findKeyShot(const std::vector<Key>& keys, size_t key) {
    KeyShot shot{key, key};
    while (shot.first > 0 && !keys[shot.first].cut)
        --shot.first;
    while (shot.last + 1 < keys.size() && !keys[shot.last + 1].cut)
        ++shot.last;
    return shot;
}

/// \param keys one or more
template <class Key>
[[nodiscard]] KeyPlace findKeyPlace(const std::vector<Key>& keys, PathEase ease, double seconds) {
    KeyPlace place;
    place.shot = findKeyShot(keys, findKey(keys, seconds));
    const double from = keys[place.shot.first].seconds;
    const double to = keys[place.shot.last].seconds;
    double time = std::clamp(seconds, from, to);
    if (ease == PathEase::InOut && to > from) {
        const double x = (time - from) / (to - from);
        time = std::clamp(from + (to - from) * x * x * (3.0 - 2.0 * x), from, to);
    }
    place.key = std::clamp(findKey(keys, time), place.shot.first, place.shot.last);
    if (place.key < place.shot.last) {
        const double start = keys[place.key].seconds;
        place.share = std::clamp((time - start) / (keys[place.key + 1].seconds - start), 0.0, 1.0);
    }
    return place;
}

/// Per second: the slope between a key's neighbours, at the ends of a shot to the only one; 0 where
/// one of them is equal, so that two equal keys hold still.
template <class Value, class Key>
[[nodiscard]] Value computeKeyTangent(
    const std::vector<Key>& keys,
    const KeyShot& shot,
    size_t key,
    const std::function<Value(size_t)>& valueAt
) {
    const size_t before = key > shot.first ? key - 1 : key;
    const size_t after = key < shot.last ? key + 1 : key;
    const Value here = valueAt(key);
    if ((before != key && valueAt(before) == here) || (after != key && valueAt(after) == here))
        return Value(0.0);
    return (valueAt(after) - valueAt(before)) / (keys[after].seconds - keys[before].seconds);
}

/// From a key to the next of its shot.
template <class Value, class Key>
[[nodiscard]] HermiteSpan<Value> describeSpan(
    const std::vector<Key>& keys,
    PathInterpolation interpolation,
    const KeyShot& shot,
    size_t key,
    const std::function<Value(size_t)>& valueAt
) {
    const Value from = valueAt(key);
    const Value to = valueAt(key + 1);
    if (interpolation == PathInterpolation::Linear)
        return {from, to - from, to, to - from};
    const double interval = keys[key + 1].seconds - keys[key].seconds;
    return {
        from,
        interval * computeKeyTangent(keys, shot, key, valueAt),
        to,
        interval * computeKeyTangent(keys, shot, key + 1, valueAt)};
}

template <class Value, class Key>
[[nodiscard]] Value interpolateAtPlace(
    const std::vector<Key>& keys,
    PathInterpolation interpolation,
    const KeyPlace& place,
    const std::function<Value(size_t)>& valueAt
) {
    const Value from = valueAt(place.key);
    if (place.share == 0.0)
        return from;
    const Value to = valueAt(place.key + 1);
    if (to == from) // a hold, to the bit
        return from;
    if (interpolation == PathInterpolation::Linear)
        return from + (to - from) * place.share;
    return interpolateHermite<Value>(
        describeSpan<Value>(keys, interpolation, place.shot, place.key, valueAt), place.share
    );
}

/// True when a key after `from` and not after `to` is a cut.
template <class Key>
[[nodiscard]] bool hasCutKeyWithin(const std::vector<Key>& keys, double from, double to) {
    return std::any_of(keys.begin(), keys.end(), [&](const Key& key) {
        return key.cut && key.seconds > from && key.seconds <= to;
    });
}

} // namespace shutter::scene
