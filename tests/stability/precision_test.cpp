// SPDX-License-Identifier: MIT
// The shaders' functions in single precision, as the device computes them but for its own rounding,
// against the very same text in double precision; and passes on the device against the same loops
// in double precision over the same G-buffer.
#include "double/motion_blur/guertin2014.glsl.h"
#include "double/motion_blur/jimenez2014.glsl.h"
#include "double/motion_blur/ray_mask.glsl.h"
#include "double/motion_blur/taps.glsl.h"
#include "double/motion_blur/weights.glsl.h"
#include "double/render/motion.glsl.h"
#include "double/tonemap/tonemap.glsl.h"
#include "double/truth/estimate.glsl.h"

#include "modules/motion_blur/passes/ray_mask.h"
#include "shaders/motion_blur/guertin2014.glsl"
#include "shaders/motion_blur/jimenez2014.glsl"
#include "shaders/motion_blur/ray_mask.glsl"
#include "shaders/motion_blur/weights.glsl"
#include "shaders/render/motion.glsl"
#include "shaders/tonemap/tonemap.glsl"
#include "shaders/truth/estimate.glsl"
#include "tests/stability/hard_case.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace shutter::stability {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::ivec2;
using image::Image;

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

void addRoundings(Worst& worst, const dvec3& single, const dvec3& twice, const dvec3& scale) {
    for (int c = 0; c < 3; ++c)
        addRoundings(worst, single[c], twice[c], scale[c]);
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
    const dvec2 size64(size);
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
        const dvec2 single(shader::motionFromClip(open, close, visible, nearW, size));
        const dvec2 twice =
            shader64::motionFromClip(dvec3(open), dvec3(close), dvec3(visible), nearW, size64);
        const auto farOut = [&](const glm::vec3& clip) {
            const double w = crosses ? double(nearW) : double(clip.z);
            return glm::length(dvec2(clip) / w * size64);
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
            shader64::edgeMeasure(dvec2(depth), dvec3(x), dvec3(y)),
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
        const dvec3 twice = shader64::toneMapNeutral(dvec3(color));
        addRoundings(neutral, shader::toneMapNeutral(color), twice, dvec3(1.0));
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
        const dvec3 a64(a);
        const dvec3 b64(b);
        const dvec3 mean64 = shader64::meanOfSets(a64, b64, count);
        addRoundings(mean, shader::meanOfSets(a, b, count), mean64, mean64);
        const dvec3 error64 = shader64::errorOfSets(a64, b64, count);
        const dvec3 brighter = glm::max(a64, b64) / double(count / 2);
        addRoundings(error, shader::errorOfSets(a, b, count), error64, brighter);
    }
    holdRoundings(mean, "mean of the rays", 3.0);
    holdRoundings(error, "standard error, of the brighter mean", 3.0);
}

constexpr int kWidth = 72;
constexpr int kHeight = 50;
constexpr int kTile = 16;
constexpr int kColumns = (kWidth + kTile - 1) / kTile;
constexpr int kRows = (kHeight + kTile - 1) / kTile;
constexpr double kSoftExtent = 0.03;
/// Below this a decision hangs on rounding: which texel a tap takes, which side of a threshold a
/// value is. Such pixels are left out; a place in pixels is rounded to some 1e-5.
constexpr double kUndecided = 2e-3;

struct Layer {
    GBuffer gbuffer{kWidth, kHeight};
    Image normal{kWidth, kHeight, 4};
    Image entityId{kWidth, kHeight, 1};
};

/// A slab that moves before a wall, both with some variety; motion beyond a tile here and there.
Layer makeLayer() {
    Layer layer;
    std::mt19937 random(23);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const bool slab = x >= 18 && x < 50 && y >= 12 && y < 37;
            const float r = unit(random);
            const float g = unit(random);
            layer.gbuffer.setColor(x, y, r, g, unit(random));
            const float jitter = unit(random);
            layer.gbuffer.setMotion(
                x,
                y,
                slab ? 9.0f + 3.0f * jitter : 0.7f,
                slab ? -4.0f : 0.3f * jitter,
                slab ? 3.0f + 0.002f * float(x) : 3.4f + 0.003f * float(y)
            );
            if (slab && x == 30 && y == 20)
                layer.gbuffer.setMotion(x, y, 100.0f, 35.0f, 3.0f);
            const dvec3 direction =
                glm::normalize(slab ? dvec3(0.1, 0.2 * jitter, 1.0) : dvec3(-0.3, 0.1, 1.0));
            for (int c = 0; c < 3; ++c)
                layer.normal.at(x, y, uint32_t(c)) = float(direction[c]);
            layer.entityId.at(x, y, 0) = slab ? 1.0f : 0.0f;
        }
    return layer;
}

