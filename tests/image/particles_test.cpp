// SPDX-License-Identifier: MIT
// Particles: where they are, what of them is seen, and that a streak is the mean of its instants.
#include "engine/image/metrics.h"
#include "engine/scene/history.h"
#include "modules/particles/particle_emitter.h"
#include "tests/image/laws.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using math::dvec2;
using math::dvec3;
using math::vec4;
using particles::ParticleEmitter;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

constexpr double kExposure = 0.1;

/// One particle of that size, pixels, born at `seconds`.
ParticleEmitter makeOne(double sizePx, const dvec3& velocity, double seconds = -1.0) {
    ParticleEmitter emitter;
    emitter.bursts = {{.seconds = seconds, .count = 1}};
    emitter.lifeSeconds = 10.0;
    emitter.velocity = velocity;
    emitter.sizeBirth = emitter.sizeDeath = sizePx;
    emitter.colors = {vec4(1.0f), vec4(1.0f), vec4(1.0f)};
    return emitter;
}

/// One metre is one pixel, before black.
struct PixelScene : SceneBuilder {
    PixelScene() { setPixelView(64); }

    ecs::Entity emit(const ParticleEmitter& emitter, const dvec3& position) {
        return test::addEmitter(*this, emitter, position);
    }
};

Shot makeShot(std::string_view method) {
    return {
        .method = method,
        .exposureSeconds = kExposure,
        .phase = scene::ShutterPhase::End,
        .instants = 256};
}

class ParticleLaw : public test::GpuTest {
  protected:
    static image::Image draw(const SceneBuilder& scene, std::string_view method = "resolved") {
        return test::renderOnce(device(), scene, makeShot(method)).color;
    }
};

/// Many that fall, slow down and change, some of which are born or die in the exposure.
ParticleEmitter makeShower() {
    ParticleEmitter emitter;
    emitter.spans = {{.fromSeconds = -2.0, .untilSeconds = 2.0, .perSecond = 150.0}};
    emitter.lifeSeconds = 0.25;
    emitter.lifeSpread = 0.5;
    emitter.velocity = dvec3(60.0, 90.0, 0.0);
    emitter.coneDegrees = 60.0;
    emitter.gravity = dvec3(0.0, -300.0, 0.0);
    emitter.drag = 3.0;
    emitter.sizeBirth = 8.0;
    emitter.sizeDeath = 5.0;
    emitter.colors = {vec4(1.0f, 0.9f, 0.4f, 1.0f), vec4(0.9f, 0.3f, 0.1f, 0.8f), vec4(0.0f)};
    return emitter;
}

TEST_F(ParticleLaw, ParticlesFollowTheClosedFormAtEveryTime) {
    PixelScene scene;
    ParticleEmitter emitter = makeOne(12.0, {20.0, 10.0, 0.0}, 0.0);
    emitter.gravity = dvec3(0.0, -8.0, 0.0);
    scene.emit(emitter, {-20.0, 0.0, -10.0});
    Stage stage(device(), scene);
    for (const double seconds : {0.25, 1.0, 1.5}) {
        Shot shot = makeShot("sharp");
        shot.seconds = seconds;
        const dvec2 centroid = test::computeCentroid(stage.render(shot).color);
        const double height = 10.0 * seconds - 4.0 * seconds * seconds;
        EXPECT_NEAR(centroid.x, 48.0 - 20.0 + 20.0 * seconds, 0.05) << seconds;
        EXPECT_NEAR(centroid.y, 32.0 - height, 0.05) << seconds;
    }
}

TEST_F(ParticleLaw, AStreaksLightIsThatOfItsInstantsInEveryMethod) {
    PixelScene scene;
    scene.emit(makeOne(9.0, {300.0, 120.0, 0.0}, -0.15), {-30.0, -10.0, -10.0});
    Stage stage(device(), scene);
    const image::Image truth = stage.render(makeShot("accumulate")).color;
    ASSERT_GT(test::sumLight(truth), 10.0);
    // Particles are drawn after the blur: over the raster's depth, or over surfaces at instants.
    for (const std::string_view method :
         test::pickMethods(test::listBlurMethods(device()), {"gather", "resolved"})) {
        const image::Image blurred = stage.render(makeShot(method)).color;
        EXPECT_NEAR(test::sumLight(blurred) / test::sumLight(truth), 1.0, 1e-3) << method;
        EXPECT_GE(image::computePsnr(blurred, truth), 60.0) << method;
    }
}

