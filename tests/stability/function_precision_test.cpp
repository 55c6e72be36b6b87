// SPDX-License-Identifier: MIT
// The shaders' functions in single precision, as the device computes them but for its own rounding,
// against the very same text in double precision.
#include "double/motion_blur/guertin2014.glsl.h"
#include "double/motion_blur/jimenez2014.glsl.h"
#include "double/motion_blur/ray_mask.glsl.h"
#include "double/motion_blur/weights.glsl.h"
#include "double/render/motion.glsl.h"
#include "double/tonemap/tonemap.glsl.h"
#include "double/truth/estimate.glsl.h"

#include "shaders/motion_blur/guertin2014.glsl"
#include "shaders/motion_blur/jimenez2014.glsl"
#include "shaders/motion_blur/ray_mask.glsl"
#include "shaders/motion_blur/weights.glsl"
#include "shaders/render/motion.glsl"
#include "shaders/tonemap/tonemap.glsl"
#include "shaders/truth/estimate.glsl"
#include "tests/stability/hard_case.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace shutter::stability {
namespace {

constexpr uint32_t kTrials = 200000;
/// Relative error of one rounding to single precision.
const double kEpsilon = std::ldexp(1.0, -24);

/// Numbers that both precisions hold exactly.
class Dice {
  public:
    float between(float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(mRandom);
    }

    /// Evenly over the decades.
    float logarithmic(float low, float high) {
        return std::exp(between(std::log(low), std::log(high)));
    }

    glm::vec2 motion(float longest) {
        return {between(-longest, longest), between(-longest, longest)};
    }

    glm::vec3 color(float brightest) {
        const float brightness = logarithmic(1e-3f, brightest);
        return {between(0.0f, brightness), between(0.0f, brightness), between(0.0f, brightness)};
    }

