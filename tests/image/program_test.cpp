// SPDX-License-Identifier: MIT
// `shutter render` from a scene file to a picture file: against an independent renderer's pictures,
// the paper's order of methods, the rivals, the truths, and the scenes that the generator makes.
#include "assets/generator/hard_cases.h"
#include "assets/generator/scaling_scenes.h"
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <ostream>
#include <string>
#include <utility>
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
using image::computePsnr;
using image::Image;
using Words = std::vector<std::string>;

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

/// As one word of a POSIX shell.
std::string quote(const std::string& word) {
    std::string quoted = "'";
    for (const char c : word)
        quoted += c == '\'' ? "'\\''" : std::string(1, c);
    return quoted + "'";
}

class Program : public test::RayTest {
  protected:
    /// Runs `shutter render` with validation on and reads the picture back. Fails the test (empty
    /// picture) with the program's words where it does not exit with 0.
    /// \param extension of the picture, ".exr" (linear) or ".png" (as displayed)
    Image render(const fs::path& scene, const Words& arguments, const char* extension = ".exr") {
        const fs::path picture = folder() / (std::string("picture") + extension);
        const fs::path messages = folder() / "messages";
        fs::remove(picture);
        std::string command = fmt::format(
            "{} render {} --validate --out {}",
            quote(SHUTTER_EXECUTABLE),
            quote(scene.string()),
            quote(picture.string())
        );
        for (const std::string& argument : arguments)
            command += " " + quote(argument);
        if (std::system((command + " > " + quote(messages.string()) + " 2>&1").c_str()) != 0) {
            ADD_FAILURE() << command << "\n" << readText(messages);
            return {};
        }
        return read(picture);
    }

    static Image read(const fs::path& file) {
        auto image = io::readImage(file);
        EXPECT_TRUE(image) << (image ? "" : image.error().message);
        return image ? std::move(image).value() : Image();
    }

    [[nodiscard]] const fs::path& folder() const { return mFolder.path(); }

  private:
    test::TempFolder mFolder;
};

struct Reference {
    const char* test;
    const char* name;
    bool isStatic = false;
    const char* method = "accumulate";
};

void PrintTo(const Reference& reference, std::ostream* stream) {
    *stream << reference.test;
}

const Reference kReferences[] = {
    {"StillQuad", "translate_quad", true},
    {"TranslatedQuad", "translate_quad"},
    {"StillQuadOfThePhaseStart", "translate_quad_start", true},
    {"QuadWithThePhaseAtTheStart", "translate_quad_start"},
    {"StillBoxBeforeTheWall", "partial_occlusion", true},
    {"BoxThatCrossesTheWall", "partial_occlusion"},
    {"StillBar", "rotate_bar", true},
    {"TurningBar", "rotate_bar"},
    {"StillChecker", "camera_checker", true},
    {"CheckerUnderAMovingCamera", "camera_checker"},
    {"StillStrip", "skinned_strip", true},
    {"BendingStrip", "skinned_strip"},
    {"StillStar", "morph_star", true},
    {"MorphingStar", "morph_star"},
    {"RaysAndTheTranslatedQuad", "translate_quad", false, "truth"},
    {"RaysAndTheQuadWithThePhaseAtTheStart", "translate_quad_start", false, "truth"},
    {"RaysAndTheBoxThatCrossesTheWall", "partial_occlusion", false, "truth"},
    {"RaysAndTheTurningBar", "rotate_bar", false, "truth"},
    {"RaysAndTheCheckerUnderAMovingCamera", "camera_checker", false, "truth"},
    {"RaysAndTheStillChecker", "camera_checker", true, "truth"},
    {"RaysAndTheBendingStrip", "skinned_strip", false, "truth"},
    {"RaysAndTheMorphingStar", "morph_star", false, "truth"},
};

class References : public Program, public testing::WithParamInterface<Reference> {};

