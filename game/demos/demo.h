// SPDX-License-Identifier: MIT
// A game without a window: a world, its rules, and the player's controls in each fixed step. The
// viewer draws world() through camera() at seconds(), with the exposure ending there
// (ShutterPhase::End).
#pragma once

#include "engine/core/result.h"
#include "engine/ecs/entity.h"
#include "engine/math/math.h"
#include "engine/scene/world.h"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::game {

inline constexpr double kGravity = 9.81; ///< m/s^2

inline constexpr int kDemoStepsPerSecond = 120;
inline constexpr double kDemoStepSeconds = 1.0 / kDemoStepsPerSecond;

/// A player's controls for one fixed step; the same for every demo. Values outside of their range
/// are clamped, NaN counts as 0.
struct DemoControls {
    double turn = 0.0;   ///< [-1, 1], right is positive: wheel, aim
    double drive = 0.0;  ///< [-1, 1], forward is positive: throttle and brake, up and down of the
                         ///< aim, speed of the carousel
    bool action = false; ///< held: hand brake, shot, throw
    bool switchCamera = false;    ///< pressed in this step
    bool toggleExclusion = false; ///< pressed in this step: the demo's body in or out of the blur
};

struct HudLine {
    std::string text;
    bool emphasis = false;  ///< the most important line
    std::string label = ""; ///< label of a value, one or two words: such lines are placed side by
                            ///< side
};

/// View settings of a demo's world.
struct DemoAppearance {
    math::vec3 background{0.0f}; ///< linear RGB where nothing is drawn: the sky
    math::vec3 ambient{0.0f};    ///< linear RGB of the light from everywhere
    double turbidity = 0.0; ///< of the clear sky that takes the place of both; 0: there is none
    /// Factor over the physical sky.
    double skyIntensity = 1.0;
};

/// Fixed steps alone change a demo: no clock, no random numbers but its own. The same controls
/// give the same bits.
class Demo {
  public:
    virtual ~Demo() = default;

    [[nodiscard]] virtual const char* name() const = 0;
    [[nodiscard]] virtual const scene::World& world() const = 0;
    /// For the viewer's settings: the CameraShutter of the cameras (World::cameras).
    [[nodiscard]] virtual scene::World& world() = 0;
    /// The active camera of World::cameras. A change is a cut.
    [[nodiscard]] virtual ecs::Entity camera() const = 0;
    [[nodiscard]] virtual DemoAppearance appearance() const = 0;
    /// One fixed step of kDemoStepSeconds. After the end the world moves on, the score stays.
    virtual void step(const DemoControls& controls) = 0;
    /// Simulated so far; the step count times kDemoStepSeconds.
    [[nodiscard]] virtual double seconds() const = 0;
    /// Score, time left, speed. After the end the final score.
    [[nodiscard]] virtual std::vector<HudLine> hud() const = 0;
    [[nodiscard]] virtual bool isOver() const = 0;
    [[nodiscard]] virtual int score() const = 0;
    /// Whether toggleExclusion has taken the demo's body out of the blur.
    [[nodiscard]] virtual bool isBodyExcluded() const = 0;
};

/// Descriptions of a demo's controls, in a few words; empty: it does not use that control.
struct DemoControlWords {
    const char* turn;
    const char* drive;
    const char* action;
    const char* body; ///< what toggleExclusion takes out of the blur
};

struct DemoInfo {
    const char* name;        ///< as makeDemo() takes it
    const char* description; ///< one line
    DemoControlWords controls;
};

[[nodiscard]] std::span<const DemoInfo> listDemos();

/// Loads `<assetFolder>/<name>.glb`. Error: a name that listDemos() lacks, a scene that cannot be
/// loaded or lacks a node that the demo plays with.
[[nodiscard]] core::Result<std::unique_ptr<Demo>>
makeDemo(std::string_view name, const std::filesystem::path& assetFolder);

} // namespace shutter::game