  private:
    std::mt19937 mRandom{17};
};

/// Errors in roundings of a value of the size `scale`.
void addRoundings(Worst& worst, double single, double twice, double scale) {
    worst.add(std::abs(single - twice) / (kEpsilon * scale));
}

void holdRoundings(const Worst& worst, const char* check, double bound) {
    hold(check, worst, bound, "2^-24");
}

/// The three filters' weights. A cylinder is steep, 15 / v per pixel, at a place that is rounded
/// from values of the size v: some 30 roundings for each of two. Cones and the rest add a few, and
/// the magnification by 30 is relative to that.
TEST(FunctionPrecision, FilterWeightsInSinglePrecisionAreNearThoseInDouble) {
    Dice dice;
    Worst gather;
    Worst guertin;
    Worst jimenez;
    for (uint32_t i = 0; i < kTrials; ++i) {
        const float z = dice.between(-3.0f, 3.0f);
        const float distance = dice.between(0.0f, 40.0f);
        const float sample = dice.logarithmic(0.01f, 300.0f);
        const float target = dice.logarithmic(0.01f, 300.0f);
        const float along = dice.between(0.0f, 1.0f);
        const float magnification = 30.0f;
        addRoundings(
            gather,
            shader::sampleWeight(z, distance, sample, target, magnification),
            shader64::sampleWeight(z, distance, sample, target, magnification),
            z >= 1.0f ? magnification : 1.0
        );
        addRoundings(
            guertin,
            shader::guertinWeight(z, distance, sample, target, along, 1.0f - along),
            shader64::guertinWeight(z, distance, sample, target, along, 1.0f - along),
            1.0
        );
        addRoundings(
            jimenez,
            shader::jimenezWeight(z, distance, sample, target),
            shader64::jimenezWeight(z, distance, sample, target),
            std::max({1.0f, distance})
        );
    }
    holdRoundings(gather, "gather's and McGuire's weight", 64.0);
    holdRoundings(guertin, "Guertin's weight", 64.0);
    holdRoundings(jimenez, "Jimenez' weight, of the distance", 4.0);
}

/// Each place in the picture is a quotient, a sum and products: four roundings of its size. A path
/// that leaves the space in front is cut where it does, a mean of two places that is then divided
/// by the near plane's distance: its roundings are relative to those places so divided.
TEST(FunctionPrecision, MotionFromClipSpaceInSinglePrecisionIsNearThatInDouble) {
    Dice dice;
    Worst inFront;
    Worst crossing;
    const glm::vec2 size(1366.0f, 768.0f);
    const glm::dvec2 size64(size);
    const float nearW = 0.05f;
    for (uint32_t i = 0; i < kTrials; ++i) {
        const auto place = [&](float w) {
            return glm::vec3(dice.between(-1.5f, 1.5f) * w, dice.between(-1.5f, 1.5f) * w, w);
        };
        const glm::vec3 visible = place(dice.logarithmic(0.06f, 1000.0f));
        const glm::vec3 open = place(dice.logarithmic(0.06f, 1000.0f));
        // Every other path ends behind the camera.
        const bool crosses = i % 2 == 0;
        glm::vec3 close = place(dice.logarithmic(0.06f, 1000.0f));
        close.z = crosses ? -close.z : close.z;
        const glm::dvec2 single(shader::motionFromClip(open, close, visible, nearW, size));
        const glm::dvec2 twice = shader64::motionFromClip(
            glm::dvec3(open), glm::dvec3(close), glm::dvec3(visible), nearW, size64
        );
        const auto farOut = [&](const glm::vec3& clip) {
            const double w = crosses ? double(nearW) : double(clip.z);
            return glm::length(glm::dvec2(clip) / w * size64);
        };
        const double scale = std::max({farOut(open), farOut(close), farOut(visible), 1366.0});
        for (int c = 0; c < 2; ++c)
            addRoundings(crosses ? crossing : inFront, single[c], twice[c], scale);
    }
    holdRoundings(inFront, "motion, of the place in the picture", 4.0);
    holdRoundings(crossing, "motion that is cut at the near plane", 4.0);
}

TEST(FunctionPrecision, TheEdgeMeasureInSinglePrecisionIsNearThatInDouble) {
    Dice dice;
    Worst worst;
    for (uint32_t i = 0; i < kTrials; ++i) {
        const glm::vec2 depth = dice.motion(dice.logarithmic(1e-4f, 1e9f));
        const glm::vec3 x = dice.color(100.0f);
        const glm::vec3 y = dice.color(100.0f);
        addRoundings(
            worst,
            shader::edgeMeasure(depth, x, y),
            shader64::edgeMeasure(glm::dvec2(depth), glm::dvec3(x), glm::dvec3(y)),
            1.0
        );
    }
    // 1 - 1 / (x + 1) turns the few roundings of x into as many of 1 at most.
    holdRoundings(worst, "edge measure", 4.0);
}

/// Bright colours come near 1, where the operator's own differences cancel: errors are relative to
/// 1 and to the colour it keeps. sRGB's root makes 5.4 of a relative error 2.4.
TEST(FunctionPrecision, ToneMapAndSrgbInSinglePrecisionAreNearThoseInDouble) {
    Dice dice;
    Worst neutral;
    Worst srgb;
    for (uint32_t i = 0; i < kTrials; ++i) {
        const glm::vec3 color = dice.color(65000.0f);
        const glm::dvec3 single(shader::toneMapNeutral(color));
        const glm::dvec3 twice = shader64::toneMapNeutral(glm::dvec3(color));
        for (int c = 0; c < 3; ++c)
            addRoundings(neutral, single[c], twice[c], 1.0);
        const float linear = dice.logarithmic(1e-6f, 2.0f);
        addRoundings(srgb, shader::encodeSrgb(linear), shader64::encodeSrgb(linear), 1.0);
    }
    holdRoundings(neutral, "Khronos PBR Neutral", 8.0);
    holdRoundings(srgb, "sRGB", 4.0);
}

/// A sum, a product and a reciprocal: three roundings of the brighter of the two sets' means.
TEST(FunctionPrecision, TheTruthsMeanAndErrorInSinglePrecisionAreNearThoseInDouble) {
    Dice dice;
    Worst mean;
    Worst error;
    for (uint32_t i = 0; i < kTrials; ++i) {
        const uint32_t count = 2 + i % 511;
        const glm::vec3 a = dice.color(65000.0f) * float(count);
        const glm::vec3 b = dice.color(65000.0f) * float(count);
        const glm::dvec3 a64(a);
        const glm::dvec3 b64(b);
        const glm::dvec3 mean1(shader::meanOfSets(a, b, count));
        const glm::dvec3 mean2 = shader64::meanOfSets(a64, b64, count);
        const glm::dvec3 error1(shader::errorOfSets(a, b, count));
        const glm::dvec3 error2 = shader64::errorOfSets(a64, b64, count);
        for (int c = 0; c < 3; ++c) {
            const double size = std::max(a64[c], b64[c]) / (count / 2);
            addRoundings(mean, mean1[c], mean2[c], mean2[c]);
            addRoundings(error, error1[c], error2[c], size);
        }
    }
    holdRoundings(mean, "mean of the rays", 3.0);
    holdRoundings(error, "standard error, of the brighter mean", 3.0);
}

} // namespace
} // namespace shutter::stability
