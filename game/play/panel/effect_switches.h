// SPDX-License-Identifier: MIT
// The effects besides the blur that a player switches, as a table: keys, panel, head-up display and
// the picture before new shaders are loops over it.
#pragma once

#include "engine/scene/world.h"
#include "game/play/panel/play_settings.h"

#include <span>
#include <string>
#include <string_view>

namespace shutter::game {

struct EffectSwitch {
    std::string_view words; ///< in the help of keys
    /// "taa"; empty: it is off.
    std::string (*describe)(const PlaySettings& settings) = nullptr;
    void (*copy)(const PlaySettings& from, PlaySettings& to) = nullptr;
    void (*turnOff)(PlaySettings& settings) = nullptr;
    /// What its key does; null: off, or on as a new player has it.
    void (*step)(PlaySettings& settings) = nullptr;
    bool takesShaders = false; ///< the first picture with it compiles some
    /// Why it changes nothing in this world, a clause; empty or null: it may.
    std::string (*explainIdle)(const scene::World& world) = nullptr;
};

/// In the order of the keys 6 to 0.
[[nodiscard]] std::span<const EffectSwitch> listEffectSwitches();

void pressKey(const EffectSwitch& effect, PlaySettings& settings);

} // namespace shutter::game
