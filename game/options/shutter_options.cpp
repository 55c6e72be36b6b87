// SPDX-License-Identifier: MIT
#include "game/options/shutter_options.h"

#include "engine/core/setting_row.h"
#include "engine/scene/shutter.h"
#include "game/options/setting_options.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace shutter::game {

namespace {

using core::makeError;
using core::Status;
using scene::CameraShutter;
using scene::ResponseShape;
using scene::ShutterMode;
using scene::ShutterPhase;

template <class T, size_t count>
Status parseWord(
    const char* option,
    const std::string& text,
    const std::array<std::pair<const char*, T>, count>& words,
    T& target
) {
    std::string known;
    for (const auto& [word, meaning] : words) {
        if (text == word) {
            target = meaning;
            return {};
        }
        known += fmt::format("{}{}", known.empty() ? "" : ", ", word);
    }
    return makeError("{} '{}' is not one of {}", option, text, known);
}

/// Written so that NaN fails.
Status requireRange(const char* option, double value, double lowest, double highest) {
    if (value >= lowest && value <= highest)
        return {};
    return makeError("{} {} must lie in [{}, {}]", option, value, lowest, highest);
}

Status requireAbove0(const char* option, double value) {
    if (value > 0.0 && std::isfinite(value))
        return {};
    return makeError("{} {} must be above 0", option, value);
}

Status parseMode(const ShutterArguments& arguments, CameraShutter& shutter) {
    if (arguments.exposureSeconds && arguments.shutterAngle)
        return makeError("--exposure and --shutter-angle exclude each other");
    if (arguments.shutterMode.empty())
        shutter.mode = arguments.shutterAngle ? ShutterMode::Angle : ShutterMode::Physical;
    else if (Status parsed = parseWord<ShutterMode, 3>(
                 "--shutter-mode",
                 arguments.shutterMode,
                 {{{"physical", ShutterMode::Physical},
                   {"angle", ShutterMode::Angle},
                   {"capped", ShutterMode::Capped}}},
                 shutter.mode
             );
             !parsed)
        return parsed;
    const bool isPhysical = shutter.mode == ShutterMode::Physical;
    if (isPhysical && arguments.shutterAngle)
        return makeError("--shutter-mode physical takes --exposure, not --shutter-angle");
    if (!isPhysical && arguments.exposureSeconds)
        return makeError(
            "--shutter-mode {} takes --shutter-angle, not --exposure", arguments.shutterMode
        );
    if (arguments.referenceFps && shutter.mode != ShutterMode::Capped)
        return makeError("--reference-fps needs --shutter-mode capped");
    return {};
}

Status
parseExposure(const ShutterArguments& arguments, double frameSeconds, CameraShutter& shutter) {
    if (Status parsed = parseMode(arguments, shutter); !parsed)
        return parsed;
    shutter.exposureSeconds = arguments.exposureSeconds.value_or(kDefaultExposureSeconds);
    shutter.angleDegrees = arguments.shutterAngle.value_or(shutter.angleDegrees);
    shutter.referenceFps = arguments.referenceFps.value_or(shutter.referenceFps);
    if (Status valid = requireAbove0("--reference-fps", shutter.referenceFps); !valid)
        return valid;
    const bool isPhysical = shutter.mode == ShutterMode::Physical;
    const double asked =
        isPhysical ? shutter.exposureSeconds : shutter.angleDegrees / 360.0 * frameSeconds;
    if (!(asked >= 0.0 && asked <= kMaxSeconds))
        return makeError(
            "{} must be 0 or more and at most {} seconds",
            isPhysical ? "--exposure" : "--shutter-angle",
            kMaxSeconds
        );
    return parseWord<ShutterPhase, 3>(
        "--phase",
        arguments.phase,
        {{{"start", ShutterPhase::Start},
          {"centre", ShutterPhase::Centre},
          {"end", ShutterPhase::End}}},
        shutter.phase
    );
}

/// NAME or NAME:NUMBER,NUMBER,...
Status parseResponse(const std::string& text, scene::ShutterResponse& response) {
    const size_t colon = text.find(':');
    const std::string name = text.substr(0, colon);
    if (Status parsed = parseWord<ResponseShape, 4>(
            "--response",
            name,
            {{{"box", ResponseShape::Box},
              {"triangle", ResponseShape::Triangle},
              {"trapezoid", ResponseShape::Trapezoid},
              {"samples", ResponseShape::Sampled}}},
            response.shape
        );
        !parsed)
        return parsed;
    std::vector<double> numbers;
    if (colon != std::string::npos)
        for (const std::string& part : splitAt(text.substr(colon + 1), ',')) {
            const auto number = core::parseNumber(part);
            if (!number)
                return makeError("--response '{}': '{}' is not a number", text, part);
            numbers.push_back(*number);
        }
    const bool takesNone =
        response.shape == ResponseShape::Box || response.shape == ResponseShape::Triangle;
    if (takesNone && colon != std::string::npos)
        return makeError("--response '{}': {} takes no numbers", text, name);
    if (response.shape == ResponseShape::Trapezoid) {
        if (numbers.size() != 2)
            return makeError("--response '{}' is not trapezoid:OPEN,CLOSE", text);
        response.openShare = numbers[0];
        response.closeShare = numbers[1];
    }
    if (response.shape == ResponseShape::Sampled)
        response.samples = std::move(numbers);
    if (Status valid = scene::validateResponse(response); !valid)
        return makeError("--response '{}': {}", text, valid.error().message);
    return {};
}

Status parseCuts(const ShutterArguments& arguments, scene::CutDetection& cuts) {
    if (Status parsed = parseWord<bool, 2>(
            "--cut-detection",
            arguments.cutDetection,
            {{{"on", true}, {"off", false}}},
            cuts.enabled
        );
        !parsed)
        return parsed;
    if (!cuts.enabled && (arguments.cutAngle || arguments.cutDistance))
        return makeError(
            "{} has no meaning with --cut-detection off",
            arguments.cutAngle ? "--cut-angle" : "--cut-distance"
        );
    cuts.degrees = arguments.cutAngle.value_or(cuts.degrees);
    cuts.metres = arguments.cutDistance.value_or(cuts.metres);
    if (Status valid = requireAbove0("--cut-angle", cuts.degrees); !valid)
        return valid;
    return requireAbove0("--cut-distance", cuts.metres);
}

Status parseScales(const ShutterArguments& arguments, CameraShutter& shutter) {
    shutter.cameraRotationScale = arguments.cameraRotationBlur;
    shutter.cameraTranslationScale = arguments.cameraTranslationBlur;
    shutter.objectScale = arguments.objectBlur;
    const std::pair<const char*, double> scales[] = {
        {"--camera-rotation-blur", shutter.cameraRotationScale},
        {"--camera-translation-blur", shutter.cameraTranslationScale},
        {"--object-blur", shutter.objectScale}};
    for (const auto& [option, value] : scales)
        if (Status valid = requireRange(option, value, 0.0, 2.0); !valid)
            return valid;
    if (!arguments.maxBlur)
        return {};
    shutter.maxBlurPercent = *arguments.maxBlur;
    return requireRange("--max-blur", shutter.maxBlurPercent, 0.0, 1000.0);
}

} // namespace

