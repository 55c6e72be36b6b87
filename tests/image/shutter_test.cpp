// SPDX-License-Identifier: MIT
// The shutter: its phase, its response, an artist's scales of it and its cap, alike in every
// method.
#include "engine/image/metrics.h"
#include "engine/scene/path.h"
#include "tests/image/laws.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"
#include "tests/support/white_quads.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using scene::ResponseShape;
using scene::ShutterPhase;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

class PhaseLaw : public test::GpuTest {};

constexpr double kMotionPx = 18.0;

/// A white quad that crosses a black picture; at time 0 its centre is the picture's.
SceneBuilder makeCrossing(const math::dvec3& direction) {
    SceneBuilder scene = test::makePixelView(64);
    test::addCard(
        scene, {24, 24}, {1, 1, 1}, {.position = {0, 0, -10}, .velocity = kMotionPx * direction}
    );
    return scene;
}

/// Where the middle of the blur lies beyond the raster instant's place, in motions.
double expectedShift(ShutterPhase phase) {
    return phase == ShutterPhase::Start ? 0.5 : phase == ShutterPhase::End ? -0.5 : 0.0;
}

/// Least share of the true shift that a method's blur has. Those that see no background, or weigh
/// samples as if a still pixel had none, leave a part of the sharp quad where it was.
double leastShare(std::string_view method) {
    // It blurs inside the quad alone: 24 px, of which 18 px fall off linearly, have their middle at
    // (6 * 3 + 9 * 12) / 15 = 8.4 px from the end, 3.6 px from the quad's and not 9.
    if (method == "own_velocity")
        return 0.39;
    if (method == "mcguire2012" || method == "guertin2014")
        return 0.6;
    // Its 15 instants do not reach the ends of the exposure.
    if (method == "resolved" || method == "adaptive")
        return 0.93;
    return 0.94; // half a pixel
}

TEST_F(PhaseLaw, TheBlurLiesWhereTheAccumulatedPicturesDoesInEveryPhase) {
    const math::dvec2 quad(48.0, 32.0);
    // A filter that spreads what it finds, and lookups.
    const auto methods =
        test::pickMethods(test::listBlurMethods(device()), {"jimenez2014", "resolved"});
    for (const math::dvec3& direction :
         {math::dvec3(1, 0, 0), math::dvec3(0, -1, 0), math::dvec3(-0.6, 0.8, 0)}) {
        const SceneBuilder scene = makeCrossing(direction);
        Stage stage(device(), scene);
        const math::dvec2 along(direction.x, -direction.y); // pixel rows count downwards
        const math::dvec2 across(-along.y, along.x);
        for (ShutterPhase phase : test::kPhases) {
            const math::dvec2 truth =
                test::computeCentroid(
                    stage.render({.method = "accumulate", .phase = phase, .instants = 36}).color
                ) -
                quad;
            const double shift = expectedShift(phase) * kMotionPx;
            EXPECT_NEAR(glm::dot(truth, along), shift, 0.3);
            EXPECT_NEAR(glm::dot(truth, across), 0.0, 0.3);
            for (const std::string_view method : methods) {
                Shot shot{.method = method, .phase = phase};
                // The paper's smears are opaque, so that their centre is the blur's.
                shot.settings = motion_blur::paperSettings();
                // The paper's magnification of the revealed layer makes the half of the blur that
                // lies inside the sharp quad too thin on purpose, which moves its centre: off here.
                shot.settings.backgroundMagnification = 1.0f;
                const math::dvec2 centroid = test::computeCentroid(stage.render(shot).color) - quad;
                const double is = glm::dot(centroid, along) * (shift < 0.0 ? -1.0 : 1.0);
                EXPECT_GE(is, leastShare(method) * std::abs(shift) - 0.1) << method << int(phase);
                EXPECT_LE(is, std::abs(shift) + 1.0) << method << int(phase);
                EXPECT_NEAR(glm::dot(centroid, across), 0.0, 0.3) << method << int(phase);
            }
        }
    }
}

