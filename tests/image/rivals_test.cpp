// SPDX-License-Identifier: MIT
// Each method of others does what it is for: its picture is nearer to brute force than the sharp
// one.
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

class Rivals : public test::GpuTest {};

TEST_F(Rivals, EachBeatsTheSharpPictureOfTheVaseInEveryPhase) {
    const auto scene = test::buildFolder() / "assets" / "vase.glb";
    ASSERT_TRUE(std::filesystem::exists(scene)) << "the target shutter_assets makes it";
    for (const char* phase : {"start", "centre", "end"}) {
        const auto draw = [&](const std::string& method, std::vector<std::string> arguments) {
            arguments.insert(
                arguments.end(), {"--size", "320x180", "--method", method, "--phase", phase}
            );
            return test::renderWithShutter(
                fmt::format("rivals_{}_{}", phase, method), ".png", scene, arguments
            );
        };
        const image::Image truth = draw("accumulate", {"--samples", "64"});
        ASSERT_EQ(truth.width, 320u);
        const auto judge = [&](const std::string& method) {
            const image::Image picture = draw(method, {});
            const double psnr =
                picture.width == truth.width ? image::computePsnr(picture, truth) : 0.0;
            fmt::print("{} {}: {:.2f} dB\n", phase, method, psnr);
            return psnr;
        };
        const double sharp = judge("sharp");
        for (const char* method :
             {"own_velocity", "mcguire2012", "guertin2014", "jimenez2014", "denoised"})
            EXPECT_GT(judge(method), sharp + 3.0) << method << " " << phase;
    }
}

} // namespace
} // namespace shutter
