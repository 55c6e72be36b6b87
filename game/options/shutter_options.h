// SPDX-License-Identifier: MIT
// The shutter's options, as a person types them and as they are meant.
#pragma once

#include "engine/core/result.h"
#include "engine/scene/components.h"

#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace shutter::game {

/// Without --exposure and --shutter-angle.
inline constexpr double kDefaultExposureSeconds = 1.0 / 60.0;

/// As typed.
struct ShutterArguments {
    std::optional<double> exposureSeconds;
    std::optional<double> shutterAngle;
    std::string shutterMode; ///< empty: physical, or angle where --shutter-angle is given
    std::optional<double> referenceFps;
    std::string phase = "end";
    std::string response = "box";
    std::string cutDetection = "on";
    std::optional<double> cutAngle;
    std::optional<double> cutDistance;
    double cameraRotationBlur = 1.0;
    double cameraTranslationBlur = 1.0;
    double objectBlur = 1.0;
    std::optional<double> maxBlur;
};

void defineShutterOptions(CLI::App& command, ShutterArguments& arguments);

/// Error: names the option that was used wrongly.
/// \param frameSeconds the duration of a frame, above 0 and finite
[[nodiscard]] core::Result<scene::CameraShutter>
interpretShutter(const ShutterArguments& arguments, double frameSeconds);

/// All of them in one line that differs where a picture may.
[[nodiscard]] std::string describeShutter(const ShutterArguments& arguments);

} // namespace shutter::game