class ShutterLaw : public test::RayTest {};

scene::CameraShutter withResponse(ResponseShape shape, std::vector<double> samples = {}) {
    scene::CameraShutter shutter;
    shutter.response.shape = shape;
    shutter.response.samples = std::move(samples);
    return shutter;
}

/// Most light at open, none at close: it makes early and late differ.
scene::CameraShutter fallingResponse() {
    return withResponse(ResponseShape::Sampled, {1.0, 0.0});
}

/// A white quad crosses black: pixel x is lit by the light taken between the quad's edges' passing.
void expectEdges(
    gpu::Device& device,
    const scene::CameraShutter& shutter,
    const std::function<double(double)>& lightBefore
) {
    constexpr double kWidth = 20.3;
    constexpr double kMotion = 31.7;
    SceneBuilder scene = test::makePixelView(8);
    test::addCard(
        scene, {kWidth, 20}, {1, 1, 1}, {.position = {0.4, 0, -10}, .velocity = {kMotion, 0, 0}}
    );
    Stage stage(device, scene);
    for (const auto phase : test::kPhases) {
        const double left =
            48.4 + kMotion * scene::computeExposure({1.0, phase}, 0.0).open - kWidth / 2.0;
        // Each edge is met to one of the 512 instants, or 256 rays of each set: 1/512 and another
        // for the other edge, < 1/255.
        for (const auto& [method, tolerance] :
             {std::pair{"accumulate", 1.0 / 255.0}, {"truth", 2.0 / 256.0}}) {
            const auto result = stage.render(
                {.method = method, .height = 8, .phase = phase, .shutter = shutter, .instants = 512}
            );
            for (uint32_t x = 0; x < 96; ++x) {
                const double enters = std::clamp((x + 0.5 - left - kWidth) / kMotion, 0.0, 1.0);
                const double leaves = std::clamp((x + 0.5 - left) / kMotion, 0.0, 1.0);
                ASSERT_NEAR(
                    result.color.at(x, 4, 1), lightBefore(leaves) - lightBefore(enters), tolerance
                ) << method
                  << " at " << x << " phase " << int(phase);
            }
        }
    }
}

TEST_F(ShutterLaw, AQuadAtConstantSpeedIsTheExactTrapezoidOrWhatTheResponseMakesOfIt) {
    expectEdges(device(), {}, [](double s) { return s; });
    expectEdges(device(), withResponse(ResponseShape::Triangle), [](double s) {
        return s < 0.5 ? 2.0 * s * s : 1.0 - 2.0 * (1.0 - s) * (1.0 - s);
    });
    expectEdges(device(), fallingResponse(), [](double s) { return 2.0 * s - s * s; });
    scene::CameraShutter shutter = withResponse(ResponseShape::Trapezoid);
    shutter.response.openShare = 0.2;
    shutter.response.closeShare = 0.4;
    expectEdges(device(), shutter, [](double s) {
        const double opening = std::min(s, 0.2);
        const double closing = std::max(s - 0.6, 0.0);
        return (opening * opening / 0.4 + std::clamp(s - 0.2, 0.0, 0.4) + closing -
                closing * closing / 0.8) /
               0.7;
    });
}

SceneBuilder makePan() {
    SceneBuilder scene = test::makeWavyRoom();
    test::addBox(
        scene,
        {0.8, 0.8, 0.8},
        {0.9f, 0.2f, 0.1f},
        {.position = {0.1, 0, -2.5}, .velocity = {0.6, 0.2, 0.3}, .angularVelocity = {0.3, 2, 1}}
    );
    scene.moveCamera({.angularVelocity = {0.02, 0.2, 0.05}});
    return scene;
}

