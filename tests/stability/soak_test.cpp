// SPDX-License-Identifier: MIT
// What leaks, creeps or depends on chance shows after thousands of frames: a demo is played without
// a window, twice, by one script that switches everything, and neither run may grow or differ.
// SHUTTER_SOAK_FRAMES makes it longer, SHUTTER_SOAK_DEMO plays another demo.
#include "engine/io/file_bytes.h"
#include "engine/json/json_file.h"
#include "game/play/loop/play_loop.h"
#include "tests/kit/process_use.h"
#include "tests/stability/soak_script.h"
#include "tests/stability/storm_stage.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <utility>

namespace shutter::stability {
namespace {

namespace fs = std::filesystem;

constexpr uint32_t kRuns = 2;
/// Not a whole number of cycles: the last sample is taken before the end.
constexpr uint32_t kShortestSoak = 1050;
constexpr uint32_t kStorm = 50;
constexpr game::PictureSize kSize{64, 36};

/// What allocators and drivers may take over a run of any length: over 20,000 frames a leak of one
/// kilobyte in each is beyond it.
constexpr uint64_t kProcessBytes = uint64_t{16} << 20u;
/// What is made when it is first needed, late in a run too: each frame in flight has a buffer of
/// its own for a picture that is read back, and images with the usage that goes with it.
constexpr uint64_t kDeviceObjects = 4;
constexpr uint64_t kDeviceBytes = uint64_t{256} << 10u;

/// What is held at the end of a cycle, when the device is idle.
struct Holdings {
    uint64_t processBytes = 0;
    gpu::LivingObjects device;
};

class SoakWatch : public game::SessionWatch {
  public:
    [[nodiscard]] std::unique_ptr<game::Stage> wrap(std::unique_ptr<game::Stage> stage) override {
        return makeStormStage(std::move(stage), kStorm);
    }

    void notePicture(uint32_t picture, gpu::Device& device, const std::function<void()>& finish)
        override {
        if ((picture + 1) % kCycleFrames != 0)
            return;
        finish();
        device.collectIdle();
        mCycles.push_back({test::findResidentBytes().value_or(0), device.living()});
    }

    [[nodiscard]] const std::vector<Holdings>& cycles() const { return mCycles; }

  private:
    std::vector<Holdings> mCycles;
};

struct SoakRun {
    fs::path pictures;
    std::vector<Holdings> cycles;
};

core::Result<SoakRun>
play(const std::string& demo, uint32_t frames, uint32_t number, const fs::path& folder) {
    SoakRun run{folder / fmt::format("pictures_{}", number), {}};
    fs::create_directories(run.pictures);
    const fs::path script = folder / fmt::format("script_{}.json", number);
    const fs::path settings = folder / "settings.json";
    SHUTTER_TRY(json::writeJsonFile(script, makeSoakScript(frames, kSize, run.pictures)));
    SHUTTER_TRY(json::writeJsonFile(settings, makeSoakSettings()));
    game::PlayArguments arguments;
    arguments.shot.scene = demo;
    arguments.shot.size = kSize;
    arguments.shot.allowOutside = true; // the script is ours
    arguments.script = script.string();
    arguments.settings = settings.string();
    arguments.assets = SHUTTER_BUILD_DIR "/assets";
    arguments.noWindow = true;
    auto session = game::interpret(arguments);
    if (!session)
        return session.error();
    session.value().device.validate = true;
    SoakWatch watch;
    auto loop = game::PlayLoop::open(session.value(), &watch);
    if (!loop)
        return loop.error();
    SHUTTER_TRY(loop.value()->run()); // messages of validation are its error
    run.cycles = watch.cycles();
    return run;
}

/// The largest of what the cycles from `first` on held.
template <class Value> uint64_t findMost(std::span<const Holdings> cycles, const Value& value) {
    uint64_t most = 0;
    for (const Holdings& cycle : cycles)
        most = std::max(most, uint64_t(value(cycle)));
    return most;
}

/// Names what grew beyond its bound from the first to the last third of the counted cycles. The
/// first half of all cycles does not count: shaders are compiled in it, and each frame in flight
/// has tables of its own (a 16 MiB buffer of shadow casters) that reach their size when the largest
/// frame first meets them, in the third cycle at the latest.
std::vector<std::string> listGrowth(const SoakRun& run) {
    const std::span<const Holdings> counted = std::span(run.cycles).subspan(run.cycles.size() / 2);
    const size_t third = std::max(counted.size() / 3, size_t{1});
    std::vector<std::string> grown;
    const auto hold = [&](const char* what, uint64_t bound, const auto& value) {
        const uint64_t early = findMost(counted.first(third), value);
        const uint64_t late = findMost(counted.last(third), value);
        ::testing::Test::RecordProperty(what, fmt::format("{} to {}", early, late));
        if (late > early + bound)
            grown.emplace_back(what);
    };
    using gpu::LivingObjects;
    hold("process memory", kProcessBytes, [](const Holdings& c) { return c.processBytes; });
    hold("device memory", kDeviceBytes, [](const Holdings& c) { return c.device.memoryBytes; });
    for (const auto& [what, count] :
         {std::pair("blocks of device memory", &LivingObjects::memoryBlocks),
          std::pair("buffers", &LivingObjects::buffers),
          std::pair("images", &LivingObjects::images),
          std::pair("acceleration structures", &LivingObjects::accelerationStructures)})
        hold(what, kDeviceObjects, [count = count](const Holdings& c) { return c.device.*count; });
    return grown;
}

uint32_t countPicturesThatDiffer(const SoakRun& a, const SoakRun& b, uint32_t frames) {
    uint32_t differing = 0;
    for (const uint32_t frame : chooseFrames(frames)) {
        const auto first = io::computeFileHash(pictureFile(a.pictures, frame));
        const auto second = io::computeFileHash(pictureFile(b.pictures, frame));
        EXPECT_TRUE(first && second) << "frame " << frame;
        differing += first && second && first.value() != second.value() ? 1 : 0;
    }
    return differing;
}

std::string readEnvironment(const char* name, const std::string& fallback) {
    const char* text = std::getenv(name); // NOLINT(concurrency-mt-unsafe)
    return text == nullptr ? fallback : text;
}

class Soak : public test::GpuTest {
  protected:
    std::vector<SoakRun> playTwice(uint32_t frames) {
        std::vector<SoakRun> runs;
        for (uint32_t run = 0; run < kRuns; ++run) {
            auto played =
                play(readEnvironment("SHUTTER_SOAK_DEMO", "gallery"), frames, run, mFolder.path());
            if (!played) {
                ADD_FAILURE() << played.error().message;
                return {};
            }
            EXPECT_EQ(played.value().cycles.size(), frames / kCycleFrames);
            runs.push_back(std::move(played).value());
        }
        return runs;
    }

  private:
    test::TempFolder mFolder;
};

TEST_F(Soak, NothingGrowsAndBothRunsShowTheSame) {
    const auto frames =
        std::max(uint32_t(std::stoul(readEnvironment("SHUTTER_SOAK_FRAMES", "0"))), kShortestSoak);
    const std::vector<SoakRun> runs = playTwice(frames);
    ASSERT_EQ(runs.size(), kRuns);
    ASSERT_TRUE(test::findResidentBytes()) << "the system does not tell the memory of a process";
    EXPECT_EQ(countPicturesThatDiffer(runs[0], runs[1], frames), 0u);
    for (const SoakRun& run : runs)
        EXPECT_EQ(listGrowth(run), std::vector<std::string>()) << run.pictures;
}

} // namespace
} // namespace shutter::stability
