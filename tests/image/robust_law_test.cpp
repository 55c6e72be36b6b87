// SPDX-License-Identifier: MIT
// Nothing that a scene can hold makes a value that is not finite, and a picture is the same twice.
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <set>
#include <string>

namespace shutter {
namespace {

using math::dvec3;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

class RobustLaw : public test::GpuTest {};

const std::set<std::string> kAllAovs = {
    "motion", "depth", "normal", "mesh_id", "tiles", "variance", "edge", "mask", "reveal"};

/// Draws by every method, in every phase, with every intermediate, and looks at every value.
void expectFinite(gpu::Device& device, const SceneBuilder& scene, Shot shot = {}) {
    Stage stage(device, scene);
    shot.aovs = kAllAovs;
    shot.wantDisplay = true;
    shot.instants = 3;
    shot.ambient = math::vec3(0.3f);
    for (std::string_view method : test::listRasterMethods(device))
        for (auto phase :
             {scene::ShutterPhase::Start, scene::ShutterPhase::Centre, scene::ShutterPhase::End}) {
            shot.method = method;
            shot.phase = phase;
            const auto result = stage.render(shot);
            const std::string label = std::string(method) + std::to_string(int(phase));
            EXPECT_EQ(result.color.width, shot.width) << label;
            EXPECT_EQ(result.color.height, shot.height) << label;
            EXPECT_TRUE(test::allFinite(result.color)) << label;
            EXPECT_TRUE(test::allFinite(result.display)) << label;
            for (const auto& [name, picture] : result.intermediates)
                EXPECT_TRUE(test::allFinite(picture)) << label << " " << name;
            if (method == "sharp")
                break; // it has no phase
        }
}

/// A textured wall, a lit sphere that moves by `velocity` over the exposure of 1 s.
SceneBuilder makeScene(const dvec3& velocity) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene::Material lit;
    lit.baseColor.texture = scene.addWaveTexture();
    const auto material = scene.addMaterial(lit);
    scene.add(test::makeQuad(6, 5, material), {.position = {0, 0, -5}});
    scene.add(test::makeSphere(0.5, material), {.position = {0.1, 0, -2.5}, .velocity = velocity});
    scene.addSun(glm::normalize(dvec3(-0.4, -0.7, -0.6)), 3.0f);
    return scene;
}

TEST_F(RobustLaw, MotionFarBeyondTheScreenStaysFinite) {
    expectFinite(device(), makeScene({5000.0, -3000.0, 0.0}));
    expectFinite(device(), makeScene({1e12, 0.0, 1e12}));
}

TEST_F(RobustLaw, MotionBelowHalfAPixelStaysFinite) {
    expectFinite(device(), makeScene({0.003, 0.0, 0.0}));
    expectFinite(device(), makeScene({1e-12, 0.0, 0.0}));
}

TEST_F(RobustLaw, OddPictureSizesStayFinite) {
    const SceneBuilder scene = makeScene({0.5, 0.2, 0.0});
    for (const auto& [width, height] : {std::pair{1u, 1u}, {40u, 40u}, {41u, 39u}, {1u, 50u}})
        expectFinite(device(), scene, {.width = width, .height = height});
}

TEST_F(RobustLaw, AHighlightOfAHundredThousandStaysFiniteAndStorable) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene::Material lamp;
    lamp.emissive = math::vec3(1e5f, 2e5f, 1.0f);
    scene.add(
        test::makeSphere(0.4, scene.addMaterial(lamp)),
        {.position = {0, 0, -2}, .velocity = {0.6, 0, 0}}
    );
    scene.addSun(dvec3(0, 0, -1), 1e6f);
    expectFinite(device(), scene);
    for (std::string_view method : test::listRasterMethods(device())) {
        const auto result = test::renderOnce(device(), scene, {.method = method});
        float brightest = 0.0f;
        for (float value : result.color.pixels)
            brightest = std::max(brightest, value);
        EXPECT_GT(brightest, 1000.0f) << method;
        EXPECT_LE(brightest, 65000.0f) << method;
    }
}

