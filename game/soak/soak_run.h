// SPDX-License-Identifier: MIT
// A demo played for hours in minutes, twice: nothing grows, and the second run shows what the first
// one showed.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "game/options/option_rows.h"
#include "game/play/loop/stage.h"
#include "game/soak/soak_samples.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace shutter::soak {

struct SoakOptions {
    std::string demo = "gallery";    ///< of game::listDemos()
    uint32_t frames = 20'000;        ///< of each run; kMinCycles cycles or more
    uint32_t storm = 60;             ///< things that come and go in a storm
    game::PictureSize size{160, 90}; ///< pixels, as a cycle begins
    std::filesystem::path out;       ///< an existing folder; pictures go to parts of it
    std::filesystem::path assets;    ///< folder of the demos' scenes; empty: the installed one
    gpu::DeviceOptions device;

    /// What a test does after a picture, to see that it is noticed.
    struct Moment {
        uint32_t run;     ///< from 0
        uint32_t picture; ///< from 0
        gpu::Device& device;
        game::Stage& stage;
    };

    std::function<void(const Moment&)> disturb{};
};

struct SoakResult {
    demand::Findings findings;
    gpu::DeviceInfo device;
};

/// Plays the demo twice by the same script, which is left in `out` with the settings and the
/// pictures of chosen frames, by which `shutter play` repeats a run. Error: a session could not be
/// opened or drawn, a file not be written, or validation had messages.
[[nodiscard]] core::Result<SoakResult> runSoak(const SoakOptions& options);

} // namespace shutter::soak