/// Our truths against an independent renderer's pictures (Cycles) of ../shared/references.
TEST_P(References, TheTruthIsThePictureOfCycles) {
    const Reference& reference = GetParam();
    const fs::path references = kShared / "references";
    const std::string name = reference.name;
    if (!fs::exists(references / (name + ".json")))
        GTEST_SKIP() << "the references are not available (" << name << ".json)";
    const auto settings = nlohmann::json::parse(readText(references / (name + ".json")));
    const auto number = [&](const char* key) {
        return fmt::format("{:.17g}", settings.at(key).get<double>());
    };
    const auto word = [&](const char* key) { return settings.at(key).get<std::string>(); };
    const auto world = settings.at("world").get<std::vector<double>>();
    const Image rendered = render(
        references / word("scene"),
        {"--method",
         reference.method,
         "--pixel",
         "box",
         "--samples",
         "256",
         "--unlit",
         "--background",
         fmt::format("{:.17g},{:.17g},{:.17g}", world.at(0), world.at(1), world.at(2)),
         "--camera",
         word("camera"),
         "--clip",
         word("clip"),
         "--time",
         number("frame_time"),
         "--exposure",
         reference.isStatic ? "0" : number("exposure"),
         "--phase",
         word("phase"),
         "--size",
         fmt::format("{}x{}", settings.at("width").get<int>(), settings.at("height").get<int>())}
    );
    const Image expected = read(references / (name + (reference.isStatic ? ".still.exr" : ".exr")));
    ASSERT_EQ(rendered.width, expected.width);
    ASSERT_EQ(rendered.height, expected.height);
    ASSERT_EQ(rendered.channels, expected.channels);
    const double psnr = computePsnr(rendered, expected);
    // The references' own noise lies 58 dB or more below the truth, and 256 instants of ours are
    // quantised like 1/256 at the silhouettes of the moving part; a wrong motion, phase or camera
    // shows far below 40.
    EXPECT_GE(psnr, 40.0);
    RecordProperty("psnr", fmt::format("{:.17g}", psnr));
}

INSTANTIATE_TEST_SUITE_P(
    Cycles,
    References,
    testing::ValuesIn(kReferences),
    [](const auto& instance) { return std::string(instance.param.test); }
);

class Paper : public Program {
  protected:
    /// Gather beats the sharp picture, and rays beat gather, against brute force, by the paper's
    /// settings and as displayed (the paper compares pictures, not radiance).
    void expectThePapersOrder(const fs::path& scene, const Words& arguments) {
        const auto draw = [&](Words chosen) {
            chosen.insert(chosen.end(), arguments.begin(), arguments.end());
            chosen.insert(chosen.end(), {"--size", "640x360"});
            return render(scene, chosen, ".png");
        };
        const Image truth = draw({"--method", "accumulate", "--samples", "256"});
        ASSERT_EQ(truth.width, 640u);
        const auto judge = [&](const std::string& name, const Words& chosen) {
            const double psnr = computePsnr(draw(chosen), truth);
            RecordProperty(name, fmt::format("{:.3f}", psnr));
            return psnr;
        };
        const double sharp = judge("sharp", {"--preset", "off"});
        // The gather has no preset of its own: the paper's hybrid without its rays.
        const double gather = judge(
            "gather",
            {"--method",
             "gather",
             "--set",
             "tileSizePx=40",
             "--set",
             "softDepthExtent=0.03",
             "--set",
             "softDepthShare=0",
             "--set",
             "foregroundMagnification=30"}
        );
        const double hybrid = judge("hybrid", {"--preset", "paper"});
        EXPECT_GT(gather, sharp);
        EXPECT_GE(hybrid - gather, 1.0) << "rays are worth a decibel";
        EXPECT_GT(judge("hybrid, defaults", {"--method", "hybrid"}), hybrid + 2.0)
            << "the defaults serve users";
    }
};