/// Rays and instants agree, and are not the picture `plain` to `mostPlain` dB: the shutter shows.
/// \return the mean of instants
image::Image expectAgreement(
    Stage& stage,
    const scene::CameraShutter& shutter,
    const image::Image* plain = nullptr,
    double mostPlain = 45.0
) {
    Shot shot{.method = "accumulate", .width = 64, .height = 48, .shutter = shutter};
    shot.instants = 256;
    image::Image instants = stage.render(shot).color;
    if (plain) {
        EXPECT_LT(image::computePsnr(*plain, instants), mostPlain) << "the shutter shows";
    }
    shot.method = "truth";
    EXPECT_GE(image::computePsnr(stage.render(shot).color, instants), 45.0);
    return instants;
}

TEST_F(ShutterLaw, RaysAndInstantsAgreeUnderAnyResponse) {
    const SceneBuilder scene = makePan();
    Stage stage(device(), scene);
    const image::Image box = expectAgreement(stage, {});
    for (const auto& shutter :
         {withResponse(ResponseShape::Triangle),
          fallingResponse(),
          withResponse(ResponseShape::Sampled, {0, 3, 0, 0, 1, 4, 0})})
        expectAgreement(stage, shutter, &box, 40.0);
}

TEST_F(ShutterLaw, AConstantResponseEqualsABoxBitForBitInEveryMethod) {
    const SceneBuilder scene = makePan();
    Stage stage(device(), scene);
    for (const std::string_view method : test::pickMethods(
             test::listRasterMethods(device()), {"accumulate", "gather", "resolved"}
         )) {
        const auto box = stage.render({.method = method}).color;
        for (const auto& shutter :
             {withResponse(ResponseShape::Trapezoid),
              withResponse(ResponseShape::Sampled, {2, 2, 2})})
            EXPECT_TRUE(
                test::sameBits(box, stage.render({.method = method, .shutter = shutter}).color)
            ) << method;
    }
}

TEST_F(ShutterLaw, FiltersInsideAMoverFollowTheResponse) {
    // A ramp of 1/400 per pixel that moves 24 px: a pixel's value is its mean sample position.
    constexpr double kMotion = 24.0;
    SceneBuilder scene = test::makePixelView(64);
    scene::Primitive ramp = test::makeQuad(400, 200, scene.addColor({1, 1, 1}));
    for (const math::vec3& position : ramp.positions)
        ramp.colors.push_back({math::vec3(position.x / 400.0f + 0.5f), 1.0f});
    scene.add(std::move(ramp), {.position = {0, 0, -10}, .velocity = {kMotion, 0, 0}});
    Stage stage(device(), scene);
    const image::Image sharp = stage.render({}).color;
    const auto meanShiftPx = [&](std::string_view method, const scene::CameraShutter& shutter) {
        const Shot shot{.method = method, .shutter = shutter, .instants = 256};
        const auto blurred = stage.render(shot).color;
        double sum = 0.0;
        for (uint32_t y = 16; y < 48; ++y)
            for (uint32_t x = 32; x < 64; ++x)
                sum += double(blurred.at(x, y, 0)) - double(sharp.at(x, y, 0));
        return sum / (32.0 * 32.0) * 400.0;
    };
    // On average light is taken at s = 1/3: 1/6 of the motion from the middle.
    const double expected = kMotion / 6.0;
    EXPECT_NEAR(meanShiftPx("accumulate", fallingResponse()), expected, 0.1);
    // A filter whose means are plain ones and one that weighs.
    for (const std::string_view method :
         test::pickMethods(test::listBlurMethods(device()), {"jimenez2014", "hybrid"})) {
        EXPECT_NEAR(meanShiftPx(method, {}), 0.0, 0.25) << method;
        const double shift = meanShiftPx(method, fallingResponse());
        // The means of these two are plain ones; the others weigh near taps more (a cone over half
        // the motion gives 5/36 for 1/6), and of Guertin's some go across.
        if (method == "own_velocity" || method == "jimenez2014") {
            EXPECT_NEAR(shift, expected, 0.25) << method;
        }
        EXPECT_GT(shift, 0.6 * expected) << method;
        EXPECT_LT(shift, 1.1 * expected) << method;
    }
}

