// SPDX-License-Identifier: MIT
// On scenes of many objects: one traversal reveals what stepping from hit to hit reveals.
#include "assets/generator/hard_cases.h"
#include "assets/generator/scenes.h"
#include "game/options/shot_arguments.h"
#include "game/shot/picture_drawer.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <system_error>
#include <unistd.h>
#include <vector>

namespace shutter {

namespace {

namespace fs = std::filesystem;
using motion_blur::RevealTraversal;

struct SceneCase {
    std::string name;
    generator::GltfWriter (*build)();
    std::string camera = "main";
    double seconds = 0.0;
    double exposureSeconds = generator::kCaseExposureSeconds;
    std::string phase = "end";
};

/// Without it the test's name would hold the bytes of a pointer.
void PrintTo(const SceneCase& scene, std::ostream* stream) {
    *stream << scene.name;
}

std::vector<SceneCase> listScenes() {
    constexpr double kExposure = 1.0 / 30.0;
    std::vector<SceneCase> scenes = {
        {"vase", &generator::buildVaseScene, "main", 0.0, kExposure},
        {"courtyard", &generator::buildCourtyardScene, "main", 0.2, kExposure},
        {"courtyard_pan", &generator::buildCourtyardScene, "pan", 0.2, kExposure}};
    for (const generator::BenchCase& hard : generator::listHardCases())
        scenes.push_back(
            {hard.name, hard.build, hard.camera, hard.timeSeconds, hard.exposureSeconds, hard.phase}
        );
    return scenes;
}

class RevealOfScenes : public test::GpuTest, public testing::WithParamInterface<SceneCase> {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        if (!device().hasRays())
            GTEST_SKIP() << "the device traces no rays";
        const SceneCase& scene = GetParam();
        const fs::path file =
            fs::temp_directory_path() / fmt::format("reveal_{}_{}.glb", scene.name, ::getpid());
        ASSERT_EQ(scene.build().write(file), "");
        game::ShotArguments arguments;
        arguments.scene = file.string();
        arguments.camera = scene.camera;
        arguments.time = scene.seconds;
        arguments.shutter = game::makeShutterArguments(scene.exposureSeconds, scene.phase);
        arguments.size = {240, 136};
        auto options = game::interpret(arguments);
        ASSERT_TRUE(options.ok()) << options.error().message;
        mOptions = std::move(options).value();
        auto shot = game::loadShot(mOptions);
        std::error_code ignored;
        fs::remove(file, ignored);
        ASSERT_TRUE(shot.ok()) << shot.error().message;
        mShot.emplace(std::move(shot).value());
    }

    render::FrameResult draw(RevealTraversal traversal, uint32_t recursionLimit) {
        game::MethodOptions method = game::makeMethod(*game::findMethod("hybrid").value());
        method.motionBlur.revealTraversal = traversal;
        method.motionBlur.recursionLimit = recursionLimit;
        render::Renderer renderer(device(), mShot->world.assets);
        game::PictureRequest picture =
            game::makePicture(*mShot, mOptions, method, GetParam().seconds);
        picture.frame.intermediates = {"mask", "mesh_id", "reveal", "reveal_motion", "reveal_id"};
        auto frame = game::PictureDrawer(device(), renderer).draw(mShot->world, picture);
        EXPECT_TRUE(frame.ok());
        return std::move(frame).value();
    }

    game::ShotOptions mOptions;
    std::optional<game::Shot> mShot;
};

/// What the two traversals say of the masked pixels.
struct Agreement {
    size_t masked = 0;
    size_t stopped = 0; ///< where stepping reached its limit on the object in front
    size_t otherObject = 0;
    double worstColor = 0.0; ///< relative to the larger, or to 0.1 where both are darker
    double worstDepth = 0.0; ///< relative
};

double differ(float a, float b, float least) {
    return std::abs(a - b) / std::max({std::abs(a), std::abs(b), least});
}

Agreement compare(const render::FrameResult& single, const render::FrameResult& stepping) {
    Agreement found;
    const auto& views = stepping.intermediates;
    const auto& others = single.intermediates;
    const image::Image& mask = views.at("mask");
    for (uint32_t y = 0; y < mask.height; ++y)
        for (uint32_t x = 0; x < mask.width; ++x) {
            if (mask.at(x, y, 0) < 0.5f)
                continue;
            ++found.masked;
            const float front = views.at("mesh_id").at(x, y, 0);
            const float id = others.at("reveal_id").at(x, y, 0);
            const float stepped = views.at("reveal_id").at(x, y, 0);
            if (stepped == front && id != front) {
                ++found.stopped; // single finds the background that lies deeper
                continue;
            }
            found.otherObject += id != stepped;
            for (uint32_t c = 0; c < 3; ++c)
                found.worstColor = std::max(
                    found.worstColor,
                    differ(others.at("reveal").at(x, y, c), views.at("reveal").at(x, y, c), 0.1f)
                );
            found.worstDepth = std::max(
                found.worstDepth,
                differ(
                    others.at("reveal_motion").at(x, y, 2),
                    views.at("reveal_motion").at(x, y, 2),
                    1.0e-6f
                )
            );
        }
    return found;
}

TEST_P(RevealOfScenes, OneTraversalFindsWhatSteppingFinds) {
    const auto single = draw(RevealTraversal::Single, 1); // its limit means nothing
    ASSERT_TRUE(single.intermediates.contains("mask")) << "nothing moves in sight";
    for (const uint32_t limit : {5u, 64u}) {
        const Agreement found = compare(single, draw(RevealTraversal::Stepping, limit));
        EXPECT_TRUE(GetParam().name != "vase" || found.masked > 200) << found.masked;
        EXPECT_EQ(found.otherObject, 0u);
        // A step that is not the first starts at another place of the ray: the hit moves by
        // rounding.
        EXPECT_LE(found.worstColor, 1.0 / 256);
        EXPECT_LE(found.worstDepth, 1.0e-5);
        // None of these scenes' objects has more surfaces than the second limit.
        EXPECT_TRUE(limit == 5u || found.stopped == 0u) << found.stopped;
    }
    const auto& counters = single.statistics.counters;
    EXPECT_LE(counters.at("rays traced"), counters.at("pixels masked"));
}

INSTANTIATE_TEST_SUITE_P(
    Scenes,
    RevealOfScenes,
    testing::ValuesIn(listScenes()),
    [](const auto& param) { return param.param.name; }
);

} // namespace
} // namespace shutter
