// SPDX-License-Identifier: MIT
// Wrong usage (exit status 2) and what fails (1): one sentence that names the option or the file,
// and nothing is written. One case of each kind: which values and files are refused is tested
// without a process for each (tests/unit/options, tests/unit/gltf).
#include "engine/image/image.h"
#include "engine/io/image_file.h"
#include "tests/cli/cli_fixture.h"

#include <cstdlib>
#include <sys/stat.h>
#include <utility>

namespace shutter::cli {

namespace {

constexpr const char* kCommands = "render, compare, info, play, replay, blur, bench, film";

constexpr const char* kResting =
    R"({"version": 1, "keys": [{"time": 0, "position": [0, 1, 2], "lookAt": [0, 1, 0]}]})";

/// A glTF file of one triangle, whose positions are in another file.
std::string makeTriangle(const std::string& uri) {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                       "min": [0, 0, 0], "max": [1, 1, 1]}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "buffers": [{"byteLength": 36, "uri": ")" +
           uri + R"("}]})";
}

} // namespace

TEST_F(Cli, WrongUsageIsRefusedByOptionBeforeAnythingIsWritten) {
    writeFile("flight.json", kResting);
    const auto draw = [&](const Arguments& more) {
        return renderVase(join({"--out", "a.png"}, more));
    };
    const auto fly = [&](const Arguments& more) {
        return renderVase(join({"--flythrough", "flight.json", "--out"}, more));
    };
    const auto film = [](const Arguments& more) {
        return join({"film", "s.gltf", "--frames", "0:3", "--out", "f_%d.png"}, more);
    };
    const auto bench = [&](const Arguments& more) {
        return join({"bench", "--out", path("x")}, more);
    };
    expectRefusals({
        {{}, kUsage, {"no command is given", kCommands}},
        {{"nosuch"}, kUsage, {"'nosuch' is no command; there are", kCommands}},
        {{"rendr", "s.glb", "--out", "a.png"}, kUsage, {"did you mean render?", kCommands}},
        {{"--method", "sharp"}, kUsage, {"no command comes before --method", kCommands}},
        {{"--out", "a.png", "render", "s.glb"}, kUsage, {"--out must come after", "render"}},
        {{"render", "s.glb", "--version"}, kUsage, {"--version must come before", "render"}},
        {{"render"}, kUsage, {"scene"}},
        {{"render", "scene.glb"}, kUsage, {"--out"}},
        {{"info"}, kUsage, {"SCENE", "--devices", "--methods"}},
        {{"compare", "a.png"}, kUsage, {"b"}},
        {draw({"--nosuch"}),
         kUsage,
         {"'--nosuch' is no option of render; `shutter render --help`"}},
        {{"render", "s.glb", "--otu", "a.png"}, kUsage, {"'--otu'", "did you mean --out?"}},
        {draw({"--shadow=sharp"}), kUsage, {"'--shadow' is no option of", "mean --shadows?"}},
        {draw({"b.glb"}), kUsage, {"'b.glb' is one argument too many for render"}},
        {{"compare", "a.png", "--ouy", "c.png"}, kUsage, {"option of compare", "mean --out?"}},
        {film({"--job", "2"}), kUsage, {"'--job' is no option of film; `shutter film --help`"}},
        {film({"--mehtod", "sharp"}), kUsage, {"option of film; did you mean --method?"}},
        {bench({"--limt", "3"}), kUsage, {"option of bench; did you mean --limit?"}},
        {draw({"--size", "5x5"}), kUsage, {"--size is given 2 times"}},
        {{"render", "s.glb", "--out"}, kUsage, {"--out needs a value"}},
        {draw({"--time=1x"}), kUsage, {"--time: '1x' is not a number"}},
        {draw({"--seed", "1.5"}), kUsage, {"--seed: 1.5 is not a whole number"}},
        {draw({"--repeat", "x"}), kUsage, {"--repeat: 'x' is not a number"}},
        {draw({"--repeat", "0"}), kUsage, {"--repeat: 0 must be 1 to 1000"}},
        {draw({"--samples", "99999999999"}), kUsage, {"--samples: 99999999999 is too large"}},
        {draw({"--loop=maybe"}), kUsage, {"--loop does not take 'maybe'"}},
        {bench({"--suite", "paper", "--limit", "0"}), kUsage, {"--limit: 0 must be above 0"}},
        {draw({"--method", "resolved", "--set", "samples=3"}),
         kUsage,
         {"no such setting", "the sample count is --samples"}},
        {draw({"--samples=257", "--method", "gather"}), kUsage, {"--samples", "257"}},
        {draw({"--phase", "a\nb\x1b[31m"}), kUsage, {"--phase"}}, // in one line
        {draw({"--exposure", "1", "--shutter-angle", "9"}),
         kUsage,
         {"--exposure", "--shutter-angle"}},
        {renderVase({"--out", "a_%d.png", "--time", "1", "--frames", "0:1"}),
         kUsage,
         {"--time", "--frames"}},
        {renderVase({"--out", "f.mp4"}), kUsage, {"--frames", "--flythrough"}},
        {fly({"f_%d.png", "--camera", "main"}), kUsage, {"--camera", "--flythrough"}},
        {fly({"f_%d.png", "--time", "1"}), kUsage, {"--time", "--flythrough"}},
        {fly({"f.png"}), kUsage, {"%04d"}},
        {fly({"f.mp4", "--aov", "motion"}), kUsage, {"--aov"}},
        {fly({"f_%d.png", "--keep-frames"}), kUsage, {"--keep-frames", ".mp4"}},
        {fly({"f_%d.png", "--ffmpeg", "x"}), kUsage, {"--ffmpeg", ".mp4"}},
        {{"render", "s.glb", "--flythrough", "flight.json", "--size", "63x36", "--out", "f.mp4"},
         kUsage,
         {"--size 63x36", "even"}},
        {film({"--aa", "taa", "--jobs", "2"}), kUsage, {"--aa taa"}},
        {film({"--budget", "8", "--jobs", "2"}), kUsage, {"--budget"}},
        {film({"--stats", "s.json"}), kUsage, {"--stats"}},
        {film({"--wait"}), kUsage, {"--wait", "--slurm"}},
        {film({"--jobs", "0"}), kUsage, {"--jobs"}},
        {film({"--slurm", "--jobs", "2"}), kUsage, {"--jobs", "--slurm"}},
        {film({"--parts", "x"}), kUsage, {"--parts x"}},
        {film({"--part", "1/2"}), kUsage, {"--part", "shutter render"}},
        {{"film", "s.gltf", "--frames", "0:3", "--out", "f.exr"}, kUsage, {"%04d"}},
        {{"film", "s.gltf", "--out", "f.exr"}, kUsage, {"--frames or --flythrough"}},
        {bench({}), kUsage, {"--suite", "SCENE"}},
        {bench({"--suite", "no"}), kUsage, {"--suite", "no", "paper", "hard"}},
    });
}

