// SPDX-License-Identifier: MIT
#include "game/options/shutter_options.h"

#include "engine/scene/shutter.h"
#include "game/options/option_rows.h"

namespace shutter::game {

namespace {

using core::makeError;
using core::Status;
using scene::ResponseShape;
using scene::ShutterMode;

/// NAME or NAME:NUMBER,NUMBER,...
Status parseResponse(const std::string& text, scene::ShutterResponse& response) {
    const size_t colon = text.find(':');
    const std::string name = text.substr(0, colon);
    const auto& shape = core::getRow(scene::listResponseRows(), "shape");
    SHUTTER_TRY(core::parseValue(shape, name, response));
    std::vector<double> numbers;
    if (colon != std::string::npos)
        for (const std::string& part : splitAt(text.substr(colon + 1), ',')) {
            const auto number = core::parseNumber(part);
            if (!number)
                return makeError("'{}': '{}' is not a number", text, part);
            numbers.push_back(*number);
        }
    const bool takesNone =
        response.shape == ResponseShape::Box || response.shape == ResponseShape::Triangle;
    if (takesNone && colon != std::string::npos)
        return makeError("'{}': {} takes no numbers", text, name);
    if (response.shape == ResponseShape::Trapezoid) {
        if (numbers.size() != 2)
            return makeError("'{}' is not trapezoid:OPEN,CLOSE", text);
        response.openShare = numbers[0];
        response.closeShare = numbers[1];
    }
    if (response.shape == ResponseShape::Sampled)
        response.samples = std::move(numbers);
    if (Status valid = scene::validateResponse(response); !valid)
        return makeError("'{}': {}", text, valid.error().message);
    return {};
}

/// Options that only some modes read.
Status checkMode(const ShutterArguments& arguments, ShutterMode mode) {
    const bool isPhysical = mode == ShutterMode::Physical;
    if (arguments.isTyped("--exposure") && arguments.isTyped("--shutter-angle"))
        return makeError("--exposure and --shutter-angle exclude each other");
    if (isPhysical && arguments.isTyped("--shutter-angle"))
        return makeError("--shutter-mode physical takes --exposure, not --shutter-angle");
    if (!isPhysical && arguments.isTyped("--exposure"))
        return makeError(
            "--shutter-mode {} takes --shutter-angle, not --exposure",
            mode == ShutterMode::Angle ? "angle" : "capped"
        );
    if (mode != ShutterMode::Capped && arguments.isTyped("--reference-fps"))
        return makeError("--reference-fps needs --shutter-mode capped");
    return {};
}

} // namespace

ShutterArguments makeShutterArguments(double exposureSeconds, const std::string& phase) {
    ShutterArguments arguments;
    arguments.shutter.exposureSeconds = exposureSeconds;
    const auto& row = core::getRow(scene::listShutterRows(), "phase");
    const Status parsed = core::parseValue(row, phase, arguments.shutter);
    SHUTTER_CHECK(parsed.ok(), "{}", parsed.error().message);
    return arguments;
}

void defineShutterOptions(CLI::App& command, ShutterArguments& arguments) {
    scene::CameraShutter& shutter = arguments.shutter;
    defineSettingOptions(command, scene::listShutterRows(), shutter, arguments.typed);
    addParsedOption(
        command,
        "--response",
        "Sensitivity over the exposure: box (default), triangle, trapezoid:OPEN,CLOSE (shares of "
        "the exposure) or samples:V,V,... (2 to 64)",
        [&shutter](const std::string& text) { return parseResponse(text, shutter.response); }
    );
    defineSettingOptions(command, scene::listCutRows(), shutter.cuts, arguments.typed);
}

core::Result<scene::CameraShutter> interpretShutter(const ShutterArguments& arguments) {
    scene::CameraShutter shutter = arguments.shutter;
    if (!arguments.isTyped("--shutter-mode") && arguments.isTyped("--shutter-angle") &&
        !arguments.isTyped("--exposure"))
        shutter.mode = ShutterMode::Angle;
    SHUTTER_TRY(checkMode(arguments, shutter.mode));
    for (const char* threshold : {"--cut-angle", "--cut-distance"})
        if (!shutter.cuts.enabled && arguments.isTyped(threshold))
            return makeError("{} has no meaning with --cut-detection off", threshold);
    SHUTTER_TRY(scene::validate(shutter, "shutter."));
    return shutter;
}

} // namespace shutter::game
