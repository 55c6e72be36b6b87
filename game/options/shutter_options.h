// SPDX-License-Identifier: MIT
// The shutter's options: those of engine/scene/shutter.h, and --response.
#pragma once

#include "engine/core/result.h"
#include "engine/scene/components.h"

#include <set>
#include <string>

namespace CLI {
class App;
}

namespace shutter::game {

/// Without --exposure and --shutter-angle.
inline constexpr double kDefaultExposureSeconds = 1.0 / 60.0;

/// The shutter as typed; interpretShutter() checks what options mean together.
struct ShutterArguments {
    scene::CameraShutter shutter{.exposureSeconds = kDefaultExposureSeconds};
    std::set<std::string> typed; ///< the options given, "--exposure"

    [[nodiscard]] bool isTyped(const char* option) const { return typed.contains(option); }
};

/// As `--exposure SECONDS --phase PHASE`. The phase must be one of the words (CHECKed).
[[nodiscard]] ShutterArguments
makeShutterArguments(double exposureSeconds, const std::string& phase);

void defineShutterOptions(CLI::App& command, ShutterArguments& arguments);

/// The shutter, whose mode follows from the options if --shutter-mode was not typed. Error: names
/// the option that was used wrongly.
[[nodiscard]] core::Result<scene::CameraShutter> interpretShutter(const ShutterArguments& arguments
);

} // namespace shutter::game
