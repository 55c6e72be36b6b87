// SPDX-License-Identifier: MIT
// Flythroughs and films as a person renders them: the same bits each time, stopped or not.
#include "engine/io/image_file.h"
#include "tests/cli/cli_fixture.h"
#include "tests/cli/folder_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <sys/stat.h>
#include <utility>

namespace shutter::cli {

namespace {

/// Six frames at 4 a second; the lens zooms and the camera is cut.
constexpr const char* kFlight = R"({
  "version": 1, "fps": 4, "keys": [
    {"time": -0.5, "position": [-0.6, 1.2, 2.3], "lookAt": [0, 0.8, -0.8], "fieldOfView": 40,
     "shutter": {"exposure": 0.02}},
    {"time": 0.25, "position": [-0.4, 1.1, 2.2], "lookAt": [0, 0.8, -0.8], "fieldOfView": 30},
    {"time": 0.5, "position": [0.4, 1.1, 2.0], "lookAt": [0, 0.8, -0.8], "fieldOfView": 35,
     "cut": true, "shutter": {"shutterAngle": 20, "phase": "centre"}},
    {"time": 0.75, "position": [0.5, 1.0, 2.0], "lookAt": [0, 0.8, -0.8], "fieldOfView": 32}
  ]
})";

class Sequence : public Cli {
  protected:
    Sequence() { writeFile("flight.json", kFlight); }

    void SetUp() override { requireDevice(); }

    [[nodiscard]] Arguments fly(const Arguments& more) const {
        return renderVase(join({"--flythrough", "flight.json"}, more));
    }

    [[nodiscard]] std::vector<std::string> readFrames(const std::string& folder) const {
        std::vector<std::string> frames;
        for (int frame = -2; frame <= 3; ++frame)
            frames.push_back(readFile(fmt::format("{}/f_{:04}.png", folder, frame)));
        return frames;
    }

    /// What ffprobe prints of entries of a film's stream.
    [[nodiscard]] std::string
    probe(const std::string& film, const std::string& entries, const char* more = "") const {
        const std::string command = fmt::format(
            "ffprobe -v error {} -select_streams v:0 -show_entries {} -of csv=p=0 '{}' > '{}'",
            more,
            entries,
            path(film),
            path("probe.txt")
        );
        EXPECT_EQ(std::system(command.c_str()), 0); // NOLINT(concurrency-mt-unsafe)
        return readFile("probe.txt");
    }

    void expectFilm(const std::string& file, const std::string& frames) const {
        EXPECT_EQ(
            probe(file, "stream=nb_read_frames,width,height,pix_fmt", "-count_frames"),
            "64,36,yuv420p," + frames + "\n"
        );
    }

    /// A program in place of ffmpeg, which encodes as `encodes` does.
    void writeEncoder(const std::string& name, const std::string& encodes) const {
        writeFile(
            name,
            "#!/bin/sh\ncase \"$1\" in\n-version) echo ffmpeg version 1;;\n"
            "-hide_banner) echo ' V libx264 x';;\n*) " +
                encodes + ";;\nesac\n"
        );
        fs::permissions(path(name), fs::perms::owner_all);
    }
};

bool hasFfmpeg(const std::string& encoder = "libx264") {
    const std::string command = "command -v ffmpeg ffprobe > /dev/null && "
                                "ffmpeg -v quiet -encoders | grep -q ' " +
                                encoder + " '";
    return std::system(command.c_str()) == 0; // NOLINT(concurrency-mt-unsafe)
}

} // namespace

TEST_F(Sequence, AMethodWithoutALensReportsThatItDrawsAPinhole) {
    const auto write = [&](const std::string& lens) {
        writeFile(
            "flight.json",
            R"({"version": 1, "keys": [{"time": 0, "position": [0, 1, 2], "lookAt": [0, 1, 0], )" +
                lens + "}]}"
        );
    };
    write(R"("focusDistance": 2, "fStop": 0.5)");
    expectWarned(fly({"--out", "f_%04d.png"}), "method sharp draws the camera as a pinhole");
    const auto with = [&](const std::string& out, const Arguments& more) {
        return fly(join({"--method", "accumulate", "--samples", "4", "--out", out}, more));
    };
    expectSuccess(with("open_%d.png", {}));
    expectSuccess(with("option_%d.png", {"--focus", "2", "--fstop", "0.5"}));
    expectSuccess(with("closed_%d.png", {"--fstop", "0"}));
    EXPECT_EQ(readFile("open_0.png"), readFile("option_0.png"));
    EXPECT_NE(readFile("open_0.png"), readFile("closed_0.png"));
    expectRefusal(with("auto_%d.png", {"--instants", "auto"}), 1, {"--instants auto", "--fstop 0"});
    write(R"("focusDistance": 2)");
    expectWarned(with("pinhole_%d.png", {}), "focusDistance of the flythrough has no effect");
    EXPECT_EQ(readFile("pinhole_0.png"), readFile("closed_0.png"));
    write(R"("fStop": 0.5)");
    expectSuccess(with("far_%d.png", {"--focus", "100"}));
    EXPECT_NE(readFile("far_0.png"), readFile("open_0.png"));
    write(R"("focusDistance": 0)");
    expectRefusal(with("bad_%d.png", {}), 1, {"flight.json", "keys[0].focusDistance"});
    write(R"("cut": false)");
    expectRefusal(with("none_%d.png", {"--focus", "2"}), 1, {"--focus needs --fstop"});
}

