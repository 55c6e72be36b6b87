// SPDX-License-Identifier: MIT
// Scenes that are hard on numbers: places, cameras, exposures, meshes, materials, transforms, sizes
// and counts. README.md lists the requirements on their pictures.
#include "engine/extract/extracted_frame.h"
#include "tests/stability/hard_case.h"
#include "tests/support/deformed_meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

namespace shutter::stability {
namespace {

using math::dvec3;
using test::makeBox;
using test::makeQuad;
using test::makeSphere;

void addWall(SceneBuilder& scene) {
    scene.add(makeQuad(6, 5, scene.addWaves()), {.position = {0, 0, -5}});
}

const Placement kMover{.position = {0.05, -0.03, -2}, .velocity = {0.5, 0.2, 0}};

/// At some instants of the exposure the camera is inside the sphere.
void buildThroughTheCamera(SceneBuilder& scene) {
    scene.add(
        makeSphere(0.5, scene.addWaves()), {.position = {0.1, 0.05, -2.5}, .velocity = {0, 0, 6}}
    );
}

/// A double-sided box turns and moves around the camera.
void buildInsideAMover(SceneBuilder& scene) {
    scene::Material inside;
    inside.doubleSided = true;
    scene.add(
        makeBox({1, 1, 1}, scene.addMaterial(inside)),
        {.velocity = {0.2, 0.1, 0.3}, .angularVelocity = {0.3, 1.0, 0.2}}
    );
}

/// No depth, and motion everywhere.
void buildSkyAlone(SceneBuilder& scene) {
    scene.moveCamera({.angularVelocity = {0.1, 0.5, 0.2}});
}

void buildCameraRotation(SceneBuilder& scene) {
    const auto waves = scene.addWaves();
    scene.add(makeQuad(8, 6, waves), {.position = {0, 0, -5}});
    scene.add(makeBox({0.5, 0.5, 0.5}, waves), {.position = {-0.4, 0, -2}});
    scene.moveCamera({.angularVelocity = {0.1, 0.6, 0.3}});
}

/// A grain of a millimetre close to the camera before a hill of a kilometre.
void buildMillimetresAndKilometres(SceneBuilder& scene) {
    scene.cameraSettings().near = 1e-4;
    const auto waves = scene.addWaves();
    scene.add(
        makeSphere(0.001, waves), {.position = {0, 0, -0.004}, .velocity = {0.001, 0.0005, 0}}
    );
    scene.add(makeSphere(1000, waves), {.position = {300, 100, -4000}, .velocity = {-400, 100, 0}});
}

/// Needles, points, a mesh that has some of both, and one triangle alone.
void buildDegenerateTriangles(SceneBuilder& scene) {
    const auto white = scene.addColor({1, 1, 1});
    scene::Primitive needle = makeQuad(1, 1, white);
    for (auto& position : needle.positions)
        position.y = 0.0f;
    scene.add(needle, kMover);
    scene::Primitive point = makeQuad(1, 1, white);
    std::fill(point.positions.begin(), point.positions.end(), math::vec3(0.0f));
    scene.add(point, kMover);
    scene::Primitive mixed = makeQuad(1, 1, white);
    mixed.indices.insert(mixed.indices.end(), 6, mixed.indices.front());
    scene.add(mixed, kMover);
    scene::Primitive alone = makeQuad(0.5, 0.5, white);
    alone.indices.resize(3);
    scene.add(alone, {.position = {-0.5, 0.4, -2}, .velocity = {0.5, 0, 0}});
}

/// Movers in one plane: which of them a pixel shows is a matter of rounding.
void buildCoplanarTriangles(SceneBuilder& scene) {
    for (int i = 0; i < 3; ++i)
        scene.add(
            makeQuad(1.0 - 0.1 * i, 0.8, scene.addWaves()),
            {.position = {0.1 * i, 0.05 * i, -2}, .velocity = {0.5 - 0.4 * i, 0.2, 0}}
        );
}

/// Two crossed bars of one mesh.
void buildSelfOverlap(SceneBuilder& scene) {
    const auto waves = scene.addWaves();
    scene.add(
        scene.addMesh({makeBox({1.2, 0.3, 0.3}, waves), makeBox({0.3, 1.2, 0.3}, waves)}),
        {.position = {0.05, 0, -2}, .velocity = {0.3, 0.1, 0}, .angularVelocity = {0.3, 0.8, 1.0}}
    );
}

/// Bars that turn up to ten times: after whole turns one ends where it began, and stored motion is
/// not the path.
void buildSpins(SceneBuilder& scene) {
    const auto bar = scene.addMesh({makeBox({1.6, 0.3, 0.2}, scene.addWaves())});
    double y = -0.6;
    for (const double turns : {0.6, 1.0, 10.3}) {
        scene.add(
            bar,
            {.position = {0, y, -2.5}, .angularVelocity = {0, 0.2, turns * 2.0 * std::numbers::pi}}
        );
        y += 0.6;
    }
}

/// Two movers of one luminance, red and green, before each other and in opposite directions.
void buildOneLuminance(SceneBuilder& scene) {
    scene.add(makeQuad(1, 0.8, scene.addColor({0.7152f, 0, 0})), kMover);
    scene.add(
        makeQuad(1, 0.8, scene.addColor({0, 0.2126f, 0})),
        {.position = {0.1, 0, -2.5}, .velocity = {-0.5, 0.1, 0}}
    );
}

/// Rods of a twentieth of a pixel that pixel centres meet or miss.
void buildThinGeometry(SceneBuilder& scene) {
    const auto white = scene.addColor({1, 1, 1});
    for (int i = 0; i < 12; ++i)
        scene.add(
            makeBox({0.002, 1.5, 0.002}, white),
            {.position = {-0.8 + 0.1377 * i, 0, -2},
             .rotation = glm::angleAxis(0.1 * i, dvec3(0, 0, 1)),
             .velocity = {0.4, 0.1, 0}}
        );
}

/// Five sheets with holes that move and turn before each other.
void buildMaskedLeaves(SceneBuilder& scene) {
    const auto leaves = scene.addWaves(true);
    for (int i = 0; i < 5; ++i)
        scene.add(
            makeQuad(0.8, 0.8, leaves),
            {.position = {-0.6 + 0.3 * i, 0.1 * i - 0.2, -2.0 - 0.2 * i},
             .rotation = glm::angleAxis(0.5 * i, glm::normalize(dvec3(0.2, 1, 0.3))),
             .velocity = {0.4, 0.1, 0},
             .angularVelocity = {0.5, 1.0, 0.2}}
        );
}

/// Mirrored along one, two and three axes; scaled to a sheet, a line, a point, and to 1e30.
void buildOddScales(SceneBuilder& scene) {
    const auto box = scene.addMesh({makeBox({0.5, 0.4, 0.3}, scene.addWaves())});
    const dvec3 scales[] = {
        {-1, 1, 1},
        {1, -1, 1},
        {-1, -1, -1},
        {-1, -1, 1},
        dvec3(0.0),
        {1, 0, 1},
        {0, 1, 1},
        {1, 1, 0},
        dvec3(1e-30),
        dvec3(1e30)};
    for (int i = 0; i < 10; ++i)
        scene.add(
            box,
            {.position = {-0.6 + 0.4 * (i % 4), 0.1 * i - 0.4, -2},
             .scale = scales[i],
             .velocity = {0.4, 0.1, 0},
             .angularVelocity = {0.3, 0.5, 0}}
        );
}

/// Rank one, rank zero, NaN, infinity and 1e300 next to a valid mover.
void buildSingularMatrices(SceneBuilder& scene) {
    const auto waves = scene.addWaves();
    const auto box = scene.addMesh({makeBox({0.5, 0.4, 0.3}, waves)});
    math::dmat4 rankOne(0.0);
    rankOne[0] = rankOne[1] = rankOne[2] = math::dvec4(1, 1, 1, 0);
    rankOne[3] = math::dvec4(0, 0, -2, 1);
    using Limits = std::numeric_limits<double>;
    for (const double bad : {Limits::quiet_NaN(), Limits::infinity(), 1e300}) {
        math::dmat4 matrix(1.0);
        matrix[3] = math::dvec4(0, 0, -2, 1);
        matrix[1][1] = bad;
        scene.add(box, matrix);
        matrix[1][1] = 1.0;
        matrix[3][0] = bad;
        scene.add(box, matrix);
    }
    scene.add(box, rankOne);
    scene.add(box, math::dmat4(0.0));
    scene.add(makeBox({0.3, 0.3, 0.3}, waves), kMover);
}

/// Two skins whose second joint is scaled to nothing, or mirrored, within the exposure.
void buildCollapsingSkins(SceneBuilder& scene) {
    const auto waves = scene.addWaves();
    double x = -0.5;
    for (const dvec3& scale : {dvec3(0.0), dvec3(-1.0, 1.0, 1.0)}) {
        const std::array joints{
            Placement{.position = {x, -0.4, -2}, .velocity = {0.4, 0.1, 0}},
            Placement{.position = {0, 0.4, 0}, .scale = scale, .angularVelocity = {0, 1, 2}}};
        test::addSkinned(scene, test::makeStrip(0.4, 0.8, 6, waves), joints);
        x += 1.0;
    }
}

/// A morph that turns its mesh inside out through a point, and one that reaches 1e30.
void buildInsideOutMorphs(SceneBuilder& scene) {
    const auto waves = scene.addWaves();
    for (const float reach : {1.0f, 1e30f}) {
        scene::Primitive box = makeBox({0.5, 0.4, 0.3}, waves);
        scene::MorphTarget target;
        for (const math::vec3& position : box.positions)
            target.positions.push_back(-2.0f * reach * position);
        box.morphTargets.push_back(target);
        test::addMorphed(
            scene,
            std::move(box),
            {.position = {0.2, 0, -2}, .velocity = {0.3, 0, 0}},
            {.from = {0.0f}, .to = {1.0f}}
        );
    }
}

/// As many waves as there may be, up to a kilometre high, over one sheet each.
void buildWaves(SceneBuilder& scene) {
    const auto waves = scene.addWaves();
    double x = -0.8;
    for (const double size : {0.0, 1e-30, 0.05, 1e3}) {
        const ecs::Entity entity =
            scene.add(test::makeStrip(0.4, 0.8, 12, waves), {.position = {x, -0.4, -2}});
        scene::VertexWaves moved;
        moved.inWorld = size != 0.05;
        moved.share = scene::WaveShare::Height;
        moved.exponent = 16.0;
        moved.waves.assign(
            scene::kMaxVertexWaves, {dvec3(size), dvec3(std::min(size, 40.0)), 1e3 * size, size}
        );
        for (scene::VertexWave& wave : moved.waves)
            wave.hertz = std::min(wave.hertz, 1e6);
        scene.world.registry.add(entity, moved);
        x += 0.5;
    }
}

struct SceneCase {
    const char* name;
    std::function<void(SceneBuilder&)> build; ///< adds what moves before the wall
    Shot shot = makeLitShot();
    bool hasWall = true;
};

Shot comparedByLuminance() {
    Shot shot = makeLitShot();
    shot.settings.objectTest = motion_blur::ObjectTest::Luminance;
    return shot;
}

Shot exposedFor(double exposureSeconds, double seconds = 0.0) {
    Shot shot = makeLitShot();
    shot.exposureSeconds = exposureSeconds;
    shot.seconds = seconds;
    return shot;
}

const SceneCase kScenes[] = {
    {"through the camera", buildThroughTheCamera, makeShot()},
    {"inside a mover", buildInsideAMover},
    {"sky alone", buildSkyAlone, makeLitShot(), false},
    {"camera rotation", buildCameraRotation, makeLitShot(), false},
    {"millimetres and kilometres", buildMillimetresAndKilometres, makeShot(), false},
    {"no exposure", addWallAndSphere, exposedFor(0.0), false},
    {"long exposure", addWallAndSphere, exposedFor(1000.0), false},
    {"hitch", addWallAndSphere, exposedFor(10.0, 10.0), false},
    {"degenerate triangles", buildDegenerateTriangles},
    {"coplanar triangles", buildCoplanarTriangles},
    {"self-overlap", buildSelfOverlap},
    {"spins", buildSpins, makeShot()},
    {"one luminance", buildOneLuminance, comparedByLuminance()},
    {"thin geometry", buildThinGeometry},
    {"masked leaves", buildMaskedLeaves},
    {"odd scales", buildOddScales},
    {"singular matrices", buildSingularMatrices},
    {"collapsing skins", buildCollapsingSkins},
    {"inside-out morphs", buildInsideOutMorphs},
    {"waves", buildWaves},
};

/// Rays at one instant against raster: the share of pixels that differ by more than two steps of
/// 255 is at most that of pixel centres on an edge, which the two round to either side.
void holdRays(Stage& stage, Shot shot, const std::string& label) {
    shot.exposureSeconds = 0.0;
    shot.instants = 1;
    const image::Image raster = draw(stage, shot, "sharp").color;
    const image::Image rays = draw(stage, shot, "truth", false).color;
    Worst share;
    float brightest = 0.0f;
    for (uint32_t y = 0; y < shot.height; ++y)
        for (uint32_t x = 0; x < shot.width; ++x) {
            double worst = 0.0;
            for (uint32_t c = 0; c < 3; ++c) {
                const double a = raster.at(x, y, c);
                const double b = rays.at(x, y, c);
                worst = std::max(worst, std::abs(a - b) / std::max(1.0, std::abs(a)));
                brightest = std::max(brightest, raster.at(x, y, c));
            }
            share.error += worst > 2.0 / 255.0 ? 1.0 / (shot.width * shot.height) : 0.0;
            ++share.samples;
        }
    hold("rays see what raster draws, share of pixels" + label, share, 0.01);
    EXPECT_GT(brightest, 0.0f) << "the picture is black";
}

TEST_F(HardCases, PicturesOfEachSceneAreFiniteInRangeAndTheSameForRays) {
    for (const SceneCase& one : kScenes) {
        SCOPED_TRACE(one.name);
        SceneBuilder scene = makeEmptyScene();
        one.build(scene);
        if (one.hasWall)
            addWall(scene);
        Stage stage(device(), scene);
        const std::string label = std::string(", ") + one.name;
        holdEveryMethod(device(), stage, one.shot, label);
        if (device().hasRayQuery())
            holdRays(stage, one.shot, label);
    }
}

TEST_F(HardCases, ObjectsPassingTheCameraMoveAwayFromTheVanishingPoint) {
    // Seen at 0.2 m as the shutter opens, 5 m behind the camera at close; its corners have no place
    // in the picture then.
    SceneBuilder scene = makeEmptyScene();
    scene.add(
        makeQuad(0.4, 0.3, scene.addWaves()), {.position = {0, 0, -0.2}, .velocity = {0, 0, 5.2}}
    );
    Stage stage(device(), scene);
    Shot shot = makeShot();
    holdEveryMethod(device(), stage, shot);
    shot.phase = scene::ShutterPhase::Start;
    const image::Image motion = draw(stage, shot, "sharp").intermediates.at("motion");
    Worst inwards;
    for (uint32_t y = 0; y < shot.height; ++y)
        for (uint32_t x = 0; x < shot.width; ++x) {
            const math::dvec2 outwards(x + 0.5 - shot.width / 2.0, y + 0.5 - shot.height / 2.0);
            const math::dvec2 moved(motion.at(x, y, 0), motion.at(x, y, 1));
            const double share =
                glm::dot(moved, outwards) / (glm::length(moved) * glm::length(outwards));
            inwards.add(glm::length(moved) < 1.0 || share < 0.999 ? 1.0 : 0.0);
        }
    hold("every motion is a pixel or more and goes outwards", inwards);
}

TEST_F(HardCases, PicturesFarFromTheOriginEqualThoseAtTheOrigin) {
    SceneBuilder near = makeEmptyScene();
    addWallAndSphere(near);
    Stage nearStage(device(), near);
    const auto expected = draw(nearStage, makeLitShot(), "hybrid");
    for (const double metres : {1e4, 1e6}) {
        SceneBuilder far = makeEmptyScene();
        addWallAndSphere(far);
        far.moveAll(dvec3(metres, -0.6 * metres, 0.8 * metres));
        Stage stage(device(), far);
        const std::string label = fmt::format(", {} m", metres);
        holdEveryMethod(device(), stage, makeLitShot(), label);
        const auto frame = draw(stage, makeLitShot(), "hybrid");
        for (const auto& [view, bound] : {std::pair{"mesh_id", 0.0}, {"motion", 1e-3}}) {
            Worst difference;
            difference.addDifference(frame.intermediates.at(view), expected.intermediates.at(view));
            hold(std::string("the same ") + view + label, difference, bound);
        }
        Worst color;
        color.addDifference(frame.color, expected.color);
        hold("the same blurred colour" + label, color, 1.0 / 255.0, "brightness");
    }
}

TEST_F(HardCases, SixteenSurfacesOnARayAreFollowedUpToTheRecursionLimit) {
    // Eight closed shells of one entity inside one another.
    SceneBuilder scene = makeEmptyScene();
    addWall(scene);
    scene::Material both;
    both.doubleSided = both.unlit = true;
    both.baseColorFactor = math::vec4(0.9f, 0.2f, 0.1f, 1.0f);
    const auto material = scene.addMaterial(both);
    std::vector<scene::Primitive> shells;
    for (int i = 0; i < 8; ++i)
        shells.push_back(makeSphere(0.7 - 0.08 * i, material));
    scene.add(scene.addMesh(std::move(shells)), kMover);
    Stage stage(device(), scene);
    Shot shot = makeLitShot();
    shot.settings.revealTraversal =
        motion_blur::RevealTraversal::Stepping; // the other has no limit
    holdEveryMethod(device(), stage, shot);
    // The mover's own shells are all that its silhouette's rays meet.
    const auto counters = draw(stage, shot, "hybrid", false).statistics.counters;
    Worst rays;
    rays.add(double(counters.at("rays traced")) / double(counters.at("pixels masked")));
    hold("rays per masked pixel", rays, double(shot.settings.recursionLimit - 1));
}

TEST_F(HardCases, HighlightsBeyondHalfFloatsAreBrightAndStorable) {
    // Lamps of 1e5, 2e5 and the largest float, and a sun of a million lux.
    SceneBuilder scene = makeEmptyScene();
    addWall(scene);
    const auto addLamp = [&](const math::vec3& emissive) {
        scene::Material lamp;
        lamp.emissive = emissive;
        return scene.addMaterial(lamp);
    };
    scene.add(makeSphere(0.4, addLamp({1e5f, 2e5f, 1.0f})), kMover);
    scene.add(
        makeSphere(0.1, addLamp({1e30f, std::numeric_limits<float>::max(), 0.0f})),
        {.position = {-0.5, 0.3, -1.5}, .velocity = {0.1, 0.3, 0}}
    );
    scene.add(
        makeSphere(0.3, scene.addLitWaves()),
        {.position = {0.6, -0.3, -2}, .velocity = {-0.2, 0.3, 0}}
    );
    scene.addSun(dvec3(0, 0, -1), 1e6f);
    Stage stage(device(), scene);
    Worst brightest;
    const auto judge = [&](std::string_view method, const Shot&, const auto& frame) {
        const auto& pixels = frame.color.pixels;
        const float own = *std::max_element(pixels.begin(), pixels.end());
        EXPECT_GT(own, 1000.0f) << method;
        brightest.add(own, method);
    };
    holdEveryMethod(device(), stage, makeLitShot(), "", Phases::InTurn, judge);
    hold("brightest value", brightest, 65000.0);
}

TEST_F(HardCases, PicturesOfOnePixelAndOfOneRowAreFiniteAndInRange) {
    SceneBuilder scene = makeEmptyScene();
    addWallAndSphere(scene);
    Stage stage(device(), scene);
    for (const auto& [width, height] :
         {std::pair{1u, 1u}, {40u, 40u}, {41u, 39u}, {1u, 50u}, {81u, 1u}}) {
        Shot shot = makeLitShot();
        shot.background = math::vec3(0.0f); // outside of the wall
        shot.width = width;
        shot.height = height;
        shot.exposureSeconds = 0.1;
        holdEveryMethod(device(), stage, shot, fmt::format(", {}x{}", width, height));
    }
}

TEST_F(HardCases, PicturesOfOddSizesAndOfMoreBlocksThanARowOfGroupsTakesAreDrawnEverywhere) {
    SceneBuilder scene = makeEmptyScene();
    addWallAndSphere(scene);
    Stage stage(device(), scene);
    const auto expectDrawn = [&](uint32_t width, uint32_t height, std::string_view method) {
        Shot shot = makeLitShot(); // no pixel of the wall is black
        shot.width = width;
        shot.height = height;
        shot.exposureSeconds = 0.1;
        const image::Image picture = draw(stage, shot, method, false).color;
        size_t undrawn = 0;
        for (size_t i = 0; i < picture.pixels.size(); i += 4)
            undrawn += !(picture.pixels[i] > 0.0f);
        EXPECT_EQ(picture.pixels.size(), size_t{4} * width * height) << method;
        EXPECT_EQ(undrawn, 0u) << method;
        EXPECT_TRUE(test::allFinite(picture)) << method;
    };
    // No side is a multiple of a tile or of a group of threads. Own velocity has no tiles, and
    // hybrid has all that gather has.
    for (const char* method : {"guertin2014", "hybrid"})
        expectDrawn(1366, 768, method);
    // 66,690 blocks of 8x8 pixels: a dispatch takes 65,535 along one axis.
    expectDrawn(4099, 1033, "gather");
    if (!test::drawsAll())
        return;
    for (const char* method : {"own_velocity", "gather"})
        expectDrawn(1366, 768, method);
    expectDrawn(7680, 4320, "gather");
}

TEST_F(HardCases, EntitiesBeyondTheTablesLimitAreRefusedAndThoseUpToItAreNot) {
    constexpr uint32_t kLimit = 7; // what a test can fill
    for (const uint32_t count : {kLimit, kLimit + 1}) {
        SceneBuilder scene = makeEmptyScene();
        const auto box = makeBox({0.1, 0.1, 0.1}, scene.addWaves());
        for (uint32_t i = 0; i < count; ++i)
            // Every other one is out of the picture: the table holds it, rays may meet it.
            scene.add(
                box, {.position = {i % 2 == 0 ? 0.0 : 90.0, 0, -2}, .velocity = {0.2 * i, 0, 0}}
            );
        render::Renderer renderer(device(), scene.world.assets);
        render::FrameRequest request;
        request.view.camera = scene.camera;
        request.view.width = request.view.height = 8;
        request.view.entityLimit = kLimit;
        const auto frame = renderer.renderFrame(scene.world, request, {});
        EXPECT_EQ(frame.ok(), count <= kLimit) << count;
        if (!frame) {
            EXPECT_NE(frame.error().message.find("more than 7 entities"), std::string::npos);
        }
    }
}

} // namespace
} // namespace shutter::stability
