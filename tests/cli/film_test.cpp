// SPDX-License-Identifier: MIT
// `shutter film`: drawn in parts, a film is the same bits as drawn by one process, stopped or not.
#include "tests/cli/child_processes.h"
#include "tests/cli/cli_fixture.h"
#include "tests/cli/drifting_scene.h"
#include "tests/cli/fake_slurm.h"
#include "tests/cli/folder_watch.h"

#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace shutter::cli {

namespace {

/// Frames of the films: so many that a part is killed before it has drawn them all.
constexpr int kFrames = 24;

class Film : public Cli {
  protected:
    void SetUp() override {
        requireDevice();
        // No camera: one that each part made to fit its own first frame would differ.
        writeFile("drifting.gltf", kDriftingScene);
    }

    [[nodiscard]] static Arguments
    draw(const std::string& command, const std::string& out, const Arguments& more = {}) {
        Arguments arguments = {
            command,
            "drifting.gltf",
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
        arguments.insert(arguments.end(), kOnSoftware.begin(), kOnSoftware.end());
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }

    [[nodiscard]] std::vector<std::string> readFrames(const std::string& folder) const {
        std::vector<std::string> frames;
        for (int frame = 0; frame < kFrames; ++frame)
            frames.push_back(readFile(fmt::format("{}/f_{}.exr", folder, frame - 1)));
        return frames;
    }

    /// Starts the film `out` in one part and kills the process that draws it after two frames.
    /// \return what the film's own process said
    Outcome killPart(const std::string& folder, const Arguments& film) const {
        const FolderWatch watch(path(folder));
        const pid_t process = start(film);
        // The working folder, the part's journal and its temporary file, and two of each picture.
        watch.waitFor(7, process);
        for (const pid_t child : listChildren(process))
            kill(child, SIGKILL);
        return finish(process);
    }
};

} // namespace

TEST_F(Film, ByPartsIsTheFilmOfOneProcess) {
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
    // Nothing of the parts is left, and both commands know what is complete.
    EXPECT_FALSE(fs::exists(path("parts.mp4.frames/plan.json")));
    EXPECT_EQ(
        expectSuccess(parts).out, "parts.mp4: is complete and skipped (--restart draws it)\n"
    );
    const auto again = expectSuccess(draw("render", "parts.mp4"));
    EXPECT_NE(
        again.out.find(fmt::format("{0} of {0} frames are complete", kFrames)), std::string::npos
    ) << again.out;
    EXPECT_FALSE(fs::exists(path("parts.mp4.frames")));
}

TEST_F(Film, APartThatIsKilledGoesOnWhereItStopped) {
    fs::create_directory(path("whole"));
    fs::create_directory(path("parts"));
    expectSuccess(draw("render", "whole/f_%d.exr"));
    const Arguments film = draw("film", "parts/f_%d.exr");
    const Outcome killed = killPart("parts", film);
    EXPECT_EQ(killed.status, 1);
    EXPECT_NE(killed.err.find("part 0 ended with status 137"), std::string::npos) << killed.err;
    ASSERT_TRUE(fs::exists(path("parts/f_-1.exr")));
    ASSERT_FALSE(fs::exists(path(fmt::format("parts/f_{}.exr", kFrames - 2))))
        << "it was killed too late";
    const auto before = fs::last_write_time(path("parts/f_-1.exr"));

    // What draws may not change on the way.
    const std::string work = "parts/.f_%d.exr.parts";
    const std::string device = readFile(work + "/device.json");
    writeFile(work + "/device.json", R"({"device": "another card", "driver": "7"})");
    const Outcome other = run(film);
    EXPECT_EQ(other.status, 1);
    EXPECT_NE(other.err.find("'another card' with driver '7'"), std::string::npos) << other.err;
    EXPECT_NE(other.err.find("llvmpipe"), std::string::npos) << other.err;
    writeFile(work + "/device.json", device);
    expectRefusal(
        draw("film", "parts/f_%d.exr", {"--unlit"}), 1, {"--out", "planned otherwise", "--restart"}
    );
    expectRefusal(draw("film", "parts/f_%d.exr", {"--parts", "2"}), 1, {"--parts 2", "in 1 parts"});
    expectRefusal({"film-part", work, "1"}, 1, {"part 1 is none of the film's"});
    expectRefusal({"film-finish", work}, 1, {"part 0 is not complete: frame"});

    expectSuccess(film);
    EXPECT_TRUE(readFrames("parts") == readFrames("whole"));
    EXPECT_TRUE(fs::last_write_time(path("parts/f_-1.exr")) == before) << "it was drawn again";
    EXPECT_FALSE(fs::exists(path(work)));
    const auto again = expectSuccess(draw("render", "parts/f_%d.exr"));
    EXPECT_NE(
        again.out.find(fmt::format("{0} of {0} frames are complete", kFrames)), std::string::npos
    ) << again.out;
}

TEST_F(Film, TheProcessesOfPartsEndWithTheFilms) {
    fs::create_directory(path("parts"));
    Arguments film = draw("film", "parts/f_%d.exr", {"--jobs", "2", "--estimate", "off"});
    film[9] = "0:99999";
    const FolderWatch watch(path("parts"));
    const pid_t process = start(film);
    watch.waitFor(9, process);
    const auto children = listChildren(process);
    EXPECT_EQ(children.size(), 2u);
    kill(process, SIGINT);
    EXPECT_EQ(finish(process).status, 128 + SIGINT);
    for (const pid_t child : children) {
        // Whoever adopts it may not have waited for it yet: then it is a zombie without a program.
        const auto isRunning = [&] {
            std::error_code gone;
            return kill(child, 0) == 0 &&
                   !fs::read_symlink(fmt::format("/proc/{}/exe", child), gone).empty() && !gone;
        };
        while (isRunning())
            usleep(10'000);
    }
    int pictures = 0;
    for (const auto& entry : fs::directory_iterator(path("parts")))
        pictures += entry.path().extension() == ".exr" ? 1 : 0;
    EXPECT_GT(pictures, 0);
}

class FilmBySlurm : public Film {
  protected:
    FakeSlurm mSlurm{path("")};
};

TEST_F(FilmBySlurm, OptionsReachTheJobsAndTheirIdsAreTold) {
    mSlurm.writeProgram(
        "sbatch", "case \"$*\" in *--array*) echo '7;cluster';; *) echo 8;; esac\n"
    );
    const Arguments film = draw(
        "film",
        "f_%d.exr",
        {"--slurm",
         "--parts",
         "3",
         "--estimate",
         "off",
         "--sbatch",
         "partition=films",
         "--sbatch",
         "--time=60",
         "--sbatch-part",
         "gres=gpu:1"}
    );
    EXPECT_EQ(expectSuccess(film).out, "job 7: parts 0-2\njob 8: finishes the film\n");
    const std::string said = readFile("said");
    const size_t second = said.find("sbatch\n", 1);
    ASSERT_NE(second, std::string::npos) << said;
    for (const char* both : {"\n--partition=films\n", "\n--time=60\n", "\n--requeue\n"}) {
        EXPECT_LT(said.find(both), second) << both;
        EXPECT_NE(said.find(both, second), std::string::npos) << both;
    }
    EXPECT_LT(said.find("\n--array=0-2\n"), second);
    EXPECT_LT(said.find("\n--gres=gpu:1\n"), second);
    EXPECT_EQ(said.find("\n--gres=gpu:1\n", second), std::string::npos);
    EXPECT_NE(said.find("\n--dependency=afterok:7\n", second), std::string::npos);
    // The jobs run what they are told to.
    writeFile("work", path(".f_%d.exr.parts"));
    EXPECT_NE(
        said.find("film-part '" + readFile("work") + "' \"$SLURM_ARRAY_TASK_ID\"\n"),
        std::string::npos
    ) << said;
    EXPECT_NE(said.find("film-finish '" + readFile("work") + "'\n", second), std::string::npos)
        << said;
}

TEST_F(FilmBySlurm, PartsWhoseFilmCannotBeFinishedAreCancelled) {
    mSlurm.writeProgram(
        "sbatch",
        "case \"$*\" in *--array*) echo 7;; *) echo 'sbatch: error: no more jobs' >&2; exit 1;; "
        "esac\n"
    );
    mSlurm.writeProgram("scancel", "");
    const Outcome outcome =
        run(draw("film", "f_%d.exr", {"--slurm", "--parts", "3", "--estimate", "off"}));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.err, "shutter: sbatch ended with status 1: sbatch: error: no more jobs\n");
    EXPECT_TRUE(readFile("said").ends_with("scancel\n7\n")) << readFile("said");
}

TEST_F(Film, ContradictionsAreRefusedBeforeAnythingIsWritten) {
    const auto refuse = [&](const Arguments& more, const Arguments& mentions, int status = 2) {
        expectRefusal(draw("film", "f_%d.exr", more), status, mentions);
    };
    refuse({"--aa", "taa", "--jobs", "2"}, {"--aa taa"});
    refuse({"--budget", "8"}, {"--budget"});
    refuse({"--stats", "s.json"}, {"--stats"});
    refuse({"--wait"}, {"--wait", "--slurm"});
    refuse({"--jobs", "0"}, {"--jobs"});
    expectRefusal(draw("film", "f.exr"), 2, {"%04d"});
    expectRefusal({"film", "drifting.gltf", "--out", "f.exr"}, 2, {"--flythrough or --frames"});
    expectRefusal({"film-part", "nowhere", "0"}, 1, {"nowhere/plan.json"});
}

} // namespace shutter::cli