/// A triangle that drifts three metres in a second, and no camera: one made to fit depends on when
/// it is made. glTF, to be written to a file.
constexpr const char* kDriftingScene =
    R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
             "min": [-1, -1, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR",
             "min": [0], "max": [1]},
            {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 8},
            {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
        "animations": [{"name": "drift", "samplers": [{"input": 1, "output": 2}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}],
        "buffers": [{"byteLength": 68, "uri": "data:application/octet-stream;base64,)"
    "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAA"
    "AAAAAAAAAAAAAEBAAAAAAAAAAAA="
    R"("}]})";

/// kDriftingScene with a camera that may focus on its triangle, which drifts away from it in front
/// of a static one.
std::string makeFocusScene(const std::string& camera) {
    std::string scene = kDriftingScene;
    const auto replace = [&](std::string_view from, const std::string& to) {
        const size_t at = scene.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        scene.replace(at, from.size(), to);
    };
    replace(R"("scenes": [{"nodes": [0]}])", R"("scenes": [{"nodes": [0, 3, 4]}])");
    replace(
        R"("nodes": [{"mesh": 0}])",
        R"("nodes": [{"rotation": [0, 0.7071068, 0, 0.7071068], "children": [1]},
            {"name": "drifter", "children": [2]},
            {"mesh": 0, "rotation": [0, -0.7071068, 0, 0.7071068]},
            {"mesh": 0, "translation": [0.7, 0.4, -6], "scale": [2, 2, 2]},
            {"camera": 0, "translation": [0.3, 0.2, 3]}], "cameras": [)" +
            camera + "]"
    );
    replace(R"("target": {"node": 0)", R"("target": {"node": 1)");
    return scene;
}

TEST_F(Sequence, AFocusedNodeGivesEachFrameTheSameBitsWhicheverAreDrawnBefore) {
    const auto write = [&](const std::string& more) {
        writeFile(
            "focus.gltf",
            makeFocusScene(
                R"({"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.1},
                    "extras": {"lens": {"fStop": 0.05, )" +
                more + "}}}"
            )
        );
    };
    const auto draw = [&](const std::string& frames, const std::string& out, const Arguments& more
                      ) {
        Arguments arguments = {
            "render",
            "focus.gltf",
            "--size",
            "64x36",
            "--method",
            "accumulate",
            "--samples",
            "16",
            "--exposure",
            "0.02",
            "--fps",
            "8",
            "--frames",
            frames,
            "--out",
            out};
        return join(join(arguments, kOnSoftware), more);
    };
    write(R"("focusNode": "drifter", "focusHalfLife": 0.1)");
    expectSuccess(draw("0:6", "whole_%d.png", {}));
    expectSuccess(draw("0:6", "part_%d.png", {"--part", "2/2"}));
    expectSuccess(draw("4:4", "alone_%d.png", {}));
    const auto expectSame = [&](const char* a, const char* b, const std::vector<int>& numbers) {
        for (const int frame : numbers)
            EXPECT_TRUE(
                readFile(fmt::format("{}_{}.png", a, frame)) ==
                readFile(fmt::format("{}_{}.png", b, frame))
            ) << a
              << frame;
    };
    expectSame("part", "whole", {1, 3, 5});
    expectSame("alone", "whole", {4});
    // It begins in focus; later the distance lags behind the node.
    expectSuccess(draw("0:6", "near_%d.png", {"--focus", "3"}));
    expectSame("near", "whole", {0});
    EXPECT_TRUE(readFile("near_4.png") != readFile("whole_4.png"));
    write(R"("focusDistance": 3)");
    expectSuccess(draw("0:6", "fixed_%d.png", {}));
    expectSame("fixed", "near", {4});
    // The option focuses as a node of the file does.
    write(R"("focusDistance": 9)");
    expectSuccess(draw("0:6", "entity_%d.png", {"--focus-entity", "drifter"}));
    write(R"("focusNode": "drifter")");
    expectSuccess(draw("0:6", "node_%d.png", {}));
    expectSame("entity", "node", {0, 4, 6});
    expectRefusal(
        draw("0:6", "bad_%d.png", {"--focus-entity", "nobody"}),
        1,
        {"focus.gltf", "--focus-entity 'nobody' is the name of no node"}
    );
    write(R"("focusNode": "nobody")");
    expectRefusal(
        draw("0:6", "bad_%d.png", {}), 1, {"focus.gltf", "extras.lens.focusNode 'nobody'"}
    );
    writeFile(
        "focus.gltf",
        makeFocusScene(
            R"({"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 2, "znear": 0.1, "zfar": 20}})"
        )
    );
    for (const auto& [option, value] : {std::pair{"--fstop", "2"}, {"--focus-entity", "drifter"}})
        expectRefusal(
            draw("0:0", "ortho_%d.png", {option, value}),
            1,
            {fmt::format("{}: an orthographic camera has no focal length, so no lens", option)}
        );
}

