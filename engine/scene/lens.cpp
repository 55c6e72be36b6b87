// SPDX-License-Identifier: MIT
#include "engine/scene/lens.h"

#include "engine/core/check.h"
#include "engine/scene/components.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace shutter::scene {

namespace {

/// Null where the camera's own field of view counts.
const LensMotion* findLensMotion(const World& world, ecs::Entity camera) {
    const bool perspective = world.registry.get<Camera>(camera).kind == CameraKind::Perspective;
    return perspective ? world.registry.find<LensMotion>(camera) : nullptr;
}

} // namespace

core::Status validateLens(const LensMotion& lens) {
    if (lens.keys.empty())
        return core::makeError("lens: it has no keys");
    for (size_t i = 0; i < lens.keys.size(); ++i) {
        const LensKey& key = lens.keys[i];
        if (!std::isfinite(key.seconds))
            return core::makeError("lens: the time of key {} is {}", i, key.seconds);
        if (i > 0 && !(key.seconds > lens.keys[i - 1].seconds))
            return core::makeError(
                "lens: key {} at {} s does not come after the one before, at {} s",
                i,
                key.seconds,
                lens.keys[i - 1].seconds
            );
        // Written so that NaN fails.
        if (!(key.yFov > 0.0 && key.yFov < std::numbers::pi))
            return core::makeError(
                "lens: the field of view of key {} is {} rad, it must lie in (0, pi)", i, key.yFov
            );
    }
    return {};
}

bool hasCutWithin(const LensMotion& lens, double from, double to) {
    return hasCutKeyWithin(lens.keys, from, to);
}

double yFovAt(const World& world, ecs::Entity camera, double seconds) {
    SHUTTER_CHECK(std::isfinite(seconds), "yFovAt {} seconds", seconds);
    const LensMotion* lens = findLensMotion(world, camera);
    if (!lens)
        return world.registry.get<Camera>(camera).yFov;
    SHUTTER_CHECK(!lens->keys.empty(), "a lens without keys");
    const KeyPlace place = findKeyPlace(lens->keys, lens->ease, seconds);
    const double from = lens->keys[place.key].yFov;
    // Of the key before, so that a lens that rests changes no bit.
    const double ratio =
        interpolateAtPlace<double>(lens->keys, lens->interpolation, place, [&](size_t key) {
            return std::log(std::tan(lens->keys[key].yFov / 2.0) / std::tan(from / 2.0));
        });
    return ratio == 0.0 ? from : 2.0 * std::atan(std::tan(from / 2.0) * std::exp(ratio));
}

bool mayZoom(const World& world, ecs::Entity camera) {
    const LensMotion* lens = findLensMotion(world, camera);
    return lens && std::any_of(lens->keys.begin(), lens->keys.end(), [&](const LensKey& key) {
               return key.yFov != lens->keys.front().yFov;
           });
}

} // namespace shutter::scene
