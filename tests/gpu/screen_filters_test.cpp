// SPDX-License-Identifier: MIT
// The filters of one layer on the device: in a centred exposure each is its publication's, whose
// loops are written down once more here in half velocities, with the weights that
// tests/unit/motion_blur holds against the papers; and no input makes a value that is not finite.
#include "engine/image/image.h"
#include "modules/motion_blur/motion_blur.h"
#include "shaders/motion_blur/guertin2014.glsl"
#include "shaders/motion_blur/jimenez2014.glsl"
#include "shaders/motion_blur/weights.glsl"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace shutter {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::vec2;
using glm::vec3;
using image::Image;
using motion_blur::getMethod;
using motion_blur::Method;
using motion_blur::MotionBlurSettings;
using test::makeMotion;

class ScreenFilters : public test::GpuTest {};

constexpr uint32_t kFilteredWidth = 48;
constexpr uint32_t kFilteredHeight = 32;
constexpr double kSoftExtent = 0.03;
/// The longest motion; taps along it stay off the borders between texels.
const dvec2 kDominant(11.3, 4.7);

struct Scene {
    Image color{kFilteredWidth, kFilteredHeight, 4};
    Image motionDepth{kFilteredWidth, kFilteredHeight, 4};
};

/// Random colours that half floats hold; motions shorter than the dominant one, a third of them
/// none, at two depths.
Scene makeFilterScene() {
    Scene scene;
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (uint32_t y = 0; y < kFilteredHeight; ++y)
        for (uint32_t x = 0; x < kFilteredWidth; ++x) {
            for (uint32_t c = 0; c < 3; ++c)
                scene.color.at(x, y, c) = image::roundToHalf(unit(random));
            scene.color.at(x, y, 3) = 1.0f;
            const bool still = random() % 3 == 0;
            for (uint32_t c = 0; c < 2; ++c)
                scene.motionDepth.at(x, y, c) = still ? 0.0f : 16.0f * unit(random) - 8.0f;
            scene.motionDepth.at(x, y, 2) = random() % 2 == 0 ? 3.0f : 3.02f;
        }
    scene.motionDepth.at(20, 13, 0) = float(kDominant.x);
    scene.motionDepth.at(20, 13, 1) = float(kDominant.y);
    return scene;
}

Image blur(
    gpu::Device& device, const Scene& scene, MotionBlurSettings settings, double rasterTime = 0.5
) {
    test::GraphRig rig(device);
    motion_blur::MotionBlur effect(device, VK_NULL_HANDLE);
    motion_blur::MotionBlurInputs inputs;
    inputs.color = rig.uploadColor(scene.color);
    inputs.motionDepth = rig.upload(scene.motionDepth);
    inputs.rasterTime = rasterTime;
    const size_t ticket = rig.want(effect.add(rig.graph, inputs, settings).color);
    run(rig);
    return rig.take(ticket);
}

/// One tile holds the whole picture; no noise.
MotionBlurSettings oneTile(const Method* method) {
    MotionBlurSettings settings;
    settings.method = method;
    settings.tileSizePx = 64;
    settings.softDepthExtent = float(kSoftExtent);
    settings.softDepthShare = 0.0f;
    settings.jitter = 0.0f;
    return settings;
}

/// What a publication's pseudocode reads at a place: clamped to the picture.
struct Texel {
    dvec3 color;
    dvec2 half; ///< half velocity
    double depth;
};

Texel read(const Scene& scene, const dvec2& at) {
    const auto x = uint32_t(std::clamp(std::floor(at.x), 0.0, double(kFilteredWidth - 1)));
    const auto y = uint32_t(std::clamp(std::floor(at.y), 0.0, double(kFilteredHeight - 1)));
    const auto value = [&](const Image& image, uint32_t c) { return double(image.at(x, y, c)); };
    return {
        {value(scene.color, 0), value(scene.color, 1), value(scene.color, 2)},
        0.5 * dvec2(value(scene.motionDepth, 0), value(scene.motionDepth, 1)),
        value(scene.motionDepth, 2)};
}

