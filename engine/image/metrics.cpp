// SPDX-License-Identifier: MIT
#include "engine/image/metrics.h"

#include "engine/image/metric_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace shutter::image {

namespace {

constexpr uint32_t kWindowRadius = 5;
constexpr uint32_t kWindowSize = 2 * kWindowRadius + 1;
constexpr double kWindowSigma = 1.5;
// Wang et al. 2004, section III.B: C = (K L)^2 with L = 1.
constexpr double kC1 = 0.01 * 0.01;
constexpr double kC2 = 0.03 * 0.03;

/// Calls visit(valueOfA, valueOfB) for every compared channel of every pixel.
template <typename Visit> void forEachValue(const Image& a, const Image& b, Visit visit) {
    const uint32_t compared = std::min(a.channels, 3u);
    for (size_t pixel = 0; pixel < size_t(a.width) * a.height; ++pixel) {
        for (uint32_t c = 0; c < compared; ++c) {
            const size_t index = pixel * a.channels + c;
            visit(double(a.pixels[index]), double(b.pixels[index]));
        }
    }
}

/// The compared values of a pixel in both pictures.
struct ValuePair {
    double a = 0.0;
    double b = 0.0;
};

/// Rec. 709; of less than three channels the first.
ValuePair computeLuminance(uint32_t channels, const std::array<ValuePair, 3>& values) {
    if (channels < 3)
        return values[0];
    ValuePair sum;
    constexpr std::array kWeights{0.2126, 0.7152, 0.0722};
    for (size_t c = 0; c < values.size(); ++c) {
        sum.a += kWeights[c] * values[c].a;
        sum.b += kWeights[c] * values[c].b;
    }
    return sum;
}

/// Luminances of a pixel from its clamped channels; NaN where one of them is.
ValuePair readDisplayed(const Image& a, const Image& b, size_t pixel) {
    std::array<ValuePair, 3> values;
    for (size_t c = 0; c < std::min(a.channels, 3u); ++c) {
        const size_t i = pixel * a.channels + c;
        values[c] = {clampToUnit(double(a.pixels[i])), clampToUnit(double(b.pixels[i]))};
    }
    return computeLuminance(a.channels, values);
}

/// Two values for a peak of 1; infinity is no difference to itself.
ValuePair readStored(const Image& a, const Image& b, size_t index, double peak) {
    const double va = a.pixels[index];
    const double vb = b.pixels[index];
    if (std::isinf(va) && va == vb)
        return {};
    return {va / peak, vb / peak};
}

/// The part of one window that lies inside the picture, along one axis; the weights sum to 1.
struct Taps {
    uint32_t first = 0;
    uint32_t count = 0;
    std::array<double, kWindowSize> weights{};
};

/// One entry a window centre along an axis of `size` pixels.
std::vector<Taps> buildTaps(uint32_t size) {
    const bool wholeWindows = size >= kWindowSize;
    const uint32_t firstCentre = wholeWindows ? kWindowRadius : 0;
    const uint32_t endCentre = wholeWindows ? size - kWindowRadius : size;
    std::vector<Taps> axis;
    axis.reserve(endCentre - firstCentre);
    for (uint32_t centre = firstCentre; centre < endCentre; ++centre) {
        Taps taps;
        taps.first = centre - std::min(centre, kWindowRadius);
        taps.count = std::min(centre + kWindowRadius + 1, size) - taps.first;
        double sum = 0.0;
        for (uint32_t i = 0; i < taps.count; ++i) {
            const double distance = double(taps.first + i) - double(centre);
            taps.weights[i] = std::exp(-distance * distance / (2.0 * kWindowSigma * kWindowSigma));
            sum += taps.weights[i];
        }
        for (double& weight : taps.weights)
            weight /= sum;
        axis.push_back(taps);
    }
    return axis;
}

/// Weighted sums of the two luminances, their squares and their product.
struct Moments {
    double a = 0.0;
    double b = 0.0;
    double aa = 0.0;
    double bb = 0.0;
    double ab = 0.0;