TEST_F(Cli, AFileThatCannotBeReadOrWrittenIsNamed) {
    writeFile("flight.json", "{\"version\": 1,\n\"keys\": 3}");
    const auto fly = [&](const char* out, const Arguments& more) {
        return renderVase(join({"--flythrough", "flight.json", "--out", out}, more));
    };
    fs::create_symlink("loop.png", path("loop.png"));
    expectRefusals({
        {{"info", "no\nsuch.glb"}, kFailed, {"such.glb"}}, // in one line
        {{"replay", "missing"}, kFailed, {"missing"}},
        {{"replay", "missing", "--method", "gather"}, kFailed, {"missing"}},
        {renderVase({"--out", "nosuch/a.png"}), kFailed, {"--out", "nosuch/a.png"}},
        {renderVase({"--out", "a.png", "--stats", "nosuch/s.json"}),
         kFailed,
         {"--stats", "nosuch"}},
        {renderVase({"--out", "loop.png"}), kFailed, {"--out", "loop.png", "in a circle"}},
        {renderVase({"--out", "b.png", "--stats", "loop.png"}),
         kFailed,
         {"--stats", "in a circle"}},
        {fly("f_%d.png", {}), kFailed, {"--flythrough: flight.json:2: keys: must be an array"}},
    });
    writeFile("flight.json", kResting);
    expectRefusals({
        {fly("no/such/f.mp4", {}), kFailed, {"--out", "no/such"}},
        {fly("f.mp4", {"--ffmpeg", "no/such/ffmpeg"}), kFailed, {"--ffmpeg", "no/such/ffmpeg"}},
    });
    const char* path = std::getenv("PATH"); // NOLINT(concurrency-mt-unsafe)
    const std::string before = path ? path : "";
    setenv("PATH", "/nowhere", 1); // NOLINT(concurrency-mt-unsafe)
    expectRefusal(fly("f.mp4", {}), kFailed, {"package ffmpeg", "--ffmpeg"});
    setenv("PATH", before.c_str(), 1); // NOLINT(concurrency-mt-unsafe)
}

TEST_F(Cli, AFolderWithoutPermissionIsRefused) {
    requirePermissions();
    if (IsSkipped())
        return;
    fs::create_directory(path("locked"));
    chmod(path("locked").c_str(), 0500);
    expectRefusal(renderVase({"--out", "locked/a.png"}), kFailed, {"--out", "locked"});
    chmod(path("locked").c_str(), 0700);
}

TEST_F(Cli, BenchExplainsHowItsProgramIsBuiltWhereThereIsNone) {
    isolateProgram();
    expectRefusal(
        {"bench", "--suite", "paper", "--out", path("x")},
        kFailed,
        {"bench is a program of its own and was not built", "--target shutter_bench"}
    );
    expectPrinted({"--help"}, {"bench"});
}

class CliScenes : public Cli {
  protected:
    void SetUp() override { requireDevice(); }

    [[nodiscard]] static Arguments draw(const std::string& scene, const Arguments& more = {}) {
        const Arguments arguments = {"render", scene, "--size", "32x18", "--out", "a.png"};
        return join(join(arguments, kOnSoftware), more);
    }
};

