// SPDX-License-Identifier: MIT
#include "engine/image/hdr_flip.h"

#include "engine/image/metric_parts.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace shutter::image {

namespace {

/// The ACES curve of Narkowicz 2016 with its exposure of 0.6, which HDR-FLIP takes for what a
/// display's tone map does: (a0 x^2 + a1 x) / (b0 x^2 + b1 x + b2).
struct ToneCurve {
    double a0 = 0.6 * 0.6 * 2.51;
    double a1 = 0.6 * 0.03;
    double b0 = 0.6 * 0.6 * 2.43;
    double b1 = 0.6 * 0.59;
    double b2 = 0.14;
};

constexpr ToneCurve kCurve{};
/// What the curve makes of the brightest light at the first exposure, and of the median at the
/// last.
constexpr double kShown = 0.85;
/// From the first exposure to the last: where half of a picture is black, no exposure shows it.
constexpr double kMostStops = 20.0;
/// A black picture has no brightest light.
constexpr double kLeastLuminance = 1.0e-6;

float applyCurve(float x) {
    const double value = double(x);
    return float(
        (kCurve.a0 * value + kCurve.a1) * value /
        ((kCurve.b0 * value + kCurve.b1) * value + kCurve.b2)
    );
}

/// Where the curve is kShown: the larger root of the quadratic.
double solveCurve() {
    const double a = kCurve.a0 - kShown * kCurve.b0;
    const double b = kCurve.a1 - kShown * kCurve.b1;
    const double c = -kShown * kCurve.b2;
    const double half = -0.5 * b / a;
    return half + std::sqrt(half * half - c / a);
}

float encodeSrgb(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// As a display shows it at an exposure.
Image show(const Image& linear, float factor) {
    Image shown(linear.width, linear.height, 3);
    for (size_t i = 0; i < size_t(linear.width) * linear.height; ++i)
        for (size_t c = 0; c < 3; ++c) {
            const float light = linear.pixels[i * linear.channels + c];
            // Infinity over infinity is none; so much light is white. NaN passes through.
            const float bright = std::min(std::max(light * factor, 0.0f), 1.0e6f);
            shown.pixels[i * 3 + c] =
                std::isnan(light) ? light : encodeSrgb(clampToUnit(applyCurve(bright)));
        }
    return shown;
}

} // namespace

ExposureRange findHdrFlipExposures(const Image& truth) {
    std::vector<double> luminances;
    for (size_t i = 0; i < size_t(truth.width) * truth.height; ++i) {
        const float* pixel = truth.pixels.data() + i * truth.channels;
        const double luminance =
            0.2126 * double(pixel[0]) + 0.7152 * double(pixel[1]) + 0.0722 * double(pixel[2]);
        if (std::isfinite(luminance))
            luminances.push_back(std::max(luminance, 0.0));
    }
    if (luminances.empty())
        return {};
    std::sort(luminances.begin(), luminances.end());
    const size_t half = luminances.size() / 2;
    const double median = luminances.size() % 2 == 1
                              ? luminances[half]
                              : 0.5 * (luminances[half - 1] + luminances[half]);
    const double shown = solveCurve();
    const auto stopsOf = [&](double luminance) {
        return std::log2(shown / std::max(luminance, kLeastLuminance));
    };
    ExposureRange range;
    range.first = stopsOf(luminances.back());
    range.last = std::min(stopsOf(median), range.first + kMostStops);
    constexpr double kSlack = 1.0e-9; // of logarithms
    range.count = std::max(2u, uint32_t(std::ceil(range.last - range.first - kSlack)));
    return range;
}

FlipResult computeHdrFlip(const Image& a, const Image& truth) {
    checkComparable(a, truth);
    SHUTTER_CHECK(a.channels >= 3, "linear pictures of {} channels", a.channels);
    FlipResult result;
    result.errorMap = Image(a.width, a.height, 1);
    if (a.pixels.empty())
        return result;
    const ExposureRange range = findHdrFlipExposures(truth);
    for (uint32_t i = 0; i < range.count; ++i) {
        const double stops = std::lerp(range.first, range.last, double(i) / (range.count - 1));
        const auto factor = float(std::exp2(stops));
        const FlipResult shown = computeFlip(show(a, factor), show(truth, factor));
        for (size_t p = 0; p < result.errorMap.pixels.size(); ++p)
            result.errorMap.pixels[p] =
                std::max(result.errorMap.pixels[p], shown.errorMap.pixels[p]);
    }
    double sum = 0.0;
    for (const float error : result.errorMap.pixels)
        sum += double(error);
    result.mean = sum / double(result.errorMap.pixels.size());
    return result;
}

} // namespace shutter::image