TEST_F(RobustLaw, ACameraInsideAMovingObjectStaysFinite) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene::Material inside;
    inside.doubleSided = true;
    inside.baseColor.texture = scene.addWaveTexture();
    const auto material = scene.addMaterial(inside);
    scene.add(
        test::makeBox({1, 1, 1}, material),
        {.velocity = {0.2, 0.1, 0.3}, .angularVelocity = {0.3, 1.0, 0.2}}
    );
    scene.add(test::makeQuad(6, 5, material), {.position = {0, 0, -5}});
    expectFinite(device(), scene);
}

TEST_F(RobustLaw, AnObjectThroughTheCameraStaysFinite) {
    const SceneBuilder scene = makeScene({0.0, 0.0, 5.0});
    expectFinite(device(), scene);
}

TEST_F(RobustLaw, AnEmptySceneIsItsBackground) {
    SceneBuilder scene;
    scene.moveCamera({.angularVelocity = {0, 0.5, 0}}); // the sky moves: the effect runs
    expectFinite(device(), scene);
    for (std::string_view method : test::listRasterMethods(device())) {
        const auto result =
            test::renderOnce(device(), scene, {.method = method, .background = math::vec3(0.5f)});
        for (uint32_t y = 0; y < 64; ++y)
            for (uint32_t x = 0; x < 96; ++x)
                // Sums of halves divided: single precision, then two conversions to half floats.
                ASSERT_NEAR(result.color.at(x, y, 1), 0.5f, 0.5f / 512.0f) << method;
    }
}

TEST_F(RobustLaw, OneTriangleStaysFinite) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    auto triangle = test::makeQuad(1, 1, scene.addColor({1, 1, 1}));
    triangle.indices.resize(3);
    scene.add(triangle, {.position = {0, 0, -2}, .velocity = {0.5, 0, 0}});
    expectFinite(device(), scene);
}

TEST_F(RobustLaw, TrianglesWithoutAreaStayFinite) {
    SceneBuilder scene = makeScene({0.5, 0.2, 0.0});
    auto needle = test::makeQuad(1, 1, scene.addColor({1, 1, 1}));
    for (auto& position : needle.positions)
        position.y = 0.0f;
    scene.add(needle, {.position = {0, 0, -2}, .velocity = {0.5, 0, 0}});
    auto point = test::makeQuad(1, 1, scene.addColor({1, 1, 1}));
    for (auto& position : point.positions)
        position = math::vec3(0.0f);
    scene.add(point, {.position = {0, 0, -2}, .velocity = {0.5, 0, 0}});
    expectFinite(device(), scene);
}

TEST_F(RobustLaw, SingularAndHugeTransformsStayFinite) {
    SceneBuilder scene = makeScene({0.5, 0.2, 0.0});
    const auto white = scene.addColor({1, 1, 1});
    scene.add(
        test::makeBox({1, 1, 1}, white),
        {.position = {0, 0, -3}, .scale = {1, 0, 1}, .velocity = {0.5, 0, 0}}
    );
    scene.add(
        test::makeBox({1, 1, 1}, white),
        {.position = {0, 0, -1e7}, .scale = dvec3(1e6), .velocity = {1e6, 0, 0}}
    );
    expectFinite(device(), scene);
}

TEST_F(RobustLaw, TwoRunsGiveTheSameBits) {
    const SceneBuilder scene = makeScene({0.6, 0.3, 0.2});
    for (std::string_view method : test::listRasterMethods(device())) {
        Shot shot{.method = method, .ambient = math::vec3(0.3f), .aovs = kAllAovs};
        const auto first = test::renderOnce(device(), scene, shot);
        Stage stage(device(), scene);
        // A picture in between must leave nothing behind.
        Shot other = shot;
        other.seconds = 0.7;
        (void)stage.render(other);
        const auto second = stage.render(shot);
        EXPECT_TRUE(test::sameBits(first.color, second.color)) << method;
        ASSERT_EQ(first.intermediates.size(), second.intermediates.size());
        for (const auto& [name, picture] : first.intermediates)
            EXPECT_TRUE(test::sameBits(picture, second.intermediates.at(name)))
                << method << " " << name;
    }
}

} // namespace
} // namespace shutter