/// Taps of McGuire and Guertin: where they lie along the dominant motion, of it.
constexpr int kTaps = 15;

dvec2 tapAt(int i) {
    return 0.5 * kDominant * (-1.0 + 2.0 * (i + 1.0) / (kTaps + 1.0));
}

/// Of the target's depth behind the sample's, in the extent over which layers mix.
float findZ(const Texel& target, const Texel& sample) {
    return float((target.depth - sample.depth) / kSoftExtent);
}

/// McGuire 2012, the pseudocode of the reconstruction.
dvec3 filterMcGuire(const Scene& scene, const dvec2& centre) {
    const Texel x = read(scene, centre);
    double weight = 1.0 / std::max(glm::length(x.half), 0.5);
    dvec3 sum = x.color * weight;
    for (int i = 0; i < kTaps; ++i) {
        if (i == (kTaps - 1) / 2)
            continue;
        const dvec2 offset = tapAt(i);
        const Texel y = read(scene, centre + offset);
        const double alpha = shader::sampleWeight(
            findZ(x, y),
            float(glm::length(offset)),
            float(glm::length(y.half)),
            float(glm::length(x.half)),
            1.0f
        );
        weight += alpha;
        sum += alpha * y.color;
    }
    return sum / weight;
}

/// Guertin 2014, its pseudocode where nothing varies: all taps along the dominant motion.
dvec3 filterGuertin(const Scene& scene, const dvec2& centre) {
    const vec2 along(glm::normalize(kDominant));
    const Texel p = read(scene, centre);
    const double speed = glm::length(p.half);
    const float a =
        std::abs(glm::dot(shader::centreDirection(vec2(2.0 * p.half), along, 1.5f), along));
    double weight = kTaps / (40.0 * std::max(speed, 0.5));
    dvec3 sum = p.color * weight;
    for (int i = 0; i < kTaps; ++i) {
        const dvec2 offset = tapAt(i);
        const Texel s = read(scene, centre + offset);
        const double alpha = shader::guertinWeight(
            findZ(p, s),
            float(glm::length(offset)),
            float(glm::length(s.half)),
            float(speed),
            a,
            shader::alignment(vec2(s.half), along)
        );
        weight += alpha;
        sum += alpha * s.color;
    }
    return sum / weight;
}

/// Jimenez 2014: eight pairs, mirrored.
dvec3 filterJimenez(const Scene& scene, const dvec2& centre) {
    constexpr int kPairs = 8;
    const Texel target = read(scene, centre);
    const double pixelsToTaps = kPairs / (0.5 * glm::length(kDominant));
    const auto spread = [&](const Texel& texel) {
        return float(glm::length(texel.half) * pixelsToTaps);
    };
    dvec3 sum(0.0);
    double weight = 0.0;
    for (int i = 0; i < kPairs; ++i) {
        const dvec2 offset = 0.5 * kDominant * ((i + 0.5) / kPairs);
        const Texel pair[] = {read(scene, centre + offset), read(scene, centre - offset)};
        vec2 weights;
        for (int k = 0; k < 2; ++k)
            weights[k] = shader::jimenezWeight(
                findZ(target, pair[k]), float(i) + 0.5f, spread(pair[k]), spread(target)
            );
        weights = shader::mirrorWeights(
            weights,
            vec2(pair[0].depth, pair[1].depth),
            vec2(glm::length(pair[0].half), glm::length(pair[1].half))
        );
        sum += double(weights.x) * pair[0].color + double(weights.y) * pair[1].color;
        weight += double(weights.x) + double(weights.y);
    }
    return (sum + (2.0 * kPairs - weight) * target.color) / (2.0 * kPairs);
}

using Filter = dvec3 (*)(const Scene&, const dvec2&);