TEST_F(Sequence, AFlythroughRenderedTwiceIsTheSameAndTheSecondTimeInOneFolderSkipped) {
    for (const char* folder : {"a", "b"}) {
        fs::create_directory(path(folder));
        const auto done = expectSuccess(fly(
            {"--method", "hybrid", "--aov", "motion", "--out", std::string(folder) + "/f_%04d.png"}
        ));
        EXPECT_EQ(done.out, "");
    }
    const auto frames = readFrames("a");
    EXPECT_TRUE(frames == readFrames("b"));
    EXPECT_EQ(std::set<std::string>(frames.begin(), frames.end()).size(), frames.size());
    EXPECT_TRUE(readFile("a/f_0001.motion.exr") == readFile("b/f_0001.motion.exr"));

    const Arguments again = fly({"--method", "hybrid", "--aov", "motion", "--out", "a/f_%04d.png"});
    EXPECT_NE(expectSuccess(again).out.find("6 of 6 frames are complete"), std::string::npos);
    // Only changed files are drawn again.
    writeFile("a/f_0000.png", "another picture");
    fs::remove(path("a/f_0001.motion.exr"));
    EXPECT_NE(expectSuccess(again).out.find("4 of 6 frames are complete"), std::string::npos);
    EXPECT_TRUE(readFrames("a") == frames);
    EXPECT_TRUE(readFile("a/f_0001.motion.exr") == readFile("b/f_0001.motion.exr"));
    // Options that report on drawing force it.
    Arguments measured = again;
    measured.insert(measured.end(), {"--stats", "s.json"});
    EXPECT_EQ(expectSuccess(measured).out, "");
    EXPECT_NE(readFile("s.json").find("\"time_s\": 0.75"), std::string::npos);
}

TEST_F(Sequence, ChangedOptionsRedrawAllFramesWithAMessage) {
    expectSuccess(fly({"--frames", "0:1", "--out", "f_%04d.png"}));
    const std::string first = readFile("f_0001.png");
    // More frames of the same film: those there are kept.
    expectPrinted(fly({"--frames", "0:2", "--out", "f_%04d.png"}), {"2 of 3 frames are complete"});
    const Arguments unlit = fly({"--frames", "0:1", "--unlit", "--out", "f_%04d.png"});
    EXPECT_EQ(expectPrinted(unlit, {"drawn otherwise"}).find("complete"), std::string::npos);
    EXPECT_TRUE(readFile("f_0001.png") != first);
    // So does another flight under the same name.
    std::string other = kFlight;
    other.replace(other.find("0.25"), 4, "0.26");
    writeFile("flight.json", other);
    expectPrinted(unlit, {"drawn otherwise"});
}

