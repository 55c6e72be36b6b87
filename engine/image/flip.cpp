// SPDX-License-Identifier: MIT
#include "engine/image/flip.h"

#include "engine/image/metric_parts.h"
#include "engine/math/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace shutter::image {

namespace {

constexpr double kPi = std::numbers::pi;

// Andersson 2020, sections 4.1 and 4.2: exponents and set points of the two pipelines.
constexpr float kColorExponent = 0.7f;         // q_c
constexpr float kColorSplit = 0.4f;            // p_c: share of the largest colour difference ...
constexpr float kColorSplitError = 0.95f;      // p_t: ... that maps to this error
constexpr float kFeatureExponent = 0.5f;       // q_f
constexpr double kFeatureWidthDegrees = 0.082; // w: peak to trough of the edge detector

/// a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees: the contrast sensitivity of section 4.1.
struct SpatialGaussian {
    double a;
    double b;
};

constexpr SpatialGaussian kLuminanceFilter{1.0, 0.0047};
constexpr SpatialGaussian kRedGreenFilter{1.0, 0.0053};
constexpr std::array<SpatialGaussian, 2> kBlueYellowFilter{{{34.1, 0.04}, {13.5, 0.025}}};
constexpr double kWidestSpatialB = 0.04;

/// Linear sRGB to CIE XYZ (D65), the exact fractions of the standard's primaries that FLIP takes.
constexpr std::array<std::array<double, 3>, 3> kXyzFromRgb{
    {{10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
     {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
     {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0}}};

using Matrix = std::array<std::array<double, 3>, 3>;

struct Color {
    float x = 0.0f;
    float y = 0.0f;
    float z = 0.0f;
};

/// Rows divided by their sums, so that white is (1, 1, 1): XYZ relative to the white point.
constexpr Matrix makeRelativeXyzFromRgb() {
    Matrix m = kXyzFromRgb;
    for (auto& row : m) {
        const double sum = row[0] + row[1] + row[2];
        for (double& value : row)
            value /= sum;
    }
    return m;
}

constexpr Matrix invert(const Matrix& m) {
    Matrix inverse{};
    const auto cofactor = [&](size_t r, size_t c) {
        const size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
        return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
    };
    const double determinant =
        m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
    for (size_t r = 0; r < 3; ++r)
        for (size_t c = 0; c < 3; ++c)
            inverse[r][c] = cofactor(c, r) / determinant;
    return inverse;
}

constexpr Matrix kRelativeXyzFromRgb = makeRelativeXyzFromRgb();
constexpr Matrix kRgbFromRelativeXyz = invert(kRelativeXyzFromRgb);

Color multiply(const Matrix& m, const Color& c) {
    const auto row = [&](size_t i) {
        return float(m[i][0]) * c.x + float(m[i][1]) * c.y + float(m[i][2]) * c.z;
    };
    return {row(0), row(1), row(2)};
}

/// CIE 15: the compression of L*a*b*.
float compressLab(float t) {
    constexpr float kDelta = 6.0f / 29.0f;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t)
                                        : t / (3.0f * kDelta * kDelta) + 4.0f / 29.0f;
}

/// CIE L*a*b* with a* and b* scaled by 0.01 L*, the Hunt effect: the darker, the less colourful.
Color computeHuntLab(const Color& linearRgb) {
    const Color xyz = multiply(kRelativeXyzFromRgb, linearRgb);
    const float fx = compressLab(xyz.x);
    const float fy = compressLab(xyz.y);
    const float fz = compressLab(xyz.z);
    const float lightness = 116.0f * fy - 16.0f;
    const float hunt = 0.01f * lightness;
    return {lightness, hunt * 500.0f * (fx - fy), hunt * 200.0f * (fy - fz)};
}

/// HyAB, for colours far apart: city-block in lightness, Euclidean in chroma (Abasi et al. 2020).
float computeHyab(const Color& a, const Color& b) {
    const float da = a.y - b.y;
    const float db = a.z - b.z;
    return std::abs(a.x - b.x) + std::sqrt(da * da + db * db);
}

/// To [0, 1]: the largest colour difference, green against blue, becomes 1; the lower 40 % of the
/// range take 95 % of the result.
float mapColorError(float distance) {
    static const float sLargest = std::pow(
        computeHyab(computeHuntLab({0.0f, 1.0f, 0.0f}), computeHuntLab({0.0f, 0.0f, 1.0f})),
        kColorExponent
    );
    const float split = kColorSplit * sLargest;
    const float error = std::pow(distance, kColorExponent);
    return error < split ? error * (kColorSplitError / split)
                         : kColorSplitError +
                               (error - split) / (sLargest - split) * (1.0f - kColorSplitError);
}

/// One axis of a spatial filter, unnormalised. The two-dimensional filter's factor a sqrt(pi / b)
/// is split between the axes, so that sums of Gaussians keep their shares.
std::vector<double> sampleSpatial(const SpatialGaussian& gaussian, int radius) {
    std::vector<double> weights;
    const double factor = std::sqrt(gaussian.a * std::sqrt(kPi / gaussian.b));
    for (int i = -radius; i <= radius; ++i) {
        const double degrees = i / kFlipPixelsPerDegree;
        weights.push_back(factor * std::exp(-kPi * kPi * degrees * degrees / gaussian.b));
    }
    return weights;
}

double sumOf(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values)
        sum += value;
    return sum;
}

Kernel scale(const std::vector<double>& weights, double factor) {
    Kernel kernel;
    for (const double weight : weights)
        kernel.push_back(float(weight * factor));
    return kernel;
}

/// Gaussians that keep a constant picture as it is.
struct SpatialKernels {
    Kernel luminance;
    Kernel redGreen;
    std::array<Kernel, 2> blueYellow; ///< the filter is the sum of both, each along x and y
};

SpatialKernels makeSpatialKernels() {
    // Three standard deviations of the widest.
    const int radius =
        int(std::ceil(3.0 * std::sqrt(kWidestSpatialB / (2.0 * kPi * kPi)) * kFlipPixelsPerDegree));
    SpatialKernels kernels;
    const auto luminance = sampleSpatial(kLuminanceFilter, radius);
    const auto redGreen = sampleSpatial(kRedGreenFilter, radius);
    kernels.luminance = scale(luminance, 1.0 / sumOf(luminance));
    kernels.redGreen = scale(redGreen, 1.0 / sumOf(redGreen));
    const auto first = sampleSpatial(kBlueYellowFilter[0], radius);
    const auto second = sampleSpatial(kBlueYellowFilter[1], radius);
    // The weights in two dimensions sum to the squares' sum.
    const double norm = 1.0 / std::hypot(sumOf(first), sumOf(second));
    kernels.blueYellow = {scale(first, norm), scale(second, norm)};
    return kernels;
}

/// Section 4.2: a Gaussian and its derivatives, whose positive weights sum to 1, negative to -1.
struct FeatureKernels {
    Kernel smooth;
    Kernel edge;
    Kernel point;
};

void normalizeSigns(std::vector<double>& weights) {
    double positive = 0.0;
    double negative = 0.0;
    for (const double weight : weights)
        (weight > 0.0 ? positive : negative) += std::abs(weight);
    for (double& weight : weights)
        weight /= weight > 0.0 ? positive : negative;
}

FeatureKernels makeFeatureKernels() {
    const double sigma = 0.5 * kFeatureWidthDegrees * kFlipPixelsPerDegree;
    const int radius = int(std::ceil(3.0 * sigma));
    std::vector<double> smooth, edge, point;
    for (int i = -radius; i <= radius; ++i) {
        const double x = i / sigma;
        const double g = std::exp(-0.5 * x * x);
        smooth.push_back(g);
        edge.push_back(-x * g);
        point.push_back((x * x - 1.0) * g);
    }
    normalizeSigns(edge);
    normalizeSigns(point);
    return {scale(smooth, 1.0 / sumOf(smooth)), scale(edge, 1.0), scale(point, 1.0)};
}

/// The opponent space YCxCz without its scales, which cancel where the filters' weights sum to 1:
/// luminance, red-green and blue-yellow.
struct Opponents {
    Plane luminance;
    Plane redGreen;
    Plane blueYellow;
};

Opponents computeOpponents(const Image& image) {
    Opponents result{
        Plane(image.width, image.height),
        Plane(image.width, image.height),
        Plane(image.width, image.height)};
    for (size_t i = 0; i < result.luminance.values.size(); ++i) {
        const float* pixel = image.pixels.data() + i * image.channels;
        const auto decode = [&](size_t channel) {
            return math::decodeSrgb(clampToUnit(pixel[channel]));
        };
        const float first = decode(0);
        const Color xyz = multiply(
            kRelativeXyzFromRgb,
            image.channels < 3 ? Color{first, first, first} : Color{first, decode(1), decode(2)}
        );
        result.luminance.values[i] = xyz.y;
        result.redGreen.values[i] = xyz.x - xyz.y;
        result.blueYellow.values[i] = xyz.y - xyz.z;
    }
    return result;
}

Plane filterBoth(const Plane& plane, const Kernel& kernel) {
    return filterAlongY(filterAlongX(plane, kernel), kernel);
}

/// Each pixel's colour as it is seen from the viewing distance.
std::vector<Color> computeSeenColors(const Opponents& opponents) {
    const SpatialKernels kernels = makeSpatialKernels();
    const Plane luminance = filterBoth(opponents.luminance, kernels.luminance);
    const Plane redGreen = filterBoth(opponents.redGreen, kernels.redGreen);
    const Plane first = filterBoth(opponents.blueYellow, kernels.blueYellow[0]);
    const Plane second = filterBoth(opponents.blueYellow, kernels.blueYellow[1]);
    std::vector<Color> seen(luminance.values.size());
    for (size_t i = 0; i < seen.size(); ++i) {
        const float y = luminance.values[i];
        const Color rgb = multiply(
            kRgbFromRelativeXyz,
            {y + redGreen.values[i], y, y - (first.values[i] + second.values[i])}
        );
        seen[i] = computeHuntLab({clampToUnit(rgb.x), clampToUnit(rgb.y), clampToUnit(rgb.z)});
    }
    return seen;
}

/// Lengths of the vectors of the detectors' answers along x and y.
struct Features {
    Plane edge;
    Plane point;
};

Features computeFeatures(const Plane& luminance) {
    const FeatureKernels kernels = makeFeatureKernels();
    const Plane smooth = filterAlongX(luminance, kernels.smooth);
    const auto length = [&](const Kernel& derivative) {
        Plane alongX = filterAlongY(filterAlongX(luminance, derivative), kernels.smooth);
        const Plane alongY = filterAlongY(smooth, derivative);
        for (size_t i = 0; i < alongX.values.size(); ++i)
            alongX.values[i] = std::sqrt(
                alongX.values[i] * alongX.values[i] + alongY.values[i] * alongY.values[i]
            );
        return alongX;
    };
    return {length(kernels.edge), length(kernels.point)};
}

/// A picture as perceived by an observer.
struct Appearance {
    std::vector<Color> colors;
    Features features;
};

Appearance computeAppearance(const Image& image) {
    const Opponents opponents = computeOpponents(image);
    return {computeSeenColors(opponents), computeFeatures(opponents.luminance)};
}

/// Section 4.3: where features differ, a difference in colour is seen the more.
float combine(float colorError, float edgeDifference, float pointDifference) {
    const float feature = std::pow(
        std::max(edgeDifference, pointDifference) / std::numbers::sqrt2_v<float>, kFeatureExponent
    );
    const float error = std::pow(colorError, 1.0f - feature);
    // Rounding may lead above 1; NaN is the largest error too.
    return error < 1.0f ? error : 1.0f;
}

/// The ACES curve of Narkowicz 2016 with its exposure of 0.6, HDR-FLIP's model of a display's tone
/// map: (a0 x^2 + a1 x) / (b0 x^2 + b1 x + b2).
struct ToneCurve {
    double a0 = 0.6 * 0.6 * 2.51;
    double a1 = 0.6 * 0.03;
    double b0 = 0.6 * 0.6 * 2.43;
    double b1 = 0.6 * 0.59;
    double b2 = 0.14;
};

constexpr ToneCurve kCurve{};
/// Result of the curve for the brightest light at the first exposure, and for the median at the
/// last.
constexpr double kShown = 0.85;
/// From the first exposure to the last: where half of a picture is black, no exposure shows it.
constexpr double kMaxStops = 20.0;
/// A black picture has no brightest light.
constexpr double kMinLuminance = 1.0e-6;

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

/// As a display shows it at an exposure.
Image show(const Image& linear, float factor) {
    Image shown(linear.width, linear.height, 3);
    for (size_t i = 0; i < size_t(linear.width) * linear.height; ++i)
        for (size_t c = 0; c < 3; ++c) {
            const float light = linear.pixels[i * linear.channels + c];
            // Infinity over infinity is none; so much light is white. NaN passes through.
            const float bright = std::min(std::max(light * factor, 0.0f), 1.0e6f);
            shown.pixels[i * 3 + c] =
                std::isnan(light) ? light : math::encodeSrgb(clampToUnit(applyCurve(bright)));
        }
    return shown;
}

} // namespace

FlipResult computeFlip(const Image& a, const Image& b) {
    checkComparable(a, b);
    FlipResult result;
    result.errorMap = Image(a.width, a.height, 1);
    if (a.pixels.empty())
        return result;
    const Appearance seenA = computeAppearance(a);
    const Appearance seenB = computeAppearance(b);
    double sum = 0.0;
    for (size_t i = 0; i < result.errorMap.pixels.size(); ++i) {
        const auto& fa = seenA.features;
        const auto& fb = seenB.features;
        const float error = combine(
            mapColorError(computeHyab(seenA.colors[i], seenB.colors[i])),
            std::abs(fa.edge.values[i] - fb.edge.values[i]),
            std::abs(fa.point.values[i] - fb.point.values[i])
        );
        result.errorMap.pixels[i] = error;
        sum += double(error);
    }
    result.mean = sum / double(result.errorMap.pixels.size());
    return result;
}

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
        return std::log2(shown / std::max(luminance, kMinLuminance));
    };
    ExposureRange range;
    range.first = stopsOf(luminances.back());
    range.last = std::min(stopsOf(median), range.first + kMaxStops);
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
