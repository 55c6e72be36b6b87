// SPDX-License-Identifier: MIT
// Scripted camera flythroughs: a JSON file of keys (flythrough.schema.json) that a camera follows
// through a scene, exactly, at any time.
#pragma once

#include "engine/core/result.h"
#include "engine/math/math.h"
#include "engine/scene/components.h"
#include "engine/scene/lens.h"
#include "engine/scene/path.h"
#include "engine/scene/world.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::flythrough {

/// Of a camera from a key on, until a key that has another.
struct FlythroughShutter {
    std::optional<double> exposureSeconds; ///< [0, 1e6]; this or the next, not both
    std::optional<double> angleDegrees;    ///< of a frame's duration as 360, [0, 36000]
    std::optional<scene::ShutterPhase> phase;
};

struct FlythroughKey {
    double seconds = 0.0;                ///< of the scene, [-1e6, 1e6]
    math::dvec3 position{0.0};           ///< metres, world space, each in [-1e9, 1e9]
    std::optional<math::dvec3> lookAt;   ///< place to look at, likewise; all keys have one, or
    std::optional<math::dquat> rotation; ///< all have a rotation, unit, of a view along -Z
    std::optional<double> fieldOfView;   ///< vertical, degrees, [0.01, 179]; all keys or none
    std::optional<FlythroughShutter> shutter;
    bool cut = false; ///< the camera jumps here; until then it stays at the key before
};

struct Flythrough {
    std::string name;  ///< may be empty
    double fps = 24.0; ///< frames a second, (0, 1000]
    scene::PathInterpolation interpolation = scene::PathInterpolation::CatmullRom;
    scene::PathEase ease = scene::PathEase::None;
    math::dvec3 up{0.0, 1.0, 0.0};   ///< what is above where keys look at a place
    std::vector<FlythroughKey> keys; ///< 1 to 100000, at rising times
};

/// Error: names the file, the line and the field, or what no single field is to blame for.
[[nodiscard]] core::Result<Flythrough> readFlythrough(const std::filesystem::path& path);

/// \param name what errors call the text
[[nodiscard]] core::Result<Flythrough> parseFlythrough(std::string_view text, std::string name);

/// What readFlythrough reads back the same, bit by bit. Error: it is not valid, or the file cannot
/// be written; then there is no file, or the one from before.
[[nodiscard]] core::Status
writeFlythrough(const std::filesystem::path& path, const Flythrough& flythrough);

/// One sentence that names the key and what is wrong with it.
[[nodiscard]] core::Status validateFlythrough(const Flythrough& flythrough);

/// The flythrough must be valid for all below.
[[nodiscard]] scene::PathMotion makePath(const Flythrough& flythrough);
/// Nothing where its keys tell no field of view.
[[nodiscard]] std::optional<scene::LensMotion> makeLens(const Flythrough& flythrough);

/// `shutter` as it is at `seconds`: the last key at or before that tells one counts, and the first
/// that does before it. What that key's shutter does not tell stays as it is: earlier keys' no
/// longer count.
void applyShutter(const Flythrough& flythrough, double seconds, scene::CameraShutter& shutter);

/// A new camera that flies. Its lens is that of the world's first camera, or Camera's own default
/// where there is none, unless the keys tell a field of view.
[[nodiscard]] ecs::Entity addFlythroughCamera(scene::World& world, const Flythrough& flythrough);

} // namespace shutter::flythrough
