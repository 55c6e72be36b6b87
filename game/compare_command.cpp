// SPDX-License-Identifier: MIT
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "game/commands.h"
#include "game/intermediates.h"
#include "game/report.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace shutter::game {

namespace {

struct CompareArguments {
    std::string a;
    std::string b;
    std::string out;
    bool json = false;
};

/// Absolute difference as black, red, yellow, white; full scale at a difference of 0.5.
image::Image makeHeatMap(const image::Image& a, const image::Image& b) {
    image::Image heat(a.width, a.height, 3);
    const uint32_t channels = a.channels;
    for (uint32_t y = 0; y < a.height; ++y)
        for (uint32_t x = 0; x < a.width; ++x) {
            float error = 0.0f;
            for (uint32_t c = 0; c < channels; ++c)
                error = std::max(error, std::abs(a.at(x, y, c) - b.at(x, y, c)));
            if (!(error == error))
                error = 1.0f;
            const float level = std::min(error * 2.0f, 1.0f) * 3.0f;
            for (uint32_t c = 0; c < 3; ++c)
                heat.at(x, y, c) = std::clamp(level - static_cast<float>(c), 0.0f, 1.0f);
        }
    return heat;
}

/// Colour alone: alpha says nothing of how a picture looks.
core::Result<image::Image> readColor(const std::string& path) {
    auto picture = io::readImage(path);
    if (!picture || picture.value().channels <= 3)
        return picture;
    return selectChannels(picture.value(), {{0, "R"}, {1, "G"}, {2, "B"}});
}

core::Status
checkComparable(const CompareArguments& arguments, const image::Image& a, const image::Image& b) {
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
    return {};
}

core::Status runCompare(const CompareArguments& arguments) {
    if (!arguments.out.empty())
        if (core::Status writable = io::checkWritable(arguments.out); !writable)
            return core::makeError("--out: {}", writable.error().message);
    auto a = readColor(arguments.a);
    if (!a)
        return a.error();
    auto b = readColor(arguments.b);
    if (!b)
        return b.error();
    if (core::Status comparable = checkComparable(arguments, a.value(), b.value()); !comparable)
        return comparable;
    const double psnr = image::computePsnr(a.value(), b.value());
    const double ssim = image::computeSsim(a.value(), b.value());
    if (arguments.json) {
        // JSON has no infinity: equal pictures have a null PSNR and "equal": true.
        nlohmann::json result = {{"ssim", ssim}, {"equal", std::isinf(psnr)}};
        result["psnr_db"] = std::isinf(psnr) ? nlohmann::json() : nlohmann::json(psnr);
        result["max_difference"] = image::computeMaxDifference(a.value(), b.value());
        fmt::print("{}\n", result.dump());
    } else {
        fmt::print("PSNR {:.2f} dB  SSIM {:.4f}\n", psnr, ssim);
    }
    if (arguments.out.empty())
        return {};
    return io::writeImage(arguments.out, makeHeatMap(a.value(), b.value()));
}

} // namespace

void addCompareCommand(CLI::App& app, int& exitStatus) {
    CLI::App* command = app.add_subcommand(
        "compare", "PSNR and SSIM of two pictures, values as stored, clamped to [0, 1]"
    );
    auto arguments = std::make_shared<CompareArguments>();
    command->add_option("a", arguments->a, "picture")->required();
    command->add_option("b", arguments->b, "reference")->required();
    command->add_flag("--json", arguments->json, "print JSON");
    command->add_option("--out", arguments->out, "heat map of the absolute difference");
    command->callback([arguments, &exitStatus] {
        const core::Status done = runCompare(*arguments);
        if (!done)
            printError(done.error());
        exitStatus = done ? kExitDone : kExitFailed;
    });
}

} // namespace shutter::game
