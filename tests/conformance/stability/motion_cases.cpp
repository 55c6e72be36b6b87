// SPDX-License-Identifier: MIT
// Synthetic G-buffers under the filters that need no rays.
#include "shaders/common/numeric.glsl"
#include "shaders/render/motion.glsl"
#include "tests/conformance/stability/case_lists.h"
#include "tests/conformance/stability/filter_rig.h"
#include "tests/conformance/stability/pictures.h"

#include <limits>
#include <random>
#include <string_view>

namespace shutter::stability {

namespace {

using motion_blur::MotionBlurSettings;

constexpr uint32_t kWidth = 56;
constexpr uint32_t kHeight = 40;
/// A mean of half floats that should be one of them, or lie between two, is off by some roundings
/// of single precision and then stored as either half float next to it (Vulkan 1.3, "Floating-Point
/// Format Conversions"): at most one unit in the last place away, or beyond.
constexpr double kStoredHalfUlps = 1.0;

/// Random colours up to `brightest`, still, at two depths within the soft extent and one far away.
GBuffer makeStill(float brightest = 1.0f) {
    GBuffer gbuffer(kWidth, kHeight);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    const float depths[] = {3.0f, 3.02f, 9.0f};
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const float r = brightest * unit(random);
            const float g = brightest * unit(random);
            gbuffer.setColor(x, y, r, g, brightest * unit(random));
            gbuffer.setMotion(x, y, 0.0f, 0.0f, depths[random() % 3]);
        }
    return gbuffer;
}

/// Gives each pixel a motion of random direction and a length in [0, `longestPx`).
void addMotion(GBuffer& gbuffer, float longestPx) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const float angle = 6.2831853f * unit(random);
            const float length = longestPx * unit(random);
            gbuffer.motionDepth.at(x, y, 0) = length * std::cos(angle);
            gbuffer.motionDepth.at(x, y, 1) = length * std::sin(angle);
        }
}

MotionBlurSettings makeSettings(const motion_blur::Method& method) {
    MotionBlurSettings settings;
    settings.method = &method;
    settings.tileSizePx = 16;
    settings.occluderTest = motion_blur::OccluderTest::Velocity;
    return settings;
}

/// What each filter in each phase makes of `gbuffer`, and of `other` where there is one.
using Judge = std::function<void(const Blurred& blurred, const Blurred* other, const char* method)>;

core::Status
filterAll(gpu::Device& device, const GBuffer& gbuffer, const GBuffer* other, const Judge& judge) {
    FilterRig rig(device);
    for (const double share : {0.0, 0.5, 1.0})
        for (const motion_blur::Method* method : listFilters()) {
            const MotionBlurSettings settings = makeSettings(*method);
            auto blurred = rig.blur(gbuffer, settings, share);
            if (!blurred)
                return blurred.error();
            if (other == nullptr) {
                judge(blurred.value(), nullptr, method->name);
                continue;
            }
            auto reference = rig.blur(*other, settings, share);
            if (!reference)
                return reference.error();
            judge(blurred.value(), &reference.value(), method->name);
        }
    return {};
}

/// Finite and inside the range of the colours; and the very bits of `same`, if it is given.
core::Result<Measurements>
measureFilters(gpu::Device& device, const GBuffer& gbuffer, const GBuffer* same) {
    Census census;
    Worst excursion;
    Worst difference;
    Range range;
    range.add(gbuffer.color);
    const core::Status done = filterAll(
        device,
        gbuffer,
        same,
        [&](const Blurred& blurred, const Blurred* other, const char* method) {
            for (const image::Image* picture : {&blurred.color, &blurred.tiles, &blurred.dominant})
                census.add(*picture);
            addExcursion(excursion, blurred.color, range, method);
            if (other != nullptr)
                addDifference(difference, blurred.color, other->color, method);
        }
    );
    if (!done)
        return done.error();
    Measurements found = {
        describe(census),
        describe(excursion, "inside the range of what was filtered", "half ulp", kStoredHalfUlps)};
    if (same != nullptr)
        found.push_back(describe(difference, "as without that motion", "", 0.0));
    return found;
}

/// A filter that has nothing to do must give its input back.
core::Result<Measurements> measureIdentity(gpu::Device& device, const GBuffer& gbuffer) {
    Census census;
    Worst difference;
    const core::Status done = filterAll(
        device,
        gbuffer,
        nullptr,
        [&](const Blurred& blurred, const Blurred*, const char* method) {
            census.add(blurred.color);
            addDifference(difference, blurred.color, gbuffer.color, method);
        }
    );
    if (!done)
        return done.error();
    return Measurements{describe(census), describe(difference, "the sharp picture", "", 0.0)};
}

core::Result<Measurements> measureZero(gpu::Device& device) {
    return measureIdentity(device, makeStill());
}

core::Result<Measurements> measureTiny(gpu::Device& device) {
    GBuffer gbuffer = makeStill();
    addMotion(gbuffer, 0.499f);
    return measureIdentity(device, gbuffer);
}

core::Result<Measurements> measureHuge(gpu::Device& device) {
    GBuffer gbuffer = makeStill();
    addMotion(gbuffer, shader::kMaxMotionPx);
    return measureFilters(device, gbuffer, nullptr);
}

