// SPDX-License-Identifier: MIT
// What the scenes that the game makes for itself say about their motion, measured in the picture.
#include "assets/generator/hard_cases.h"
#include "assets/generator/scaling_scenes.h"
#include "engine/io/image_file.h"
#include "tests/image/shutter_command.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

namespace shutter {

namespace generator {

/// Without it the test's name would hold the bytes of a pointer.
void PrintTo(const BenchCase& hardCase, std::ostream* stream) {
    *stream << hardCase.name;
}

} // namespace generator

namespace {

namespace fs = std::filesystem;
using generator::BenchCase;

struct Drawn {
    image::Image picture;
    image::Image motion; ///< x, y in pixels
};

/// Writes the scene, draws it, and reads the picture and its motion back.
Drawn draw(
    const std::string& name,
    const generator::GltfWriter& writer,
    const std::vector<std::string>& arguments
) {
    const fs::path folder = test::buildFolder() / "test_pictures";
    fs::create_directories(folder);
    const fs::path scene = folder / (name + ".glb");
    const std::string problem = writer.write(scene);
    EXPECT_EQ(problem, "");
    std::vector<std::string> all = arguments;
    all.insert(all.end(), {"--aov", "motion"});
    Drawn drawn;
    drawn.picture = test::renderWithShutter(name, ".exr", scene, all);
    fs::remove(scene);
    auto motion = io::readImage(folder / (name + ".motion.exr"));
    if (!motion) {
        ADD_FAILURE() << motion.error().message;
        return drawn;
    }
    drawn.motion = std::move(motion).value();
    return drawn;
}

double lengthAt(const image::Image& motion, uint32_t x, uint32_t y) {
    return std::hypot(double(motion.at(x, y, 0)), double(motion.at(x, y, 1)));
}

class HardCasePicture : public test::GpuTest, public testing::WithParamInterface<BenchCase> {};

TEST_P(HardCasePicture, RendersAndItsLongestMotionIsWhatItsDescriptionStates) {
    const BenchCase& hardCase = GetParam();
    constexpr uint32_t kWidth = 320;
    const double scale = kWidth / generator::kCaseSizePx.x;
    const glm::vec3 sky = hardCase.background;
    const Drawn drawn = draw(
        fmt::format("hard_{}", hardCase.name),
        hardCase.build(),
        {"--camera",
         hardCase.camera,
         "--time",
         fmt::format("{}", hardCase.timeSeconds),
         "--exposure",
         fmt::format("{}", hardCase.exposureSeconds),
         "--phase",
         hardCase.phase,
         "--background",
         fmt::format("{},{},{}", sky.x, sky.y, sky.z),
         "--method",
         "hybrid",
         "--size",
         "320x180"}
    );
    ASSERT_EQ(drawn.motion.width, kWidth);
    EXPECT_TRUE(test::allFinite(drawn.picture));
    double peak = 0.0;
    double brightness = 0.0;
    size_t moving = 0;
    for (uint32_t y = 0; y < drawn.motion.height; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const double length = lengthAt(drawn.motion, x, y) / scale;
            peak = std::max(peak, length);
            moving += length > 0.5;
            brightness += drawn.picture.at(x, y, 1);
        }
    const double pixels = double(kWidth) * drawn.motion.height;
    RecordProperty("peakPx", fmt::format("{:.2f}", peak));
    EXPECT_GE(peak, hardCase.peakMotionPx.x);
    EXPECT_LE(peak, hardCase.peakMotionPx.y);
    EXPECT_GT(double(moving) / pixels, 0.01) << "a mover that one can see";
    EXPECT_GT(brightness / pixels, 0.1) << "a picture that one can see";
}

INSTANTIATE_TEST_SUITE_P(
    Generated,
    HardCasePicture,
    testing::ValuesIn(generator::listHardCases().begin(), generator::listHardCases().end()),
    [](const auto& test) { return std::string(test.param.name); }
);

class ScalingPicture : public test::GpuTest {};

TEST_F(ScalingPicture, TheMovingShareIsTheOneAskedForWithin2Percent) {
    for (const float share : {0.0f, 0.05f, 0.25f, 0.5f, 0.8f, 1.0f, 7.0f}) {
        const Drawn drawn = draw(
            "moving_share",
            generator::buildMovingShareScene(share),
            {"--method",
             "sharp",
             "--size",
             "640x360",
             "--camera",
             generator::kScalingCamera,
             "--exposure",
             fmt::format("{}", generator::kScalingExposureSeconds)}
        );
        ASSERT_EQ(drawn.motion.width, 640u);
        size_t moving = 0;
        for (uint32_t y = 0; y < drawn.motion.height; ++y)
            for (uint32_t x = 0; x < drawn.motion.width; ++x)
                moving += lengthAt(drawn.motion, x, y) > 0.5;
        const double measured = double(moving) / (640.0 * 360.0);
        EXPECT_NEAR(measured, std::min(share, 1.0f), 0.02);
    }
}

TEST_F(ScalingPicture, EntitiesHideTheSameShareHoweverManyTheyAre) {
    std::vector<double> shares;
    for (const int count : {1, 100, 10'000}) {
        const Drawn drawn = draw(
            "entities",
            generator::buildEntitiesScene(count),
            {"--method", "sharp", "--size", "640x360"}
        );
        ASSERT_EQ(drawn.motion.width, 640u);
        size_t moving = 0;
        double peak = 0.0;
        for (uint32_t y = 0; y < drawn.motion.height; ++y)
            for (uint32_t x = 0; x < drawn.motion.width; ++x) {
                const double length = lengthAt(drawn.motion, x, y);
                moving += length > 0.5;
                peak = std::max(peak, length);
            }
        shares.push_back(double(moving) / (640.0 * 360.0));
        EXPECT_GT(peak, 5.0) << count;
        EXPECT_LT(peak, 13.0) << count;
    }
    EXPECT_NEAR(shares[1], shares[0], 0.05);
    EXPECT_NEAR(shares[2], shares[0], 0.05);
}

} // namespace
} // namespace shutter