/// Single precision throughout, but the result is stored as a half float: 2^-11 of values below 1
/// (either neighbour: 2^-10). Where two speeds or depths are so alike that rounding decides, a
/// pixel may differ: one in 200.
void expectFilter(const Scene& scene, const Image& picture, Filter filter) {
    uint32_t off = 0;
    for (uint32_t y = 0; y < kFilteredHeight; ++y)
        for (uint32_t x = 0; x < kFilteredWidth; ++x) {
            const dvec3 expected = filter(scene, {x + 0.5, y + 0.5});
            double difference = 0.0;
            for (uint32_t c = 0; c < 3; ++c)
                difference = std::max(difference, std::abs(picture.at(x, y, c) - expected[int(c)]));
            off += difference > 1.5e-3;
        }
    EXPECT_LE(off, kFilteredWidth * kFilteredHeight / 200);
    EXPECT_GT(
        test::computeMaxDifferenceWhere(picture, scene.color, [](auto, auto) { return true; }), 0.1
    ) << "it blurs";
}

TEST_F(ScreenFilters, EachIsThePublishedOneInACentredExposure) {
    struct Case {
        const char* method;
        uint32_t samples;
        Filter filter;
    };

    const Scene scene = makeFilterScene();
    for (const Case& one :
         {Case{"mcguire2012", 0, filterMcGuire},
          {"guertin2014", 15, filterGuertin},
          {"jimenez2014", 16, filterJimenez},
          {"jimenez2014", 15, filterJimenez}}) { // pairs: rounded up
        SCOPED_TRACE(testing::Message() << one.method << " " << one.samples);
        MotionBlurSettings settings = oneTile(&getMethod(one.method));
        if (one.samples > 0)
            settings.sampleCount = one.samples;
        expectFilter(scene, blur(device(), scene, settings), one.filter);
    }
}

TEST_F(ScreenFilters, OwnVelocityIsTheMeanAlongThePixelsMotionInEveryPhase) {
    // A ramp to the right, read at nearest texels: the mean of the taps' places.
    Scene scene;
    scene.color = makeMotion(kFilteredWidth, kFilteredHeight, [](uint32_t x, uint32_t) {
        return vec3(0.0f, float(x) / 64.0f, 0.0f);
    });
    scene.motionDepth = makeMotion(kFilteredWidth, kFilteredHeight, [](uint32_t, uint32_t y) {
        return vec3(y < 16 ? 8.0f : 0.4f, 0.0f, 3.0f); // below half a pixel: still
    });
    MotionBlurSettings settings = oneTile(&getMethod("own_velocity"));
    settings.sampleCount = 16;
    for (const double share : {0.0, 0.5, 1.0}) {
        const Image picture = blur(device(), scene, settings, share);
        for (uint32_t y = 0; y < kFilteredHeight; ++y)
            for (uint32_t x = 8; x < kFilteredWidth - 8; ++x) {
                // Taps at (i + 1/2) / 2 from -8 (1 - share) on: two in each texel they cross, but
                // for the texel at each end of an odd half.
                double expected = 0.0;
                for (int i = 0; i < 16; ++i)
                    expected += std::floor(x + 0.5 + 8.0 * ((i + 0.5) / 16.0 + share - 1.0)) / 16.0;
                ASSERT_NEAR(
                    picture.at(x, y, 1), (y < 16 ? expected : double(x)) / 64.0, 1.0 / 1024.0
                ) << x
                  << ", " << y << " share " << share;
            }
    }
}