TEST_F(ParticleLaw, AParticleBornOrDyingInTheExposureIsVisibleForItsShare) {
    const auto measure = [&](double born, double life) {
        PixelScene scene;
        ParticleEmitter emitter = makeOne(12.0, {}, born);
        emitter.lifeSeconds = life;
        scene.emit(emitter, {0.0, 0.0, -10.0});
        return test::sumLight(draw(scene));
    };
    const double all = measure(-1.0, 10.0);
    ASSERT_GT(all, 10.0);
    EXPECT_NEAR(measure(-0.025, 10.0) / all, 0.25, 1e-3);
    EXPECT_NEAR(measure(-0.2, 0.13) / all, 0.3, 1e-3);
    EXPECT_NEAR(measure(-0.06, 0.02) / all, 0.2, 1e-3);
    EXPECT_EQ(measure(-0.3, 0.1), 0.0);
    EXPECT_EQ(measure(0.1, 1.0), 0.0);
}

TEST_F(ParticleLaw, AShowerIsAsTheMeanOfManyInstantsHasIt) {
    for (const particles::ParticleBlend blend :
         {particles::ParticleBlend::Alpha, particles::ParticleBlend::Add}) {
        PixelScene scene;
        ParticleEmitter emitter = makeShower();
        emitter.blend = blend;
        scene.emit(emitter, {-10.0, -10.0, -10.0});
        Stage stage(device(), scene);
        for (const auto shape : {scene::ResponseShape::Box, scene::ResponseShape::Triangle}) {
            Shot shot = makeShot("resolved");
            shot.shutter.response.shape = shape;
            const image::Image blurred = stage.render(shot).color;
            shot.method = "accumulate";
            const image::Image truth = stage.render(shot).color;
            shot.method = "sharp";
            EXPECT_LE(image::computePsnr(stage.render(shot).color, truth), 32.0);
            EXPECT_GE(image::computePsnr(blurred, truth), 45.0);
            EXPECT_NEAR(test::sumLight(blurred) / test::sumLight(truth), 1.0, 0.03);
        }
    }
}

TEST_F(ParticleLaw, APictureDoesNotDependOnThoseBeforeItNorOnTheOrderOfEmitters) {
    const auto addBoth = [](PixelScene& scene, bool swapped) {
        for (const int i : {swapped ? 1 : 0, swapped ? 0 : 1}) {
            ParticleEmitter emitter = makeShower();
            emitter.seed = uint32_t(i);
            scene.emit(emitter, {-10.0, 4.0 * i - 10.0, -10.0 - i});
        }
    };
    PixelScene scene;
    addBoth(scene, false);
    Shot shot = makeShot("resolved");
    shot.seconds = 0.35;
    const image::Image alone = test::renderOnce(device(), scene, shot).color;
    test::Frames frames(device(), scene);
    for (int i = 0; i < 3; ++i) {
        Shot before = shot;
        before.seconds = 0.2 + 0.05 * i;
        (void)frames.draw(before);
    }
    EXPECT_TRUE(test::sameBits(frames.draw(shot).color, alone));
    PixelScene swapped;
    addBoth(swapped, true);
    EXPECT_TRUE(test::sameBits(test::renderOnce(device(), swapped, shot).color, alone));
}

TEST_F(ParticleLaw, MirroredAndReversedOnesGiveMirroredAndEqualPictures) {
    const auto draw = [&](double side, double direction, scene::ShutterPhase phase) {
        PixelScene scene;
        ParticleEmitter emitter = makeOne(9.0, {direction * 300.0, 0.0, 0.0}, -2.0);
        // At time 0 it is at its side's 4.
        scene.emit(emitter, {side * 4.0 - direction * 600.0, 3.0, -10.0});
        Shot shot = makeShot("resolved");
        shot.phase = phase;
        return test::renderOnce(device(), scene, shot).color;
    };
    using scene::ShutterPhase;
    const image::Image right = draw(1.0, 1.0, ShutterPhase::End);
    ASSERT_GT(test::sumLight(right), 5.0);
    EXPECT_GE(image::computePsnr(test::mirror(draw(-1.0, -1.0, ShutterPhase::End)), right), 70.0);
    EXPECT_GE(image::computePsnr(draw(1.0, -1.0, ShutterPhase::Start), right), 70.0);
}

