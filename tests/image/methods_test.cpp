// SPDX-License-Identifier: MIT
// What every method leaves alone and which settings it reads; camera motion from depth alone; noise
// of the instants.
#include "engine/image/metrics.h"
#include "tests/image/laws.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using motion_blur::InstantNoise;
using motion_blur::Method;
using motion_blur::MotionBlurSettings;
using test::AdaptiveLaw;
using test::SceneBuilder;
using test::Shot;
using test::Stage;
using Row = core::SettingRow<MotionBlurSettings>;

class IdentityLaw : public test::GpuTest {};

/// A lit, textured scene with a mover in front.
SceneBuilder makeSphereBeforeWall(const math::dvec3& velocity) {
    SceneBuilder scene = test::makeView();
    scene::Material lit;
    lit.baseColor.texture = scene.addWaveTexture();
    lit.roughnessFactor = 0.4f;
    const auto material = scene.addMaterial(lit);
    scene.add(test::makeQuad(8, 6, material), {.position = {0, 0, -6}});
    scene.add(test::makeSphere(0.6, material), {.position = {-0.3, 0, -3}, .velocity = velocity});
    scene.addSun(glm::normalize(math::dvec3(-0.4, -0.7, -0.6)), 3.0f);
    return scene;
}

bool hasBlurPass(const render::FrameResult& result) {
    const auto& passes = result.statistics.passes;
    return std::any_of(passes.begin(), passes.end(), [](const auto& pass) {
        return pass.owner == render::PassOwner::Blur;
    });
}

TEST_F(IdentityLaw, ZeroExposureMotionScaleOrReachGivesTheSharpPictureBitForBit) {
    struct Case {
        dvec3 velocity;
        const char* reason;
        double exposureSeconds = 1.0;
        scene::CameraShutter shutter{};
    };

    scene::CameraShutter unscaled;
    unscaled.cameraRotationScale = unscaled.cameraTranslationScale = unscaled.objectScale = 0.0;
    scene::CameraShutter capped;
    capped.maxBlurPercent = 0.0;
    const dvec3 moving(2.0, 0.5, 0.0);
    const Case cases[] = {
        {moving, "exposure is 0", 0.0},
        {dvec3(0.0), "nothing in the picture moves"},
        {moving, "nothing", 1.0, unscaled},
        {moving, "", 1.0, capped}};
    for (const auto& [velocity, reason, exposure, shutter] : cases) {
        SceneBuilder scene = makeSphereBeforeWall(velocity);
        if (velocity != dvec3(0.0))
            scene.moveCamera({.velocity = {-0.3, 0.1, 0.1}, .angularVelocity = {0.02, 0.2, 0.1}});
        Stage stage(device(), scene);
        Shot shot{.exposureSeconds = exposure, .shutter = shutter, .ambient = math::vec3(0.2f)};
        const auto expected = stage.render(shot).color;
        for (const std::string_view method : test::listRasterMethods(device())) {
            shot.method = method;
            const auto result = stage.render(shot);
            EXPECT_TRUE(test::sameBits(result.color, expected)) << method << " " << reason;
            if (method == "sharp" || method == "accumulate")
                continue;
            const std::string decision = test::describeMotionBlur(result);
            EXPECT_TRUE(decision.starts_with("skipped: ")) << decision;
            EXPECT_NE(decision.find(reason), std::string::npos) << decision;
            EXPECT_FALSE(hasBlurPass(result));
        }
    }
}

TEST_F(IdentityLaw, AMoverThatIsThereRunsTheEffectAndChangesThePicture) {
    const SceneBuilder scene = makeSphereBeforeWall({2.0, 0.5, 0.0});
    Stage stage(device(), scene);
    const Shot sharp{.ambient = math::vec3(0.2f)};
    const auto before = stage.render(sharp);
    for (const std::string_view method :
         test::pickMethods(test::listBlurMethods(device()), {"mcguire2012", "hybrid"})) {
        Shot shot = sharp;
        shot.method = method;
        const auto result = stage.render(shot);
        EXPECT_FALSE(test::sameBits(result.color, before.color)) << method;
        EXPECT_TRUE(test::describeMotionBlur(result).starts_with("ran: "));
        EXPECT_TRUE(hasBlurPass(result)) << method;
    }
}

