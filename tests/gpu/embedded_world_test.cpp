// SPDX-License-Identifier: MIT
// What `resolved` does not need of a host: vectors where movers have matrices, ids where nothing
// moves by itself, the frame before at a cut.
#include "engine/image/metrics.h"
#include "tests/gpu/checker_changes.h"
#include "tests/gpu/checker_host.h"
#include "tests/support/picture.h"

#include <functional>
#include <memory>
#include <string>

namespace shutter {
namespace {

using motion_blur::EmbeddedMotionBlur;
using test::GivenFrame;

class EmbeddedWorld : public test::CheckerHost {
  protected:
    using Change = std::function<void(GivenFrame&, int frame)>;

    static void
    doNothing(GivenFrame&, int, const test::CheckedDrawing&, const test::CheckedDrawing&) {}

    /// The last of three frames by `resolved`.
    image::Image draw(const Change& change) {
        const test::CheckCase plain{"", "", doNothing};
        const auto blur = create(describeHost());
        const test::Picture output(device(), "output", {test::kCheckedWidth, test::kCheckedHeight});
        for (int frame = 0; frame < 3; ++frame) {
            GivenFrame given = give(frame, plain);
            given.isResolved = true;
            test::giveMatrices(given);
            std::erase_if(given.listed, [](const auto& mover) {
                return mover.worldFromObject.empty();
            });
            given.inputs.output = {output.handle(), test::kNothing, test::kCopied};
            change(given, frame);
            given.inputs.convention.cameras = given.cameras;
            record(*blur, uint32_t(frame % 2), given, &output);
        }
        return output.read();
    }

    image::Image drawSharp() {
        return draw([](GivenFrame& given, int) {
            given.keys = {given.keys.back()};
            given.listed.clear();
            given.inputs.motion.followsLast = false;
        });
    }
};

TEST_P(EmbeddedWorld, RigidMoversNeedNoVectors) {
    const image::Image with = draw([](GivenFrame&, int) {});
    const image::Image without = draw([](GivenFrame& given, int) { given.hasVectors = false; });
    EXPECT_GT(image::computePsnr(without, with), 60.0);
    EXPECT_LT(image::computePsnr(with, drawSharp()), 45.0) << "nothing was blurred";
    const image::Image still = draw([](GivenFrame& given, int) {
        given.hasVectors = false;
        given.listed.clear();
    });
    EXPECT_LT(image::computePsnr(still, with), 50.0) << "no mover was blurred";
}

TEST_P(EmbeddedWorld, AStillWorldNeedsNoIds) {
    const auto listNothing = [](GivenFrame& given, int) {
        given.listed.clear();
        given.hasVectors = false;
    };
    const image::Image one = draw([&](GivenFrame& given, int frame) {
        listNothing(given, frame);
        for (size_t i = 0; i < test::kCheckedPixels; ++i)
            given.ids[i] = given.metres[i] >= shader::kSkyDepth ? 0xFFFFFFFFu : 0u;
        given.rowCount = 1;
    });
    const image::Image none = draw([&](GivenFrame& given, int frame) {
        listNothing(given, frame);
        given.hasIds = false;
        given.rowCount = 0; // does not count
    });
    EXPECT_TRUE(test::sameBits(none, one));
    EXPECT_LT(image::computePsnr(one, drawSharp()), 45.0) << "nothing was blurred";
}

TEST_P(EmbeddedWorld, AtACutTheRastersKeyAloneCounts) {
    const image::Image cut = draw([](GivenFrame& given, int frame) {
        given.hasVectors = false;
        if (frame < 2)
            return;
        given.inputs.convention.scales.isCut = true;
        given.cameras.viewFromWorldBefore = given.cameras.clipFromViewBefore = math::dmat4(0.0);
        given.keys.front().viewFromWorld = math::dmat4(0.0);
        given.keys.front().clipFromView = math::dmat4(0.0);
        for (std::vector<math::dmat4>& matrices : given.matrices)
            matrices.front() = math::dmat4(0.0);
    });
    EXPECT_TRUE(test::sameBits(cut, drawSharp()));
}

std::vector<test::CheckScene> listScenes() {
    std::vector<test::CheckScene> scenes = test::listCheckScenes();
    scenes.resize(3); // generated ones
    return scenes;
}

INSTANTIATE_TEST_SUITE_P(
    Scenes,
    EmbeddedWorld,
    testing::ValuesIn(listScenes()),
    [](const auto& scene) { return scene.param.name; }
);

} // namespace
} // namespace shutter
