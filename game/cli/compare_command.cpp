// SPDX-License-Identifier: MIT
#include "engine/core/result.h"
#include "engine/image/flip.h"
#include "engine/image/image.h"
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "game/cli/commands.h"
#include "game/cli/compare_pictures.h"
#include "game/options/option_rows.h"
#include "game/options/program.h"
#include "modules/tonemap/tonemap.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <string>

namespace shutter::game {

namespace {

struct CompareArguments {
    std::string a;
    std::string b;
    std::string out;
    std::string map; ///< empty: flip where both are display values, else difference
    tonemap::TonemapSettings tonemap{};
    std::set<std::string> typed; ///< options of `tonemap`
    bool linear = false;
    bool json = false;
};

std::string describeOperator(const tonemap::TonemapSettings& settings) {
    return core::describeValue(core::getRow(tonemap::listTonemapRows(), "tonemap"), settings);
}

struct Metrics {
    double psnrDb = 0.0; ///< infinity: equal
    double ssim = 0.0;
    double peak = 1.0;                     ///< that the first two are for
    bool isEqual = false;                  ///< nothing that was compared differs
    std::optional<image::FlipResult> flip; ///< of display values only: it models a display
};

/// Absolute difference as black, red, yellow, white; full scale at a difference of 0.5.
image::Image makeHeatMap(const image::Image& a, const image::Image& b) {
    image::Image heat(a.width, a.height, 3);
    const uint32_t channels = a.channels;
    for (uint32_t y = 0; y < a.height; ++y)
        for (uint32_t x = 0; x < a.width; ++x) {
            float error = 0.0f;
            for (uint32_t c = 0; c < channels; ++c) {
                if (a.at(x, y, c) == b.at(x, y, c))
                    continue; // infinite, too
                const float difference = std::abs(a.at(x, y, c) - b.at(x, y, c));
                error = difference <= error ? error : difference; // takes a NaN
                if (std::isnan(error))
                    break;
            }
            if (std::isnan(error))
                error = 1.0f;
            const float level = std::min(error * 2.0f, 1.0f) * 3.0f;
            for (uint32_t c = 0; c < 3; ++c)
                heat.at(x, y, c) = std::clamp(level - static_cast<float>(c), 0.0f, 1.0f);
        }
    return heat;
}

/// Checks the arguments alone: an error is wrong usage.
core::Status checkArguments(const CompareArguments& arguments) {
    if (!arguments.map.empty() && arguments.map != "flip" && arguments.map != "difference")
        return core::makeError("--map '{}' is not one of flip, difference", arguments.map);
    if (!arguments.map.empty() && arguments.out.empty())
        return core::makeError("--map needs --out, the file to write");
    return {};
}

core::Status checkMap(const CompareArguments& arguments, const Comparison& pictures) {
    if (arguments.map != "flip" || pictures.isDisplay())
        return {};
    return core::makeError(
        "--map flip needs display values, which --linear does not make of '{}'",
        pictures.a.isDisplay ? arguments.b : arguments.a
    );
}

Metrics measure(const Comparison& pictures) {
    const image::Image& a = pictures.a.image;
    const image::Image& b = pictures.b.image;
    Metrics metrics;
    metrics.isEqual =
        pictures.maxDifference == 0.0 && pictures.storedDifference.value_or(0.0) == 0.0 &&
        std::all_of(pictures.others.begin(), pictures.others.end(), [](const OtherChannel& other) {
            return other.maxDifference == 0.0;
        });
    if (pictures.isDisplay()) {
        metrics.psnrDb = image::computePsnr(a, b);
        metrics.ssim = image::computeSsim(a, b);
        metrics.flip = image::computeFlip(a, b);
    } else {
        metrics.peak = image::findPeak(b);
        metrics.psnrDb = image::computeStoredPsnr(a, b);
        metrics.ssim = image::computeStoredSsim(a, b, pictures.isColor);
    }
    return metrics;
}

/// Which values the metrics are of.
std::string describeValues(const Comparison& pictures, const Metrics& metrics) {
    if (!pictures.isDisplay())
        return fmt::format(
            "values as stored{}, peak {:g}",
            pictures.isColor
                ? std::string()
                : fmt::format(" of {}", fmt::join(pictures.a.image.channelNames, ", ")),
            metrics.peak
        );
    const bool both = pictures.a.isToneMapped && pictures.b.isToneMapped;
    if (!pictures.a.isToneMapped && !pictures.b.isToneMapped)
        return "display values as stored";
    std::string text = fmt::format(
        "display values, tone map {}, EV {:g}",
        describeOperator(pictures.tonemap),
        pictures.tonemap.exposureValue
    );
    if (!both)
        text += fmt::format(
            " of '{}' alone", toOneLine(pictures.a.isToneMapped ? pictures.a.name : pictures.b.name)
        );
    return text;
}

nlohmann::json describeTonemap(const Comparison& pictures) {
    nlohmann::json applied = nlohmann::json::array();
    if (pictures.a.isToneMapped)
        applied.push_back("a");
    if (pictures.b.isToneMapped)
        applied.push_back("b");
    if (applied.empty())
        return {};
    return {
        {"operator", describeOperator(pictures.tonemap)},
        {"ev", pictures.tonemap.exposureValue},
        {"applied_to", applied}};
}

/// JSON has no infinity: null.
nlohmann::json describeNumber(double number) {
    return std::isfinite(number) ? nlohmann::json(number) : nlohmann::json();
}

void printJson(const Comparison& pictures, const Metrics& metrics) {
    nlohmann::json result = {{"ssim", metrics.ssim}, {"equal", metrics.isEqual}};
    result["psnr_db"] = describeNumber(metrics.psnrDb);
    result["peak"] = metrics.peak;
    result["flip"] = metrics.flip ? nlohmann::json(metrics.flip->mean) : nlohmann::json();
    result["max_difference"] = describeNumber(pictures.maxDifference);
    result["stored_max_difference"] =
        pictures.storedDifference ? describeNumber(*pictures.storedDifference) : nlohmann::json();
    nlohmann::json& others = result["other_channels"] = nlohmann::json::object();
    for (const OtherChannel& other : pictures.others)
        others[other.name] = describeNumber(other.maxDifference);
    result["notes"] = pictures.notes;
    result["values"] = pictures.isDisplay() ? "display" : "stored";
    result["tonemap"] = describeTonemap(pictures);
    fmt::print("{}\n", result.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void printText(const Comparison& pictures, const Metrics& metrics) {
    fmt::print(
        "PSNR {:.2f} dB  SSIM {:.4f}{}  ({})\n",
        metrics.psnrDb,
        metrics.ssim,
        metrics.flip ? fmt::format("  FLIP {:.4f}", metrics.flip->mean) : std::string(),
        describeValues(pictures, metrics)
    );
    for (const OtherChannel& other : pictures.others)
        if (other.maxDifference > 0.0)
            fmt::print(
                "{} differs by up to {:g}, which no metric is of\n",
                toOneLine(other.name),
                other.maxDifference
            );
    for (const std::string& note : pictures.notes)
        fmt::print("{}\n", toOneLine(note));
}

core::Status
writeMap(const CompareArguments& arguments, const Comparison& pictures, const Metrics& metrics) {
    if (arguments.map == "difference" || !metrics.flip)
        return io::writeImage(arguments.out, makeHeatMap(pictures.a.image, pictures.b.image));
    const image::Image& errors = metrics.flip->errorMap;
    // The extension was checked before. A display format gets colours, any other the errors
    // themselves.
    return io::writeImage(
        arguments.out,
        io::isDisplayFormat(arguments.out).value() ? image::colorWithMagma(errors) : errors
    );
}

core::Status runCompare(const CompareArguments& arguments) {
    if (!arguments.out.empty())
        if (core::Status writable = io::checkWritable(arguments.out); !writable)
            return core::makeError("--out: {}", writable.error().message);
    const auto pictures =
        readComparison(arguments.a, arguments.b, arguments.linear, arguments.tonemap);
    if (!pictures)
        return pictures.error();
    SHUTTER_TRY(checkMap(arguments, pictures.value()));
    const Metrics metrics = measure(pictures.value());
    if (arguments.json)
        printJson(pictures.value(), metrics);
    else
        printText(pictures.value(), metrics);
    return arguments.out.empty() ? core::Status() : writeMap(arguments, pictures.value(), metrics);
}

} // namespace

void addCompareCommand(CLI::App& app, int& exitStatus) {
    CLI::App* command = app.add_subcommand(
        "compare",
        "PSNR, SSIM and FLIP of two pictures as a display shows them: EXR and HDR are tone mapped, "
        "8 and 16-bit pictures are taken as stored"
    );
    auto arguments = std::make_shared<CompareArguments>();
    command->add_option("a", arguments->a, "picture")->required();
    command->add_option("b", arguments->b, "reference")->required();
    command->add_flag("--json", arguments->json, "print JSON");
    command->add_option(
        "--out", arguments->out, "write an error map: .png or .jpg in colours, or .exr"
    );
    command->add_option(
        "--map",
        arguments->map,
        "kind of error map: flip (default) or difference (absolute, white at 0.5)"
    );
    CLI::Option* linear = command->add_flag(
        "--linear",
        arguments->linear,
        "compare values as stored, whatever their size, without tone mapping"
    );
    defineSettingOptions(
        *command, tonemap::listTonemapRows(), arguments->tonemap, arguments->typed
    );
    for (const auto& row : tonemap::listTonemapRows())
        command->get_option(row.option)->excludes(linear);
    command->callback([arguments, &exitStatus] {
        const auto fail = [&](int status, const core::Error& error) {
            printError(error);
            exitStatus = status;
        };
        if (const core::Status sensible = checkArguments(*arguments); !sensible)
            return fail(kExitUsage, sensible.error());
        if (const core::Status done = runCompare(*arguments); !done)
            return fail(kExitFailed, done.error());
        exitStatus = kExitDone;
    });
}

} // namespace shutter::game
