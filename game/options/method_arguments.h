// SPDX-License-Identifier: MIT
// The options that choose and set up a method, as typed.
#pragma once

#include "engine/core/result.h"
#include "game/shot/shot_options.h"

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace shutter::game {

struct MethodArguments {
    std::string method = motion_blur::getDefaultMethod().name;
    std::string preset; ///< chooses method and settings in place of `method`; empty: none
    std::optional<uint32_t> samples; ///< else the method's own number
    std::optional<double> error;
    std::string instants; ///< "auto"; empty: as many as `samples`
    std::optional<double> maxStepPx;
    std::vector<std::string> settings; ///< NAME=VALUE
    motion_blur::BlurBudget budget{};
    std::set<std::string> typed; ///< "--budget" if it was given
};

void defineMethodOptions(CLI::App& command, MethodArguments& arguments);

/// Error: names the option that was used wrongly.
[[nodiscard]] core::Result<MethodOptions> interpret(const MethodArguments& arguments);

/// Sets one setting from NAME=VALUE. Names are MotionBlurSettings' fields (motion_blur/settings.h),
/// and only those that the method reads. Error: names the wrong argument, or the range that the
/// value is outside of.
[[nodiscard]] core::Status applySetting(
    const std::string& text, const MethodInfo& method, motion_blur::MotionBlurSettings& settings
);

/// All values that pictures depend on, in one line.
[[nodiscard]] std::string describe(const MethodArguments& arguments);

} // namespace shutter::game
