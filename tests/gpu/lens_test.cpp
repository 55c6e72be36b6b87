// SPDX-License-Identifier: MIT
// Laws of the filters that blur a picture by its depth, and of the one that traces rays past what
// is near.
#include "engine/image/metrics.h"
#include "game/shot/picture_drawer.h"
#include "modules/depth_of_field/depth_of_field.h"
#include "tests/gpu/effect_rig.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

namespace shutter {
namespace {

/// Depth in metres of each pixel.
using DepthAt = std::function<float(uint32_t x, uint32_t y)>;

constexpr double kFocus = 2.0; ///< metres

class LensFilters : public test::GpuTest, public testing::WithParamInterface<const char*> {
  protected:
    /// \param lens of a camera whose yFov is a Camera's own
    image::Image
    filter(const image::Image& picture, const DepthAt& depth, const scene::CameraLens& lens) {
        const uint32_t width = picture.width;
        const uint32_t height = picture.height;
        test::GraphRig rig(device());
        const graph::ImageHandle color = rig.uploadColor(picture);
        test::EffectRig effect(rig, color, width, height);
        effect.gbuffer.motionDepth =
            rig.upload(test::makeMotion(width, height, [&](uint32_t x, uint32_t y) {
                return math::vec3(0.0f, 0.0f, depth(x, y));
            }));

        scene::World world;
        const ecs::Entity camera = world.registry.create();
        world.registry.add(camera, scene::Camera{});
        world.registry.add(camera, scene::LocalTransform{});
        world.registry.add(camera, lens);
        const scene::ExposureMotion motion(world, camera, {});
        const double tangent = std::tan(scene::Camera{}.yFov / 2.0);
        effect.frame.constants.pixelFootprint = {float(2.0 * tangent / height), 0.0f};
        render::ExtractContext context{world, effect.view, motion, effect.frame, effect.facts};

        depth_of_field::DepthOfField depthOfField(device());
        depthOfField.configure({&depth_of_field::getFilter(GetParam()), mTaps});
        EXPECT_TRUE(test::decide(depthOfField, effect.facts).run);
        depthOfField.extract(context);
        depthOfField.declare(effect.context);
        const size_t ticket = rig.want(effect.context.color);
        mPasses = test::run(rig).passes.size();
        return rig.take(ticket);
    }

    /// A lens focused at kFocus that spreads a surface at `depth` over that radius.
    static scene::CameraLens makeLens(double depth, double radiusPx, uint32_t height) {
        const double tangent = std::tan(scene::Camera{}.yFov / 2.0);
        const double pixelsAtOne = height / (2.0 * tangent);
        const double radius = radiusPx / pixelsAtOne / std::abs(1.0 / kFocus - 1.0 / depth);
        scene::CameraLens lens;
        lens.focusDistance = kFocus;
        lens.fStop = lens.sensorHeight / (2.0 * tangent) / (2.0 * radius);
        return lens;
    }