    void add(const Moments& m, double weight) {
        a += weight * m.a;
        b += weight * m.b;
        aa += weight * m.aa;
        bb += weight * m.bb;
        ab += weight * m.ab;
    }
};

/// Wang et al. 2004, eq. 13, from the moments of one window.
double scoreWindow(const Moments& m) {
    const double varianceA = m.aa - m.a * m.a;
    const double varianceB = m.bb - m.b * m.b;
    const double covariance = m.ab - m.a * m.b;
    const double score = ((2.0 * m.a * m.b + kC1) * (2.0 * covariance + kC2)) /
                         ((m.a * m.a + m.b * m.b + kC1) * (varianceA + varianceB + kC2));
    return std::isnan(score) ? 0.0 : score;
}

/// A row of moments filtered along x.
void filterRow(
    const std::vector<Moments>& row,
    const std::vector<Taps>& columns,
    std::vector<Moments>& filtered
) {
    for (size_t i = 0; i < columns.size(); ++i) {
        Moments sum;
        for (uint32_t tap = 0; tap < columns[i].count; ++tap)
            sum.add(row[columns[i].first + tap], columns[i].weights[tap]);
        filtered[i] = sum;
    }
}

/// Mean score of the windows of two pictures. \param read the pair of values of a pixel, by its
/// index
template <typename Read> double computeMeanScore(uint32_t width, uint32_t height, Read read) {
    const std::vector<Taps> columns = buildTaps(width);
    const std::vector<Taps> rows = buildTaps(height);

    // Windows never reach over more rows than this ring holds, so memory does not grow with height.
    std::array<std::vector<Moments>, kWindowSize> ring;
    ring.fill(std::vector<Moments>(columns.size()));
    std::vector<Moments> scratch(width);
    uint32_t rowsFiltered = 0;
    double sum = 0.0;
    for (const Taps& row : rows) {
        for (; rowsFiltered < row.first + row.count; ++rowsFiltered) {
            for (uint32_t x = 0; x < width; ++x) {
                const ValuePair v = read(size_t(rowsFiltered) * width + x);
                scratch[x] = {v.a, v.b, v.a * v.a, v.b * v.b, v.a * v.b};
            }
            filterRow(scratch, columns, ring[rowsFiltered % kWindowSize]);
        }
        for (size_t i = 0; i < columns.size(); ++i) {
            Moments window;
            for (uint32_t tap = 0; tap < row.count; ++tap)
                window.add(ring[(row.first + tap) % kWindowSize][i], row.weights[tap]);
            sum += scoreWindow(window);
        }
    }
    return sum / (double(rows.size()) * double(columns.size()));
}

/// Of `count` squared errors for a peak of 1.
double toDecibels(double squaredSum, size_t count) {
    if (squaredSum == 0.0)
        return std::numeric_limits<double>::infinity();
    return 10.0 * std::log10(double(count) / squaredSum);
}

} // namespace

double computePsnr(const Image& a, const Image& b) {
    checkComparable(a, b);
    double squaredSum = 0.0;
    size_t count = 0;
    forEachValue(a, b, [&](double va, double vb) {
        const double difference = clampToUnit(va) - clampToUnit(vb);
        squaredSum += std::isnan(difference) ? 1.0 : difference * difference;
        ++count;
    });
    return toDecibels(squaredSum, count);
}

double computeSsim(const Image& a, const Image& b) {
    checkComparable(a, b);
    if (a.pixels.empty())
        return 1.0;
    return computeMeanScore(a.width, a.height, [&](size_t pixel) {
        return readDisplayed(a, b, pixel);
    });
}

double findPeak(const Image& reference) {
    double peak = 1.0;
    for (const float value : reference.pixels)
        if (std::isfinite(value))
            peak = std::max(peak, std::abs(double(value)));
    return peak;
}

double computeStoredPsnr(const Image& picture, const Image& reference) {
    checkComparable(picture, reference);
    const double peak = findPeak(reference);
    double squaredSum = 0.0;
    for (size_t i = 0; i < picture.pixels.size(); ++i) {
        const ValuePair v = readStored(picture, reference, i, peak);
        const double difference = v.a - v.b;
        squaredSum += std::isfinite(difference) ? difference * difference : 1.0;
    }
    return toDecibels(squaredSum, picture.pixels.size());
}

double computeStoredSsim(const Image& picture, const Image& reference, bool isColor) {
    checkComparable(picture, reference);
    if (picture.pixels.empty())
        return 1.0;
    const double peak = findPeak(reference);
    const uint32_t channels = picture.channels;
    if (isColor && channels == 3)
        return computeMeanScore(picture.width, picture.height, [&](size_t pixel) {
            std::array<ValuePair, 3> values;
            for (size_t c = 0; c < values.size(); ++c)
                values[c] = readStored(picture, reference, pixel * channels + c, peak);
            return computeLuminance(channels, values);
        });
    double sum = 0.0;
    for (uint32_t c = 0; c < channels; ++c)
        sum += computeMeanScore(picture.width, picture.height, [&](size_t pixel) {
            return readStored(picture, reference, pixel * channels + c, peak);
        });
    return sum / channels;
}

double computeMaxDifference(const Image& a, const Image& b) {
    checkComparable(a, b);
    double largest = 0.0;
    forEachValue(a, b, [&](double va, double vb) {
        if (va == vb)
            return; // also infinity against itself, whose difference would be NaN
        const double difference = std::abs(va - vb);
        largest = std::max(
            largest, std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference
        );
    });
    return largest;
}

} // namespace shutter::image
