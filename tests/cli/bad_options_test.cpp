// SPDX-License-Identifier: MIT
// Wrong usage: exit status 2 and a sentence that names the option. No device is opened for it.
// Which values an option refuses is tested without a process for each (tests/unit/options).
#include "tests/cli/cli_fixture.h"

#include <fmt/format.h>

#include <sys/stat.h>
#include <utility>

namespace shutter::cli {

TEST_F(Cli, AMissingSubcommandIsWrongUsage) {
    expectRefusal({}, kUsage, {"subcommand"});
    expectRefusal({"nosuch"}, kUsage, {"subcommand"});
}

TEST_F(Cli, RenderNeedsASceneAndAnOutput) {
    expectRefusal({"render"}, kUsage, {"scene"});
    expectRefusal({"render", "scene.glb"}, kUsage, {"--out"});
}

TEST_F(Cli, AnUnknownOptionIsNamed) {
    expectRefusal(renderVase({"--out", "a.png", "--nosuch"}), kUsage, {"--nosuch"});
    expectRefusal({"info", "--nosuch"}, kUsage, {"--nosuch"});
    expectRefusal({"compare", "a", "b", "--nosuch"}, kUsage, {"--nosuch"});
}

TEST_F(Cli, AnOptionThatIsGivenTwiceIsRefused) {
    expectRefusal(renderVase({"--out", "a.png", "--size", "5x5"}), kUsage, {"--size"});
}

TEST_F(Cli, AValueThatAnOptionDoesNotTakeIsRefusedByName) {
    struct Bad {
        const char* option;
        const char* value;
        const char* mention;
    };

    for (const Bad& bad :
         {Bad{"--time", "1x", "1x"},
          Bad{"--samples", "", ""},
          Bad{"--samples", "257", "257"},
          Bad{"--exposure", "nan", "nan"},
          Bad{"--background", "-1,0,0", "-1,0,0"},
          Bad{"--method", "nosuch", "nosuch"},
          Bad{"--aov", "motion,nosuch", "nosuch"},
          Bad{"--frames", "nosuch", "nosuch"},
          Bad{"--set", "nosuch=1", "nosuch"},
          Bad{"--set", "edgeThreshold=1", "edgeThreshold"}}) // another method's
        expectRefusal(
            renderVase({"--out", "a.png", fmt::format("{}={}", bad.option, bad.value)}),
            kUsage,
            {bad.option, bad.mention}
        );
}

TEST_F(Cli, OptionsThatExcludeEachOtherAreRefused) {
    expectRefusal(
        renderVase({"--out", "a.png", "--exposure", "0.1", "--shutter-angle", "180"}),
        kUsage,
        {"--exposure", "--shutter-angle"}
    );
    expectRefusal(
        renderVase({"--out", "a_%04d.png", "--time", "1", "--frames", "0:1"}),
        kUsage,
        {"--time", "--frames"}
    );
}

TEST_F(Cli, FramesThatRunBackwardsOrHaveOneFileAreRefused) {
    expectRefusal(renderVase({"--out", "a_%04d.png", "--frames", "5:1"}), kUsage, {"--frames"});
    expectRefusal(
        renderVase({"--out", "a.png", "--frames", "0:1"}), kUsage, {"--out", "a.png", "%04d"}
    );
}

TEST_F(Cli, AnOutputThatCannotBeWrittenIsRefusedBeforeDrawing) {
    writeFile("file", "");
    fs::create_directory(path("folder.png"));
    for (const char* out : {"nosuch/a.png", "file/a.png", "folder.png"})
        expectRefusal(renderVase({"--out", out}), kFailed, {"--out", out});
    expectRefusal(
        renderVase({"--out", "a.png", "--stats", "nosuch/s.json"}), kFailed, {"--stats", "nosuch"}
    );
}

TEST_F(Cli, AnUnknownPictureFormatIsRefused) {
    for (const char* out : {"a.bmp", "a"})
        expectRefusal(renderVase({"--out", out}), kUsage, {"--out", out});
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

TEST_F(Cli, AnUnknownDeviceIsAnsweredWithThoseThereAre) {
    requireDevice();
    if (IsSkipped())
        return;
    for (const char* device : {"nosuch", "99", "-1"})
        expectRefusal(
            {"render",
             SHUTTER_ASSETS "/vase.glb",
             "--out",
             "a.png",
             fmt::format("--device={}", device)},
            kFailed,
            {"--device", device, "llvmpipe"}
        );
}

TEST_F(Cli, AMethodIsRefusedByNameWhereTheTierOfRaysThatItNeedsIsHidden) {
    requireDevice();
    if (IsSkipped())
        return;
    const auto arguments = [](const char* rays, const char* method) {
        return Arguments{
            "render",
            SHUTTER_ASSETS "/vase.glb",
            "--size",
            "32x18",
            "--out",
            "a.png",
            "--device",
            "llvmpipe",
            "--rays",
            rays,
            "--method",
            method};
    };
    expectRefusal(arguments("none", "hybrid"), kFailed, {"hybrid", "VK_KHR_ray_query"});
    expectRefusal(arguments("none", "truth"), kFailed, {"truth", "VK_KHR_ray_query"});
    expectRefusal(arguments("pipeline", "truth"), kFailed, {"truth", "VK_KHR_ray_query"});
    expectRefusal(arguments("pipeline", "denoised"), kFailed, {"denoised", "VK_KHR_ray_query"});
    expectSuccess(arguments("none", "gather"));
    expectSuccess(arguments("pipeline", "hybrid"));
}

TEST_F(Cli, AnUnknownCameraOrClipIsAnsweredWithThoseThereAre) {
    requireDevice();
    if (IsSkipped())
        return;
    const std::string scene = SHUTTER_ASSETS "/courtyard.glb";
    const auto arguments = [&](const std::string& option, const std::string& value) {
        return Arguments{
            "render",
            scene,
            "--size",
            "64x36",
            "--out",
            "a.png",
            "--device",
            "llvmpipe",
            fmt::format("{}={}", option, value)};
    };
    for (const char* camera : {"nosuch", "99", "-1"})
        expectRefusal(
            arguments("--camera", camera), kFailed, {"--camera", "courtyard.glb", camera, "pan"}
        );
    expectRefusal(
        arguments("--clip", "nosuch"), kFailed, {"--clip", "nosuch", "camera_pan_linear"}
    );
}

TEST_F(Cli, ASentenceStaysOneLineWhateverTheArgumentHolds) {
    expectRefusal(renderVase({"--out", "a.png", "--phase", "a\nb\x1b[31m"}), kUsage, {"--phase"});
    expectRefusal({"info", "no\nsuch.glb"}, kFailed, {"such.glb"});
}

} // namespace shutter::cli
