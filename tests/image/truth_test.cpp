// SPDX-License-Identifier: MIT
// The two truths, from a scene file to a picture file: rays that each have their own time, and
// sharp frames at many times.
#include "engine/image/metrics.h"
#include "tests/image/shutter_command.h"
#include "tests/support/gpu_fixture.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace shutter {
namespace {

class Truth : public test::GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && !device().hasRayQuery())
            GTEST_SKIP() << device().info().name << " has no ray queries";
    }
};

void expectAgreement(
    const std::string& name, const std::string& scene, const std::vector<std::string>& arguments
) {
    const auto file = test::buildFolder() / "assets" / scene;
    ASSERT_TRUE(std::filesystem::exists(file)) << "the target shutter_assets makes it";
    for (const std::string pixel : {"centre", "box"}) {
        const auto draw = [&](const std::string& method) {
            std::vector<std::string> all = arguments;
            all.insert(
                all.end(),
                {"--size", "160x90", "--method", method, "--samples", "256", "--pixel", pixel}
            );
            return test::renderWithShutter(
                fmt::format("truth_{}_{}_{}", name, pixel, method), ".exr", file, all
            );
        };
        const image::Image rays = draw("truth");
        const image::Image frames = draw("accumulate");
        ASSERT_EQ(rays.width, 160u);
        ASSERT_EQ(frames.width, 160u);
        const double psnr = image::computePsnr(rays, frames);
        fmt::print("{} {}: {:.2f} dB\n", name, pixel, psnr);
        EXPECT_GE(psnr, 45.0) << pixel;
    }
}

TEST_F(Truth, BothTruthsAgreeOnTheVase) {
    expectAgreement("vase", "vase.glb", {});
}

TEST_F(Truth, BothTruthsAgreeOnTheCourtyardUnderAPan) {
    expectAgreement(
        "courtyard",
        "courtyard.glb",
        {"--camera", "pan", "--time", "0.05", "--background", "0.35,0.5,0.75"}
    );
}

nlohmann::json readPicture(const std::filesystem::path& stats) {
    std::ifstream file(stats);
    return nlohmann::json::parse(file).at("pictures").at(0);
}

TEST_F(Truth, ItStopsAtTheErrorThatIsWished) {
    const auto scene = test::buildFolder() / "assets" / "vase.glb";
    const auto stats = test::buildFolder() / "test_pictures" / "truth_stop.json";
    const auto draw = [&](const std::string& error) {
        const auto picture = test::renderWithShutter(
            "truth_stop",
            ".exr",
            scene,
            // Large enough that a batch is fewer rays than --samples.
            {"--method",
             "truth",
             "--samples",
             "64",
             "--size",
             "400x225",
             "--unlit",
             "--error",
             error,
             "--stats",
             stats.string()}
        );
        EXPECT_EQ(picture.width, 400u);
        return readPicture(stats);
    };
    const nlohmann::json early = draw("0.5");
    EXPECT_LT(early.at("counters").at("rays a pixel").get<int>(), 64);
    EXPECT_GE(early.at("counters").at("rays a pixel").get<int>(), 16);
    EXPECT_LE(early.at("measures").at("standard error").get<double>(), 0.5);
    EXPECT_EQ(
        early.at("counters").at("rays traced").get<int>(),
        early.at("counters").at("rays a pixel").get<int>() * 400 * 225
    );
    const nlohmann::json never = draw("0.0000001");
    EXPECT_EQ(never.at("counters").at("rays a pixel").get<int>(), 64);
    EXPECT_GT(never.at("measures").at("standard error").get<double>(), 0.0000001);
}

} // namespace
} // namespace shutter