/// One control turned: on the camera's shutter, or on the mover.
struct Control {
    std::string name;
    scene::CameraShutter shutter{};
    scene::MotionBlur mover{};
};

std::vector<Control> listControls() {
    std::vector<Control> controls;
    const auto add = [&](const char* name, const std::function<void(Control&)>& turn) {
        controls.push_back({name});
        turn(controls.back());
    };
    add("camera rotation 0", [](Control& c) { c.shutter.cameraRotationScale = 0.0; });
    add("camera rotation 2", [](Control& c) { c.shutter.cameraRotationScale = 2.0; });
    add("camera translation 0", [](Control& c) { c.shutter.cameraTranslationScale = 0.0; });
    add("objects 0", [](Control& c) { c.shutter.objectScale = 0.0; });
    add("objects 1.5", [](Control& c) { c.shutter.objectScale = 1.5; });
    add("mover 0.5", [](Control& c) { c.mover.scale = 0.5; });
    add("mover 2", [](Control& c) { c.mover.scale = 2.0; });
    add("mover excluded", [](Control& c) { c.mover.exclude = true; });
    add("cap of 6 percent", [](Control& c) { c.shutter.maxBlurPercent = 6.0; });
    add("all", [](Control& c) {
        c.shutter.cameraRotationScale = 0.5;
        c.shutter.cameraTranslationScale = 1.5;
        c.shutter.objectScale = 0.7;
        c.mover.scale = 1.3;
    });
    return controls;
}

/// A camera that pans and goes sideways, a textured wall, a mover.
struct ArtistScene {
    SceneBuilder builder = test::makeWavyRoom(5.0, 9.0, 7.0);
    ecs::Entity mover;

    ArtistScene() {
        mover = test::addCard(
            builder,
            {1.4, 1.4},
            {0.9f, 0.2f, 0.1f},
            {.position = {0.1, 0, -2.5}, .velocity = {0.5, 0.2, 0.2}}
        );
        builder.moveCamera({.velocity = {-0.3, 0.1, 0.1}, .angularVelocity = {0.02, 0.2, 0.1}});
    }
};

TEST_F(ShutterLaw, RaysAndInstantsAgreeUnderEveryControl) {
    ArtistScene scene;
    Stage stage(device(), scene.builder);
    const image::Image plain = expectAgreement(stage, {});
    for (const Control& control : listControls()) {
        SCOPED_TRACE(control.name);
        scene.builder.world.registry.add(scene.mover, control.mover);
        expectAgreement(stage, control.shutter, &plain);
    }
}

TEST_F(ShutterLaw, MotionVectorsAreTheDisplacementInThePictureUnderEveryControl) {
    SceneBuilder scene = test::makeView();
    const ecs::Entity marker =
        test::addMarker(scene, 0.25, {.position = {0.2, 0.1, -3}, .velocity = {0.6, 0.3, 0.4}});
    scene.moveCamera({.velocity = {-0.3, 0.1, 0.1}, .angularVelocity = {0.02, 0.2, 0.1}});
    Stage stage(device(), scene);
    for (const Control& control : listControls()) {
        SCOPED_TRACE(control.name);
        scene.world.registry.add(marker, control.mover);
        test::expectMotionOfMarker(
            stage,
            {.exposureSeconds = 0.4, .shutter = control.shutter},
            control.mover.exclude ? 0.0 : 1.0
        );
    }
}

/// Whether the pixel and its neighbours show the entity.
bool isInside(const image::Image& ids, float id, uint32_t x, uint32_t y) {
    if (x == 0 || y == 0 || x + 1 >= ids.width || y + 1 >= ids.height)
        return false;
    for (uint32_t row = y - 1; row <= y + 1; ++row)
        for (uint32_t column = x - 1; column <= x + 1; ++column)
            if (ids.at(column, row, 0) != id)
                return false;
    return true;
}