TEST_F(ParticleLaw, ACameraPanBlursParticlesLikeTheWorld) {
    SceneBuilder scene = test::makeView();
    scene.moveCamera({.angularVelocity = {0.0, 1.5, 0.0}});
    test::addEmitter(scene, makeOne(0.3, {}), {0.3, 0.1, -4.0});
    test::Comparison pan(device(), scene, makeShot("sharp"), 256);
    EXPECT_LE(pan.psnr("sharp"), 35.0);
    EXPECT_GE(pan.psnr("resolved"), 55.0);
}

/// How near pictures are to the mean of many instants.
struct Likeness {
    double psnr = 0.0;  ///< of resolved
    double light = 0.0; ///< of resolved: ratio of the sums of light
    double sharp = 0.0; ///< PSNR of the sharp picture
};

Likeness compareChange(gpu::Device& device, const ParticleEmitter& emitter, Shot shot) {
    PixelScene scene;
    scene.emit(emitter, {-10.0, 3.0, -10.0});
    Stage stage(device, scene);
    const image::Image blurred = stage.render(shot).color;
    shot.method = "accumulate";
    const image::Image truth = stage.render(shot).color;
    shot.method = "sharp";
    return {
        image::computePsnr(blurred, truth),
        test::sumLight(blurred) / test::sumLight(truth),
        image::computePsnr(stage.render(shot).color, truth)};
}

TEST_F(ParticleLaw, AParticleThatGrowsOrShrinksIsTheMeanOfItsInstants) {
    const auto makeGrowing = [](double birth, double death, const dvec3& velocity) {
        ParticleEmitter emitter = makeOne(birth, velocity, -0.11);
        emitter.sizeDeath = death;
        emitter.lifeSeconds = 0.15;
        return emitter;
    };
    for (const auto& [birth, death, speed] :
         {std::tuple(0.1, 60.0, 0.0),
          {60.0, 0.0, 0.0},
          {0.1, 60.0, 100.0},
          {50.0, 8.0, 500.0},
          {0.0, 1.5, 0.0}})
        for (const auto shape : {scene::ResponseShape::Box, scene::ResponseShape::Triangle}) {
            Shot shot = makeShot("resolved");
            shot.shutter.response.shape = shape;
            const Likeness found =
                compareChange(device(), makeGrowing(birth, death, {speed, 0.0, 0.0}), shot);
            EXPECT_GT(found.psnr, 50.0) << birth << ", " << speed;
            EXPECT_NEAR(found.light, 1.0, 0.01) << birth << ", " << speed;
            EXPECT_LT(found.sharp, found.psnr - 10.0) << birth << ", " << speed;
        }
}

TEST_F(ParticleLaw, AFlashIsTheMeanOfItsColours) {
    ParticleEmitter flash = makeOne(20.0, {}, -0.09);
    flash.lifeSeconds = 0.07;
    // Opacity peaks at a third of the exposure, and light and opacity change together.
    flash.colors = {vec4(4.0f, 1.0f, 0.5f, 0.0f), vec4(0.5f, 1.0f, 1.0f, 1.0f), vec4(0.0f)};
    for (const double speed : {0.0, 300.0}) {
        flash.velocity.x = speed;
        const Likeness found = compareChange(device(), flash, makeShot("resolved"));
        EXPECT_GT(found.psnr, 50.0) << speed;
        EXPECT_NEAR(found.light, 1.0, 0.01) << speed;
    }
}

TEST_F(ParticleLaw, APictureThatTurnsGrowsOrFlashesInPlaceIsTheMeanOfItsInstants) {
    PixelScene scene;
    scene.world.assets.textures[scene.addWaveTexture(64, /*alphaHoles=*/true)].isLoose = true;
    ParticleEmitter turns = makeOne(40.0, {});
    turns.spin = 12.0;
    turns.seed = 3;
    ParticleEmitter grows = makeOne(4.0, {}, -0.11);
    grows.sizeDeath = 50.0;
    grows.lifeSeconds = 0.15;
    ParticleEmitter flashes = makeOne(40.0, {}, -0.09);
    flashes.lifeSeconds = 0.07;
    flashes.colors = {vec4(1.0f, 1.0f, 1.0f, 0.0f), vec4(1.0f), vec4(1.0f, 1.0f, 1.0f, 0.0f)};
    for (ParticleEmitter emitter : {turns, grows, flashes}) {
        emitter.texture = 0;
        const ecs::Entity entity = scene.emit(emitter, {-2.0, 3.0, -10.0});
        test::Comparison change(device(), scene, makeShot("sharp"), 256);
        const render::FrameResult blurred = change.render("resolved");
        EXPECT_GT(change.psnr(blurred), change.psnr("sharp") + 8.0) << emitter.spin;
        EXPECT_GT(change.psnr(blurred), 34.0) << emitter.spin;
        EXPECT_NEAR(test::sumLight(blurred.color) / test::sumLight(change.truth()), 1.0, 0.01);
        scene::hide(scene.world, entity);
    }
}

