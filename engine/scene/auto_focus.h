// SPDX-License-Identifier: MIT
// Autofocus on an entity: a system that knows where things are, not what a picture shows, so that
// the same world gives the same bits in every run.
//
// The distance is computed at steps of a fixed length, counted from time 0, and its inverse, by
// which blur grows evenly, is eased exponentially. Between steps it is linear. So frames of any
// rate, and exposures of any length, see the same lens at the same time.
#pragma once

#include "engine/core/result.h"
#include "engine/ecs/entity.h"
#include "engine/scene/shutter.h"
#include "engine/scene/world.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace shutter::scene {

/// Component of a camera with a lens: focuses it at an entity. Goes before CameraLens's
/// focusDistance, and behind FocusMotion's keys and LensOverride. Has an effect once
/// advanceAutoFocus() or replayAutoFocus() was called.
struct AutoFocus {
    ecs::Entity target; ///< whose origin is in focus; may be dead or null: the last distance stays
    /// Seconds in which the inverse of the distance goes half of its way, [0, 1e3]; 0: it is there
    /// at once.
    double halfLife = 0.15;
};

/// Component: the distances of the last steps. The system alone writes it.
struct FocusTrail {
    struct Cut {
        int64_t step = 0;     ///< the first one after it
        double seconds = 0.0; ///< from which the distance of `step` counts
    };

    int64_t firstStep = 0;        ///< of `inverses`
    std::vector<double> inverses; ///< of the focus distances, 1/m, one per step
    std::vector<Cut> cuts;        ///< rising
    /// Time of the last CameraCut that was seen.
    double cutSeconds = -std::numeric_limits<double>::infinity();
    bool isReplayed = false; ///< by replayAutoFocus()
    AutoFocus focus;         ///< of the first step
};

/// Steps a second of scene time, as many as those of the demos.
inline constexpr double kFocusStepsPerSecond = 120.0;

/// One sentence that names the field which is out of its range.
[[nodiscard]] core::Status validateAutoFocus(const AutoFocus& focus);

/// Distance of `target` along the camera's axis at `seconds` (finite), metres. Nothing where it is
/// not alive, nearer than the near plane, behind the camera, or nowhere (not finite).
[[nodiscard]] std::optional<double>
findFocusDistance(const World& world, ecs::Entity camera, ecs::Entity target, double seconds);

/// Steps all autofocus cameras up to the time `until` (finite), for worlds that are simulated: what
/// moves must be known up to the step at or after it. The first call focuses at once, and so does
/// one that comes ten minutes after the last, or goes back more than two seconds. A cut
/// of the camera (history.h) focuses at once, too. Without a distance the one before stays; before
/// there was any, CameraLens's counts.
void advanceAutoFocus(World& world, double until);

/// The same as if a world whose motion is a function of time had been stepped since time 0, or for
/// ten to twenty minutes: a frame does not depend on which frames were drawn before, nor on what
/// AutoFocus was then. Before time 0 the distance is that of time 0. \param until finite
void replayAutoFocus(World& world, double until);

/// The same, as far as a frame of `camera` sees the lens, scales of the exposure's blur included.
/// \param camera alive, with a Camera
void replayAutoFocus(World& world, ecs::Entity camera, const ExposureInterval& exposure);

/// Focus distance of the camera at `seconds`, metres; nothing where it has no AutoFocus, or the
/// system did not run. Before the first step in memory, and after the last, that step's.
[[nodiscard]] std::optional<double>
autoFocusAt(const World& world, ecs::Entity camera, double seconds);

} // namespace shutter::scene