TEST_F(ShutterLaw, AnExcludedMoverIsSharpInEveryMethodUnderAZoomToo) {
    ArtistScene scene;
    // A texture shows whatever is off its place.
    const ecs::Entity excluded = scene.builder.add(
        test::makeQuad(1.2, 1.2, scene.builder.addWaves()),
        {.position = {-0.1, 0.1, -2}, .velocity = {0.8, 0.1, 0.1}, .angularVelocity = {0, 0.5, 2}}
    );
    scene.builder.world.registry.add(excluded, scene::MotionBlur{.exclude = true});
    Stage stage(device(), scene.builder);
    const auto expectSharpInside = [&](std::string_view method, uint32_t filterLevels = 5) {
        const auto sharp = stage.render({.aovs = {"mesh_id"}});
        const image::Image& ids = sharp.intermediates.at("mesh_id");
        const float id = ids.at(48, 32, 0);
        size_t count = 0;
        const auto inside = [&](uint32_t x, uint32_t y) {
            const bool is = isInside(ids, id, x, y);
            count += is;
            return is;
        };
        const auto elsewhere = [&](uint32_t x, uint32_t y) { return ids.at(x, y, 0) != id; };
        test::Shot shot{.method = method, .instants = 32};
        shot.settings.filterLevels = filterLevels;
        const auto blurred = stage.render(shot).color;
        // A step of the half floats, and what a texel's filter makes of places 1e-4 px apart;
        // Jimenez's filter fades still pixels over one tap's distance wherever motion reaches.
        // The filter of denoised takes texture for noise in each tile that motion crosses: 0.111
        // was measured. Its rays alone are held to the others' bound below.
        const double tolerance = method == "jimenez2014"                    ? 0.03
                                 : method == "denoised" && filterLevels > 0 ? 0.15
                                                                            : 4e-3;
        EXPECT_LT(test::computeMaxDifferenceWhere(blurred, sharp.color, inside), tolerance)
            << method;
        EXPECT_GT(test::computeMaxDifferenceWhere(blurred, sharp.color, elsewhere), 0.1) << method;
        EXPECT_GT(count, 300u);
    };
    for (const std::string_view method : test::pickMethods(
             test::listBlurMethods(device()), {"guertin2014", "resolved", "denoised"}
         ))
        expectSharpInside(method);
    expectSharpInside("denoised", 0);
    expectSharpInside("accumulate");
    expectSharpInside("truth");
    scene.builder.world.registry.add(
        scene.builder.camera,
        scene::LensMotion{{{-1.0, 1.1}, {1.0, 0.7}}, {}, scene::PathEase::None}
    );
    for (const char* method : {"hybrid", "accumulate", "truth"})
        expectSharpInside(method);
}

class MotionCapLaw : public test::GpuTest {};

constexpr double kCapPx = 6.0; // of 96: 6.25 percent

Shot cappedShot(std::string_view method) {
    Shot shot;
    shot.method = method;
    shot.shutter.maxBlurPercent = 100.0 * kCapPx / shot.width;
    shot.aovs = {"motion", "mesh_id"};
    return shot;
}

/// A wall (id 0), a slow mover (1) and a fast one (2); one metre is one pixel.
SceneBuilder makeTwoMovers(const dvec3& fast) {
    SceneBuilder scene = test::makePixelView(64);
    scene.add(test::makeQuad(300, 200, scene.addWaves()), {.position = {0, 0, -20}});
    test::addCard(
        scene, {14, 14}, {0, 0.4f, 1}, {.position = {-28, 0, -10}, .velocity = {0, 5, 0}}
    );
    test::addCard(scene, {14, 14}, {1, 0.2f, 0}, {.position = {20, 0, -10}, .velocity = fast});
    return scene;
}