TEST_F(ParticleLaw, APictureOnThemIsShownAtInstantsOfTheExposure) {
    PixelScene scene;
    scene.addWaves(); // image 0
    scene.world.assets.textures[0].isLoose = true;
    ParticleEmitter emitter = makeOne(24.0, {200.0, 0.0, 0.0}, -0.1);
    emitter.spin = 4.0;
    emitter.texture = 0;
    scene.emit(emitter, {-12.0, 0.0, -10.0});
    test::Comparison spin(device(), scene, makeShot("sharp"), 256);
    const render::FrameResult blurred = spin.render("resolved");
    EXPECT_EQ(test::countPasses(blurred, "particles"), 4u);
    EXPECT_NEAR(test::sumLight(blurred.color) / test::sumLight(spin.truth()), 1.0, 0.01);
    EXPECT_GE(spin.psnr(blurred), 25.0);
    EXPECT_LE(spin.psnr("sharp"), 20.0);
}

TEST_F(ParticleLaw, HolesOfAParticlesPictureShowTheBackground) {
    PixelScene scene;
    scene.world.assets.textures[scene.addWaveTexture(64, /*alphaHoles=*/true)].isLoose = true;
    test::addCard(scene, {100, 80}, {0.6f, 0.6f, 0.6f}, {.position = {0, 0, -20}});
    ParticleEmitter emitter = makeOne(40.0, {200.0, 0.0, 0.0}, -0.1);
    emitter.texture = 0;
    scene.emit(emitter, {-12.0, 0.0, -10.0});
    Stage stage(device(), scene);
    const image::Image truth = stage.render(makeShot("accumulate")).color;
    for (const std::string_view method : test::kSharpAndResolved) {
        const image::Image picture = stage.render(makeShot(method)).color;
        EXPECT_LE(test::findBrightest(picture), 1.001f);
        EXPECT_NEAR(test::sumLight(picture) / test::sumLight(truth), 1.0, 0.02) << method;
    }
}

TEST_F(ParticleLaw, AWayThatBendsOrGoesIntoAWallIsSeenAsAtItsInstants) {
    const auto compare = [&](bool bends) {
        PixelScene scene;
        test::addCard(scene, {100, 80}, {0.1f, 0.2f, 0.3f}, {.position = {0, 0, -12}});
        // As it is at the exposure's end, or in its middle where it meets the wall.
        ParticleEmitter emitter = makeOne(9.0, {300.0, 250.0, bends ? 0.0 : -100.0}, -kExposure);
        if (bends)
            emitter.gravity = dvec3(0.0, -5000.0, 0.0);
        scene.emit(emitter, {-15.0, -5.0, bends ? -10.0 : -7.0});
        return test::Comparison(device(), scene, makeShot("sharp"), 256).psnr("resolved");
    };
    EXPECT_GT(compare(true), 38.0);
    EXPECT_GT(compare(false), 50.0);
}

TEST_F(ParticleLaw, SurfacesInFrontHideParticles) {
    for (const std::string_view method : test::kSharpAndResolved) {
        PixelScene scene;
        test::addCard(scene, {40, 40}, {0.2f, 0.4f, 0.6f}, {.position = {0, 0, -5}});
        const image::Image without = draw(scene, method);
        scene.emit(makeOne(10.0, {50.0, 0.0, 0.0}), {-50.0, 0.0, -10.0});
        EXPECT_TRUE(test::sameBits(draw(scene, method), without)) << method;
        scene.emit(makeOne(10.0, {50.0, 0.0, 0.0}), {-50.0, 0.0, -4.0});
        EXPECT_FALSE(test::sameBits(draw(scene, method), without)) << method;
    }
}