motion_blur::MotionBlurSettings makeSettings() {
    motion_blur::MotionBlurSettings settings;
    settings.method = &motion_blur::getMethod("gather");
    settings.tileSizePx = kTile;
    settings.sampleCount = 15;
    settings.softDepthExtent = float(kSoftExtent);
    settings.softDepthShare = 0.0f;
    settings.foregroundMagnification = 30.0f;
    settings.maskTest = motion_blur::MaskTest::Paper;
    return settings;
}

/// Reads like a nearest sampler that clamps to the border, and keeps how near a border of texels a
/// place came.
class Reader {
  public:
    explicit Reader(const Layer& layer) : mLayer(layer) {}

    [[nodiscard]] ivec2 texel(const dvec2& at) {
        for (const double place : {at.x, at.y})
            mMargin = std::min(mMargin, std::abs(place - std::round(place)));
        return glm::clamp(ivec2(glm::floor(at)), ivec2(0), ivec2(kWidth - 1, kHeight - 1));
    }

    [[nodiscard]] dvec3 color(const ivec2& at) const { return read(mLayer.gbuffer.color, at); }

    /// Motion and depth.
    [[nodiscard]] dvec3 motionDepth(const ivec2& at) const {
        return read(mLayer.gbuffer.motionDepth, at);
    }

    [[nodiscard]] dvec3 normal(const ivec2& at) const { return read(mLayer.normal, at); }

    [[nodiscard]] float entityId(const ivec2& at) const {
        return mLayer.entityId.at(uint32_t(at.x), uint32_t(at.y), 0);
    }

    /// A decision was taken that another rounding may take otherwise, by this distance.
    void note(double margin) { mMargin = std::min(mMargin, std::abs(margin)); }

    [[nodiscard]] bool isDecided() const { return mMargin > kUndecided; }

    void restart() { mMargin = 1.0; }

  private:
    static dvec3 read(const Image& picture, const ivec2& at) {
        const auto value = [&](uint32_t c) {
            return double(picture.at(uint32_t(at.x), uint32_t(at.y), c));
        };
        return {value(0), value(1), value(2)};
    }

    const Layer& mLayer;
    double mMargin = 1.0;
};

/// Longest motion of each tile, and of each tile's neighbourhood.
struct Tiles {
    std::vector<dvec2> longest;
    std::vector<dvec2> dominant;
};

size_t tileAt(int x, int y) {
    return size_t(y / kTile) * kColumns + size_t(x / kTile);
}

Tiles findTiles(const Layer& layer) {
    Tiles tiles{std::vector<dvec2>(kColumns * kRows), {}};
    const Reader reader(layer);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            dvec2& longest = tiles.longest[tileAt(x, y)];
            longest = shader64::longerMotion(longest, dvec2(reader.motionDepth({x, y})));
        }
    for (dvec2& longest : tiles.longest)
        longest = shader64::clampMotion(longest, kTile);
    for (int i = 0; i < kColumns * kRows; ++i) {
        dvec2& dominant = tiles.dominant.emplace_back(tiles.longest[size_t(i)]);
        for (int j = 0; j < kColumns * kRows; ++j)
            if (std::abs(i % kColumns - j % kColumns) <= 1 &&
                std::abs(i / kColumns - j / kColumns) <= 1)
                dominant = shader64::longerMotion(dominant, tiles.longest[size_t(j)]);
    }
    return tiles;
}

/// reconstruct.comp without a revealed layer.
dvec3 gather(
    Reader& reader,
    const dvec2& dominant,
    int x,
    int y,
    const motion_blur::MotionBlurSettings& settings,
    double share
) {
    const dvec2 centre(x + 0.5, y + 0.5);
    const dvec3 target = reader.motionDepth({x, y});
    const double targetSpeed = glm::length(dvec2(target));
    double weight = shader64::centreWeight(targetSpeed);
    dvec3 sum = weight * reader.color({x, y});
    const double range = glm::length(dominant);
    const double noise = shader64::interleavedGradientNoise(dvec2(x, y));
    reader.note(std::min(noise, 1.0 - noise)); // the noise starts again: a whole tap's distance
    const double offset = glm::mix(0.5, noise, double(settings.jitter));
    for (uint32_t i = 0; i < settings.sampleCount; ++i) {
        const double u = shader64::tapPosition(i, offset, settings.sampleCount, share);
        const double reach = u >= 0.0 ? share : 1.0 - share;
        const ivec2 at = reader.texel(centre + dominant * u);
        const dvec3 tap = reader.motionDepth(at);
        const double z = (target.z - tap.z) / kSoftExtent;
        reader.note(z - 1.0); // from here on the weight is magnified
        const double w = shader64::sampleWeight(
            z,
            range * std::abs(u),
            glm::length(dvec2(tap)) * reach,
            targetSpeed * reach,
            double(settings.foregroundMagnification)
        );
        sum += w * reader.color(at);
        weight += w;
    }
    return sum / weight;
}

