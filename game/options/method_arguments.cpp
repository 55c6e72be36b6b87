// SPDX-License-Identifier: MIT
#include "game/options/method_arguments.h"

#include "engine/core/setting_row.h"
#include "game/options/option_rows.h"
#include "game/shot/methods.h"
#include "game/shot/picture_drawer.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace shutter::game {

namespace {

using core::makeError;
using core::Status;

constexpr uint32_t kMaxSamples = 65536;
constexpr double kMinStepPx = 1.0e-3;
constexpr double kMaxStepPx = 1.0e3;
constexpr uint32_t kMaxInstants = 1024; ///< of `--instants auto` without --samples

using M = MethodArguments;

constexpr std::array kRows = {
    makeRow<&M::method>("--method", "method, see `shutter info --methods`; default resolved"),
    makeRow<&M::preset>(
        "--preset",
        "off, performance, balanced, quality or paper: a method and its settings; the middle three "
        "also set --aa, --shadows and --bloom of `render` and `film`, unless these are given"
    ),
    makeRow<&M::samples>(
        "--samples",
        "taps (filters), instants (resolved, adaptive, accumulate) or rays per pixel (truth, "
        "denoised)"
    ),
    makeRow<&M::error>("--error", "stop truth at this standard error (linear RMS)"),
    makeRow<&M::instants>(
        "--instants",
        "auto: accumulate takes as many instants as the frame moves, --samples at most"
    ),
    makeRow<&M::maxStepPx>(
        "--max-step",
        "with --instants auto: what nothing moves farther than between two of them, pixels; "
        "default 1"
    ),
    makeRow<&M::settings>("--set", "change a setting of the method, NAME=VALUE (repeatable)"),
};

/// The method and its settings, before any of them is changed.
Status chooseMethod(const MethodArguments& arguments, MethodOptions& options) {
    const Preset* preset = nullptr;
    if (!arguments.preset.empty()) {
        const auto found = findPreset(arguments.preset);
        if (!found)
            return found.error();
        preset = found.value();
    }
    const auto method = findMethod(preset ? preset->method : arguments.method);
    if (!method)
        return method.error();
    options =
        makeMethod(*method.value(), preset ? preset->blur : motion_blur::MotionBlurSettings());
    return {};
}

Status interpretSamples(const MethodArguments& arguments, MethodOptions& options) {
    const auto& row = core::getRow(motion_blur::listSettingRows(), "sampleCount");
    const uint32_t most = options.method->blur ? uint32_t(row.range.highest) : kMaxSamples;
    options.samples = arguments.samples.value_or(options.samples);
    if (arguments.samples && (options.samples == 0 || options.samples > most))
        return makeError("--samples {} must lie in [1, {}]", options.samples, most);
    if (!options.method->blur)
        return {};
    options.motionBlur.sampleCount = options.samples;
    if (Status valid = motion_blur::validate(options.motionBlur); !valid)
        return makeError("--samples: {}", valid.error().message);
    return {};
}

Status interpretError(const MethodArguments& arguments, MethodOptions& options) {
    if (arguments.error && options.method->family != MethodFamily::Truth)
        return makeError("--error needs a method that estimates its error: truth");
    // Written so that NaN fails.
    if (arguments.error && !(*arguments.error > 0.0 && std::isfinite(*arguments.error)))
        return makeError("--error {} must be above 0", *arguments.error);
    options.error = arguments.error;
    return {};
}

Status interpretInstants(const MethodArguments& arguments, MethodOptions& options) {
    if (arguments.instants.empty())
        return arguments.maxStepPx ? makeError("--max-step requires --instants auto") : Status();
    if (arguments.instants != "auto")
        return makeError(
            "--instants '{}' is not auto; --samples sets a number", arguments.instants
        );
    if (options.method->family != MethodFamily::Accumulate)
        return makeError(
            "--instants auto is for accumulate: method {} draws one raster image, or rays that "
            "--error ends",
            options.method->name
        );
    options.maxStepPx = arguments.maxStepPx.value_or(1.0);
    // Written so that NaN fails.
    if (!(*options.maxStepPx >= kMinStepPx && *options.maxStepPx <= kMaxStepPx))
        return makeError(
            "--max-step {} must lie in [{}, {}]", *options.maxStepPx, kMinStepPx, kMaxStepPx
        );
    if (!arguments.samples)
        options.samples = kMaxInstants;
    return {};
}

} // namespace

void defineMethodOptions(CLI::App& command, MethodArguments& arguments) {
    defineRows(command, OptionRows<M>(kRows), arguments);
    command.get_option("--preset")->excludes("--method");
    defineSettingOptions(command, motion_blur::listBudgetRows(), arguments.budget, arguments.typed);
}

core::Result<MethodOptions> interpret(const MethodArguments& arguments) {
    MethodOptions options;
    for (const auto step : {chooseMethod, interpretSamples, interpretInstants, interpretError})
        SHUTTER_TRY(step(arguments, options));
    for (const std::string& setting : arguments.settings)
        SHUTTER_TRY(applySetting(setting, *options.method, options.motionBlur));
    if (arguments.typed.contains("--budget") && !options.method->blur)
        return makeError("--budget: method {} has nothing to give up", options.method->name);
    options.budget = arguments.budget;
    if (Status valid = motion_blur::validate(options.budget); !valid)
        return makeError("--budget: {}", valid.error().message);
    return options;
}

Status applySetting(
    const std::string& text, const MethodInfo& method, motion_blur::MotionBlurSettings& settings
) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos)
        return makeError("--set '{}' is not NAME=VALUE", text);
    const std::string name = text.substr(0, equals);
    const std::string value = text.substr(equals + 1);
    if (!method.blur)
        return makeError("--set '{}': method {} has no settings", name, method.name);
    const std::vector<std::string_view>& known = method.blur->settings;
    if (std::find(known.begin(), known.end(), name) == known.end())
        return makeError(
            "--set '{}': method {} has no such setting, it has {}{}",
            name,
            method.name,
            fmt::join(known, ", "),
            method.sampleUnit ? "; the sample count is --samples" : ""
        );
    const auto& row = core::getRow(motion_blur::listSettingRows(), name);
    if (Status parsed = core::parseValue(row, value, settings); !parsed)
        return makeError("--set {}: {}", name, parsed.error().message);
    return {};
}

std::string describe(const MethodArguments& arguments) {
    return describeRows(OptionRows<M>(kRows), arguments) +
           core::describeValues(motion_blur::listBudgetRows(), arguments.budget);
}

} // namespace shutter::game