TEST_F(Paper, RaysBeatGatherBeatsSharpOnTheVase) {
    expectThePapersOrder(assetFile("vase.glb"), {});
}

TEST_F(Paper, RaysBeatGatherBeatsSharpInThePinkRoom) {
    const fs::path scene = kShared / "scenes" / "pink-room" / "pink_room_lite_animated.glb";
    if (!fs::exists(scene))
        GTEST_SKIP() << "the Pink Room is not available";
    expectThePapersOrder(scene, {"--clip", "vase_slide_fast_linear", "--time", "0.12"});
}

TEST_F(Program, EachRivalIsNearerToTheTruthOfTheVaseThanTheSharpPictureInEveryPhase) {
    for (const char* phase : {"start", "centre", "end"}) {
        const auto draw = [&](const char* method, const char* samples) {
            Words words{"--size", "320x180", "--method", method, "--phase", phase};
            if (samples != nullptr)
                words.insert(words.end(), {"--samples", samples});
            return render(assetFile("vase.glb"), words, ".png");
        };
        const Image truth = draw("accumulate", "64");
        ASSERT_EQ(truth.width, 320u);
        const double sharp = computePsnr(draw("sharp", nullptr), truth);
        for (const char* method :
             {"own_velocity", "mcguire2012", "guertin2014", "jimenez2014", "denoised"})
            EXPECT_GT(computePsnr(draw(method, nullptr), truth), sharp + 3.0)
                << method << " " << phase;
    }
}

