// SPDX-License-Identifier: MIT
// Synthetic G-buffers under the filters that need no rays: motion of any length or none, weights
// that sum to nothing, bright colours, and changes that are too small to see.
#include "shaders/common/numeric.glsl"
#include "shaders/render/motion.glsl"
#include "tests/stability/hard_case.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <random>

namespace shutter::stability {
namespace {

using motion_blur::Method;
using motion_blur::MotionBlurSettings;

/// A mean of half floats that should be one of them, or lie between two, is off by some roundings
/// of single precision and then stored as either half float next to it (Vulkan 1.3, "Floating-Point
/// Format Conversions"): at most one unit in the last place away, or beyond.
constexpr double kStoredHalfUlps = 1.0;

/// The motion blur's methods that need no rays.
std::vector<const Method*> listFilters() {
    std::vector<const Method*> filters;
    for (const Method* method : motion_blur::listMethods())
        if (method->readsImagesOnly())
            filters.push_back(method);
    return filters;
}

class HardFilters : public test::GpuTest {
  protected:
    static constexpr uint32_t kWidth = 56;
    static constexpr uint32_t kHeight = 40;

    template <class Visit> static void forEachPixel(const Visit& doIt) {
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x)
                doIt(x, y);
    }

    /// Random colours up to `brightest`, still, at two depths within the soft extent and one far
    /// away.
    static GBuffer makeStill(float brightest = 1.0f) {
        GBuffer gbuffer(kWidth, kHeight);
        std::mt19937 random(3);
        std::uniform_real_distribution<float> unit(0.0f, 1.0f);
        const float depths[] = {3.0f, 3.02f, 9.0f};
        forEachPixel([&](uint32_t x, uint32_t y) {
            const float r = brightest * unit(random);
            const float g = brightest * unit(random);
            gbuffer.setColor(x, y, r, g, brightest * unit(random));
            gbuffer.setMotion(x, y, 0.0f, 0.0f, depths[random() % 3]);
        });
        return gbuffer;
    }

    /// ... each pixel with a motion of random direction and a length in [0, `longestPx`).
    static GBuffer makeMoving(float longestPx, float brightest = 1.0f) {
        GBuffer gbuffer = makeStill(brightest);
        std::mt19937 random(5);
        std::uniform_real_distribution<float> unit(0.0f, 1.0f);
        forEachPixel([&](uint32_t x, uint32_t y) {
            const float angle = 6.2831853f * unit(random);
            const float length = longestPx * unit(random);
            gbuffer.motionDepth.at(x, y, 0) = length * std::cos(angle);
            gbuffer.motionDepth.at(x, y, 1) = length * std::sin(angle);
        });
        return gbuffer;
    }

    /// What each filter makes of the G-buffer, in each phase.
    void filterAll(
        const GBuffer& gbuffer,
        const std::function<void(const Blurred& blurred, const std::string& method)>& judge
    ) {
        FilterRig rig(device());
        for (const double share : {0.0, 0.5, 1.0})
            for (const Method* method : listFilters()) {
                MotionBlurSettings settings;
                settings.method = method;
                settings.tileSizePx = 16;
                settings.occluderTest = motion_blur::OccluderTest::Velocity;
                judge(
                    rig.blur(gbuffer, settings, share), fmt::format("{}, {}", method->name, share)
                );
            }
    }

    void holdFiniteAndInRange(const GBuffer& gbuffer, const std::string& label) {
        Worst notFinite;
        Worst excursion;
        Range range;
        range.add(gbuffer.color);
        filterAll(gbuffer, [&](const Blurred& blurred, const std::string& method) {
            for (const image::Image* picture : {&blurred.color, &blurred.tiles, &blurred.dominant})
                notFinite.addNotFinite(*picture, method);
            range.addExcursion(excursion, blurred.color, method);
        });
        hold("finite" + label, notFinite);
        hold(
            "inside the range of what was filtered" + label, excursion, kStoredHalfUlps, "half ulp"
        );
    }

    /// Pixels that `picks` chooses keep their colours.
    void holdColors(
        const GBuffer& gbuffer,
        const std::function<bool(uint32_t x, uint32_t y, const std::string& method)>& picks
    ) {
        Worst difference;
        filterAll(gbuffer, [&](const Blurred& blurred, const std::string& method) {
            difference.addNotFinite(blurred.color, method);
            forEachPixel([&](uint32_t x, uint32_t y) {
                for (uint32_t c = 0; c < 3 && picks(x, y, method); ++c) {
                    const double color = gbuffer.color.at(x, y, c);
                    difference.add(
                        std::abs(blurred.color.at(x, y, c) - color) / halfUlp(color), method
                    );
                }
            });
        });
        hold("colours stay", difference, kStoredHalfUlps, "half ulp");
    }