TEST_F(IdentityLaw, PixelsOutOfReachOfEveryMoverKeepTheirBits) {
    // 11 px of motion in the leftmost of six tiles of 16 px: with one neighbour to each side, the
    // four tiles on the right are out of reach.
    SceneBuilder scene = test::makePixelView(64);
    const auto waves = scene.addWaves();
    scene.add(test::makeQuad(96, 64, waves), {.position = {0, 0, -20}});
    test::addCard(scene, {6, 6}, {1, 0, 0}, {.position = {-41, 0, -10}, .velocity = {3, 0, 0}});
    Stage stage(device(), scene);
    const auto sharp = stage.render({});
    // One that looks tiles up exactly, and one that does so beside.
    for (const std::string_view method :
         test::pickMethods(test::listBlurMethods(device()), {"mcguire2012", "guertin2014"})) {
        Shot shot{.method = method};
        shot.settings.tileSizePx = 16;
        const auto result = stage.render(shot);
        ASSERT_TRUE(hasBlurPass(result));
        // These two look up a tile up to a quarter of a tile away.
        const bool jitters = method == "guertin2014" || method == "jimenez2014";
        const uint32_t reach = jitters ? 36 : 32;
        const auto farAway = [&](uint32_t x, uint32_t) { return x >= reach; };
        const auto near = [&](uint32_t x, uint32_t) { return x < reach; };
        EXPECT_EQ(test::computeMaxDifferenceWhere(result.color, sharp.color, farAway), 0.0)
            << method;
        EXPECT_GT(test::computeMaxDifferenceWhere(result.color, sharp.color, near), 0.1) << method;
    }
}

class MethodSettingsLaw : public test::GpuTest {};

/// A bit of everything that a setting may be about: long uniform motion, directions that cross,
/// still and moving surfaces at depths near and far, surfaces behind one another within one entity
/// and across, edges sharp and soft.
test::SceneBuilder makeAllSorts() {
    test::SceneBuilder scene = test::makeView();
    scene.moveCamera({.velocity = {-1.0, 0.2, 0}});
    const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
    // The wall alone is seen at the left and right: uniform motion, far from all else.
    scene.add(test::makeQuad(64, 18, waves), {.position = {0, 0, -12}, .velocity = {0.6, 0.2, 0}});
    scene.add(test::makeQuad(2.4, 1.2, waves), {.position = {1, 1, -4}, .velocity = {2.5, 0, 0}});
    scene.add(
        test::makeBox({0.9, 0.7, 0.6}, waves),
        {.position = {-0.6, 0, -3}, .velocity = {0.9, 0.3, 0}}
    );
    scene.add(
        test::makeBox({0.5, 0.5, 0.5}, waves),
        {.position = {0.3, -0.2, -3.02}, .velocity = {-0.7, 0.9, 0.4}, .angularVelocity = {0, 1, 3}}
    );
    scene.add(test::makeQuad(0.8, 0.3, waves), {.position = {0.6, -0.6, -2}});
    // One entity of more layers than a stepping ray passes.
    std::vector<scene::Primitive> layers;
    for (int i = 0; i < 16; ++i)
        layers.push_back(test::transformed(
            test::makeQuad(0.5, 0.5, waves),
            glm::translate(math::dmat4(1.0), dvec3(0.0, 0.0, -0.01 * i))
        ));
    scene.add(
        scene.addMesh(std::move(layers)), {.position = {-0.4, 0.8, -3}, .velocity = {0.9, -0.3, 0}}
    );
    return scene;
}

/// Draws with one renderer and one set of pipelines.
class Drawer : public test::Frames {
  public:
    using Frames::Frames;

    image::Image drawWith(const MotionBlurSettings& settings) {
        constexpr double kFrameSeconds = 0.5;
        test::Shot shot{
            .method = settings.method->name,
            .width = 320,
            .height = 96,
            .exposureSeconds = 0.5,
            .frameSeconds = kFrameSeconds,
            .settings = settings};
        // The previous frame exists for methods with lookups in it.
        if (settings.method->readsInstantMotions) {
            shot.seconds = -kFrameSeconds;
            (void)draw(shot);
            shot.seconds = 0.0;
        }
        return draw(shot).color;
    }
};

/// Settings to start from: the defaults, and those with which what waits for another setting
/// counts.
std::vector<MotionBlurSettings> listBases(const Method& method) {
    MotionBlurSettings plain;
    plain.method = &method;
    plain.sampleCount = std::min(method.defaultSamples, 8u);
    MotionBlurSettings steps = plain;
    steps.revealTraversal = motion_blur::RevealTraversal::Stepping;
    steps.uniformMotionPx = 4.0f;
    MotionBlurSettings luminance = plain;
    luminance.objectTest = motion_blur::ObjectTest::Luminance;
    MotionBlurSettings weights = plain;
    weights.composite = motion_blur::CompositeRule::Weights;
    return {plain, steps, luminance, weights};
}