TEST_F(CliScenes, AnUnknownNameIsAnsweredWithThoseThereAre) {
    const std::string scene = SHUTTER_ASSETS "/courtyard.glb";
    const auto on = [](const char* device) {
        return Arguments{
            "render", SHUTTER_ASSETS "/vase.glb", "--out", "a.png", "--device", device};
    };
    expectRefusals({
        {on("nosuch"), kFailed, {"--device", "nosuch", "llvmpipe"}},
        {on("99"), kFailed, {"--device", "99", "llvmpipe"}},
        {draw(scene, {"--camera", "nosuch"}),
         kFailed,
         {"--camera", "courtyard.glb", "nosuch", "pan"}},
        {draw(scene, {"--camera=99"}), kFailed, {"--camera", "99", "pan"}},
        {draw(scene, {"--clip", "nosuch"}), kFailed, {"--clip", "nosuch", "camera_pan_linear"}},
    });
}

TEST_F(CliScenes, AMethodIsRefusedByNameWhereTheTierOfRaysThatItNeedsIsHidden) {
    const auto by = [&](const char* method, const char* rays) {
        return draw(SHUTTER_ASSETS "/vase.glb", {"--method", method, "--rays", rays});
    };
    expectRefusals({
        {by("hybrid", "none"), kFailed, {"hybrid", "VK_KHR_ray_query"}},
        {by("truth", "none"), kFailed, {"truth", "VK_KHR_ray_query"}},
        {by("truth", "pipeline"), kFailed, {"truth", "VK_KHR_ray_query"}},
        {by("denoised", "pipeline"), kFailed, {"denoised", "VK_KHR_ray_query"}},
    });
    expectSuccess(by("gather", "none"));
    expectSuccess(by("hybrid", "pipeline"));
}

TEST_F(CliScenes, ASceneThatCannotBeDrawnIsRefusedByRenderAndInfo) {
    writeFile("text.gltf", "a shopping list\n");
    writeFile("missing.gltf", makeTriangle("points.bin"));
    for (const auto& [file, mention] :
         {std::pair{"nosuch.glb", "nosuch.glb"},
          {"text.gltf", "text.gltf"},
          {"missing.gltf", "points.bin"}})
        expectRefusals({
            {draw(file, {"--stats", "s.json"}), kFailed, {file, mention}},
            {{"info", file}, kFailed, {file, mention}},
        });
}

TEST_F(CliScenes, AFileOutsideTheFolderIsReadOnlyWhereThatIsAllowed) {
    fs::create_directory(path("sub"));
    writeFile("sub/scene.gltf", makeTriangle("../points.bin"));
    writeFile("points.bin", std::string(36, '\0'));
    expectRefusal(draw("sub/scene.gltf"), kFailed, {"sub/scene.gltf", "../points.bin", "leaves"});
    expectRefusal({"info", "sub/scene.gltf"}, kFailed, {"sub/scene.gltf", "leaves"});
    expectSuccess({"info", "sub/scene.gltf", "--allow-outside"});
}

TEST_F(CliScenes, AMisspeltMemberOfTheExtrasIsWarnedOfWithItsFile) {
    writeFile(
        "misspelt.gltf",
        R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"camera": 0}], "cameras": [{"type": "perspective",
        "perspective": {"yfov": 0.7, "znear": 0.1}, "extras": {"lens": {"fstop": 2}, "id": 3}}]})"
    );
    const Outcome drawn = run(draw("misspelt.gltf", {"--method", "sharp"}));
    EXPECT_EQ(drawn.status, 0);
    EXPECT_EQ(
        drawn.err,
        "shutter: warning: misspelt.gltf: cameras[0].extras.lens has a member 'fstop': not used\n"
    );
}

TEST_F(CliScenes, AnEnvironmentThatIsNoneIsRefused) {
    image::Image picture(64, 32, 3);
    picture.channelNames = {"N.x", "N.y", "N.z"};
    ASSERT_TRUE(io::writeImage(path("normals.exr"), picture));
    picture.channelNames = {};
    ASSERT_TRUE(io::writeImage(path("part.exr"), picture));
    ASSERT_TRUE(io::writeImage(path("square.exr"), image::Image(64, 64, 3)));
    std::string exr = readFile("part.exr");
    const std::string window("displayWindow\0box2i\0\x10\0\0\0", 24);
    const size_t right = exr.find(window) + window.size() + 8;
    exr[right] = 127;
    exr[right + 4] = 63;
    writeFile("part.exr", exr);
    writeFile("text.hdr", "no picture");
    for (const auto& [file, mention] :
         {std::pair{"missing.hdr", "missing.hdr"},
          {"text.hdr", "text.hdr"},
          {"square.exr", "64x64"},
          {"normals.exr", "no colour but N.x, N.y, N.z"},
          {"part.exr", "display window"}})
        expectRefusal(
            renderVase({"--out", "a.png", "--environment", file}),
            kFailed,
            {"--environment", mention}
        );
}

} // namespace shutter::cli