TEST_F(ScreenFilters, TheOccluderTestKeepsAStillObjectOutOfTheBlurBehindIt) {
    // A red post that is static before a green wall that moves.
    const auto isPost = [](uint32_t x) { return x >= 22 && x < 26; };
    Scene scene;
    scene.color = makeMotion(kFilteredWidth, kFilteredHeight, [&](uint32_t x, uint32_t) {
        return isPost(x) ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 1.0f, 0.0f);
    });
    scene.motionDepth = makeMotion(kFilteredWidth, kFilteredHeight, [&](uint32_t x, uint32_t) {
        return isPost(x) ? vec3(0.0f, 0.0f, 2.0f) : vec3(12.0f, 0.0f, 9.0f);
    });
    MotionBlurSettings settings = oneTile(&getMethod("own_velocity"));
    EXPECT_GT(blur(device(), scene, settings).at(20, 9, 0), 0.2f) << "without it the post smears";
    settings.occluderTest = motion_blur::OccluderTest::Velocity;
    const auto everywhere = [](auto, auto) { return true; };
    const Image tested = blur(device(), scene, settings);
    EXPECT_EQ(test::computeMaxDifferenceWhere(tested, scene.color, everywhere), 0.0);
    // Where every tap is an occluder the sharp colour stays, too.
    scene.motionDepth = makeMotion(kFilteredWidth, kFilteredHeight, [](uint32_t x, uint32_t) {
        return x == 24 ? vec3(400.0f, 0.0f, 9.0f) : vec3(0.0f, 0.0f, 2.0f);
    });
    settings.sampleCount = 16; // no tap at its own place
    EXPECT_TRUE(test::sameBits(blur(device(), scene, settings), scene.color));
}

TEST_F(ScreenFilters, APixelThatMovesIsBlurredWhateverTileTheJitterFetches) {
    // A moving tile next to a static one, each with its own neighbourhood.
    Scene scene = makeFilterScene();
    scene.motionDepth = makeMotion(kFilteredWidth, kFilteredHeight, [](uint32_t x, uint32_t) {
        return vec3(x < 16 ? 9.0f : 0.0f, 0.0f, 3.0f);
    });
    for (const Method* method : {&getMethod("guertin2014"), &getMethod("jimenez2014")}) {
        MotionBlurSettings settings = oneTile(method);
        settings.tileSizePx = 16;
        settings.neighbourhoodTiles = 1;
        settings.jitter = 1.0f;
        const Image picture = blur(device(), scene, settings);
        size_t sharp = 0;
        for (uint32_t y = 0; y < kFilteredHeight; ++y)
            for (uint32_t x = 0; x < 16; ++x)
                sharp += std::abs(picture.at(x, y, 0) - scene.color.at(x, y, 0)) < 1e-4f &&
                         std::abs(picture.at(x, y, 1) - scene.color.at(x, y, 1)) < 1e-4f;
        EXPECT_EQ(sharp, 0u) << method->name;
    }
}

TEST_F(ScreenFilters, GuertinsSecondDirectionTakesTapsOnBothSidesOfAStaticPixel) {
    // A red slab above moves up, one below moves down, the part between is static; the dominant
    // motion runs across. At shutter close each slab was over the middle before.
    Scene scene;
    for (uint32_t y = 0; y < kFilteredHeight; ++y)
        for (uint32_t x = 0; x < kFilteredWidth; ++x) {
            const bool slab = x < 20 && (y < 6 || y >= 26); // out of reach of each other
            scene.color.at(x, y, 0) = slab ? 1.0f : 0.0f;
            scene.motionDepth.at(x, y, 1) = !slab ? 0.0f : y < 6 ? -10.0f : 10.0f;
            scene.motionDepth.at(x, y, 2) = slab ? 3.0f : 9.0f;
        }
    scene.motionDepth.at(22, 15, 0) = 12.0f;
    MotionBlurSettings settings = oneTile(&getMethod("guertin2014"));
    settings.tileSizePx = 24; // two adjacent tiles; the other one's motion goes up
    scene.motionDepth.at(40, 15, 0) = 0.6f;
    scene.motionDepth.at(40, 15, 1) = 9.0f;
    settings.sampleCount = 35;
    const Image picture = blur(device(), scene, settings, 1.0);
    EXPECT_GT(picture.at(8, 8, 0), 0.1f) << "from above";
    EXPECT_GT(picture.at(8, 23, 0), 0.1f) << "from below";
}