TEST_F(Sequence, ACameraMadeToFitFitsWhenRequested) {
    writeFile("drifting.gltf", kDriftingScene);
    const auto draw = [&](const Arguments& more) {
        Arguments arguments = {"render", "drifting.gltf", "--size", "64x36", "--method", "sharp"};
        arguments.insert(arguments.end(), kOnSoftware.begin(), kOnSoftware.end());
        arguments.insert(arguments.end(), more.begin(), more.end());
        return expectSuccess(arguments).out;
    };
    draw({"--time", "1", "--out", "fitted.png"});
    draw({"--time", "1", "--framing-time", "1", "--out", "same.png"});
    draw({"--time", "1", "--framing-time", "0", "--out", "other.png"});
    EXPECT_TRUE(readFile("same.png") == readFile("fitted.png"));
    EXPECT_TRUE(readFile("other.png") != readFile("fitted.png"));
    // A frame that another camera drew is drawn again.
    draw({"--fps", "2", "--frames", "1:2", "--out", "f_%d.png"});
    const std::string own = readFile("f_2.png");
    const std::string printed = draw({"--fps", "2", "--frames", "0:2", "--out", "f_%d.png"});
    EXPECT_NE(printed.find("drawn otherwise"), std::string::npos) << printed;
    EXPECT_TRUE(readFile("f_2.png") != own);
    EXPECT_TRUE(readFile("f_2.png") == readFile("other.png"));
}

TEST_F(Sequence, AKilledAndRestartedRunLeavesTheSameFiles) {
    fs::create_directory(path("whole"));
    expectSuccess(fly({"--out", "whole/f_%04d.png"}));
    const auto whole = readFrames("whole");
    // The journal is two events, its temporary file and the rename, and so is each picture: an odd
    // number falls between them, an even one before the next picture.
    for (const int events : {3, 6}) {
        const std::string folder = std::to_string(events);
        fs::create_directory(path(folder));
        const Arguments arguments = fly({"--out", folder + "/f_%04d.png"});
        const FolderWatch watch(path(folder));
        const pid_t process = start(arguments);
        watch.waitFor(events, process);
        EXPECT_EQ(stop(process, SIGKILL).status, kKilled) << "it ended by itself";
        // What has a picture's name is a whole one.
        const auto left = readFrames(folder);
        const auto isThere = [](const std::string& frame) { return !frame.empty(); };
        const auto drawn = size_t(std::count_if(left.begin(), left.end(), isThere));
        EXPECT_GE(drawn, size_t(events / 2 - 1));
        EXPECT_LT(drawn, whole.size()) << "it was killed too late";
        for (size_t i = 0; i < left.size(); ++i)
            EXPECT_TRUE(left[i].empty() || left[i] == whole[i]) << i;
        expectSuccess(arguments);
        EXPECT_TRUE(readFrames(folder) == whole) << events;
    }
}

TEST_F(Sequence, NoiseThatTurnsIsTheSameAfterAStop) {
    std::string open = kFlight; // long enough for noise
    open.replace(open.find("0.02"), 4, "0.25");
    writeFile("flight.json", open);
    const auto draw = [&](const std::string& noise, const Arguments& more) {
        const Arguments set = {"--set", "instantNoise=" + noise};
        expectSuccess(fly(join(join({"--method", "resolved", "--samples", "2"}, set), more)));
    };
    for (const char* folder : {"fixed", "whole", "stopped"})
        fs::create_directory(path(folder));
    draw("fixed", {"--out", "fixed/f_%04d.png"});
    draw("per_frame", {"--out", "whole/f_%04d.png"});
    draw("per_frame", {"--frames", "-2:-1", "--out", "stopped/f_%04d.png"});
    draw("per_frame", {"--out", "stopped/f_%04d.png"});
    EXPECT_TRUE(readFrames("whole") == readFrames("stopped"));
    EXPECT_TRUE(readFrames("whole") != readFrames("fixed"));
}

TEST_F(Sequence, AFilmHasEveryFrameAndIsTheSameEachTime) {
    if (!hasFfmpeg())
        GTEST_SKIP() << "ffmpeg is not installed";
    const Arguments film = fly({"--out", "film.mp4"});
    expectSuccess(film);
    expectFilm("film.mp4", "6");
    EXPECT_FALSE(fs::exists(path("film.mp4.frames")));
    const std::string bytes = readFile("film.mp4");
    expectPrinted(film, {"film.mp4 is complete"});
    expectSuccess(join(film, {"--restart", "--keep-frames"}));
    EXPECT_TRUE(readFile("film.mp4") == bytes);
    EXPECT_TRUE(fs::exists(path("film.mp4.frames/frame_000005.png")));
    // The frames that were kept are those of a film of which less is there.
    fs::remove(path("film.mp4"));
    fs::remove(path("film.mp4.frames/frame_000002.png"));
    expectPrinted(film, {"5 of 6 frames are complete"});
    EXPECT_TRUE(readFile("film.mp4") == bytes);
    EXPECT_FALSE(fs::exists(path("film.mp4.frames")));
}