/// A wall of waves, puffs before it, and a box that sweeps between the near and the far ones.
struct PuffScene : SceneBuilder {
    explicit PuffScene(const ParticleEmitter& puffs) {
        setPerspective(0.9);
        add(test::makeQuad(9.0, 6.0, addWaves()), {.position = {0, 0, -4}});
        for (const double depth : {-2.2, -3.4})
            test::addEmitter(*this, puffs, {0.0, 0.0, depth});
    }

    void addSweep(double speed, const math::vec3& color = {0.9f, 0.2f, 0.1f}) {
        add(test::makeBox({0.6, 0.7, 0.2}, addColor(color)),
            {.position = {0, 0, -2.8}, .velocity = {speed, 0, 0}});
    }
};

/// Thirty puffs or sparks that were all born at once.
ParticleEmitter makePuffs() {
    ParticleEmitter emitter;
    emitter.bursts = {{.seconds = -1.0, .count = 30}};
    emitter.lifeSeconds = 10.0;
    emitter.velocity = dvec3(0.0, 0.4, 0.0);
    emitter.coneDegrees = 180.0;
    emitter.sizeBirth = emitter.sizeDeath = 0.35;
    emitter.colors = {vec4(0.3f, 0.8f, 0.9f, 0.5f), vec4(0.3f, 0.8f, 0.9f, 0.5f), vec4(0.2f)};
    return emitter;
}

test::Comparison comparePuffs(gpu::Device& device, const PuffScene& scene) {
    return {device, scene, {.width = 192, .height = 128, .exposureSeconds = 0.25}, 128};
}

TEST_F(ParticleLaw, AMoverHidesAndShowsThemAtTheInstantsAtWhichItIsThere) {
    ParticleEmitter sparks = makePuffs();
    sparks.blend = particles::ParticleBlend::Add;
    for (const auto& [emitter, least] : {std::pair(makePuffs(), 46.0), std::pair(sparks, 42.0)}) {
        PuffScene scene(emitter);
        scene.addSweep(2.4);
        test::Comparison puffs = comparePuffs(device(), scene);
        EXPECT_GT(puffs.psnr("resolved"), least);
        EXPECT_LT(puffs.psnr("gather"), least - 4.0) << "the raster's depth would do as well";
    }
}

TEST_F(ParticleLaw, ACameraThatMovesHidesThemAtEachInstantByWhatItSeesThen) {
    PuffScene scene(makePuffs());
    scene.addSweep(0.0);
    scene.moveCamera({.velocity = {1.2, 0.0, -0.5}});
    test::Comparison puffs = comparePuffs(device(), scene);
    EXPECT_GT(puffs.psnr("resolved"), 48.0);
    EXPECT_LT(puffs.psnr("gather"), 42.0) << "the raster's depth would do as well";
}

TEST_F(ParticleLaw, OverGlassTheyLieOverWhatIsSeenThroughIt) {
    PuffScene scene(makePuffs());
    scene.addSweep(2.4, math::vec3(8.0f)); // bright: the background shows through dark glass
    scene.add(
        test::makeQuad(2.2, 1.6, test::addGlass(scene, {0.05f, 0.05f, 0.05f, 0.9f})),
        {.position = {0, 0, -2.4}, .velocity = {0.4, 0, 0}}
    );
    EXPECT_GT(comparePuffs(device(), scene).psnr("resolved"), 37.0);
}

TEST_F(ParticleLaw, InstantsAreLookedUpOnlyWhereSomethingOpaqueMoves) {
    const auto hasInstants = [&](const PuffScene& scene, std::string_view method) {
        const Shot shot{.method = method, .width = 192, .height = 128, .exposureSeconds = 0.25};
        return test::hasPass(test::renderOnce(device(), scene, shot), "instant surfaces");
    };
    PuffScene still(makePuffs());
    still.addSweep(0.0);
    EXPECT_FALSE(hasInstants(still, "resolved"));
    PuffScene aside(makePuffs());
    test::addBox(
        aside,
        {0.2, 0.2, 0.2},
        {0.9f, 0.2f, 0.1f},
        {.position = {3.4, 1.9, -3.8}, .velocity = {0.2, 0, 0}}
    );
    EXPECT_FALSE(hasInstants(aside, "resolved"));
    PuffScene swept(makePuffs());
    swept.addSweep(2.4);
    EXPECT_TRUE(hasInstants(swept, "resolved"));
    EXPECT_FALSE(hasInstants(swept, "gather"));
}