class PassPrecision : public test::GpuTest {};

TEST_F(PassPrecision, TilesAndGatherAreNearTheSameLoopsInDouble) {
    const Layer layer = makeLayer();
    motion_blur::MotionBlurSettings settings = makeSettings();
    ASSERT_EQ(settings.neighbourhoodTiles, 3u); // findTiles()
    const Tiles tiles = findTiles(layer);
    FilterRig rig(device());
    Worst tileMotion;
    Worst even;
    Worst noisy;
    uint64_t undecided = 0;
    for (const auto& [share, jitter] :
         {std::pair{0.0, 0.0f}, {0.5, 0.0f}, {1.0, 0.0f}, {1.0, 1.0f}}) {
        settings.jitter = jitter;
        const Blurred blurred = rig.blur(layer.gbuffer, settings, share);
        for (int i = 0; i < kColumns * kRows; ++i)
            for (const auto& [picture, expected] :
                 {std::pair{&blurred.tiles, &tiles.longest},
                  {&blurred.dominant, &tiles.dominant}}) {
                const auto x = uint32_t(i % kColumns);
                const auto y = uint32_t(i / kColumns);
                const dvec2 found(picture->at(x, y, 0), picture->at(x, y, 1));
                const dvec2& wanted = (*expected)[size_t(i)];
                tileMotion.add(glm::length(found - wanted) / glm::length(wanted) * 0x1p24);
            }
        Reader reader(layer);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                reader.restart();
                const dvec2 dominant = tiles.dominant[tileAt(x, y)];
                const dvec3 wanted = gather(reader, dominant, x, y, settings, share);
                undecided += !reader.isDecided();
                for (int c = 0; c < 3 && reader.isDecided(); ++c) {
                    const double found = blurred.color.at(uint32_t(x), uint32_t(y), uint32_t(c));
                    // Stored as a half float, rounded to either neighbour (Vulkan 1.3, "Floating-
                    // Point Format Conversions"): less than one unit in the last place.
                    const double beyond = std::abs(found - wanted[c]) - halfUlp(wanted[c]);
                    (jitter > 0.0f ? noisy : even).add(std::max(beyond, 0.0) * 0x1p24);
                }
            }
    }
    const double pixels = 4.0 * kWidth * kHeight;
    // Two products and a root where a motion is cut to a tile's length, else none.
    hold("tile max and neighbour max", tileMotion, 4.0, "2^-24");
    // Colours are below 1. A weight is off by 60 roundings at most, a few of them of one sign.
    hold("gather, evenly spaced taps, beyond a half ulp", even, 64.0, "2^-24");
    // Noise is the fraction of 53 times a fraction of up to 72 / 15: each tap is off by some 300
    // roundings of the tap's distance, and of a weight's slope over it.
    hold("gather, taps moved by noise, beyond a half ulp", noisy, 4096.0, "2^-24");
    EXPECT_LE(undecided, 0.15 * pixels) << "taps that hang on rounding";
}

/// edge.comp: candidate, measure, edge. The measure is stored in 8 bits.
dvec3 findEdge(
    Reader& reader, int x, int y, const motion_blur::MotionBlurSettings& settings, double share
) {
    const dvec2 centre(x + 0.5, y + 0.5);
    const dvec3 target = reader.motionDepth({x, y});
    const dvec2 motion = shader64::clampMotion(dvec2(target), double(settings.tileSizePx));
    reader.note(glm::length(motion) - 0.5);
    const auto reveals = [&](const dvec2& offset) {
        reader.note(glm::length(offset) - 0.5);
        if (glm::length(offset) < 0.5)
            return false;
        const dvec2 next = glm::clamp(centre + offset, dvec2(0.5), dvec2(kWidth, kHeight) - 0.5);
        const ivec2 at = reader.texel(next);
        const double step = reader.motionDepth(at).z - target.z;
        reader.note(step - kSoftExtent);
        return reader.entityId(at) != reader.entityId({x, y}) && step > kSoftExtent;
    };
    const bool candidate =
        glm::length(motion) >= 0.5 && (reveals(motion * share) || reveals(motion * (share - 1.0)));
    dvec2 depth(0.0);
    dvec3 normalX(0.0);
    dvec3 normalY(0.0);
    for (int v = -2; v <= 2; ++v)
        for (int u = -2; u <= 2; ++u) {
            const ivec2 at =
                glm::clamp(ivec2(x + u, y + v), ivec2(0), ivec2(kWidth - 1, kHeight - 1));
            const dvec2 kernel(
                shader64::sobelDerive(u) * shader64::sobelSmooth(v),
                shader64::sobelDerive(v) * shader64::sobelSmooth(u)
            );
            depth += kernel * reader.motionDepth(at).z;
            normalX += kernel.x * reader.normal(at);
            normalY += kernel.y * reader.normal(at);
        }
    const double measure = shader64::edgeMeasure(depth, normalX, normalY);
    reader.note(measure - double(settings.edgeThreshold));
    return {candidate, measure, candidate && measure > double(settings.edgeThreshold)};
}