TEST_F(Sequence, FilmsAreEncodedByTheCodecThatIsNamed) {
    if (!hasFfmpeg("libaom-av1"))
        GTEST_SKIP() << "ffmpeg with libaom-av1 is not installed";
    const auto draw = [&](const std::string& file, const Arguments& more) {
        expectSuccess(fly(join({"--fps", "24", "--frames", "0:1", "--out", file}, more)));
        return probe(file, "stream=codec_name,pix_fmt:stream_tags=timecode");
    };
    EXPECT_EQ(draw("eight.mp4", {"--codec", "av1"}), "av1,yuv420p\n");
    EXPECT_EQ(
        draw("ten.mp4", {"--bit-depth", "10", "--timecode", "01:02:03:01"}),
        "h264,yuv420p10le,01:02:03:01\n"
    );
    EXPECT_EQ(
        draw("prores.mov", {"--codec", "prores", "--timecode", "frame", "--keep-frames"}),
        "prores,yuv422p10le,00:00:00:00\n"
    );
    // Frames of sixteen bits: those of eight would leave the lower half empty.
    const auto frame = io::readImage(path("prores.mov.frames/frame_000001.png"));
    ASSERT_TRUE(frame.ok()) << frame.error().message;
    const auto& values = frame.value().pixels;
    EXPECT_TRUE(std::any_of(values.begin(), values.end(), [](float value) {
        return std::abs(value * 255.0f - std::round(value * 255.0f)) > 0.1f;
    }));
    expectFailure(fly({"--out", "late.mp4", "--timecode", "00:00:00:04"}), "a second has 4 frames");
}

TEST_F(Sequence, PicturesOfExrCarryTheTimeCodesOfTheirFrames) {
    // Name, type and size of the attribute; then the digits of frames, seconds, minutes, hours.
    const std::string attribute("timeCode\0timecode\0\x08\0\0\0", 22);
    const auto readCode = [&](const std::string& file) {
        const std::string bytes = readFile(file);
        const size_t place = bytes.find(attribute);
        EXPECT_NE(place, std::string::npos) << file;
        return place == std::string::npos ? "" : bytes.substr(place + attribute.size(), 4);
    };
    expectSuccess(fly({"--out", "f_%d.exr", "--timecode", "12:34:56:03", "--aov", "depth"}));
    EXPECT_EQ(readCode("f_-2.depth.exr"), "\x03\x56\x34\x12");
    EXPECT_EQ(readCode("f_-2.exr"), "\x03\x56\x34\x12");
    EXPECT_EQ(readCode("f_-1.exr"), std::string("\0\x57\x34\x12", 4));
    EXPECT_EQ(readCode("f_3.exr"), std::string("\0\x58\x34\x12", 4));
    // A sequence with another time code is another: nothing of this one is taken for complete.
    expectPrinted(fly({"--out", "f_%d.exr", "--timecode", "00:00:00:00"}), {"all are drawn again"});
    EXPECT_EQ(readCode("f_-2.exr"), std::string(4, '\0'));
    expectFailure(fly({"--out", "g_%d.exr", "--timecode", "frame"}), "frame -2 has none");
}

TEST_F(Sequence, ARateThatIsAFractionIsThatOfTheFilmAndOfItsPictures) {
    // Name, type and size of the attribute; then 24000 and 1001.
    const std::string rate("framesPerSecond\0rational\0\x08\0\0\0\xC0\x5D\0\0\xE9\x03\0\0", 37);
    expectSuccess(
        fly({"--fps", "24000/1001", "--frames", "0:1", "--out", "f_%d.exr", "--aov", "depth"})
    );
    EXPECT_NE(readFile("f_1.exr").find(rate), std::string::npos);
    EXPECT_NE(readFile("f_1.depth.exr").find(rate), std::string::npos);
    expectSuccess(renderVase({"--method", "sharp", "--out", "single.exr"}));
    EXPECT_EQ(readFile("single.exr").find("framesPerSecond"), std::string::npos);
    std::string flight = kFlight;
    flight.replace(flight.find("\"fps\": 4"), 8, "\"fps\": \"24000/1001\"");
    writeFile("flight.json", flight);
    expectSuccess(fly({"--frames", "0:0", "--out", "g_%d.exr"}));
    EXPECT_NE(readFile("g_0.exr").find(rate), std::string::npos);
    if (!hasFfmpeg())
        GTEST_SKIP() << "ffmpeg is not installed";
    for (const auto& [fps, expected] :
         {std::pair{"24000/1001", "24000/1001"}, {"29.97", "2997/100"}}) {
        expectSuccess(fly({"--fps", fps, "--frames", "0:3", "--out", "film.mp4"}));
        EXPECT_EQ(probe("film.mp4", "stream=r_frame_rate"), std::string(expected) + "\n");
    }
}