TEST_F(ParticleLaw, SoftParticlesFadeInFrontOfASurface) {
    const auto measure = [&](double softMetres) {
        PixelScene scene;
        test::addCard(scene, {60, 60}, {0, 0, 0}, {.position = {0, 0, -10}});
        ParticleEmitter emitter = makeOne(12.0, {});
        emitter.softMetres = softMetres;
        scene.emit(emitter, {0.0, 0.0, -9.0});
        return test::sumLight(draw(scene, "sharp"));
    };
    const double hard = measure(0.0);
    EXPECT_NEAR(measure(0.5) / hard, 1.0, 1e-3);
    EXPECT_NEAR(measure(4.0) / hard, 0.25, 2e-3);
}

TEST_F(ParticleLaw, ParticlesWithoutOpacitySizeOrLifeChangeNothing) {
    PixelScene scene;
    test::addCard(scene, {40, 40}, {0.2f, 0.4f, 0.6f}, {.position = {0, 0, -50}});
    const image::Image without = draw(scene);
    ParticleEmitter emitter = makeShower();
    emitter.spans[0].untilSeconds = -1.0;
    const ecs::Entity entity = scene.emit(emitter, {0.0, 0.0, -10.0});
    const render::FrameResult dead = test::renderOnce(device(), scene, makeShot("resolved"));
    EXPECT_TRUE(test::sameBits(dead.color, without));
    EXPECT_EQ(test::countPasses(dead, "particles"), 0u);
    auto& component = scene.world.registry.get<ParticleEmitter>(entity);
    component = makeShower();
    component.colors = {vec4(1.0f, 1.0f, 1.0f, 0.0f), vec4(0.0f), vec4(0.0f)};
    const render::FrameResult clear = test::renderOnce(device(), scene, makeShot("resolved"));
    EXPECT_EQ(test::countPasses(clear, "particles"), 1u);
    EXPECT_TRUE(test::sameBits(clear.color, without));
    component = makeShower();
    component.sizeBirth = component.sizeDeath = 0.0;
    EXPECT_TRUE(test::sameBits(draw(scene), without));
}

TEST_F(ParticleLaw, AnExposureOf0IsTheSharpPictureAndAStaticParticleIsToAHalfStep) {
    PixelScene shower;
    shower.emit(makeShower(), {-10.0, -10.0, -10.0});
    Shot shot = makeShot("resolved");
    shot.exposureSeconds = 0.0;
    EXPECT_TRUE(
        test::sameBits(test::renderOnce(device(), shower, shot).color, draw(shower, "sharp"))
    );
    PixelScene still;
    still.emit(makeOne(14.0, {}), {3.0, 2.0, -10.0});
    EXPECT_LE(image::computeMaxDifference(draw(still, "sharp"), draw(still)), 1.0 / 1024.0);
}

TEST_F(ParticleLaw, LightThatThePictureCannotHoldStaysFinite) {
    for (const std::string_view method : test::kSharpAndResolved) {
        PixelScene scene;
        ParticleEmitter emitter = makeOne(20.0, {});
        emitter.bursts[0].count = 200;
        emitter.blend = particles::ParticleBlend::Add;
        emitter.colors.fill(vec4(1000.0f, 1000.0f, 1000.0f, 1.0f));
        scene.emit(emitter, {0.0, 0.0, -10.0});
        const image::Image picture = draw(scene, method);
        EXPECT_TRUE(test::allFinite(picture)) << method;
        EXPECT_GE(picture.at(48, 32, 0), 60000.0f) << method;
    }
}

TEST_F(ParticleLaw, LitOnesSendBackTheLightFromEverywhereAndOfLamps) {
    PixelScene scene;
    ParticleEmitter emitter = makeOne(20.0, {});
    emitter.lit = true;
    emitter.colors.fill(vec4(0.5f, 0.5f, 0.5f, 1.0f));
    scene.emit(emitter, {0.5, -0.5, -10.0});
    Shot shot = makeShot("sharp");
    shot.ambient = math::vec3(0.8f);
    EXPECT_NEAR(test::renderOnce(device(), scene, shot).color.at(48, 32, 1), 0.4f, 2e-3f);
    scene.addSun({0.0, -1.0, 0.0}, 12.5663706f);
    EXPECT_NEAR(test::renderOnce(device(), scene, shot).color.at(48, 32, 1), 0.9f, 4e-3f);
}