/// The settings with other values of the row.
std::vector<MotionBlurSettings> varyRow(const Row& row, const MotionBlurSettings& base) {
    std::vector<MotionBlurSettings> varied;
    if (const auto* words = std::get_if<core::WordField<MotionBlurSettings>>(&row.field)) {
        for (size_t word = 0; word < words->words.size(); ++word)
            words->set(varied.emplace_back(base), word);
        return varied;
    }
    if (std::holds_alternative<bool MotionBlurSettings::*>(row.field)) {
        auto& flag = varied.emplace_back(base).*std::get<bool MotionBlurSettings::*>(row.field);
        flag = !flag;
        return varied;
    }
    for (const double value : {row.range.lowest, 4.0, 0.25, 7.0, row.range.highest}) {
        MotionBlurSettings other = base;
        if (core::setNumber(row, other, value))
            varied.push_back(other);
    }
    return varied;
}

TEST_F(MethodSettingsLaw, AMethodReadsTheSettingsThatItListsAndNoOther) {
    const test::SceneBuilder scene = makeAllSorts();
    Drawer drawer(device(), scene);
    // Those of the most settings: of rays and tiles, and of lookups.
    for (const std::string_view name :
         test::pickMethods(test::listBlurMethods(device()), {"hybrid", "resolved"})) {
        const Method& method = motion_blur::getMethod(name);
        const std::vector<MotionBlurSettings> bases = listBases(method);
        std::vector<image::Image> expected;
        for (const MotionBlurSettings& base : bases)
            expected.push_back(drawer.drawWith(base));
        for (const Row& row : motion_blur::listSettingRows()) {
            bool changes = false;
            for (size_t i = 0; i < bases.size(); ++i)
                for (const MotionBlurSettings& settings : varyRow(row, bases[i]))
                    if (!changes)
                        changes = !test::sameBits(drawer.drawWith(settings), expected[i]);
            const auto& listed = method.settings;
            const bool isListed = std::string_view(row.name) == "sampleCount" ||
                                  std::find(listed.begin(), listed.end(), row.name) != listed.end();
            EXPECT_EQ(changes, isListed) << name << " " << row.name;
        }
    }
}

/// A textured wall and a box before it, with sky at the sides.
test::SceneBuilder makeBoxInSky(const test::Placement& camera, const dvec3& boxVelocity) {
    test::SceneBuilder scene = test::makeView();
    scene.moveCamera(camera);
    const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
    scene.add(test::makeQuad(5, 3, waves), {.position = {0, 0, -5}});
    scene.add(
        test::makeBox({0.8, 0.6, 0.5}, waves), {.position = {0.2, 0, -2.5}, .velocity = boxVelocity}
    );
    return scene;
}

test::Shot rosadoShot(std::string_view method) {
    return {.method = method, .exposureSeconds = 0.5, .background = math::vec3(0.2f, 0.4f, 0.6f)};
}

TEST_F(IdentityLaw, RosadoEqualsOwnVelocityUnderCameraMotionOnly) {
    const test::Placement moving{
        .velocity = {0.4, 0.1, -0.3}, .angularVelocity = {0.02, 0.1, 0.05}};
    const test::SceneBuilder scene = makeBoxInSky(moving, dvec3(0.0));
    const auto sharp = test::renderOnce(device(), scene, rosadoShot("sharp"));
    const auto expected = test::renderOnce(device(), scene, rosadoShot("own_velocity"));
    const auto result = test::renderOnce(device(), scene, rosadoShot("rosado2007"));
    EXPECT_LT(image::computePsnr(expected.color, sharp.color), 35.0) << "nothing was blurred";
    EXPECT_GT(image::computePsnr(result.color, expected.color), 55.0);
}

TEST_F(IdentityLaw, AMovingObjectStaysSharpUnderAStaticCamera) {
    const test::SceneBuilder scene = makeBoxInSky({}, {0.8, 0.2, 0.0});
    const auto sharp = test::renderOnce(device(), scene, rosadoShot("sharp"));
    const auto result = test::renderOnce(device(), scene, rosadoShot("rosado2007"));
    EXPECT_TRUE(test::sameBits(result.color, sharp.color));
}

constexpr uint32_t kMethodWidth = 192;
constexpr uint32_t kMethodHeight = 128;
constexpr double kWayPx = 120.0;

test::Shot noisyShotOf(std::string_view method, InstantNoise noise = InstantNoise::Off) {
    test::Shot shot{
        .method = method,
        .width = kMethodWidth,
        .height = kMethodHeight,
        .exposureSeconds = 1.0,
        .frameSeconds = 2.0,
        .instants = 240};
    shot.settings.instantNoise = noise;
    return shot;
}

