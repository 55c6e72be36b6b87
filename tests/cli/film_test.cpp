// SPDX-License-Identifier: MIT
// `shutter film`: drawn in parts, a film is the same bits as drawn by one process, stopped or not.
#include "tests/cli/cli_fixture.h"
#include "tests/cli/folder_watch.h"

#include <fmt/format.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/types.h>
#include <utility>
#include <vector>

namespace shutter::cli {

namespace {

/// Two triangles that drift to and fro against one another, one of glass, and particles that the
/// other one emits. No camera.
constexpr const char* kGlassScene =
    R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2]}],
        "nodes": [
            {"mesh": 0, "children": [3]},
            {"mesh": 1},
            {"children": [1], "translation": [2, 0.3, 0.5], "scale": [-1, 1, 1]},
            {"extras": {"particles": {
                "spans": [{"fromSeconds": -3, "perSecond": 30}], "lifeSeconds": 0.6,
                "lifeSpread": 0.5, "velocity": [0, 2, 0], "coneDegrees": 50, "sizeBirth": 0.3,
                "inherit": 1, "gravity": [0, -3, 0], "drag": 0.5}}}],
        "materials": [
            {"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.3, 0.2, 1]}},
            {"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.5, 0.9, 0.6]},
             "alphaMode": "BLEND", "doubleSided": true}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]},
                   {"primitives": [{"attributes": {"POSITION": 0}, "material": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
             "min": [-1, -1, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 7, "type": "SCALAR",
             "min": [0], "max": [6]},
            {"bufferView": 2, "componentType": 5126, "count": 7, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 28},
            {"buffer": 0, "byteOffset": 64, "byteLength": 84}],
        "animations": [{"name": "drift", "samplers": [{"input": 1, "output": 2}],
            "channels": [
                {"sampler": 0, "target": {"node": 0, "path": "translation"}},
                {"sampler": 0, "target": {"node": 1, "path": "translation"}}]}],
        "buffers": [{"byteLength": 148, "uri": "data:application/octet-stream;base64,)"
    "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAABA"
    "AABAQAAAgEAAAKBAAADAQAAAAAAAAAAAAAAAAAAAAEAAAAAAAAAAAAAAAAAAAAAA"
    "AAAAAAAAAEAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAEAAAAAAAAAAAAAAAAAAAAAA"
    "AAAAAA=="
    R"("}]})";

/// The processes that a process has started, and that run.
std::vector<pid_t> listChildren(pid_t process) {
    std::vector<pid_t> children;
    for (const auto& thread : fs::directory_iterator(fmt::format("/proc/{}/task", process))) {
        std::ifstream list(thread.path() / "children");
        for (pid_t child = 0; list >> child;)
            children.push_back(child);
    }
    return children;
}

/// Frames of the films: so many that a part is killed before it has drawn them all.
constexpr int kFrames = 24;

class Film : public Cli {
  protected:
    void SetUp() override {
        requireDevice();
        // No camera: one that each part made to fit its own first frame would differ.
        writeFile("glass.gltf", kGlassScene);
    }

    [[nodiscard]] static Arguments
    draw(const std::string& command, const std::string& out, const Arguments& more = {}) {
        Arguments arguments = {
            command,
            "glass.gltf",
            "--size",
            "64x36",
            "--method",
            "gather",
            "--fps",
            "4",
            "--frames",
            fmt::format("-1:{}", kFrames - 2),
            "--out",
            out};
        return join(join(arguments, kOnSoftware), more);
    }

    /// The frames of the film as one process draws them.
    [[nodiscard]] const std::vector<std::string>& drawWhole() const {
        static std::vector<std::string> frames;
        if (frames.empty()) {
            fs::create_directory(path("whole"));
            expectSuccess(draw("render", "whole/f_%d.exr"));
            frames = readFrames("whole");
        }
        return frames;
    }

    [[nodiscard]] std::vector<std::string> readFrames(const std::string& folder) const {
        std::vector<std::string> frames;
        for (int frame = 0; frame < kFrames; ++frame)
            frames.push_back(readFile(fmt::format("{}/f_{}.exr", folder, frame - 1)));
        return frames;
    }

    /// The processes that draw: children of those that a film's own process starts.
    [[nodiscard]] static std::vector<pid_t> listDrawing(pid_t film) {
        std::vector<pid_t> drawing;
        for (const pid_t child : listChildren(film))
            for (const pid_t own : listChildren(child))
                if (readName(own) == "shutter") // not what counts the frames that are done
                    drawing.push_back(own);
        return drawing;
    }

    static std::string readName(pid_t process) {
        std::ifstream file(fmt::format("/proc/{}/comm", process));
        std::string name;
        std::getline(file, name);
        return name;
    }
};

} // namespace