TEST_F(ParticleLaw, ThePictureAfterTenHoursIsThatOfTheBeginning) {
    // Without randomness, since it depends on the start of a span.
    const auto drawAt = [&](double hours, std::string_view method) {
        PixelScene scene;
        ParticleEmitter emitter = makeShower();
        const double begin = hours * 3600.0;
        emitter.spans.clear();
        for (int i = 0; i < 24; ++i)
            emitter.bursts.push_back({.seconds = begin - 0.4 + i / 64.0, .count = 1});
        emitter.coneDegrees = emitter.lifeSpread = 0.0;
        const ecs::Entity entity = scene.emit(emitter, {-10.0, -10.0, -10.0});
        // It is at the same places, and turns the same way.
        scene.world.registry.get<scene::LocalTransform>(entity).transform.translation.x -=
            40.0 * begin;
        scene.world.registry.add(entity, scene::LinearVelocity{dvec3(40.0, 0.0, 0.0)});
        Shot shot = makeShot(method);
        shot.seconds = begin;
        return test::renderOnce(device(), scene, shot).color;
    };
    for (const std::string_view method : test::kSharpAndResolved) {
        const image::Image first = drawAt(0.0, method);
        ASSERT_GT(test::sumLight(first), 10.0);
        EXPECT_LT(image::computeMaxDifference(drawAt(10.0, method), first), 2.0e-3) << method;
    }
}

TEST_F(ParticleLaw, NearTheEyeTheyFadeAndBehindItTheyAreNotSeen) {
    const auto makeWall = [] {
        SceneBuilder scene = test::makeView();
        test::addCard(scene, {9.0, 6.0}, {0.2f, 0.4f, 0.6f}, {.position = {0, 0, -4}});
        return scene;
    };
    const auto drawWith = [&](double z, double speed, std::string_view method) {
        SceneBuilder scene = makeWall();
        test::addEmitter(scene, makeOne(0.5, {0.2, 0.0, speed}, 0.0), {0.1, 0.05, z});
        Shot shot = makeShot(method);
        shot.seconds = kExposure;
        shot.instants = 128;
        return test::renderOnce(device(), scene, shot).color;
    };
    for (const std::string_view method : test::kSharpAndResolved) {
        const image::Image wall = draw(makeWall(), method);
        for (const double z : {0.0, 0.3, 1.0, 40.0}) // behind the eye, or in it
            EXPECT_TRUE(test::sameBits(drawWith(z, 0.0, method), wall)) << z << method;
        // One that its plane cuts, those before it, and one that comes from behind the wall.
        double before = 0.0;
        for (const double z : {-0.06, -0.1, -0.2, -0.4, -0.56}) {
            const image::Image picture = drawWith(z, 0.0, method);
            EXPECT_TRUE(test::allFinite(picture)) << z << method;
            EXPECT_LE(test::findBrightest(picture), 1.001) << z << method;
            const double shown = double(picture.at(50, 30, 0)) - 0.2;
            EXPECT_GE(shown, before) << "it fades" << z << method;
            before = shown;
        }
        EXPECT_GT(before, 0.5);
    }
    for (const double speed : {9.0, -9.0}) { // it crosses the plane halfway
        const double z = -0.05 - 0.5 * speed * kExposure;
        const image::Image blurred = drawWith(z, speed, "resolved");
        EXPECT_TRUE(test::allFinite(blurred));
        EXPECT_GT(image::computePsnr(blurred, drawWith(z, speed, "accumulate")), 30.0) << speed;
    }
}

TEST_F(ParticleLaw, TruthShowsThemTooOverWhatItsRaysMeet) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "needs ray queries";
    PixelScene scene;
    test::addCard(scene, {60, 50}, {0.1f, 0.3f, 0.2f}, {.position = {0, 0, -20}});
    scene.emit(makeShower(), {-10.0, -10.0, -10.0});
    Stage stage(device(), scene);
    const image::Image accumulated = stage.render(makeShot("accumulate")).color;
    EXPECT_GE(image::computePsnr(stage.render(makeShot("truth")).color, accumulated), 45.0);
    Shot still = makeShot("truth");
    still.exposureSeconds = 0.0;
    still.instants = 16;
    const image::Image rays = stage.render(still).color;
    still.method = "sharp";
    EXPECT_GE(image::computePsnr(rays, stage.render(still).color), 60.0);
}

} // namespace
} // namespace shutter