/// A bright post two pixels wide that crosses a black picture.
test::SceneBuilder makePost(double wayPx = kWayPx) {
    test::SceneBuilder scene = test::makePixelView(kMethodHeight);
    test::addCard(
        scene,
        {2.0, 2.0 * kMethodHeight},
        math::vec3(1.0f),
        {.position = {0.0, 0.0, -10.0}, .velocity = {wayPx, 0.0, 0.0}}
    );
    return scene;
}

class InstantNoises : public test::GpuTest {};

/// Errors along the middle of the post's smear, as shares of its brightness.
struct SmearError {
    double banding = 0.0; ///< root mean square of the columns' means
    double noise = 0.0;   ///< ... of the remainder without them
};

SmearError measureSmear(const image::Image& picture, const image::Image& truth) {
    const auto from = uint32_t(0.5 * (kMethodWidth - 0.8 * kWayPx));
    double bright = 0.0;
    double banding = 0.0;
    double noise = 0.0;
    for (uint32_t x = from; x < kMethodWidth - from; ++x) {
        double mean = 0.0;
        double squares = 0.0;
        for (uint32_t y = 0; y < kMethodHeight; ++y) {
            const double error = double(picture.at(x, y, 0)) - double(truth.at(x, y, 0));
            mean += error / kMethodHeight;
            squares += error * error / kMethodHeight;
            bright += double(truth.at(x, y, 0)) / kMethodHeight;
        }
        banding += mean * mean;
        noise += squares - mean * mean;
    }
    const double columns = kMethodWidth - 2.0 * from;
    return {
        std::sqrt(banding / columns) * columns / bright,
        // Equal columns leave a difference of roundings, which may be negative.
        std::sqrt(std::max(noise, 0.0) / columns) * columns / bright};
}

/// Draws frames by number, in any order, with one renderer.
class NumberedFrames : public test::Frames {
  public:
    using Frames::Frames;

    image::Image at(int frame, InstantNoise noise) {
        constexpr double kFrameSeconds = 1.0 / 30.0;
        return draw({.method = "resolved",
                     .width = kMethodWidth,
                     .height = kMethodHeight,
                     .seconds = frame * kFrameSeconds,
                     .frameSeconds = kFrameSeconds,
                     .settings = {.history = false, .instantNoise = noise}}
        ).color;
    }
};

TEST_F(InstantNoises, APostThatGoesFarLeavesGrainInsteadOfCopies) {
    const test::SceneBuilder scene = makePost();
    const auto truth = test::renderOnce(device(), scene, noisyShotOf("accumulate")).color;
    const auto plain =
        measureSmear(test::renderOnce(device(), scene, noisyShotOf("resolved")).color, truth);
    EXPECT_GT(plain.banding, 1.0) << "the shot bands";
    EXPECT_LT(plain.noise, 0.01);
    for (const InstantNoise noise : {InstantNoise::Fixed, InstantNoise::PerFrame}) {
        const auto drawn = test::renderOnce(device(), scene, noisyShotOf("resolved", noise));
        const SmearError error = measureSmear(drawn.color, truth);
        EXPECT_LT(error.banding, 0.3 * plain.banding);
        EXPECT_LT(error.noise, 1.1 * plain.banding) << "no more error than there was";
    }
}

TEST_F(AdaptiveLaw, NoiseAppliesToRaysToo) {
    const test::SceneBuilder scene = makePost();
    const auto truth = test::renderOnce(device(), scene, noisyShotOf("accumulate")).color;
    for (const float rays : {0.0f, 256.0f}) {
        test::Shot shot = noisyShotOf("adaptive");
        shot.settings.raysPerPixel = rays;
        const auto plain = test::renderOnce(device(), scene, shot);
        shot.settings.instantNoise = InstantNoise::Fixed;
        const auto drawn = test::renderOnce(device(), scene, shot);
        EXPECT_LT(
            measureSmear(drawn.color, truth).banding, 0.3 * measureSmear(plain.color, truth).banding
        ) << rays;
    }
}

// Instants less than a pixel apart leave no copies.
TEST_F(InstantNoises, SlowMoversHaveNoNoise) {
    const test::SceneBuilder scene = makePost(12.0);
    EXPECT_TRUE(test::sameBits(
        test::renderOnce(device(), scene, noisyShotOf("resolved", InstantNoise::Fixed)).color,
        test::renderOnce(device(), scene, noisyShotOf("resolved")).color
    ));
}

