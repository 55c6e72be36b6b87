// SPDX-License-Identifier: MIT
// The denoised method: rays are right on average, the filter takes their noise and leaves what is
// none.
#include "engine/image/metrics.h"
#include "tests/image/shutter_command.h"
#include "tests/support/gpu_fixture.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace shutter {
namespace {

class Denoised : public test::GpuTest {
  protected:
    static image::Image
    draw(const std::string& name, const std::string& method, std::vector<std::string> arguments) {
        const auto scene = test::buildFolder() / "assets" / "vase.glb";
        arguments.insert(arguments.end(), {"--size", "640x360", "--method", method, "--validate"});
        return test::renderWithShutter("denoised_" + name, ".exr", scene, arguments);
    }
};

TEST_F(Denoised, IsNearerToTheTruthThanItsRaysAre) {
    const image::Image truth = draw("truth", "accumulate", {"--samples", "128"});
    ASSERT_EQ(truth.width, 640u);

    struct Gain {
        const char* rays;
        double decibels;
    };

    // Stratified rays need the filter less the more they are.
    for (const Gain& expected : {Gain{"1", 6.0}, Gain{"2", 2.0}, Gain{"4", 1.0}}) {
        const std::string rays = expected.rays;
        const image::Image noisy =
            draw("noisy_" + rays, "denoised", {"--samples", rays, "--set", "filterLevels=0"});
        const image::Image filtered = draw("filtered_" + rays, "denoised", {"--samples", rays});
        EXPECT_GT(
            image::computePsnr(filtered, truth),
            image::computePsnr(noisy, truth) + expected.decibels
        ) << rays
          << " rays";
    }
}

/// Away from the vase every ray of a pixel sees the same: there is nothing to filter.
TEST_F(Denoised, LeavesWhatStandsStillAsTheRaysSawIt) {
    const image::Image rays = draw("rays", "denoised", {"--set", "filterLevels=0"});
    const image::Image filtered = draw("filtered", "denoised", {});
    const image::Image truth = draw("still", "truth", {"--samples", "1"});
    ASSERT_EQ(filtered.width, 640u);
    // The vase and what it passes lie in the middle of the picture.
    for (uint32_t y = 0; y < 360; ++y)
        for (uint32_t x = 0; x < 640; ++x) {
            if (x >= 120 && x < 520)
                continue;
            for (uint32_t c = 0; c < 3; ++c) {
                ASSERT_EQ(filtered.at(x, y, c), rays.at(x, y, c)) << x << " " << y;
                ASSERT_NEAR(filtered.at(x, y, c), truth.at(x, y, c), 2e-3f) << x << " " << y;
            }
        }
}

TEST_F(Denoised, ManyRaysConverge) {
    const image::Image truth = draw("truth128", "accumulate", {"--samples", "128"});
    const image::Image picture = draw("r64", "denoised", {"--samples", "64"});
    ASSERT_EQ(picture.width, truth.width);
    EXPECT_GT(image::computePsnr(picture, truth), 42.0);
}

} // namespace
} // namespace shutter