TEST_F(ScreenFilters, SurfacesAcrossADominantMotionKeepTheirColour) {
    // No weight but the target's own: static pixels, each at a different depth, next to one mover.
    Scene scene = makeFilterScene();
    scene.motionDepth = makeMotion(kFilteredWidth, kFilteredHeight, [](uint32_t x, uint32_t y) {
        // The mover is behind them all: it may cover nothing.
        return x == 20 && y == 13 ? vec3(kDominant, 9.0f) : vec3(0.0f, 0.0f, 3.0f);
    });
    for (const Method* method :
         {&getMethod("mcguire2012"), &getMethod("guertin2014"), &getMethod("own_velocity")}) {
        const Image picture = blur(device(), scene, oneTile(method));
        const auto still = [](uint32_t x, uint32_t y) { return x != 20 || y != 13; };
        // A sum of one weighted colour divided by its weight, as a half float.
        EXPECT_LE(test::computeMaxDifferenceWhere(picture, scene.color, still), 1.0 / 1024.0)
            << method->name;
    }
}

TEST_F(ScreenFilters, ATileThatIsLookedUpBeyondABorderIsNotLeftOut) {
    // A mover fills the tiles at the left; with neighbourhoods of one tile only the jitter of the
    // lookup carries its smear over the border at x = 16.
    constexpr uint32_t kTile = 16;
    Scene scene = makeFilterScene();
    scene.motionDepth = makeMotion(kFilteredWidth, kFilteredHeight, [](uint32_t x, uint32_t) {
        return x < kTile ? vec3(14.0f, 0.0f, 1.0f) : vec3(0.0f, 0.0f, 3.0f);
    });
    for (const Method* method : {&getMethod("guertin2014"), &getMethod("jimenez2014")}) {
        MotionBlurSettings settings;
        settings.method = method;
        settings.tileSizePx = kTile;
        settings.neighbourhoodTiles = 1;
        const Image blurred = blur(device(), scene, settings);
        const double across =
            test::computeMaxDifferenceWhere(blurred, scene.color, [](uint32_t x, uint32_t) {
                return x >= kTile && x < kTile + kTile / 4;
            });
        EXPECT_GT(across, 0.05) << method->name;
        const double beyond =
            test::computeMaxDifferenceWhere(blurred, scene.color, [](uint32_t x, uint32_t) {
                return x >= 2 * kTile;
            });
        EXPECT_LE(beyond, 1e-3) << method->name; // rounding to half floats
    }
}

TEST_F(ScreenFilters, MotionThatIsNotFiniteCountsAsNone) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    for (const auto& [x, y] :
         {std::pair{nan, 0.0f}, {infinity, nan}, {-infinity, infinity}, {3e38f, 3e38f}}) {
        Scene scene = makeFilterScene();
        Scene zeroed = scene;
        std::mt19937 random(11);
        for (int i = 0; i < 200; ++i) {
            const auto column = uint32_t(random() % kFilteredWidth);
            const auto row = uint32_t(random() % kFilteredHeight);
            if (column == 20 && row == 13)
                continue;
            scene.motionDepth.at(column, row, 0) = x;
            scene.motionDepth.at(column, row, 1) = y;
            zeroed.motionDepth.at(column, row, 0) = zeroed.motionDepth.at(column, row, 1) = 0.0f;
        }
        for (const Method* method :
             {&getMethod("own_velocity"),
              &getMethod("mcguire2012"),
              &getMethod("guertin2014"),
              &getMethod("jimenez2014")}) {
            MotionBlurSettings settings = oneTile(method);
            settings.occluderTest = motion_blur::OccluderTest::Velocity;
            const Image picture = blur(device(), scene, settings);
            EXPECT_TRUE(test::allFinite(picture)) << method->name;
            EXPECT_TRUE(test::sameBits(picture, blur(device(), zeroed, settings))) << method->name;
        }
    }
}

} // namespace
} // namespace shutter
