// SPDX-License-Identifier: MIT
#include "engine/core/result.h"
#include "engine/image/image.h"
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "game/cli/commands.h"
#include "game/options/program.h"
#include "game/options/shot_arguments.h"
#include "game/output/extra_files.h"
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
#include <string>
#include <string_view>
#include <utility>

namespace shutter::game {

namespace {

// What is compared: both pictures brought to the display alike.

struct CompareInput {
    image::Image image;        ///< colour alone: alpha does not change how a picture looks
    bool isDisplay = false;    ///< values are display values, sRGB
    bool isToneMapped = false; ///< they were tone mapped here
};

/// "R" of "R" and of "layer.R".
std::string_view lastPart(std::string_view channelName) {
    return channelName.substr(channelName.find_last_of('.') + 1);
}

/// Whether the channels are red, green, blue or grey, by name. Motion and depth are not colours.
bool isColor(const image::Image& picture) {
    const auto& names = picture.channelNames;
    if (picture.channels == 1)
        return names.empty() || lastPart(names[0]) == "Y";
    constexpr std::array<std::string_view, 3> kRgb{"R", "G", "B"};
    return picture.channels == 3 &&
           (names.empty() ||
            std::equal(kRgb.begin(), kRgb.end(), names.begin(), [](auto a, auto& b) {
                return a == lastPart(b);
            }));
}

image::Image dropAlpha(image::Image picture) {
    if (picture.channels == 2 && picture.channelNames.size() == 2 &&
        lastPart(picture.channelNames[1]) == "A")
        return selectChannels(picture, {{0, "Y"}});
    if (picture.channels <= 3)
        return picture;
    std::vector<std::string> names = std::move(picture.channelNames);
    image::Image color = selectChannels(picture, {{0, "R"}, {1, "G"}, {2, "B"}});
    if (names.size() >= 3)
        color.channelNames.assign(names.begin(), names.begin() + 3);
    return color;
}

/// Reads a picture. One that is not stored for a display (EXR, HDR) is tone mapped, unless `stored`
/// keeps the values as they are. Error: names the file; channels that are not colours cannot be
/// tone mapped.
core::Result<CompareInput>
readCompareInput(const std::string& path, bool stored, const tonemap::TonemapSettings& settings) {
    auto file = io::readStoredImage(path);
    if (!file)
        return file.error();
    CompareInput input;
    input.image = dropAlpha(std::move(file.value().image));
    input.isDisplay = file.value().isDisplayEncoded;
    if (input.isDisplay || stored)
        return input;
    if (!isColor(input.image))
        return core::makeError(
            "'{}' holds no colour that can be tone mapped but {}: compare its values with --linear",
            path,
            fmt::join(input.image.channelNames, ", ")
        );
    input.image = tonemap::computeDisplayImage(input.image, settings);
    input.isDisplay = true;
    input.isToneMapped = true;
    return input;
}

struct CompareArguments {
    std::string a;
    std::string b;
    std::string out;
    std::string map;       ///< empty: flip where both are display values, else difference
    ShotArguments display; ///< --tonemap and --ev
    bool linear = false;
    bool json = false;
};

/// Both pictures, and how they came to be comparable.
struct Comparison {
    CompareInput a;
    CompareInput b;
    tonemap::TonemapSettings tonemap;

