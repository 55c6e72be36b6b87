// SPDX-License-Identifier: MIT
// A motion that changes by 1e-4 pixels may change no pixel by more than a bound.
#include "tests/conformance/stability/case_lists.h"
#include "tests/conformance/stability/filter_rig.h"
#include "tests/conformance/stability/pictures.h"

#include <cmath>
#include <string>

namespace shutter::stability {

namespace {

using motion_blur::Method;
using motion_blur::MotionBlurSettings;

constexpr uint32_t kWidth = 64;
constexpr uint32_t kHeight = 48;
constexpr float kStepPx = 1e-4f;
/// Steepest slope of the picture, brightness a pixel.
constexpr double kSlope = 1.0 / 32.0;
/// Half floats of [1/2, 1) are 2^-11 apart, smaller ones less; one is rounded to either neighbour.
constexpr double kStored = 0x1p-11;

/// A smooth picture, so that a tap that moves on to the next texel changes little; a slab in front
/// that moves by `frontPx` to the right before a wall that moves by `backPx` down.
GBuffer makeSmooth(float frontPx, float backPx) {
    GBuffer gbuffer(kWidth, kHeight);
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            // Amplitude and frequency make the slope at most kSlope along each axis.
            const auto wave = [](double t) { return float(0.5 + 0.25 * std::sin(t / 8.0)); };
            gbuffer.setColor(x, y, wave(x), wave(y), wave(0.7 * x + 0.7 * y));
            const bool front = x >= 20 && x < 44 && y >= 14 && y < 34;
            // Depths apart by less than the extent: no weight jumps with them.
            if (front)
                gbuffer.setMotion(x, y, frontPx, 0.3f * frontPx, 3.0f);
            else
                gbuffer.setMotion(x, y, 0.2f * backPx, backPx, 3.02f);
        }
    return gbuffer;
}

MotionBlurSettings makeSettings(const Method& method) {
    MotionBlurSettings settings;
    settings.method = &method;
    settings.tileSizePx = 24;
    return settings;
}

core::Result<Worst> compareSteps(
    gpu::Device& device, const Method& method, const std::vector<std::pair<float, float>>& motions
) {
    FilterRig rig(device);
    Worst worst;
    for (const auto& [front, back] : motions) {
        auto before = rig.blur(makeSmooth(front, back), makeSettings(method));
        if (!before)
            return before.error();
        auto after = rig.blur(makeSmooth(front + kStepPx, back + kStepPx), makeSettings(method));
        if (!after)
            return after.error();
        addDifference(
            worst,
            before.value().color,
            after.value().color,
            fmt::format("motion {} and {} px", front, back)
        );
    }
    return worst;
}

/// Largest change of a filter whose taps are nearest texels. Weights change by about the step over
/// a tenth of the motion, 1e-4 of them; what is more is the decision that flips, which texel a tap
/// takes: of the taps, at most two of a pixel are within the step of a border at a time, and each
/// has less than a tenth of the weight. Each then moves the mean by its share of the slope. Both
/// means are stored as half floats, off by less than kStored each.
constexpr double kBound = 0.2 * kSlope + 2.0 * kStored;

core::Result<Measurements> measureSmall(gpu::Device& device) {
    Measurements found;
    for (const Method* method : listFilters()) {
        auto worst = compareSteps(
            device, *method, {{11.3f, 7.1f}, {7.9f, 17.3f}, {19.7f, 3.3f}, {14.2f, 14.9f}}
        );
        if (!worst)
            return worst.error();
        found.push_back(describe(worst.value(), method->name, "brightness", kBound));
    }
    return found;
}

/// Where a decision flips: at half a pixel a still picture starts to blur.
core::Result<Measurements> measureThreshold(gpu::Device& device) {
    Measurements found;
    for (const Method* method : listFilters()) {
        auto worst = compareSteps(device, *method, {{0.47886f, 0.0f}, {0.0f, 0.49022f}});
        if (!worst)
            return worst.error();
        // The taps are in the pixel's own texel then, whose colour is a half float: what is left is
        // the rounding of their mean, which may store that colour's neighbour.
        found.push_back(describe(
            worst.value(), std::string(method->name) + " at half a pixel", "brightness", kStored
        ));
    }
    return found;
}

} // namespace

std::vector<HardCase> listContinuityCases() {
    return {
        {"SmallChange",
         "A motion changed by 1e-4 pixels",
         "Two movers over a smooth picture, all motions longer by 1e-4 pixels; taps may step over "
         "the border between two texels.",
         measureSmall},
        {"StillThreshold",
         "A motion that passes half a pixel",
         "The decision that a pixel is not still any more flips; every "
         "tap is within the pixel then, so the picture stays.",
         measureThreshold},
    };
}

} // namespace shutter::stability