/// Longest motion vector over the pixels of one id, px.
double findLongest(const render::FrameResult& result, float id) {
    const image::Image& motion = result.intermediates.at("motion");
    const image::Image& ids = result.intermediates.at("mesh_id");
    double longest = 0.0;
    for (uint32_t y = 0; y < ids.height; ++y)
        for (uint32_t x = 0; x < ids.width; ++x)
            if (ids.at(x, y, 0) == id)
                longest =
                    std::max(longest, double(std::hypot(motion.at(x, y, 0), motion.at(x, y, 1))));
    return longest;
}

TEST_F(MotionCapLaw, AMoverBeyondTheCapMovesAsFarAsTheCapAndTheOthersAsBefore) {
    const SceneBuilder scene = makeTwoMovers({24, 0, 0});
    const auto capped = test::renderOnce(device(), scene, cappedShot("sharp"));
    EXPECT_EQ(findLongest(capped, 0), 0.0);
    EXPECT_NEAR(findLongest(capped, 1), 5.0, 1e-4);
    EXPECT_NEAR(findLongest(capped, 2), kCapPx, 0.01 * kCapPx);
}

TEST_F(MotionCapLaw, ATurningMoverEndsAtTheCapThoughItsChordIsNoMeasureOfItsAngle) {
    SceneBuilder scene = test::makePixelView(64);
    test::addCard(
        scene, {40, 6}, {1, 0.2f, 0}, {.position = {0, 0, -10}, .angularVelocity = {0, 0, 3.0}}
    );
    const auto capped = test::renderOnce(device(), scene, cappedShot("sharp"));
    EXPECT_NEAR(findLongest(capped, 0), kCapPx, 0.02 * kCapPx);
}

TEST_F(MotionCapLaw, TheCameraMovesLessForStaticEntitiesAndMoversKeepTheirWayOnTheScreen) {
    SceneBuilder scene = makeTwoMovers({5, 0, 0});
    scene.moveCamera({.velocity = {-10, 0, 0}}); // 10 px; the fast mover 15 px on the screen
    Shot uncapped = cappedShot("sharp");
    uncapped.shutter.maxBlurPercent = 1000.0;
    const auto free = test::renderOnce(device(), scene, uncapped);
    EXPECT_NEAR(findLongest(free, 0), 10.0, 1e-3);
    EXPECT_NEAR(findLongest(free, 2), 15.0, 1e-3);
    const auto capped = test::renderOnce(device(), scene, cappedShot("sharp"));
    for (const float id : {0.0f, 1.0f, 2.0f})
        EXPECT_NEAR(findLongest(capped, id), kCapPx, 0.01 * kCapPx) << id;
}

TEST_F(MotionCapLaw, TruthShowsAShorterExposure) {
    // For one mover before a camera at rest, the cap is an exposure in that proportion.
    const SceneBuilder scene = makeTwoMovers({24, 0, 0});
    SceneBuilder alone = test::makePixelView(64);
    test::addCard(
        alone, {14, 14}, {1, 0.2f, 0}, {.position = {20, 0, -10}, .velocity = {24, 0, 0}}
    );
    Shot capped = cappedShot("accumulate");
    capped.instants = 64;
    const Shot shorter{.method = "accumulate", .exposureSeconds = kCapPx / 24.0, .instants = 64};
    const auto expected = test::renderOnce(device(), alone, shorter);
    const auto actual = test::renderOnce(device(), alone, capped);
    EXPECT_GE(image::computePsnr(actual.color, expected.color), 60.0);
    if (!device().hasRayQuery())
        return;
    Shot rays = cappedShot("truth");
    rays.instants = 256;
    test::Comparison both(device(), scene, rays, 256);
    EXPECT_GE(both.psnr("truth"), 45.0);
}

} // namespace
} // namespace shutter