/// mask.comp: an edge along the motion.
bool meetsEdge(Reader& reader, const Image& edges, int x, int y, const dvec2& offset) {
    const auto steps = uint32_t(std::ceil(glm::length(offset) / 1.5));
    for (uint32_t i = 0; i <= steps; ++i) {
        const dvec2 along = offset * (double(i) / std::max(steps, 1u));
        const ivec2 at = reader.texel(dvec2(x + 0.5, y + 0.5) + along);
        if (edges.at(uint32_t(at.x), uint32_t(at.y), 2) > 0.5f)
            return true;
    }
    return false;
}

TEST_F(PassPrecision, TheRayMaskIsThatOfTheSameTestsInDouble) {
    const Layer layer = makeLayer();
    motion_blur::MotionBlurSettings settings = makeSettings();
    settings.method = &motion_blur::getMethod("hybrid");
    settings.edgeThreshold = 0.8f;
    const motion_blur::TileMotion tileMotion(device());
    const motion_blur::BlockSorter sorter(device());
    const motion_blur::RayMask rayMask(device());
    Worst measure;
    Worst edges;
    Worst masks;
    uint64_t undecided = 0;
    uint64_t masked = 0;
    for (const double share : {0.0, 0.5, 1.0}) {
        test::GraphRig rig(device());
        const auto params = motion_blur::resolve(settings, kWidth, kHeight, share);
        const graph::ImageHandle motionDepth = rig.upload(layer.gbuffer.motionDepth);
        const auto tiles = tileMotion.add(rig.graph, motionDepth, params);
        const auto outputs = rayMask.add(
            rig.graph,
            {motionDepth,
             rig.upload(layer.normal),
             rig.uploadIds(layer.entityId),
             sorter.add(rig.graph, tiles, params, true),
             true},
            params
        );
        const size_t edgeTicket = rig.want(outputs.edge);
        const size_t maskTicket = rig.want(outputs.masked.mask);
        (void)need(rig.run());
        const Image edge = rig.take(edgeTicket);
        const Image mask = rig.take(maskTicket);
        Reader reader(layer);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const auto found = [&](const Image& picture, uint32_t c) {
                    return double(picture.at(uint32_t(x), uint32_t(y), c));
                };
                reader.restart();
                const dvec3 wanted = findEdge(reader, x, y, settings, share);
                measure.add(255.0 * std::abs(found(edge, 1) - wanted.y));
                undecided += !reader.isDecided();
                if (reader.isDecided())
                    edges.add(std::max(
                        std::abs(found(edge, 0) - wanted.x), std::abs(found(edge, 2) - wanted.z)
                    ));
                // The third test, of the edges that the device found.
                reader.restart();
                const dvec2 motion = shader64::clampMotion(
                    dvec2(reader.motionDepth({x, y})), double(settings.tileSizePx)
                );
                const bool wantedMask = glm::length(motion) >= 0.5 &&
                                        (meetsEdge(reader, edge, x, y, motion * share) ||
                                         meetsEdge(reader, edge, x, y, motion * (share - 1.0)));
                masked += wantedMask;
                if (reader.isDecided())
                    masks.add(std::abs(found(mask, 0) - (wantedMask ? 1.0 : 0.0)));
            }
    }
    const double pixels = 3.0 * kWidth * kHeight;
    // Rounded to 8 bits: half a step, and a little for the device's way to round.
    hold("edge measure of every pixel", measure, 0.51, "1/255");
    hold("candidates and edges", edges);
    hold("mask", masks);
    EXPECT_LE(undecided, 0.15 * pixels) << "tests that hang on rounding";
    EXPECT_GT(masked, 100u);
}

} // namespace
} // namespace shutter::stability