    uint32_t mTaps = 64;
    size_t mPasses = 0; ///< of the last frame, reading back included
};

/// Steps from far before the focus to infinity, and what no depth may be.
float findHardDepth(uint32_t x, uint32_t y) {
    constexpr float kDepths[] = {
        1.0e-6f,
        0.1f,
        1.0f,
        2.0f,
        3.0f,
        1.0e9f,
        0.0f,
        -1.0f,
        std::numeric_limits<float>::infinity(),
        std::numeric_limits<float>::quiet_NaN()};
    return kDepths[(x / 3 + 5 * (y / 4)) % std::size(kDepths)];
}

TEST_P(LensFilters, AConstantColourStaysConstantAtAllDepths) {
    const image::Image even = test::makePicture(96, 64, 0.75f);
    const image::Image filtered = filter(even, findHardDepth, makeLens(1.0, 8.0, 64));
    for (const float value : filtered.pixels)
        ASSERT_NEAR(value, 0.75f, 1.0e-3f);
}

TEST_P(LensFilters, AClosedLensAddsNoPassAndKeepsAllBits) {
    const image::Image noise = test::makeNoise(96, 64);
    const image::Image filtered = filter(noise, findHardDepth, {});
    EXPECT_TRUE(test::sameBits(filtered, noise));
    const size_t reading = mPasses;
    (void)filter(noise, findHardDepth, makeLens(1.0, 8.0, 64));
    EXPECT_EQ(mPasses, reading + 3);
}

TEST_P(LensFilters, APlaneInFocusKeepsAllBits) {
    const image::Image noise = test::makeNoise(96, 64);
    const auto atFocus = [](uint32_t, uint32_t) { return float(kFocus); };
    EXPECT_TRUE(test::sameBits(filter(noise, atFocus, makeLens(1.0, 20.0, 64)), noise));
}

TEST_P(LensFilters, ABrightConstantStaysUnderHugeCirclesInPicturesOfAllSizes) {
    constexpr float kBright = 30000.0f;
    // NaN is stored as 0.
    const auto isConstant = [](const image::Image& picture) {
        for (uint32_t y = 0; y < picture.height; ++y)
            for (uint32_t x = 0; x < picture.width; ++x)
                for (uint32_t c = 0; c < 3; ++c)
                    if (!(std::abs(picture.at(x, y, c) - kBright) < 0.01f * kBright))
                        return false;
        return true;
    };
    for (const glm::uvec2 size : {glm::uvec2(1, 1), {41, 39}, {3, 200}}) {
        const image::Image bright = test::makePicture(size.x, size.y, kBright);
        scene::CameraLens lens;
        lens.fStop = 0.01;
        lens.focusDistance = 1.0e-4;
        EXPECT_TRUE(isConstant(filter(bright, findHardDepth, lens))) << size.x;
        lens.focusDistance = kFocus;
        EXPECT_TRUE(isConstant(filter(bright, findHardDepth, lens))) << size.x;
    }
}

TEST_P(LensFilters, AFarPointOfLightBecomesADiscOfTheLensesRadiusAndKeepsItsLight) {
    mTaps = depth_of_field::kMaxTaps;
    constexpr double kRadius = 9.0;
    image::Image point = test::makePicture(128, 128, 0.0f);
    for (uint32_t c = 0; c < 4; ++c)
        point.at(64, 64, c) = 1000.0f;
    const auto far = [](uint32_t, uint32_t) { return 10.0f; };
    const image::Image filtered = filter(point, far, makeLens(10.0, kRadius, 128));
    double sum = 0.0;
    double outside = 0.0;
    for (uint32_t y = 0; y < 128; ++y)
        for (uint32_t x = 0; x < 128; ++x) {
            sum += filtered.at(x, y, 0);
            if (std::hypot(double(x) - 64.0, double(y) - 64.0) > kRadius + 1.5)
                outside += filtered.at(x, y, 0);
        }
    EXPECT_NEAR(sum, 1000.0, 50.0);
    EXPECT_EQ(outside, 0.0);
    const double even = 1000.0 / (std::numbers::pi * kRadius * kRadius);
    double middle = 0.0;
    for (uint32_t y = 60; y <= 68; ++y)
        for (uint32_t x = 60; x <= 68; ++x)
            middle += filtered.at(x, y, 0) / 81.0;
    EXPECT_NEAR(middle, even, 0.1 * even);
}

TEST_P(LensFilters, ANearEdgeCoversWhatIsSharpByTheShareOfItsDisc) {
    mTaps = depth_of_field::kMaxTaps;
    constexpr uint32_t kSize = 128;
    constexpr double kRadius = 10.0;
    const auto isNear = [](uint32_t x) { return x < kSize / 2; };
    image::Image edge = test::makePicture(kSize, kSize, 0.0f);
    for (uint32_t y = 0; y < kSize; ++y)
        for (uint32_t x = 0; x < kSize / 2; ++x)
            for (uint32_t c = 0; c < 4; ++c)
                edge.at(x, y, c) = 1.0f;
    const auto depth = [&](uint32_t x, uint32_t) { return isNear(x) ? 1.0f : float(kFocus); };
    const image::Image filtered = filter(edge, depth, makeLens(1.0, kRadius, kSize));
    // Jimenez's filter has no background behind the near field, which is unchanged.
    const bool looksBehind = GetParam() == std::string("near_far");
    for (int away = looksBehind ? -8 : 0; away <= 12; away += 4) {
        const uint32_t x = uint32_t(int(kSize / 2) + away);
        double mean = 0.0;
        for (uint32_t y = 32; y < 96; ++y)
            mean += filtered.at(x, y, 0) / 64.0;
        // The share of a disc beyond a chord at that distance of its middle.
        const double t = std::clamp((away + 0.5) / kRadius, -1.0, 1.0);
        const double share = (std::acos(t) - t * std::sqrt(1.0 - t * t)) / std::numbers::pi;
        EXPECT_NEAR(mean, share, 0.05) << away;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Each,
    LensFilters,
    testing::Values("jimenez2014", "near_far"),
    [](const auto& named) { return std::string(named.param); }
);

constexpr double kWall = 4.0; ///< metres away, and in focus
constexpr double kCard = 1.0; ///< likewise
constexpr uint32_t kRays = 4;

class LensRays : public test::RayTest {
  protected:
    LensRays() {
        mOptions.width = 96;
        mOptions.height = 64;
        mOptions.usesLens = true;
        mScene.setPerspective(0.9);
        mScene.world.registry.add(mScene.camera, scene::CameraShutter{.exposureSeconds = 0.0});
    }

    void addWall(scene::AssetIndex material) {
        mScene.add(test::makeQuad(8.0, 6.0, material), {.position = {0, 0, -kWall}});
    }

    /// Left of the middle, as high as the picture.
    void addCard(scene::AssetIndex material) {
        mScene.add(test::makeQuad(0.25, 3.0, material), {.position = {-0.2, 0, -kCard}});
    }

    void addWallAndCard() {
        addWall(mScene.addWaves());
        addCard(mScene.addColor({0.5f, 0.4f, 0.1f}));
    }

    void setLens(double fStop, double focus = kWall) {
        scene::CameraLens lens;
        lens.fStop = fStop;
        lens.focusDistance = focus;
        scene::World& world = mRenderer ? mShot.world : mScene.world;
        world.registry.add(mScene.camera, lens);
    }

    render::FrameResult draw(const game::MethodOptions& method) {
        if (!mRenderer) {
            mShot.camera = mScene.camera;
            mShot.world = std::move(mScene.world);
            mRenderer.emplace(device(), mShot.world.assets);
        }
        game::PictureDrawer drawer(device(), *mRenderer);
        auto drawn = drawer.draw(mShot.world, game::makePicture(mShot, mOptions, method, 0.0));
        EXPECT_TRUE(drawn.ok());
        return drawn ? std::move(drawn).value() : render::FrameResult();
    }

    image::Image drawBy(const char* method) {
        return draw(game::makeMethod(*game::findMethod(method).value())).color;
    }

    render::FrameResult filter(const char* name) {
        game::MethodInfo method = *game::findMethod("sharp").value();
        method.name = name;
        method.hasLens = true;
        method.lensFilter = &depth_of_field::getFilter(name);
        game::MethodOptions options;
        options.method = &method;
        options.samples = kRays;
        options.lensTaps = depth_of_field::kDefaultTaps;
        return draw(options);
    }

    test::SceneBuilder mScene;
    game::Shot mShot;
    game::ShotOptions mOptions;
    std::optional<render::Renderer> mRenderer;
};

TEST_F(LensRays, ABackgroundThatTheRasterDoesNotHaveIsSeenPastANearCard) {
    addWallAndCard();
    setLens(0.06);
    const image::Image truth = drawBy("accumulate");
    const double sharp = image::computePsnr(drawBy("sharp"), truth);
    const double guessed = image::computePsnr(filter("near_far").color, truth);
    const render::FrameResult seen = filter("hybrid");
    EXPECT_GT(guessed, sharp);
    EXPECT_GT(image::computePsnr(seen.color, truth), guessed + 3.0);
    // One ray a sample, and one more where all of them hit the card.
    const uint64_t pixels = seen.statistics.counters.at("pixels masked");
    const uint64_t rays = seen.statistics.counters.at("rays traced");
    EXPECT_GT(pixels, 0u);
    EXPECT_LT(pixels, 96u * 64u / 2u);
    EXPECT_GT(rays, kRays * pixels);
    EXPECT_LT(rays, 2 * kRays * pixels);
    EXPECT_TRUE(test::sameBits(filter("hybrid").color, seen.color));
}

TEST_F(LensRays, FramesOfSmoothEdgesTakeTurnsInTheLens) {
    addWallAndCard();
    setLens(0.06, 3.0); // the wall is behind the focus, so that each place sees other parts of it
    mOptions.pixel = extract::PixelModel::Box;
    const image::Image truth = drawBy("accumulate");
    const double one = image::computePsnr(filter("hybrid").color, truth);
    mOptions.picture.antiAliasing = game::AntiAliasing::Box;
    const render::FrameResult seen = filter("hybrid");
    EXPECT_GT(image::computePsnr(seen.color, truth), one + 1.0);
    EXPECT_GT(seen.statistics.counters.at("rays traced"), 16u * kRays);
}

TEST_F(LensRays, OneColourStaysOneColourUnderEachLensAndThroughGlass) {
    const math::vec3 even(0.75f);
    scene::Material glass = mScene.world.assets.materials[mScene.addColor(even)];
    glass.alphaMode = scene::AlphaMode::Blend;
    glass.baseColorFactor.a = 0.5f;
    addWall(mScene.addColor(even));
    addCard(mScene.addColor(even));
    mScene.add(
        test::makeQuad(2.0, 2.0, mScene.addMaterial(glass)), {.position = {0.3, 0, -0.7 * kWall}}
    );
    for (const auto& [fStop, focus] :
         {std::pair(0.06, kWall), {0.01, kWall}, {0.06, 1.5}, {0.01, 1.0e-4}}) {
        setLens(fStop, focus);
        const image::Image filtered = filter("hybrid").color;
        for (uint32_t y = 0; y < filtered.height; ++y)
            for (uint32_t x = 0; x < filtered.width; ++x)
                for (uint32_t c = 0; c < 3; ++c)
                    ASSERT_NEAR(filtered.at(x, y, c), 0.75f, 1.0e-3f) << x << ", " << y;
    }
}

TEST_F(LensRays, WithoutAnythingNearItIsTheFilterOfTheRaster) {
    addWall(mScene.addWaves());
    setLens(0.06, kCard);
    const render::FrameResult seen = filter("hybrid");
    EXPECT_TRUE(test::sameBits(seen.color, filter("near_far").color));
    EXPECT_FALSE(test::sameBits(seen.color, drawBy("sharp")));
    EXPECT_EQ(seen.statistics.counters.at("rays traced"), 0u);
}

TEST_F(LensRays, ALensThatSpreadsNothingOverAPixelKeepsAllBits) {
    addWallAndCard();
    setLens(1000.0);
    EXPECT_TRUE(test::sameBits(filter("hybrid").color, drawBy("sharp")));
}

TEST_F(LensRays, ASurfaceThatRunsThroughTheFocusHidesWhatIsBeneathIt) {
    // A floor before a black sky: nothing near has an edge.
    mScene.add(
        test::makeQuad(60.0, 60.0, mScene.addColor(math::vec3(0.25f))),
        {.position = {0, -1, 0}, .rotation = math::dquat(math::dvec3(-std::numbers::pi / 2, 0, 0))}
    );
    setLens(0.06, 4.0);
    const image::Image floor = filter("hybrid").color;
    for (uint32_t y = 48; y < 64; ++y)
        for (uint32_t x = 0; x < 96; ++x)
            ASSERT_NEAR(floor.at(x, y, 0), 0.25f, 1.0e-3f) << x << ", " << y;
}

} // namespace
} // namespace shutter