    /// Every seventh pixel or so has the motion (x, y), which counts as none.
    void holdAsStill(float right, float down, const std::string& label) {
        GBuffer gbuffer = makeMoving(14.0f);
        GBuffer zeroed = gbuffer;
        std::mt19937 random(11);
        forEachPixel([&](uint32_t x, uint32_t y) {
            if (random() % 7 != 0)
                return;
            const float depth = gbuffer.motionDepth.at(x, y, 2);
            gbuffer.setMotion(x, y, right, down, depth);
            zeroed.setMotion(x, y, 0.0f, 0.0f, depth);
        });
        holdFiniteAndInRange(gbuffer, label);
        std::vector<image::Image> expected;
        filterAll(zeroed, [&](const Blurred& blurred, const std::string&) {
            expected.push_back(blurred.color);
        });
        Worst difference;
        size_t at = 0;
        filterAll(gbuffer, [&](const Blurred& blurred, const std::string& method) {
            difference.addDifference(blurred.color, expected.at(at++), method);
        });
        hold("as without that motion" + label, difference);
    }
};

TEST_F(HardFilters, MotionBelowHalfAPixelGivesThePictureBack) {
    for (const GBuffer& gbuffer : {makeStill(), makeMoving(0.499f)}) {
        Worst difference;
        filterAll(gbuffer, [&](const Blurred& blurred, const std::string& method) {
            difference.addDifference(blurred.color, gbuffer.color, method);
        });
        hold("the sharp picture", difference);
    }
}

TEST_F(HardFilters, TheLongestMotionAndTheBrightestColoursAreFiniteAndInRange) {
    holdFiniteAndInRange(makeMoving(shader::kMaxMotionPx), ", longest motion");
    holdFiniteAndInRange(makeMoving(30.0f, shader::kMaxColor), ", brightest colours");
}

TEST_F(HardFilters, MotionThatIsNanOrInfiniteOrHasAnInfiniteLengthCountsAsNone) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    holdAsStill(nan, 2.0f, ", NaN");
    holdAsStill(infinity, -infinity, ", infinite");
    holdAsStill(3e38f, 3e38f, ", length beyond a float");
}

TEST_F(HardFilters, StaticPixelsStaySharpIfAllTapsHaveZeroWeight) {
    // Before one mover far behind them.
    GBuffer gbuffer = makeStill();
    forEachPixel([&](uint32_t x, uint32_t y) { gbuffer.setMotion(x, y, 0.0f, 0.0f, 3.0f); });
    gbuffer.setMotion(20, 13, 11.0f, 4.0f, 9.0f);
    holdColors(gbuffer, [](uint32_t x, uint32_t y, const std::string& method) {
        // Jimenez takes the next tap for covered in part, however slow it is.
        return !method.starts_with("jimenez2014") && (x != 20 || y != 13);
    });
}

TEST_F(HardFilters, AConstantColourStaysUnderAnyMotion) {
    GBuffer gbuffer = makeMoving(30.0f);
    forEachPixel([&](uint32_t x, uint32_t y) { gbuffer.setColor(x, y, 0.3f, 0.7f, 0.1f); });
    holdColors(gbuffer, [](uint32_t, uint32_t, const std::string&) { return true; });
}

/// Steepest slope of the smooth picture, brightness a pixel.
constexpr double kSlope = 1.0 / 32.0;
/// Half floats of [1/2, 1) are 2^-11 apart, smaller ones less; one is rounded to either neighbour.
constexpr double kStored = 0x1p-11;

/// A smooth picture, so that a tap that moves on to the next texel changes little; a slab in front
/// that moves by `frontPx` to the right before a wall that moves by `backPx` down.
GBuffer makeSmooth(float frontPx, float backPx) {
    GBuffer gbuffer(64, 48);
    for (uint32_t y = 0; y < 48; ++y)
        for (uint32_t x = 0; x < 64; ++x) {
            // Amplitude and frequency make the slope at most kSlope along each axis.
            const auto wave = [](double t) { return float(0.5 + 0.25 * std::sin(t / 8.0)); };
            gbuffer.setColor(x, y, wave(x), wave(y), wave(0.7 * x + 0.7 * y));
            // Depths apart by less than the extent: no weight jumps with them.
            if (x >= 20 && x < 44 && y >= 14 && y < 34)
                gbuffer.setMotion(x, y, frontPx, 0.3f * frontPx, 3.0f);
            else
                gbuffer.setMotion(x, y, 0.2f * backPx, backPx, 3.02f);
        }
    return gbuffer;
}

/// A small change of motion that flips decisions, and by how much a pixel may differ then.
struct Step {
    const char* name;
    std::vector<std::pair<float, float>> motions;
    double bound;
};

const Step kSteps[] = {
    // Of a filter whose taps are nearest texels, weights change by about the step over a tenth of
    // the motion, 1e-4 of them; the rest is the decision that flips, which texel a tap takes: of
    // the taps, at most two of a pixel are within the step of a border at a time, and each has less
    // than a tenth of the weight. Each then moves the mean by its share of the slope. Both means
    // are stored as half floats, off by less than kStored each.
    {"a longer motion",
     {{11.3f, 7.1f}, {7.9f, 17.3f}, {19.7f, 3.3f}, {14.2f, 14.9f}},
     0.2 * kSlope + 2.0 * kStored},
    // The decision that a pixel is still flips. The taps are in the pixel's own texel then, whose
    // colour is a half float: the remainder is the rounding of their mean.
    {"a motion past half a pixel", {{0.47886f, 0.0f}, {0.0f, 0.49022f}}, kStored},
};

TEST_F(HardFilters, AMotionLongerByATenthOfAThousandthOfAPixelIsNotSeen) {
    constexpr float kStepPx = 1e-4f;
    FilterRig rig(device());
    for (const auto& [name, motions, bound] : kSteps)
        for (const Method* method : listFilters()) {
            MotionBlurSettings settings;
            settings.method = method;
            settings.tileSizePx = 24;
            Worst worst;
            for (const auto& [front, back] : motions)
                worst.addDifference(
                    rig.blur(makeSmooth(front, back), settings).color,
                    rig.blur(makeSmooth(front + kStepPx, back + kStepPx), settings).color,
                    fmt::format("motion {} and {} px", front, back)
                );
            hold(fmt::format("{}, {}", method->name, name), worst, bound, "brightness");
        }
}

} // namespace
} // namespace shutter::stability