TEST_F(Film, AFilmDrawnInPartsEqualsThatOfOneProcess) {
    if (std::system("command -v ffmpeg > /dev/null") != 0) // NOLINT(concurrency-mt-unsafe)
        GTEST_SKIP() << "ffmpeg is not installed";
    expectSuccess(draw("render", "one.mp4", {"--keep-frames"}));
    const Arguments parts =
        draw("film", "parts.mp4", {"--jobs", "2", "--parts", "3", "--keep-frames"});
    EXPECT_EQ(expectSuccess(parts).out, "");
    EXPECT_TRUE(readFile("one.mp4") == readFile("parts.mp4"));
    std::set<std::string> frames;
    for (int frame = 0; frame < kFrames; ++frame) {
        const std::string name = fmt::format("frame_{:06}.png", frame);
        frames.insert(readFile("one.mp4.frames/" + name));
        EXPECT_TRUE(readFile("one.mp4.frames/" + name) == readFile("parts.mp4.frames/" + name))
            << frame;
    }
    EXPECT_GT(frames.size(), 1u) << "it moves";
    Arguments one = draw("render", "one.png", {"--explain"});
    one[9] = "9:9";
    expectPrinted(one, {"blended instants", "particles live in its exposure"});
    // Nothing of the parts is left, and both commands know the complete frames.
    EXPECT_FALSE(fs::exists(path("parts.mp4.parts")));
    for (const std::string& file : listFiles())
        EXPECT_EQ(file.find(".part_"), std::string::npos) << file;
    const std::string skipped = "parts.mp4 is complete, so it is skipped (--restart draws it)\n";
    EXPECT_EQ(expectSuccess(parts).out, skipped);
    EXPECT_EQ(expectSuccess(draw("render", "parts.mp4")).out, skipped);
}

TEST_F(Film, APartThatIsKilledGoesOnWhereItStopped) {
    fs::create_directory(path("parts"));
    const Arguments film = draw("film", "parts/f_%d.exr");
    const FolderWatch watch(path("parts"));
    const pid_t process = start(film);
    // The logs' folder, the part's journal and its temporary file, and two of each picture.
    watch.waitFor(7, process);
    for (const pid_t child : listDrawing(process))
        kill(child, SIGKILL);
    const Outcome killed = finish(process);
    EXPECT_EQ(killed.status, kFailed);
    EXPECT_NE(killed.err.find("part 1 ended with status 137"), std::string::npos) << killed.err;
    ASSERT_TRUE(fs::exists(path("parts/f_-1.exr")));
    ASSERT_FALSE(fs::exists(path(fmt::format("parts/f_{}.exr", kFrames - 2))))
        << "it was killed too late";
    const auto before = fs::last_write_time(path("parts/f_-1.exr"));

    // What draws may not change on the way.
    expectFailure(draw("film", "parts/f_%d.exr", {"--unlit"}), "were drawn otherwise");
    expectRefusal(
        draw("render", "parts/f_%d.exr", {"--unlit"}),
        kFailed,
        {"--out", "drawn otherwise", "--restart"}
    );

    expectSuccess(film);
    EXPECT_TRUE(readFrames("parts") == drawWhole());
    EXPECT_TRUE(fs::last_write_time(path("parts/f_-1.exr")) == before) << "it was drawn again";
    EXPECT_FALSE(fs::exists(path("parts/.f_%d.exr.parts")));
    expectPrinted(
        draw("render", "parts/f_%d.exr"), {fmt::format("{0} of {0} frames are complete", kFrames)}
    );
}

TEST_F(Film, PartsOfAnotherNumberTakeOverWhatWasDrawn) {
    fs::create_directory(path("parts"));
    EXPECT_EQ(expectSuccess(draw("render", "parts/f_%d.exr", {"--part", "2/3"})).out, "");
    const auto before = fs::last_write_time(path("parts/f_0.exr"));
    EXPECT_FALSE(fs::exists(path("parts/f_-1.exr")));
    EXPECT_FALSE(fs::exists(path("parts/f_1.exr")));
    // Every third of the frames 0, 2, 4, ... is complete.
    EXPECT_EQ(
        expectSuccess(draw("render", "parts/f_%d.exr", {"--part", "2/2"})).out,
        "parts/f_%d.exr: 4 of 12 frames are complete on disk and skipped (--restart draws them)\n"
    );
    expectSuccess(draw("film", "parts/f_%d.exr", {"--jobs", "2", "--parts", "5"}));
    EXPECT_TRUE(readFrames("parts") == drawWhole());
    EXPECT_TRUE(fs::last_write_time(path("parts/f_0.exr")) == before) << "it was drawn again";
    // With --restart, any program and device may draw it.
    expectSuccess(draw("film", "parts/f_%d.exr", {"--unlit", "--restart"}));
    EXPECT_FALSE(fs::last_write_time(path("parts/f_0.exr")) == before);
}