void defineShutterOptions(CLI::App& command, ShutterArguments& a) {
    command.add_option("--exposure", a.exposureSeconds, "seconds; default 1/60");
    command.add_option("--shutter-angle", a.shutterAngle, "degrees of a frame at F");
    command.add_option(
        "--shutter-mode",
        a.shutterMode,
        "physical (seconds), angle (share of the frame) or capped (angle, no longer than at "
        "--reference-fps)"
    );
    command.add_option("--reference-fps", a.referenceFps, "of --shutter-mode capped; default 24");
    command.add_option("--phase", a.phase, "raster instant: start, centre or end (default)");
    command.add_option(
        "--response",
        a.response,
        "sensitivity over the exposure: box (default), triangle, trapezoid:OPEN,CLOSE (shares of "
        "the exposure) or samples:V,V,... (2 to 64)"
    );
    command.add_option(
        "--cut-detection", a.cutDetection, "on (default) or off: a camera that jumps is cut"
    );
    command.add_option("--cut-angle", a.cutAngle, "degrees, smallest turn that is a cut; 10");
    command.add_option("--cut-distance", a.cutDistance, "metres, smallest displacement; 0.5");
    command.add_option(
        "--camera-rotation-blur", a.cameraRotationBlur, "scale of the blur by turning, 0 to 2"
    );
    command.add_option(
        "--camera-translation-blur", a.cameraTranslationBlur, "by the camera's displacement, 0 to 2"
    );
    command.add_option("--object-blur", a.objectBlur, "by what moves in the world, 0 to 2");
    command.add_option(
        "--max-blur", a.maxBlur, "longest blur, percent of the picture's width; default: no cap"
    );
}

core::Result<CameraShutter>
interpretShutter(const ShutterArguments& arguments, double frameSeconds) {
    CameraShutter shutter;
    if (Status parsed = parseExposure(arguments, frameSeconds, shutter); !parsed)
        return parsed.error();
    if (Status parsed = parseResponse(arguments.response, shutter.response); !parsed)
        return parsed.error();
    if (Status parsed = parseCuts(arguments, shutter.cuts); !parsed)
        return parsed.error();
    if (Status parsed = parseScales(arguments, shutter); !parsed)
        return parsed.error();
    return shutter;
}

std::string describeShutter(const ShutterArguments& a) {
    return fmt::format(
        "exposure {} angle {} mode {} reference {} phase {} response {} cuts {} {} {} blur {} {} "
        "{} cap {}",
        a.exposureSeconds.value_or(-1.0),
        a.shutterAngle.value_or(-1.0),
        a.shutterMode,
        a.referenceFps.value_or(-1.0),
        a.phase,
        a.response,
        a.cutDetection,
        a.cutAngle.value_or(-1.0),
        a.cutDistance.value_or(-1.0),
        a.cameraRotationBlur,
        a.cameraTranslationBlur,
        a.objectBlur,
        a.maxBlur.value_or(-1.0)
    );
}

} // namespace shutter::game
