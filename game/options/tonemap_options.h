// SPDX-License-Identifier: MIT
// --tonemap and --ev: the same words wherever a picture is brought to a display.
#pragma once

#include "engine/core/result.h"
#include "modules/tonemap/tonemap.h"

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace shutter::game {

/// Adds both options, which write to `op` and `exposureValue`; returns them.
std::vector<CLI::Option*>
defineTonemapOptions(CLI::App& command, std::string& op, double& exposureValue);

/// An Error names the option that has no meaning.
[[nodiscard]] core::Result<tonemap::TonemapSettings>
interpretTonemap(const std::string& op, double exposureValue);

/// The word that --tonemap takes.
[[nodiscard]] const char* nameOf(tonemap::Operator op);

} // namespace shutter::game