TEST_F(Program, BothTruthsAgreeOnTheVaseAndOnTheCourtyardUnderAPan) {
    const std::pair<const char*, Words> scenes[] = {
        {"vase.glb", {}},
        {"courtyard.glb", {"--camera", "pan", "--time", "0.05", "--background", "0.35,0.5,0.75"}}};
    for (const auto& [scene, arguments] : scenes)
        for (const char* pixel : {"centre", "box"}) {
            const auto draw = [&](const char* method) {
                Words words = arguments;
                words.insert(
                    words.end(),
                    {"--size", "160x90", "--method", method, "--samples", "256", "--pixel", pixel}
                );
                return render(assetFile(scene), words);
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

class Denoised : public Program {
  protected:
    Image draw(const char* method, const char* samples, bool isFiltered = true) {
        Words words{"--size", "640x360", "--method", method, "--samples", samples};
        if (!isFiltered)
            words.insert(words.end(), {"--set", "filterLevels=0"});
        return render(assetFile("vase.glb"), words);
    }
};

TEST_F(Denoised, DenoisedPictureIsNearerToTheTruthThanItsRays) {
    const Image truth = draw("accumulate", "128");
    ASSERT_EQ(truth.width, 640u);
    // Stratified rays need the filter less the more they are.
    for (const auto& [rays, decibels] : {std::pair{"1", 6.0}, {"2", 2.0}, {"4", 1.0}})
        EXPECT_GT(
            computePsnr(draw("denoised", rays), truth),
            computePsnr(draw("denoised", rays, false), truth) + decibels
        ) << rays
          << " rays";
    EXPECT_GT(computePsnr(draw("denoised", "64"), truth), 42.0) << "many rays converge";
}

TEST_F(Denoised, DenoisingLeavesStaticSurfacesUnchanged) {
    const Image rays = draw("denoised", "1", false);
    const Image filtered = draw("denoised", "1");
    const Image truth = draw("truth", "1");
    ASSERT_EQ(filtered.width, 640u);
    // Every ray of a pixel away from the vase, and from surfaces behind it, has the same result.
    for (uint32_t y = 0; y < 360; ++y)
        for (uint32_t x = 0; x < 640; x += x == 119 ? 401 : 1)
            for (uint32_t c = 0; c < 3; ++c) {
                ASSERT_EQ(filtered.at(x, y, c), rays.at(x, y, c)) << x << " " << y;
                ASSERT_NEAR(filtered.at(x, y, c), truth.at(x, y, c), 2e-3f) << x << " " << y;
            }
}

/// A scene that the generator makes, drawn, and its motion.
struct Drawn {
    Image picture;
    Image motion; ///< x, y in pixels
    double peakPx = 0.0;
    double movingShare = 0.0; ///< of the pixels, by more than half a pixel at `scale`
};

class GeneratedScene : public Program {
  protected:
    Drawn draw(const generator::GltfWriter& writer, Words arguments, double scale = 1.0) {
        const fs::path scene = folder() / "scene.glb";
        EXPECT_EQ(writer.write(scene), "");
        arguments.insert(arguments.end(), {"--aov", "motion"});
        Drawn drawn;
        drawn.picture = render(scene, arguments);
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
};

class HardCasePicture : public GeneratedScene,
                        public testing::WithParamInterface<generator::BenchCase> {};

TEST_P(HardCasePicture, RendersAndItsLongestMotionIsWhatItsDescriptionStates) {
    const generator::BenchCase& hardCase = GetParam();
    const glm::vec3 sky = hardCase.background;
    Words arguments = {
        "--camera",
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
        "320x180"};
    Drawn drawn = draw(hardCase.build(), arguments, 320 / generator::kCaseSizePx.x);
    ASSERT_EQ(drawn.motion.width, 320u);
    EXPECT_TRUE(test::allFinite(drawn.picture));
    double brightness = 0.0;
    for (uint32_t y = 0; y < 180; ++y)
        for (uint32_t x = 0; x < 320; ++x)
            brightness += drawn.picture.at(x, y, 1) / (320.0 * 180.0);
    RecordProperty("peakPx", fmt::format("{:.2f}", drawn.peakPx));
    if (hardCase.movesParticles) {
        // They write no motion: how far they go is robustness' to measure.
        EXPECT_EQ(drawn.peakPx, 0.0);
        arguments.insert(arguments.end(), {"--particles", "off"});
        const Image without = draw(hardCase.build(), arguments).picture;
        for (size_t i = 0; i < without.pixels.size(); i += 4)
            drawn.movingShare += std::abs(drawn.picture.pixels[i] - without.pixels[i]) > 1.0f / 256;
        drawn.movingShare /= 320.0 * 180.0;
    } else {
        EXPECT_GE(drawn.peakPx, hardCase.peakMotionPx.x);
        EXPECT_LE(drawn.peakPx, hardCase.peakMotionPx.y);
    }
    EXPECT_GT(drawn.movingShare, 0.01) << "a mover that one can see";
    EXPECT_GT(brightness, 0.1) << "a picture that one can see";
}

INSTANTIATE_TEST_SUITE_P(
    Generated,
    HardCasePicture,
    testing::ValuesIn(generator::listHardCases().begin(), generator::listHardCases().end()),
    [](const auto& test) { return std::string(test.param.name); }
);

TEST_F(GeneratedScene, TheMovingShareIsTheOneAskedForWithin2Percent) {
    for (const float share : {0.0f, 0.05f, 0.25f, 0.5f, 0.8f, 1.0f, 7.0f}) {
        const Drawn drawn = draw(
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
        EXPECT_NEAR(drawn.movingShare, std::min(share, 1.0f), 0.02);
    }
}

TEST_F(GeneratedScene, EntitiesHideTheSameShareHoweverManyTheyAre) {
    std::map<int, double> shares;
    for (const int count : {1, 100, 10'000}) {
        const Drawn drawn =
            draw(generator::buildEntitiesScene(count), {"--method", "sharp", "--size", "640x360"});
        ASSERT_EQ(drawn.motion.width, 640u);
        shares[count] = drawn.movingShare;
        EXPECT_GT(drawn.peakPx, 5.0) << count;
        EXPECT_LT(drawn.peakPx, 13.0) << count;
        EXPECT_NEAR(shares[count], shares[1], 0.05) << count;
    }
}

} // namespace
} // namespace shutter