TEST_F(Sequence, AFolderWithANumberPatternInItsNameIsAFolderLikeAnyOther) {
    const std::string folder = "%d day 100%% -50%20off Größe_🎥\n";
    fs::create_directory(path(folder));
    const Arguments drawn = fly({"--frames", "0:1", "--out", folder + "/p %s_%04d.png"});
    expectSuccess(drawn);
    for (const char* frame : {"/p %s_0000.png", "/p %s_0001.png"})
        EXPECT_TRUE(fs::exists(path(folder) + frame)) << frame;
    expectPrinted(drawn, {"2 of 2 frames are complete"});
    if (!hasFfmpeg())
        GTEST_SKIP() << "ffmpeg is not installed";
    expectSuccess(fly({"--frames", "0:1", "--out", folder + "/film_%d.mp4"}));
    expectFilm(folder + "/film_%d.mp4", "2");
    EXPECT_FALSE(fs::exists(path(folder + "/film_%d.mp4.frames")));
}

TEST_F(Sequence, ALinkThatIsAFilmStaysALink) {
    if (!hasFfmpeg())
        GTEST_SKIP() << "ffmpeg is not installed";
    fs::create_directory(path("store"));
    writeFile("store/real.mp4", "old");
    fs::permissions(path("store/real.mp4"), fs::perms(0640));
    fs::create_symlink("store/real.mp4", path("film.mp4"));
    expectSuccess(fly({"--frames", "0:1", "--out", "film.mp4"}));
    EXPECT_TRUE(fs::is_symlink(path("film.mp4")));
    expectFilm("store/real.mp4", "2");
    EXPECT_EQ(fs::status(path("store/real.mp4")).permissions(), fs::perms(0640));
    ASSERT_EQ(::mkfifo(path("pipe.mp4").c_str(), 0600), 0);
    expectFailure(
        fly({"--frames", "0:1", "--out", "pipe.mp4"}), "pipe or a device, and a film needs a file"
    );
    EXPECT_TRUE(fs::is_fifo(path("pipe.mp4")));
}

TEST_F(Sequence, AnFfmpegThatFailsOrComplainsLeavesNoFilm) {
    writeEncoder("failing.sh", "echo first >&2; echo no room >&2; exit 3");
    expectFailure(
        fly({"--out", "film.mp4", "--ffmpeg", path("failing.sh")}), "ended with status 3: no room"
    );
    EXPECT_FALSE(fs::exists(path("film.mp4")));
    EXPECT_TRUE(fs::exists(path("film.mp4.frames/frame_000005.png"))) << "they may be encoded yet";
    // It ends well, but half of the film is missing.
    writeFile("film.mp4", "the one before");
    writeEncoder(
        "lying.sh",
        "for last; do :; done; echo half > \"${last#file:}\"; echo disk is full >&2; exit 0"
    );
    expectFailure(fly({"--out", "film.mp4", "--ffmpeg", path("lying.sh")}), "disk is full");
    EXPECT_EQ(readFile("film.mp4"), "the one before");
    EXPECT_TRUE(fs::exists(path("film.mp4.frames/frame_000001.png")));
}

TEST_F(Sequence, AClipOfTheSceneFliesItsCamera) {
    Arguments clip =
        renderVase({"--flythrough", "clip:camera_pan_linear", "--fps", "2", "--out", "f_%d.png"});
    clip[1] = SHUTTER_ASSETS "/courtyard.glb";
    expectSuccess(clip);
    EXPECT_TRUE(readFile("f_0.png") != readFile("f_1.png"));
    EXPECT_TRUE(fs::exists(path("f_2.png")));
    EXPECT_FALSE(fs::exists(path("f_3.png"))) << "the clip lasts a second";
    expectRefusal(
        join(clip, {"--camera", "main"}), 1, {"clip:camera_pan_linear moves no camera 'main'"}
    );
    *std::find(clip.begin(), clip.end(), "clip:camera_pan_linear") = "clip:nothing";
    expectRefusal(clip, 1, {"clip:nothing", "camera_pan_linear"});
}

} // namespace shutter::cli