    [[nodiscard]] bool isDisplay() const { return a.isDisplay && b.isDisplay; }
};

struct Metrics {
    double psnrDb = 0.0; ///< infinity: equal
    double ssim = 0.0;
    double maxDifference = 0.0;
    std::optional<image::FlipResult>
        flip; ///< of display values only: it models what a display shows
};

/// Absolute difference as black, red, yellow, white; full scale at a difference of 0.5.
image::Image makeHeatMap(const image::Image& a, const image::Image& b) {
    image::Image heat(a.width, a.height, 3);
    const uint32_t channels = a.channels;
    for (uint32_t y = 0; y < a.height; ++y)
        for (uint32_t x = 0; x < a.width; ++x) {
            float error = 0.0f;
            for (uint32_t c = 0; c < channels; ++c) {
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

core::Status checkComparable(const CompareArguments& arguments, const Comparison& pictures) {
    const image::Image& a = pictures.a.image;
    const image::Image& b = pictures.b.image;
    if (a.width != b.width || a.height != b.height)
        return core::makeError(
            "'{}' is {}x{} and '{}' is {}x{}: pictures of one size can be compared",
            arguments.a,
            a.width,
            a.height,
            arguments.b,
            b.width,
            b.height
        );
    if (a.channels != b.channels)
        return core::makeError(
            "'{}' has {} channels and '{}' has {}", arguments.a, a.channels, arguments.b, b.channels
        );
    if (arguments.map == "flip" && !pictures.isDisplay())
        return core::makeError(
            "--map flip needs display values, which --linear does not make of '{}'",
            pictures.a.isDisplay ? arguments.b : arguments.a
        );
    return {};
}

/// The words alone: what it finds is wrong usage.
core::Status checkArguments(const CompareArguments& arguments) {
    if (!arguments.map.empty() && arguments.map != "flip" && arguments.map != "difference")
        return core::makeError("--map '{}' is not one of flip, difference", arguments.map);
    if (!arguments.map.empty() && arguments.out.empty())
        return core::makeError("--map needs --out, the file to write");
    return {};
}

core::Result<Comparison>
readPictures(const CompareArguments& arguments, const tonemap::TonemapSettings& tonemap) {
    auto a = readCompareInput(arguments.a, arguments.linear, tonemap);
    if (!a)
        return a.error();
    auto b = readCompareInput(arguments.b, arguments.linear, tonemap);
    if (!b)
        return b.error();
    Comparison pictures{std::move(a.value()), std::move(b.value()), tonemap};
    SHUTTER_TRY(checkComparable(arguments, pictures));
    return pictures;
}

Metrics measure(const Comparison& pictures) {
    const image::Image& a = pictures.a.image;
    const image::Image& b = pictures.b.image;
    Metrics metrics;
    metrics.psnrDb = image::computePsnr(a, b);
    metrics.ssim = image::computeSsim(a, b);
    metrics.maxDifference = image::computeMaxDifference(a, b);
    if (pictures.isDisplay())
        metrics.flip = image::computeFlip(a, b);
    return metrics;
}

/// Which values the metrics are of.
std::string describeValues(const CompareArguments& arguments, const Comparison& pictures) {
    if (!pictures.isDisplay())
        return "values as stored, clamped to [0, 1]";
    const bool both = pictures.a.isToneMapped && pictures.b.isToneMapped;
    if (!pictures.a.isToneMapped && !pictures.b.isToneMapped)
        return "display values as stored";
    std::string text = fmt::format(
        "display values, tone map {}, EV {:g}",
        kTonemapWords[static_cast<size_t>(pictures.tonemap.op)],
        pictures.tonemap.exposureValue
    );
    if (!both)
        text += fmt::format(
            " of '{}' alone", toOneLine(pictures.a.isToneMapped ? arguments.a : arguments.b)
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
        {"operator", kTonemapWords[static_cast<size_t>(pictures.tonemap.op)]},
        {"ev", pictures.tonemap.exposureValue},
        {"applied_to", applied}};
}

void printJson(const Comparison& pictures, const Metrics& metrics) {
    // JSON has no infinity: equal pictures have a null PSNR and "equal": true.
    const bool equal = std::isinf(metrics.psnrDb);
    nlohmann::json result = {{"ssim", metrics.ssim}, {"equal", equal}};
    result["psnr_db"] = equal ? nlohmann::json() : nlohmann::json(metrics.psnrDb);
    result["flip"] = metrics.flip ? nlohmann::json(metrics.flip->mean) : nlohmann::json();
    result["max_difference"] = metrics.maxDifference;
    result["values"] = pictures.isDisplay() ? "display" : "stored";
    result["tonemap"] = describeTonemap(pictures);
    fmt::print("{}\n", result.dump());
}

void printText(
    const CompareArguments& arguments, const Comparison& pictures, const Metrics& metrics
) {
    fmt::print(
        "PSNR {:.2f} dB  SSIM {:.4f}{}  ({})\n",
        metrics.psnrDb,
        metrics.ssim,
        metrics.flip ? fmt::format("  FLIP {:.4f}", metrics.flip->mean) : std::string(),
        describeValues(arguments, pictures)
    );
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

core::Status
runCompare(const CompareArguments& arguments, const tonemap::TonemapSettings& tonemap) {
    if (!arguments.out.empty())
        if (core::Status writable = io::checkWritable(arguments.out); !writable)
            return core::makeError("--out: {}", writable.error().message);
    const auto pictures = readPictures(arguments, tonemap);
    if (!pictures)
        return pictures.error();
    const Metrics metrics = measure(pictures.value());
    if (arguments.json)
        printJson(pictures.value(), metrics);
    else
        printText(arguments, pictures.value(), metrics);
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
        "compare values as stored, clamped to [0, 1], without tone mapping"
    );
    for (CLI::Option* option : defineTonemapOptions(*command, arguments->display))
        option->excludes(linear);
    command->callback([arguments, &exitStatus] {
        const auto fail = [&](int status, const core::Error& error) {
            printError(error);
            exitStatus = status;
        };
        if (const core::Status sensible = checkArguments(*arguments); !sensible)
            return fail(kExitUsage, sensible.error());
        const auto tonemap = interpretTonemap(arguments->display);
        if (!tonemap)
            return fail(kExitUsage, tonemap.error());
        if (const core::Status done = runCompare(*arguments, tonemap.value()); !done)
            return fail(kExitFailed, done.error());
        exitStatus = kExitDone;
    });
}

} // namespace shutter::game
