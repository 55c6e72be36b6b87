// SPDX-License-Identifier: MIT
// Our truth against an independent renderer's: rigid cases of ../shared/references.
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "tests/image/shutter_command.h"
#include "tests/support/gpu_fixture.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <string>
#include <vector>

namespace shutter {
namespace {

class References : public test::GpuTest {};

/// dB. The references' own noise lies 58 dB or more below the truth, and 256 instants of ours are
/// quantised like 1/256 at the silhouettes of the moving part; a wrong motion, phase or camera
/// shows far below 40.
constexpr double kLeastPsnr = 40.0;

std::string number(double value) {
    return fmt::format("{:.17g}", value);
}

image::Image readReference(const std::filesystem::path& path) {
    auto read = io::readImage(path);
    if (read)
        return std::move(read).value();
    ADD_FAILURE() << read.error().message;
    return {};
}

/// Renders the case with its JSON's settings and compares.
/// \param suffix of the reference, "" (moving) or ".still"
/// \param method accumulate or truth
void expectReference(
    const std::string& name, const std::string& suffix, const std::string& method = "accumulate"
) {
    const std::filesystem::path folder = test::sharedFolder() / "references";
    if (!std::filesystem::exists(folder / (name + ".json")))
        GTEST_SKIP() << "the references are not beside the project (" << name << ".json)";
    std::ifstream file(folder / (name + ".json"));
    const nlohmann::json settings = nlohmann::json::parse(file);
    const bool still = !suffix.empty();
    const double exposure = still ? 0.0 : settings.at("exposure").get<double>();
    const auto world = settings.at("world").get<std::vector<double>>();
    const auto rendered = test::renderWithShutter(
        fmt::format("reference_{}{}_{}", name, suffix, method),
        ".exr",
        folder / settings.at("scene").get<std::string>(),
        {"--method",
         method,
         "--pixel",
         "box",
         "--samples",
         "256",
         "--unlit",
         "--background",
         fmt::format("{:.17g},{:.17g},{:.17g}", world.at(0), world.at(1), world.at(2)),
         "--camera",
         settings.at("camera").get<std::string>(),
         "--clip",
         settings.at("clip").get<std::string>(),
         "--time",
         number(settings.at("frame_time").get<double>()),
         "--exposure",
         number(exposure),
         "--phase",
         settings.at("phase").get<std::string>(),
         "--size",
         fmt::format("{}x{}", settings.at("width").get<int>(), settings.at("height").get<int>())}
    );
    const image::Image reference = readReference(folder / (name + suffix + ".exr"));
    ASSERT_EQ(rendered.width, reference.width);
    ASSERT_EQ(rendered.height, reference.height);
    ASSERT_EQ(rendered.channels, reference.channels);
    const double psnr = image::computePsnr(rendered, reference);
    EXPECT_GE(psnr, kLeastPsnr);
    ::testing::Test::RecordProperty("psnr", number(psnr));
    fmt::print("{} {}{}: {:.2f} dB\n", method, name, suffix, psnr);
}

TEST_F(References, TheStillQuadIsCyclesQuad) {
    expectReference("translate_quad", ".still");
}

TEST_F(References, TheTranslatedQuadIsCyclesTrapezoid) {
    expectReference("translate_quad", "");
}

TEST_F(References, TheStillQuadOfThePhaseStartIsCyclesQuad) {
    expectReference("translate_quad_start", ".still");
}

TEST_F(References, TheQuadWithThePhaseAtTheStartIsCyclesTrapezoid) {
    expectReference("translate_quad_start", "");
}

TEST_F(References, TheStillBoxBeforeTheWallIsCyclesBox) {
    expectReference("partial_occlusion", ".still");
}

TEST_F(References, TheBoxThatCrossesTheWallIsCyclesBox) {
    expectReference("partial_occlusion", "");
}

TEST_F(References, TheStillBarIsCyclesBar) {
    expectReference("rotate_bar", ".still");
}

TEST_F(References, TheTurningBarIsCyclesArc) {
    expectReference("rotate_bar", "");
}

TEST_F(References, TheStillCheckerIsCyclesChecker) {
    expectReference("camera_checker", ".still");
}

TEST_F(References, TheCheckerUnderAMovingCameraIsCyclesChecker) {
    expectReference("camera_checker", "");
}

TEST_F(References, TheStillStripIsCyclesStrip) {
    expectReference("skinned_strip", ".still");
}

TEST_F(References, TheBendingStripIsCyclesStrip) {
    expectReference("skinned_strip", "");
}

TEST_F(References, TheStillStarIsCyclesStar) {
    expectReference("morph_star", ".still");
}

TEST_F(References, TheMorphingStarIsCyclesStar) {
    expectReference("morph_star", "");
}

class TruthReferences : public References {
  protected:
    void SetUp() override {
        References::SetUp();
        if (!IsSkipped() && !HasFatalFailure() && !device().hasRayQuery())
            GTEST_SKIP() << device().info().name << " has no ray queries";
    }
};

TEST_F(TruthReferences, RaysMeetCyclesTrapezoid) {
    expectReference("translate_quad", "", "truth");
}

TEST_F(TruthReferences, RaysMeetCyclesTrapezoidWithThePhaseAtTheStart) {
    expectReference("translate_quad_start", "", "truth");
}

TEST_F(TruthReferences, RaysMeetCyclesBoxThatCrossesTheWall) {
    expectReference("partial_occlusion", "", "truth");
}

TEST_F(TruthReferences, RaysMeetCyclesArc) {
    expectReference("rotate_bar", "", "truth");
}

TEST_F(TruthReferences, RaysMeetCyclesCheckerUnderAMovingCamera) {
    expectReference("camera_checker", "", "truth");
}

TEST_F(TruthReferences, RaysMeetCyclesStillChecker) {
    expectReference("camera_checker", ".still", "truth");
}

TEST_F(TruthReferences, RaysMeetCyclesBendingStrip) {
    expectReference("skinned_strip", "", "truth");
}

TEST_F(TruthReferences, RaysMeetCyclesMorphingStar) {
    expectReference("morph_star", "", "truth");
}

} // namespace
} // namespace shutter
