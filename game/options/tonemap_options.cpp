// SPDX-License-Identifier: MIT
#include "game/options/tonemap_options.h"

#include <CLI/CLI.hpp>

#include <cmath>

namespace shutter::game {

std::vector<CLI::Option*>
defineTonemapOptions(CLI::App& command, std::string& op, double& exposureValue) {
    return {
        command.add_option(
            "--ev", exposureValue, "stops of exposure before tone mapping; default 0"
        ),
        command.add_option("--tonemap", op, "neutral (default) or none")};
}

core::Result<tonemap::TonemapSettings>
interpretTonemap(const std::string& op, double exposureValue) {
    tonemap::TonemapSettings settings;
    if (op == nameOf(tonemap::Operator::Neutral))
        settings.op = tonemap::Operator::Neutral;
    else if (op == nameOf(tonemap::Operator::None))
        settings.op = tonemap::Operator::None;
    else
        return core::makeError("--tonemap '{}' is not one of neutral, none", op);
    if (!(std::abs(exposureValue) <= 32.0)) // NaN too
        return core::makeError("--ev must lie in [-32, 32]");
    settings.exposureValue = exposureValue;
    return settings;
}

const char* nameOf(tonemap::Operator op) {
    switch (op) {
    case tonemap::Operator::None:
        return "none";
    case tonemap::Operator::Neutral:
        break;
    }
    return "neutral";
}

} // namespace shutter::game