TEST_F(Film, TheProcessesOfPartsEndWithTheFilms) {
    fs::create_directory(path("parts"));
    Arguments film = draw("film", "parts/f_%d.exr", {"--jobs", "2"});
    film[9] = "0:99999";
    const FolderWatch watch(path("parts"));
    const pid_t process = start(film);
    watch.waitFor(9, process);
    const std::vector<pid_t> children = listDrawing(process);
    EXPECT_EQ(children.size(), 2u);
    EXPECT_EQ(stop(process, SIGINT).status, 128 + SIGINT);
    for (const pid_t child : children)
        EXPECT_TRUE(kill(child, 0) != 0) << "it was waited for";
    int pictures = 0;
    for (const auto& entry : fs::directory_iterator(path("parts")))
        pictures += entry.path().extension() == ".exr" ? 1 : 0;
    EXPECT_GT(pictures, 0);
}

/// Programs of Slurm, first on PATH, that record their arguments in the file `calls`.
class FakeSlurm {
  public:
    explicit FakeSlurm(fs::path folder) : mFolder(std::move(folder)) {
        const char* path = std::getenv("PATH"); // NOLINT(concurrency-mt-unsafe)
        mPath = path ? path : "";
        fs::create_directory(mFolder / "bin");
        setenv( // NOLINT(concurrency-mt-unsafe)
            "PATH",
            ((mFolder / "bin").string() + ":" + mPath).c_str(),
            1
        );
    }

    ~FakeSlurm() { setenv("PATH", mPath.c_str(), 1); } // NOLINT(concurrency-mt-unsafe)

    FakeSlurm(const FakeSlurm&) = delete;
    FakeSlurm& operator=(const FakeSlurm&) = delete;

    void writeProgram(const std::string& name, const std::string& body) const {
        const fs::path file = mFolder / "bin" / name;
        std::ofstream(file) << fmt::format(
            "#!/bin/sh\nprintf '%s\\n' {} \"$@\" >> '{}'\n{}",
            name,
            (mFolder / "calls").string(),
            body
        );
        fs::permissions(file, fs::perms::owner_all);
    }

  private:
    fs::path mFolder;
    std::string mPath;
};

class FilmBySlurm : public Film {
  protected:
    FilmBySlurm() {
        for (const char* name : {"squeue", "scancel"})
            mSlurm.writeProgram(name, "");
    }

    FakeSlurm mSlurm{path("")};
};

TEST_F(FilmBySlurm, OptionsReachTheJobsAndTheirIdsArePrinted) {
    mSlurm.writeProgram(
        "sbatch", "case \"$*\" in *--array*) echo '7;cluster';; *) echo 8;; esac\n"
    );
    const Arguments film = draw(
        "film",
        "it's f_%d.exr",
        {"--slurm", "--parts", "3", "--sbatch", "partition=films", "--sbatch", "--time=60"}
    );
    EXPECT_EQ(expectSuccess(film).out, "job 7: parts 1-3\njob 8: finishes the film\n");
    const std::string printed = readFile("calls");
    const size_t second = printed.find("sbatch\n", 1);
    ASSERT_NE(second, std::string::npos) << printed;
    for (const char* both : {"\n--partition=films\n", "\n--time=60\n", "\n--requeue\n"}) {
        EXPECT_LT(printed.find(both), second) << both;
        EXPECT_NE(printed.find(both, second), std::string::npos) << both;
    }
    EXPECT_LT(printed.find("\n--array=1-3\n"), second);
    EXPECT_NE(printed.find("\n--dependency=afterok:7\n", second), std::string::npos);
    // The jobs run the requested command in any shell.
    EXPECT_NE(
        printed.find("'--out' 'it'\\''s f_%d.exr' '--device' 'llvmpipe'  --part "
                     "$SLURM_ARRAY_TASK_ID/3\n"),
        std::string::npos
    ) << printed;
    EXPECT_EQ(readFile(".it's f_%d.exr.parts/jobs"), "7 8\n");
}

TEST_F(FilmBySlurm, PartsWhoseFilmCannotBeFinishedAreCancelled) {
    mSlurm.writeProgram(
        "sbatch",
        "case \"$*\" in *--array*) echo 7;; *) echo 'sbatch: error: no more jobs' >&2; exit 1;; "
        "esac\n"
    );
    const Outcome outcome = run(draw("film", "f_%d.exr", {"--slurm", "--parts", "3"}));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.err, "shutter: sbatch ended with status 1: sbatch: error: no more jobs\n");
    EXPECT_TRUE(readFile("calls").ends_with("scancel\n7\n")) << readFile("calls");
}

} // namespace shutter::cli
