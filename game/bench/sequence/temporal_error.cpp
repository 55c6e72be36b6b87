// SPDX-License-Identifier: MIT
#include "game/bench/sequence/temporal_error.h"

#include <algorithm>
#include <cmath>

namespace shutter::bench {

namespace {

constexpr uint32_t kColors = 3;

void checkAlike(const image::Image& a, const image::Image& b) {
    SHUTTER_CHECK(
        a.width == b.width && a.height == b.height && a.channels == b.channels,
        "pictures of {}x{} and {}x{}",
        a.width,
        a.height,
        b.width,
        b.height
    );
}

uint32_t countColors(const image::Image& picture) {
    return std::min(picture.channels, kColors);
}

} // namespace

double computeFlicker(const FramePair& before, const FramePair& now) {
    checkAlike(before.picture, before.truth);
    checkAlike(before.picture, now.picture);
    checkAlike(before.picture, now.truth);
    constexpr double kLargest = 2.0;
    const uint32_t colors = countColors(now.picture);
    const size_t pixels = size_t(now.picture.width) * now.picture.height;
    if (pixels == 0)
        return 0.0;
    double sum = 0.0;
    for (size_t i = 0; i < pixels; ++i)
        for (uint32_t c = 0; c < colors; ++c) {
            const size_t at = i * now.picture.channels + c;
            const double changed =
                double(now.picture.pixels[at]) - double(before.picture.pixels[at]);
            const double due = double(now.truth.pixels[at]) - double(before.truth.pixels[at]);
            const double error = std::abs(changed - due);
            sum += std::isnan(error) ? kLargest : error;
        }
    return sum / double(pixels * colors);
}

image::Image computeFineError(const image::Image& picture, const image::Image& truth) {
    checkAlike(picture, truth);
    const uint32_t colors = countColors(picture);
    if (picture.width < 3 || picture.height < 3)
        return {0, 0, colors};
    image::Image fine(picture.width - 2, picture.height - 2, colors);
    const auto errorAt = [&](uint32_t x, uint32_t y, uint32_t c) {
        const float error = picture.at(x, y, c) - truth.at(x, y, c);
        return std::isnan(error) ? 1.0f : error;
    };
    for (uint32_t y = 0; y < fine.height; ++y)
        for (uint32_t x = 0; x < fine.width; ++x)
            for (uint32_t c = 0; c < colors; ++c) {
                const float around = errorAt(x, y + 1, c) + errorAt(x + 2, y + 1, c) +
                                     errorAt(x + 1, y, c) + errorAt(x + 1, y + 2, c);
                fine.at(x, y, c) = 0.5f * (errorAt(x + 1, y + 1, c) - 0.25f * around);
            }
    return fine;
}

double computeFixedPower(const image::Image& before, const image::Image& now) {
    checkAlike(before, now);
    if (now.pixels.empty())
        return 0.0;
    double sum = 0.0;
    for (size_t i = 0; i < now.pixels.size(); ++i)
        sum += double(before.pixels[i]) * double(now.pixels[i]);
    return sum / double(now.pixels.size());
}

double computeFixedNoise(std::span<const double> powers) {
    double sum = 0.0;
    for (const double power : powers)
        sum += power;
    return powers.empty() ? 0.0 : std::sqrt(std::max(sum / double(powers.size()), 0.0));
}

double computeFilmPsnr(std::span<const double> psnr) {
    SHUTTER_CHECK(!psnr.empty(), "a film without frames");
    double meanSquare = 0.0;
    for (const double each : psnr)
        meanSquare += std::pow(10.0, -each / 10.0);
    return -10.0 * std::log10(meanSquare / double(psnr.size()));
}

} // namespace shutter::bench
