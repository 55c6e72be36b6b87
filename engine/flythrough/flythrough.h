// SPDX-License-Identifier: MIT
// Scripted camera flythroughs: a JSON file of keys (flythrough.schema.json) that a camera follows
// through a scene, exactly, at any time.
#pragma once

#include "engine/core/frame_rate.h"
#include "engine/core/result.h"
#include "engine/math/math.h"
#include "engine/scene/camera.h"
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

/// Changes to the camera's shutter from a key on, until a key that has others.
struct FlythroughShutter {
    std::optional<double> exposureSeconds; ///< [0, 1e6]; excludes angleDegrees
    std::optional<double> angleDegrees;    ///< 360 is the frame's duration; [0, 36000]
    std::optional<scene::ShutterPhase> phase;
};

struct FlythroughKey {
    double seconds = 0.0;                ///< scene time, [-1e6, 1e6]
    math::dvec3 position{0.0};           ///< metres, world space, each in [-1e9, 1e9]
    std::optional<math::dvec3> lookAt;   ///< point to aim at, same units; all keys have one, or
    std::optional<math::dquat> rotation; ///< all have a unit rotation of a view along -Z
    /// Vertical, of the picture, degrees, [0.01, 179]; in all keys or none.
    std::optional<double> fieldOfView;
    /// Focus distance of the lens (scene::CameraLens), metres, [1e-4, 1e9]; in all keys or none.
    std::optional<double> focusDistance;
    /// F-number of the lens, [0.01, 1e9]; in all keys or none.
    std::optional<double> fStop;
    std::optional<FlythroughShutter> shutter;
    /// Seconds of the scene per second of the film, [0.001, 1000]; TimeRamp defines it between
    /// keys.
    std::optional<double> timeScale;
    bool cut = false; ///< the camera jumps here; until then it stays at the key before
};

struct Flythrough {
    std::string name;    ///< may be empty
    core::FrameRate fps; ///< frames per second, (0, 1000]
    scene::PathInterpolation interpolation = scene::PathInterpolation::CatmullRom;
    scene::PathEase ease = scene::PathEase::None;
    math::dvec3 up{0.0, 1.0, 0.0};   ///< up direction for keys with lookAt
    std::vector<FlythroughKey> keys; ///< 1 to 100000, at increasing times
};

/// Error: names the file, the line and the field that is wrong.
[[nodiscard]] core::Result<Flythrough> readFlythrough(const std::filesystem::path& path);

/// \param name what errors call the text
[[nodiscard]] core::Result<Flythrough> parseFlythrough(std::string_view text, std::string name);

/// Writes a file that readFlythrough reads back bit for bit. Error: the flythrough is not valid or
/// the file cannot be written; an earlier file of that name is then preserved.
[[nodiscard]] core::Status
writeFlythrough(const std::filesystem::path& path, const Flythrough& flythrough);

/// Error: one sentence that names the key and the fault.
[[nodiscard]] core::Status validateFlythrough(const Flythrough& flythrough);

// All functions below require a valid flythrough.

[[nodiscard]] scene::PathMotion makePath(const Flythrough& flythrough);
/// Nothing where the keys give no field of view.
[[nodiscard]] std::optional<scene::LensMotion> makeLens(const Flythrough& flythrough);

/// Nothing where the keys give neither a focus distance nor an f-number.
[[nodiscard]] std::optional<scene::FocusMotion> makeFocus(const Flythrough& flythrough);

/// Applies to `shutter` the changes in effect at `seconds`: those of the last key at or before that
/// time which has any; before the first such key, those of the first. Fields that this key leaves
/// out keep their value in `shutter`; earlier keys have no effect.
void applyShutter(const Flythrough& flythrough, double seconds, scene::CameraShutter& shutter);

/// Adds a camera that follows the keys. Its lens is that of the world's first camera, or Camera's
/// default in a world without cameras, except for what the keys give of it; it focuses as that one
/// does.
[[nodiscard]] ecs::Entity addFlythroughCamera(scene::World& world, const Flythrough& flythrough);

} // namespace shutter::flythrough
