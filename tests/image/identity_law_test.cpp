// SPDX-License-Identifier: MIT
// Pictures that motion blur must leave alone: no exposure, no motion, or nothing but one colour.
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cmath>

namespace shutter {
namespace {

using test::SceneBuilder;
using test::Shot;
using test::Stage;

class IdentityLaw : public test::GpuTest {};

/// A lit, textured scene with a mover in front.
SceneBuilder makeScene(const math::dvec3& velocity) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
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
    return std::any_of(
        result.statistics.passes.begin(),
        result.statistics.passes.end(),
        [](const auto& pass) { return pass.owner == render::PassOwner::Blur; }
    );
}

void expectSkipped(const render::FrameResult& result, const std::string& reason) {
    const std::string decision = test::describeMotionBlur(result);
    EXPECT_TRUE(decision.starts_with("skipped: ")) << decision;
    EXPECT_NE(decision.find(reason), std::string::npos) << decision;
    EXPECT_FALSE(hasBlurPass(result));
}

void expectTheSharpPicture(
    gpu::Device& device, const SceneBuilder& scene, Shot shot, const std::string& reason
) {
    Stage stage(device, scene);
    shot.ambient = math::vec3(0.2f);
    const auto expected = stage.render(shot);
    for (std::string_view method : test::listBlurMethods(device)) {
        shot.method = method;
        const auto result = stage.render(shot);
        EXPECT_TRUE(test::sameBits(result.color, expected.color)) << method;
        expectSkipped(result, reason);
    }
}

TEST_F(IdentityLaw, ExposureZeroGivesTheSharpPictureBitForBit) {
    expectTheSharpPicture(
        device(), makeScene({2.0, 0.5, 0.0}), {.exposureSeconds = 0.0}, "exposure is 0"
    );
}

TEST_F(IdentityLaw, WithoutMotionThePictureIsTheSharpOneBitForBit) {
    expectTheSharpPicture(
        device(), makeScene(math::dvec3(0.0)), {}, "nothing in the picture moves"
    );
}

TEST_F(IdentityLaw, AMoverThatIsThereRunsTheEffectAndChangesThePicture) {
    const SceneBuilder scene = makeScene({2.0, 0.5, 0.0});
    Stage stage(device(), scene);
    const Shot sharp{.ambient = math::vec3(0.2f)};
    const auto before = stage.render(sharp);
    for (std::string_view method : test::listBlurMethods(device())) {
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
    SceneBuilder scene;
    scene.setPixelView(64);
    const auto waves = scene.addTextured(scene.addWaveTexture());
    scene.add(test::makeQuad(96, 64, waves), {.position = {0, 0, -20}});
    scene.add(
        test::makeQuad(6, 6, scene.addColor({1, 0, 0})),
        {.position = {-41, 0, -10}, .velocity = {3, 0, 0}}
    );
    Stage stage(device(), scene);
    const auto sharp = stage.render({});
    for (std::string_view method : test::listBlurMethods(device())) {
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

TEST_F(IdentityLaw, OneConstantColourStaysThatColourInEveryMethod) {
    // Not representable as a half float, so that rounding shows.
    const math::vec3 color(0.3f, 0.7f, 0.1f);
    SceneBuilder scene;
    scene.setPerspective(0.9);
    const auto material = scene.addColor(color);
    scene.add(
        test::makeBox({1, 1, 1}, material),
        {.position = {0, 0, -3}, .velocity = {0.7, 0.3, 0.2}, .angularVelocity = {0, 1, 0.5}}
    );
    scene.add(
        test::makeSphere(0.5, material), {.position = {0.5, 0.2, -4}, .velocity = {-0.9, 0.2, 0}}
    );
    Stage stage(device(), scene);
    for (std::string_view method : test::listRasterMethods(device())) {
        const auto result = stage.render({.method = method, .background = color, .aovs = {"mask"}});
        ASSERT_FALSE(result.color.pixels.empty());
        // The G-buffer stores half floats, and so does the blur. Vulkan lets a device round to
        // either neighbour (lavapipe cuts off): a unit in the last place each, which is at most
        // 2^-10 of the value; 2^-9 together. The weighted mean between the two is in single
        // precision: some 34 operations of 2^-24, nothing beside it.
        for (uint32_t y = 0; y < 64; ++y)
            for (uint32_t x = 0; x < 96; ++x)
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(
                        result.color.at(x, y, static_cast<uint32_t>(c)),
                        color[c],
                        color[c] * (1.0f / 512.0f)
                    ) << method
                      << " at " << x << ", " << y;
        if (method == "hybrid") {
            EXPECT_GT(test::countSet(result.intermediates.at("mask")), 50u);
        }
    }
}

} // namespace
} // namespace shutter