/// Every seventh pixel or so gets the motion (x, y); it must count as none.
core::Result<Measurements> measureScattered(gpu::Device& device, float x, float y) {
    GBuffer gbuffer = makeStill();
    addMotion(gbuffer, 14.0f);
    GBuffer zeroed = gbuffer;
    std::mt19937 random(11);
    for (uint32_t row = 0; row < kHeight; ++row)
        for (uint32_t column = 0; column < kWidth; ++column)
            if (random() % 7 == 0) {
                const float depth = gbuffer.motionDepth.at(column, row, 2);
                gbuffer.setMotion(column, row, x, y, depth);
                zeroed.setMotion(column, row, 0.0f, 0.0f, depth);
            }
    return measureFilters(device, gbuffer, &zeroed);
}

core::Result<Measurements> measureNan(gpu::Device& device) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    return measureScattered(device, nan, 2.0f);
}

core::Result<Measurements> measureInfinite(gpu::Device& device) {
    const float infinity = std::numeric_limits<float>::infinity();
    auto first = measureScattered(device, infinity, -infinity);
    if (!first)
        return first;
    // Finite, but its length is not.
    auto second = measureScattered(device, 3e38f, 3e38f);
    if (!second)
        return second;
    for (Measured& row : second.value()) {
        row.check += ", length beyond a float";
        first.value().push_back(row);
    }
    return first;
}

/// Still pixels in front of one mover far behind them: no tap weighs anything.
core::Result<Measurements> measureZeroWeights(gpu::Device& device) {
    GBuffer gbuffer = makeStill();
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x)
            gbuffer.setMotion(x, y, 0.0f, 0.0f, 3.0f);
    gbuffer.setMotion(20, 13, 11.0f, 4.0f, 9.0f);
    Census census;
    Worst difference;
    const core::Status done = filterAll(
        device,
        gbuffer,
        nullptr,
        [&](const Blurred& blurred, const Blurred*, const char* method) {
            census.add(blurred.color);
            // Jimenez takes the next tap for covered in part, however slow it is.
            if (method == std::string_view("jimenez2014"))
                return;
            for (uint32_t y = 0; y < kHeight; ++y)
                for (uint32_t x = 0; x < kWidth; ++x)
                    for (uint32_t c = 0; c < 3 && (x != 20 || y != 13); ++c) {
                        const double from = gbuffer.color.at(x, y, c);
                        const double error = std::abs(blurred.color.at(x, y, c) - from);
                        difference.add(error / halfUlp(from), method);
                    }
        }
    );
    if (!done)
        return done.error();
    return Measurements{
        describe(census),
        describe(difference, "still pixels stay sharp", "half ulp", kStoredHalfUlps)};
}

core::Result<Measurements> measureConstant(gpu::Device& device) {
    GBuffer gbuffer = makeStill();
    addMotion(gbuffer, 30.0f);
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x)
            gbuffer.setColor(x, y, 0.3f, 0.7f, 0.1f);
    Worst difference;
    const core::Status done = filterAll(
        device,
        gbuffer,
        nullptr,
        [&](const Blurred& blurred, const Blurred*, const char* method) {
            for (uint32_t y = 0; y < kHeight; ++y)
                for (uint32_t x = 0; x < kWidth; ++x)
                    for (uint32_t c = 0; c < 3; ++c) {
                        const double color = gbuffer.color.at(x, y, c);
                        const double error = std::abs(blurred.color.at(x, y, c) - color);
                        difference.add(error / halfUlp(color), method);
                    }
        }
    );
    if (!done)
        return done.error();
    return Measurements{
        describe(difference, "a constant colour stays", "half ulp", kStoredHalfUlps)};
}

core::Result<Measurements> measureBright(gpu::Device& device) {
    GBuffer gbuffer = makeStill(shader::kMaxColor);
    addMotion(gbuffer, 30.0f);
    return measureFilters(device, gbuffer, nullptr);
}

} // namespace

std::vector<HardCase> listMotionCases() {
    return {
        {"ZeroMotion",
         "No motion",
         "Every motion is 0: the passes run and must give the picture back.",
         measureZero},
        {"TinyMotion",
         "Motion below half a pixel",
         "No motion is as long as the half pixel from which anything blurs.",
         measureTiny},
        {"HugeMotion",
         "Motion longer than the screen",
         "Random motions up to the longest that is stored, 32768 pixels.",
         measureHuge},
        {"NanMotion", "NaN motion", "A seventh of all motions is NaN.", measureNan},
        {"InfiniteMotion",
         "Infinite motion",
         "A seventh of all motions are infinite, or so long that their length is.",
         measureInfinite},
        {"ZeroWeightSum",
         "No tap weighs anything",
         "Still pixels before one mover far behind them: all that is left is a pixel's own weight.",
         measureZeroWeights},
        {"ConstantColour", "One colour", "Random motion over one colour.", measureConstant},
        {"BrightestColours",
         "Colours up to the end of half floats",
         "Random colours up to 65000 under random motion: sums of taps pass the end of half "
         "floats.",
         measureBright},
    };
}

} // namespace shutter::stability
