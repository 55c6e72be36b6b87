// SPDX-License-Identifier: MIT
// Laws of the depth of field that traces rays past what is near.
#include "engine/image/metrics.h"
#include "game/shot/picture_drawer.h"
#include "modules/depth_of_field/depth_of_field.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <numbers>
#include <optional>
#include <string>
#include <utility>

namespace shutter {
namespace {

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
    addWall(mScene.addWaves());
    addCard(mScene.addColor({0.5f, 0.4f, 0.1f}));
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
    addWall(mScene.addWaves());
    addCard(mScene.addColor({0.5f, 0.4f, 0.1f}));
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
    addWall(mScene.addWaves());
    addCard(mScene.addColor({0.5f, 0.4f, 0.1f}));
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
