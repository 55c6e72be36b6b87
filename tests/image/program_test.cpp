// SPDX-License-Identifier: MIT
// `shutter render` from a scene file to a picture file: against an independent renderer's pictures,
// the paper's order of methods, the rivals, the truths, and the scenes that the generator makes.
#include "assets/generator/hard_cases.h"
#include "assets/generator/scaling_scenes.h"
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "game/options/render_arguments.h"
#include "game/output/sequence.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/temp_folder.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter {

namespace {

namespace fs = std::filesystem;
using image::computePsnr;
using image::Image;

const fs::path kShared = SHUTTER_SHARED_DIR;

fs::path assetFile(const std::string& name) {
    const fs::path file = fs::path(SHUTTER_BUILD_DIR) / "assets" / name;
    EXPECT_TRUE(fs::exists(file)) << "the target shutter_assets makes it";
    return file;
}

std::string readText(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// A scene that the generator makes, drawn, and its motion.
struct Drawn {
    Image picture;
    Image motion; ///< x, y in pixels
    double peakPx = 0.0;
    double movingShare = 0.0; ///< of the pixels, by more than half a pixel at `scale`
};

class Program : public test::RayTest {
  protected:
    /// Draws what `shutter render` draws with these words, to a file, and reads it back: all of the
    /// program but its main function and its device, so that libraries are loaded and pipelines
    /// made once for all. Fails the test (empty picture) with the program's sentence on an error.
    /// \param options separated by spaces
    /// \param extension of the picture, ".exr" (linear) or ".png" (as displayed)
    Image
    render(const fs::path& scene, const std::string& options, const char* extension = ".exr") {
        const fs::path picture = folder() / (std::string("picture") + extension);
        fs::remove(picture);
        std::istringstream typed(options);
        std::vector<std::string> words{std::istream_iterator<std::string>(typed), {}};
        words.insert(words.begin(), {scene.string(), "--out", picture.string()});
        std::reverse(words.begin(), words.end()); // as CLI11 takes them
        game::RenderArguments arguments;
        CLI::App command;
        game::defineRenderOptions(command, arguments);
        command.parse(words);
        const auto wanted = game::interpret(arguments);
        if (!wanted) {
            ADD_FAILURE() << wanted.error().message;
            return {};
        }
        if (auto drawn = game::renderSequence(wanted.value(), std::nullopt, device()); !drawn) {
            ADD_FAILURE() << drawn.error().message;
            return {};
        }
        return read(picture);
    }

    static Image read(const fs::path& file) {
        auto image = io::readImage(file);
        EXPECT_TRUE(image) << (image ? "" : image.error().message);
        return image ? std::move(image).value() : Image();
    }

    /// Gather beats the sharp picture, and rays beat gather, against brute force, by the paper's
    /// settings and as displayed (the paper compares pictures, not radiance).
    void expectThePapersOrder(const fs::path& scene, const std::string& options) {
        const auto draw = [&](const std::string& method) {
            return render(scene, method + " --size 640x360 " + options, ".png");
        };
        const Image truth = draw("--method accumulate --samples 64");
        ASSERT_EQ(truth.width, 640u);
        const auto judge = [&](const char* name, const char* method) {
            const double psnr = computePsnr(draw(method), truth);
            RecordProperty(name, fmt::format("{:.3f}", psnr));
            return psnr;
        };
        const double sharp = judge("sharp", "--preset off");
        // The gather has no preset of its own: the paper's hybrid without its rays.
        const double gather = judge(
            "gather",
            "--method gather --set tileSizePx=40 --set softDepthExtent=0.03 --set softDepthShare=0 "
            "--set foregroundMagnification=30"
        );
        const double hybrid = judge("hybrid", "--preset paper");
        EXPECT_GT(gather, sharp);
        EXPECT_GE(hybrid - gather, 1.0) << "rays are worth a decibel";
        EXPECT_GT(judge("hybrid, defaults", "--method hybrid"), hybrid + 2.0)
            << "the defaults serve users";
    }

    Drawn drawGenerated(
        const generator::GltfWriter& writer, const std::string& options, double scale = 1.0
    ) {
        const fs::path scene = folder() / "scene.glb";
        EXPECT_EQ(writer.write(scene), "");
        Drawn drawn;
        drawn.picture = render(scene, options + " --aov motion");
        drawn.motion = read(folder() / "picture.motion.exr");
        for (uint32_t y = 0; y < drawn.motion.height; ++y)
            for (uint32_t x = 0; x < drawn.motion.width; ++x) {
                const double length =
                    std::hypot(drawn.motion.at(x, y, 0), drawn.motion.at(x, y, 1)) / scale;
                drawn.peakPx = std::max(drawn.peakPx, length);
                drawn.movingShare += length > 0.5;
            }
        drawn.movingShare /= double(drawn.motion.width) * drawn.motion.height;
        return drawn;
    }

    [[nodiscard]] const fs::path& folder() const { return mFolder.path(); }

  private:
    test::TempFolder mFolder;
};

/// The program itself writes the file that all other tests here draw in their own process.
TEST_F(Program, TheExecutableDrawsWhatItsLibraryDraws) {
    const fs::path scene = assetFile("vase.glb");
    const fs::path picture = folder() / "program.exr";
    const std::string command = fmt::format(
        "'{}' render '{}' --validate --size 96x54 --out '{}' > '{}' 2>&1",
        SHUTTER_EXECUTABLE,
        scene.string(),
        picture.string(),
        (folder() / "messages").string()
    );
    ASSERT_EQ(std::system(command.c_str()), 0) << readText(folder() / "messages");
    EXPECT_TRUE(test::sameBits(read(picture), render(scene, "--size 96x54")));
}

/// The mean of each two by two pixels.
Image halve(const Image& picture) {
    Image half(picture.width / 2, picture.height / 2, picture.channels);
    for (uint32_t y = 0; y < 2 * half.height; ++y)
        for (uint32_t x = 0; x < 2 * half.width; ++x)
            for (uint32_t c = 0; c < half.channels; ++c)
                half.at(x / 2, y / 2, c) += picture.at(x, y, c) / 4.0f;
    return half;
}

class References : public Program, public testing::WithParamInterface<const char*> {
  protected:
    /// dB between our truth, of as many pixels as half the sides have, and Cycles' picture of
    /// ../shared/references, both with the whole pixel's mean.
    double compare(const char* method, bool isStatic) {
        const fs::path references = kShared / "references";
        const std::string name = GetParam();
        const auto settings = nlohmann::json::parse(readText(references / (name + ".json")));
        const auto number = [&](const char* key) {
            return fmt::format("{:.17g}", settings.at(key).get<double>());
        };
        const auto word = [&](const char* key) { return settings.at(key).get<std::string>(); };
        const auto world = settings.at("world").get<std::vector<double>>();
        const Image expected =
            halve(read(references / (name + (isStatic ? ".still.exr" : ".exr"))));
        const Image rendered = render(
            references / word("scene"),
            fmt::format(
                "--method {} --pixel box --samples {} --unlit --background "
                "{:.17g},{:.17g},{:.17g} "
                "--camera {} --clip {} --time {} --exposure {} --phase {} --size {}x{}",
                method,
                // Edges of the checker move in every pixel.
                name == "camera_checker" ? 256 : 64,
                world.at(0),
                world.at(1),
                world.at(2),
                word("camera"),
                word("clip"),
                number("frame_time"),
                isStatic ? "0" : number("exposure"),
                word("phase"),
                expected.width,
                expected.height
            )
        );
        EXPECT_EQ(rendered.channels, expected.channels);
        const double psnr = computePsnr(rendered, expected);
        RecordProperty(
            std::string(method) + (isStatic ? " still" : ""), fmt::format("{:.17g}", psnr)
        );
        return psnr;
    }
};

TEST_P(References, TheTruthsAreThePicturesOfCycles) {
    if (!fs::exists(kShared / "references" / (std::string(GetParam()) + ".json")))
        GTEST_SKIP() << "the references are not available (" << GetParam() << ".json)";
    // The references' own noise lies 58 dB or more below the truth, and 64 instants of ours are
    // quantised like 1/64 at the silhouettes of the moving part; a wrong motion, phase or camera
    // shows far below 40.
    EXPECT_GE(compare("accumulate", true), 40.0);
    EXPECT_GE(compare("accumulate", false), 40.0);
    EXPECT_GE(compare("truth", false), 40.0);
    if (std::string_view(GetParam()) == "camera_checker") {
        EXPECT_GE(compare("truth", true), 40.0);
    }
}

INSTANTIATE_TEST_SUITE_P(
    Cycles,
    References,
    testing::Values(
        "translate_quad",
        "translate_quad_start",
        "partial_occlusion",
        "rotate_bar",
        "camera_checker",
        "skinned_strip",
        "morph_star"
    ),
    [](const auto& instance) { return std::string(instance.param); }
);

TEST_F(Program, RaysBeatGatherBeatsSharpOnTheVase) {
    expectThePapersOrder(assetFile("vase.glb"), "");
}

TEST_F(Program, RaysBeatGatherBeatsSharpInThePinkRoom) {
    const fs::path scene = kShared / "scenes" / "pink-room" / "pink_room_lite_animated.glb";
    if (!fs::exists(scene))
        GTEST_SKIP() << "the Pink Room is not available";
    expectThePapersOrder(scene, "--clip vase_slide_fast_linear --time 0.12");
}

TEST_F(Program, EachRivalIsNearerToTheTruthOfTheVaseThanTheSharpPictureInEveryPhase) {
    for (const char* phase : {"start", "centre", "end"}) {
        const auto draw = [&](const std::string& method) {
            return render(
                assetFile("vase.glb"),
                fmt::format("--size 320x180 --phase {} --method {}", phase, method),
                ".png"
            );
        };
        const Image truth = draw("accumulate --samples 64");
        ASSERT_EQ(truth.width, 320u);
        const double sharp = computePsnr(draw("sharp"), truth);
        for (const char* method :
             {"own_velocity", "mcguire2012", "guertin2014", "jimenez2014", "denoised"})
            EXPECT_GT(computePsnr(draw(method), truth), sharp + 3.0) << method << " " << phase;
    }
}

TEST_F(Program, BothTruthsAgreeOnTheVaseAndOnTheCourtyardUnderAPan) {
    const std::pair<const char*, const char*> scenes[] = {
        {"vase.glb", ""}, {"courtyard.glb", "--camera pan --time 0.05 --background 0.35,0.5,0.75"}};
    for (const auto& [scene, options] : scenes)
        for (const char* pixel : {"centre", "box"}) {
            const auto draw = [&, &scene = scene, &options = options](const char* method) {
                return render(
                    assetFile(scene),
                    fmt::format(
                        "--size 160x90 --method {} --samples 256 --pixel {} {}",
                        method,
                        pixel,
                        options
                    )
                );
            };
            const Image rays = draw("truth");
            ASSERT_EQ(rays.width, 160u);
            EXPECT_GE(computePsnr(rays, draw("accumulate")), 45.0) << scene << " " << pixel;
        }
}

TEST_F(Program, RaysStopAtTheErrorThatIsWished) {
    const fs::path stats = folder() / "stats.json";
    const auto draw = [&](const char* error) {
        // Large enough that a batch is fewer rays than --samples.
        const Image picture = render(
            assetFile("vase.glb"),
            fmt::format(
                "--method truth --samples 64 --size 400x225 --unlit --error {} --stats {}",
                error,
                stats.string()
            )
        );
        EXPECT_EQ(picture.width, 400u);
        return nlohmann::json::parse(readText(stats)).at("pictures").at(0);
    };
    const nlohmann::json early = draw("0.5");
    const int rays = early.at("counters").at("rays per pixel").get<int>();
    EXPECT_LT(rays, 64);
    EXPECT_GE(rays, 16);
    EXPECT_LE(early.at("measures").at("standard error").get<double>(), 0.5);
    EXPECT_EQ(early.at("counters").at("rays traced").get<int>(), rays * 400 * 225);
    const nlohmann::json never = draw("0.0000001");
    EXPECT_EQ(never.at("counters").at("rays per pixel").get<int>(), 64);
    EXPECT_GT(never.at("measures").at("standard error").get<double>(), 0.0000001);
}

TEST_F(Program, TheDenoisedPictureIsNearerToTheTruthThanItsRaysAndStaticSurfacesStay) {
    const auto draw = [&](const std::string& method, bool isFiltered = true) {
        return render(
            assetFile("vase.glb"),
            "--size 320x180 --method " + method + (isFiltered ? "" : " --set filterLevels=0")
        );
    };
    const Image truth = draw("accumulate --samples 64");
    ASSERT_EQ(truth.width, 320u);
    // Stratified rays need the filter less the more they are.
    for (const auto& [rays, decibels] : {std::pair{"1", 6.0}, {"2", 2.0}, {"4", 1.0}}) {
        const std::string method = std::string("denoised --samples ") + rays;
        const Image filtered = draw(method);
        const Image unfiltered = draw(method, false);
        EXPECT_GT(computePsnr(filtered, truth), computePsnr(unfiltered, truth) + decibels) << rays;
        if (rays != std::string_view("1"))
            continue;
        // Every ray of a pixel away from the vase, and from surfaces behind it, has the same
        // result.
        const Image one = draw("truth --samples 1");
        for (uint32_t y = 0; y < 180; ++y)
            for (uint32_t x = 0; x < 320; x += x == 59 ? 201 : 1)
                for (uint32_t c = 0; c < 3; ++c) {
                    ASSERT_EQ(filtered.at(x, y, c), unfiltered.at(x, y, c)) << x << " " << y;
                    ASSERT_NEAR(filtered.at(x, y, c), one.at(x, y, c), 2e-3f) << x << " " << y;
                }
    }
    EXPECT_GT(computePsnr(draw("denoised --samples 64"), truth), 42.0) << "many rays converge";
}

TEST_F(Program, EachHardCaseRendersAndItsLongestMotionIsWhatItsDescriptionStates) {
    for (const generator::BenchCase& hardCase : generator::listHardCases()) {
        SCOPED_TRACE(hardCase.name);
        const glm::vec3 sky = hardCase.background;
        const std::string options = fmt::format(
            "--camera {} --time {} --exposure {} --phase {} --background {},{},{} --method hybrid "
            "--size 320x180",
            hardCase.camera,
            hardCase.timeSeconds,
            hardCase.exposureSeconds,
            hardCase.phase,
            sky.x,
            sky.y,
            sky.z
        );
        Drawn drawn = drawGenerated(hardCase.build(), options, 320 / generator::kCaseSizePx.x);
        ASSERT_EQ(drawn.motion.width, 320u);
        EXPECT_TRUE(test::allFinite(drawn.picture));
        double brightness = 0.0;
        for (uint32_t y = 0; y < 180; ++y)
            for (uint32_t x = 0; x < 320; ++x)
                brightness += drawn.picture.at(x, y, 1) / (320.0 * 180.0);
        RecordProperty(hardCase.name, fmt::format("{:.2f}", drawn.peakPx));
        if (hardCase.movesParticles) {
            // They write no motion: how far they go is robustness' to measure.
            EXPECT_EQ(drawn.peakPx, 0.0);
            const Image without =
                drawGenerated(hardCase.build(), options + " --particles off").picture;
            for (size_t i = 0; i < without.pixels.size(); i += 4)
                drawn.movingShare +=
                    std::abs(drawn.picture.pixels[i] - without.pixels[i]) > 1.0f / 256;
            drawn.movingShare /= 320.0 * 180.0;
        } else {
            EXPECT_GE(drawn.peakPx, hardCase.peakMotionPx.x);
            EXPECT_LE(drawn.peakPx, hardCase.peakMotionPx.y);
        }
        EXPECT_GT(drawn.movingShare, 0.01) << "a mover that one can see";
        EXPECT_GT(brightness, 0.1) << "a picture that one can see";
    }
}

TEST_F(Program, TheMovingShareIsTheOneAskedForWithin2Percent) {
    for (const float share : {0.0f, 0.05f, 0.25f, 0.5f, 0.8f, 1.0f, 7.0f}) {
        const Drawn drawn = drawGenerated(
            generator::buildMovingShareScene(share),
            fmt::format(
                "--method sharp --size 640x360 --camera {} --exposure {}",
                generator::kScalingCamera,
                generator::kScalingExposureSeconds
            )
        );
        ASSERT_EQ(drawn.motion.width, 640u);
        EXPECT_NEAR(drawn.movingShare, std::min(share, 1.0f), 0.02);
    }
}

TEST_F(Program, EntitiesHideTheSameShareHoweverManyTheyAre) {
    double ofOne = 0.0;
    for (const int count : {1, 100, 10'000}) {
        const Drawn drawn =
            drawGenerated(generator::buildEntitiesScene(count), "--method sharp --size 640x360");
        ASSERT_EQ(drawn.motion.width, 640u);
        if (count == 1)
            ofOne = drawn.movingShare;
        EXPECT_GT(drawn.peakPx, 5.0) << count;
        EXPECT_LT(drawn.peakPx, 13.0) << count;
        EXPECT_NEAR(drawn.movingShare, ofOne, 0.05) << count;
    }
}

} // namespace
} // namespace shutter
