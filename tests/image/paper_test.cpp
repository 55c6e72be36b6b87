// SPDX-License-Identifier: MIT
// The paper's claim: gather beats the sharp picture, and rays beat gather, against brute force.
// The paper's settings throughout, as displayed (the paper compares pictures, not radiance).
#include "engine/image/metrics.h"
#include "tests/image/shutter_command.h"
#include "tests/support/gpu_fixture.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace shutter {
namespace {

class Paper : public test::GpuTest {};

/// The gather has no preset of its own: the paper's hybrid without its rays.
const std::vector<std::string> kPaperGather = {
    "--method",
    "gather",
    "--set",
    "tileSizePx=40",
    "--set",
    "softDepthExtent=0.03",
    "--set",
    "softDepthShare=0",
    "--set",
    "foregroundMagnification=30"};

/// One test per scene: the truth costs most of the time and is drawn once.
void expectThePapersOrder(
    const std::string& name,
    const std::filesystem::path& scene,
    const std::vector<std::string>& arguments
) {
    const auto draw = [&](const std::string& method, const std::vector<std::string>& chosen) {
        std::vector<std::string> all = arguments;
        all.insert(all.end(), {"--size", "640x360"});
        all.insert(all.end(), chosen.begin(), chosen.end());
        return test::renderWithShutter(
            fmt::format("paper_{}_{}", name, method), ".png", scene, all
        );
    };
    const image::Image truth = draw("accumulate", {"--method", "accumulate", "--samples", "256"});
    ASSERT_EQ(truth.width, 640u);
    const auto judge = [&](const std::string& method, const std::vector<std::string>& chosen) {
        const image::Image picture = draw(method, chosen);
        const double psnr = picture.width == truth.width ? image::computePsnr(picture, truth) : 0.0;
        fmt::print("{} {}: {:.2f} dB\n", name, method, psnr);
        ::testing::Test::RecordProperty(method, fmt::format("{:.3f}", psnr));
        return psnr;
    };
    const double sharp = judge("sharp", {"--preset", "off"});
    const double gather = judge("gather", kPaperGather);
    const double hybrid = judge("hybrid", {"--preset", "paper"});
    EXPECT_GT(gather, sharp);
    EXPECT_GE(hybrid - gather, 1.0) << "rays are worth a decibel";
    EXPECT_GT(judge("hybrid, defaults", {"--method", "hybrid"}), hybrid + 2.0)
        << "the defaults serve users";
}

TEST_F(Paper, RaysBeatGatherBeatsSharpOnTheVase) {
    const auto scene = test::buildFolder() / "assets" / "vase.glb";
    ASSERT_TRUE(std::filesystem::exists(scene)) << "the target shutter_assets makes it";
    expectThePapersOrder("vase", scene, {});
}

TEST_F(Paper, RaysBeatGatherBeatsSharpInThePinkRoom) {
    const auto scene =
        test::sharedFolder() / "scenes" / "pink-room" / "pink_room_lite_animated.glb";
    if (!std::filesystem::exists(scene))
        GTEST_SKIP() << "the Pink Room is not beside the project";
    expectThePapersOrder(
        "pink_room", scene, {"--clip", "vase_slide_fast_linear", "--time", "0.12"}
    );
}

} // namespace
} // namespace shutter