TEST_F(InstantNoises, NoiseDoesNotChangeAUniformSurface) {
    test::SceneBuilder scene = test::makePixelView(kMethodHeight);
    test::addCard(
        scene,
        {1000.0, 1000.0},
        {0.25f, 0.5f, 0.75f},
        {.position = {0.0, 0.0, -10.0}, .velocity = {kWayPx, 0.5 * kWayPx, 0.0}}
    );
    const auto sharp = test::renderOnce(device(), scene, noisyShotOf("sharp"));
    for (const float uniformMotionPx : {0.5f, 0.0f}) {
        test::Shot shot = noisyShotOf("resolved", InstantNoise::Fixed);
        shot.settings.uniformMotionPx = uniformMotionPx;
        const auto drawn = test::renderOnce(device(), scene, shot);
        EXPECT_LT(image::computeMaxDifference(drawn.color, sharp.color), 1.0e-3);
    }
}

// Blocks of one plane and pixels that search each for itself take the same instants.
TEST_F(InstantNoises, BlockLookupsEqualThoseOfTheirPixels) {
    test::SceneBuilder scene = test::makePixelView(kMethodHeight);
    const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
    scene.add(
        test::makeQuad(8.0 * kMethodWidth, 8.0 * kMethodWidth, waves),
        {.position = {0.0, 0.0, -10.0}, .velocity = {kWayPx, 0.3 * kWayPx, 0.0}}
    );
    test::Shot shot = noisyShotOf("resolved", InstantNoise::Fixed);
    const auto together = test::renderOnce(device(), scene, shot);
    EXPECT_GT(together.statistics.counters.at("blocks uniform"), 0u);
    shot.settings.uniformMotionPx = 0.0f;
    const auto each = test::renderOnce(device(), scene, shot);
    EXPECT_GT(image::computePsnr(together.color, each.color), 45.0);
    shot.settings.sampleCount = 40; // more instants than blocks store
    EXPECT_TRUE(test::allFinite(test::renderOnce(device(), scene, shot).color));
}

TEST_F(InstantNoises, AFrameHasTheSameBitsHoweverItWasReached) {
    const test::SceneBuilder scene = makePost();
    const std::vector<int> numbers = {-1, 0, 1, 2, 3};
    NumberedFrames whole(device(), scene);
    std::vector<image::Image> turning;
    std::vector<image::Image> fixed;
    for (const int number : numbers) {
        turning.push_back(whole.at(number, InstantNoise::PerFrame));
        fixed.push_back(whole.at(number, InstantNoise::Fixed));
    }
    NumberedFrames resumed(device(), scene); // as after a stop
    for (const size_t i : {3u, 1u, 0u}) {
        EXPECT_TRUE(test::sameBits(resumed.at(numbers[i], InstantNoise::PerFrame), turning[i]));
        EXPECT_TRUE(test::sameBits(resumed.at(numbers[i], InstantNoise::Fixed), fixed[i]));
    }
    EXPECT_TRUE(test::sameBits(turning[1], fixed[1])) << "frame 0 is not turned";
}

// The post is put where it was in each frame: only the noise differs.
TEST_F(InstantNoises, TurningHasOtherGrainInEachFrameWhichVanishesInTheMean) {
    test::SceneBuilder scene = test::makePixelView(kMethodHeight);
    const ecs::Entity post = test::addCard(scene, {2.0, 2.0 * kMethodHeight}, math::vec3(1.0f), {});
    const auto draw = [&](int frame, test::Shot shot) {
        shot.seconds = frame * shot.frameSeconds;
        shot.settings.history = false;
        scene.place(
            post, {.position = {-kWayPx * shot.seconds, 0.0, -10.0}, .velocity = {kWayPx, 0.0, 0.0}}
        );
        return test::renderOnce(device(), scene, shot).color;
    };
    const test::Shot fixed = noisyShotOf("resolved", InstantNoise::Fixed);
    const test::Shot turning = noisyShotOf("resolved", InstantNoise::PerFrame);
    const auto first = draw(0, fixed);
    EXPECT_TRUE(test::sameBits(first, draw(1, fixed)));
    EXPECT_FALSE(test::sameBits(first, draw(1, turning)));
    const auto truth = draw(0, noisyShotOf("accumulate"));
    constexpr int kFrames = 5;
    image::Image mean(kMethodWidth, kMethodHeight, first.channels);
    for (int frame = 0; frame < kFrames; ++frame) {
        const auto drawn = draw(frame, turning);
        for (size_t i = 0; i < mean.pixels.size(); ++i)
            mean.pixels[i] += drawn.pixels[i] / kFrames;
    }
    EXPECT_LT(measureSmear(mean, truth).noise, 0.4 * measureSmear(first, truth).noise);
}

} // namespace
} // namespace shutter
