// SPDX-License-Identifier: MIT
// A host's lens: its pictures equal the plugin's by either interface, a closed one changes nothing,
// and the samples that a host answers have places of it.
#include "engine/image/metrics.h"
#include "engine/scene/lens.h"
#include "tests/gpu/gbuffer_host.h"

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace shutter {
namespace {

using motion_blur::HostInputs;
using motion_blur::HostLens;
using test::BlurStage;
using test::MotionDescriber;
using test::settingsOf;
using test::StagedFrame;

constexpr uint32_t kLensInstants = 7;
constexpr double kDoubleNan = std::numeric_limits<double>::quiet_NaN();
/// Six blades, wider than high; what is 5 m away is in focus.
constexpr scene::CameraLens kLens{
    .fStop = 0.05,
    .focusDistance = 5.0,
    .blades = 6,
    .bladeRotation = 0.4,
    .roundness = 0.3,
    .squeeze = 1.5};

HostLens describeLens(const scene::World& world, ecs::Entity camera) {
    const auto& lens = world.registry.get<scene::CameraLens>(camera);
    HostLens made;
    made.radius = scene::computeLensRadius(lens, world.registry.get<scene::Camera>(camera).yFov);
    made.focusDistance = lens.focusDistance;
    made.bladeRotation = lens.bladeRotation;
    made.roundness = lens.roundness;
    made.squeeze = lens.squeeze;
    made.blades = lens.blades;
    return made;
}

class EmbeddedLens : public test::StagedTest {
  protected:
    [[nodiscard]] motion_blur::HostDevice hostOfSuite() const override {
        motion_blur::HostDevice host = describeHost();
        host.measures = true;
        return host;
    }

    /// A wall behind what is in focus, and a square and a box before it.
    static void build(test::SceneBuilder& scene, bool moves) {
        const double speed = moves ? 1.0 : 0.0;
        scene.setPerspective(1.0);
        scene.world.registry.add(scene.camera, kLens);
        if (moves)
            scene.moveCamera({.velocity = {0.4, 0.1, -0.6}, .angularVelocity = {0.1, 0.5, 0.2}});
        const auto waves = scene.addTextured(scene.addWaveTexture(), true);
        scene.add(test::makeQuad(24.0, 16.0, waves), {.position = {0.0, 0.0, -10.0}});
        scene.add(
            test::makeQuad(0.8, 0.8, waves),
            {.position = {0.2, 0.1, -2.0}, .velocity = {2.0 * speed, 0.4 * speed, 0.0}}
        );
        scene.add(
            test::makeBox(math::dvec3(0.8), waves),
            {.position = {-1.2, -0.4, -5.0}, .angularVelocity = {speed, 2.0 * speed, 3.0 * speed}}
        );
    }

    void start(bool moves) {
        build(mScene, moves);
        const auto settings = settingsOf("resolved", kLensInstants);
        mStage.emplace(device(), mScene, *mBlur, blurOfC(), settings, settings);
        mStage->declareMotion(mDescriber);
        mStage->request.view.usesLens = true;
        mStage->shutter.exposureSeconds = moves ? 0.25 : 0.0;
        mStage->frameSeconds = 0.25;
        mStage->shutter.phase = scene::ShutterPhase::End;
        mStage->host.changeInputs = [this](const render::PictureContext&, HostInputs& inputs) {
            inputs.motion.lens = describeLens(mScene.world, mScene.camera);
            if (mChange)
                mChange(inputs);
        };
    }

    void TearDown() override {
        mStage.reset();
        StagedTest::TearDown();
    }

    StagedFrame draw(int frame) {
        mStage->seconds = frame * mStage->frameSeconds;
        return mStage->draw();
    }

    test::SceneBuilder mScene;
    MotionDescriber mDescriber{kLensInstants};
    std::function<void(HostInputs&)> mChange;
    std::optional<BlurStage> mStage;
};

TEST_F(EmbeddedLens, ALensAndMotionGiveTheBitsOfThePluginInEachFrame) {
    start(true);
    (void)draw(0); // the plugin draws the raster of the frame before, the host has none
    mDescriber.followsLast = true;
    for (const int frame : {1, 2}) {
        const StagedFrame drawn = draw(frame);
        EXPECT_GT(drawn.result.statistics.counters.at("samples from the last frame"), 0u);
        expectSame(drawn);
    }
    const StagedFrame open = draw(3);
    mChange = [](HostInputs& inputs) { inputs.motion.lens = {}; };
    EXPECT_LT(image::computePsnr(draw(3).output, open.output), 40.0) << "the lens is seen";
}

TEST_F(EmbeddedLens, TheLensAloneOfAStaticWorldGivesTheBitsOfThePlugin) {
    start(false);
    const image::Image sharp = mStage->drawSharp().color;
    mDescriber.followsLast = true;
    for (const bool hasIds : {true, false}) {
        mChange = [hasIds](HostInputs& inputs) {
            inputs.motion.keys = inputs.motion.keys.last(1);
            inputs.motion.movers = {};
            if (!hasIds)
                inputs.motion.rowIds = {};
        };
        mStage->host.dropsIds = !hasIds;
        for (const int frame : {0, 1}) { // the second one has another before it
            const StagedFrame drawn = draw(frame);
            EXPECT_LT(image::computePsnr(drawn.output, sharp), 35.0) << "nothing is out of focus";
            if (hasIds)
                expectSame(drawn);
            else // edges within one id are interpolated across
                EXPECT_GT(image::computePsnr(drawn.output, drawn.result.color), 30.0);
        }
    }
}

TEST_F(EmbeddedLens, AClosedLensChangesNeitherBitsNorPasses) {
    start(true);
    const auto drawWith = [&](const HostLens& lens) {
        mChange = [lens](HostInputs& inputs) { inputs.motion.lens = lens; };
        const StagedFrame drawn = draw(1);
        EXPECT_TRUE(test::sameBits(drawn.byC, drawn.output));
        const auto report = mStage->blur->report(0);
        EXPECT_TRUE(report.ok()) << report.error().message;
        std::string passes;
        for (const gpu::PassTime& pass : report.value().passes)
            passes += pass.name + ", ";
        return std::pair(drawn.output, passes);
    };
    const auto [none, passesOfNone] = drawWith({});
    HostLens closed{
        .radius = 0.0, .focusDistance = kDoubleNan, .squeeze = kDoubleNan, .blades = 77};
    const auto [pinhole, passes] = drawWith(closed);
    EXPECT_TRUE(test::sameBits(pinhole, none));
    EXPECT_EQ(passes, passesOfNone);
    closed = {.radius = 0.1};
    EXPECT_NE(drawWith(closed).second, passesOfNone);
    EXPECT_NE(drawWith(closed).second.find("filter lens"), std::string::npos);
    EXPECT_EQ(passesOfNone.find("lens"), std::string::npos);
}

/// The filter behind the search marks its radii by negative alphas.
TEST_F(EmbeddedLens, AnyAlphaOfTheHostsColourGivesTheSamePicture) {
    constexpr VkExtent2D kSize{48, 32};
    const auto drawWith = [&](float alpha) {
        std::vector<uint64_t> colors;
        std::vector<glm::vec4> motions; // half is in focus, half far behind it
        for (uint32_t i = 0; i < kSize.width * kSize.height; ++i) {
            const uint32_t x = i % kSize.width;
            const float value = (i * 7 + i / kSize.width * 3) % 11 < 5 ? 0.2f : 0.9f;
            colors.push_back(test::packHalf({value, 0.5f * value, 0.3f, alpha}));
            motions.emplace_back(0.0f, 0.0f, x < kSize.width / 2 ? 5.0f : 50.0f, 0.0f);
        }
        mTexels.clear();
        HostInputs in;
        in.width = kSize.width;
        in.height = kSize.height;
        in.color = makeTexels(VK_FORMAT_R16G16B16A16_SFLOAT, kSize, colors).describe();
        in.motionDepth = makeTexels(VK_FORMAT_R32G32B32A32_SFLOAT, kSize, motions).describe();
        const motion_blur::HostCameraKey key{
            1.0, glm::dmat4(1.0), math::clipFromViewPerspective(1.0, 1.5, 0.1)};
        in.motion.keys = {&key, 1};
        in.motion.lens = {.radius = 0.5, .focusDistance = 5.0};
        image::Image picture = EmbeddedTest::draw(in, settingsOf("resolved", kLensInstants));
        for (size_t i = 3; i < picture.pixels.size(); i += 4)
            picture.pixels[i] = 1.0f;
        return picture;
    };
    const image::Image opaque = drawWith(1.0f);
    for (const float alpha : {0.0f, -1.0f, -1.5f, -60000.0f, float(kDoubleNan)})
        EXPECT_TRUE(test::sameBits(drawWith(alpha), opaque)) << alpha;
}

TEST_F(EmbeddedLens, LensesAtTheEndsOfTheirRangeGiveFinitePictures) {
    start(true);
    for (const double radius : {1e-300, 1e-9, 1000.0})
        for (const double focus : {1e-4, 1e9}) {
            const std::vector<double> focuses(kLensInstants + 1, focus);
            mChange = [&](HostInputs& inputs) {
                inputs.motion.lens = {.radius = radius, .focusDistances = focuses};
            };
            const StagedFrame drawn = draw(1);
            EXPECT_TRUE(test::allFinite(drawn.output)) << radius << " " << focus;
            EXPECT_TRUE(test::sameBits(drawn.byC, drawn.output));
        }
}

} // namespace
} // namespace shutter
