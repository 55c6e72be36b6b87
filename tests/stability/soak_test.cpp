// SPDX-License-Identifier: MIT
// What leaks, creeps or depends on chance shows after thousands of frames: a demo is played without
// a window, twice, by one script that switches everything, and neither run may grow or differ.
// SHUTTER_SOAK_FRAMES makes it longer, SHUTTER_SOAK_DEMO plays another demo.
#include "engine/io/file_bytes.h"
#include "engine/json/json_file.h"
#include "engine/scene/history.h"
#include "engine/scene/motion.h"
#include "game/demos/random.h"
#include "game/play/loop/play_loop.h"
#include "game/play/loop/stage.h"
#include "tests/kit/process_use.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace shutter::stability {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Frames after which the same is done again. At a cycle's end everything is set as at its start,
/// so that memory use may be compared then (addPauses()).
constexpr uint32_t kCycleFrames = 250;
constexpr double kFrameSeconds = 1.0 / 30.0;
constexpr uint32_t kKeptPictures = 20;

/// The events of one cycle by frame.
using Cycle = std::map<uint32_t, std::vector<ordered_json>>;

/// Keys pressed every third frame: methods twice as often as the rest. M walks through all methods,
/// N through those of the left side, V through the intermediates.
constexpr std::array kToggles = {
    "m", "m", "m", "n", "v", "x", "b", "f1", "1", "2", "3", "4", "5", "comma", "slash"};
constexpr uint32_t kToggleEvery = 3;
/// From here on a cycle goes back to how it began.
constexpr uint32_t kReturn = 225;

ordered_json tap(const char* key) {
    return {{"key", key}};
}

ordered_json makeResize(uint32_t width, uint32_t height) {
    return {{"resize", {std::max(width, 1u), std::max(height, 1u)}}};
}

void addToggles(Cycle& cycle) {
    game::Random random(1);
    for (uint32_t frame = 4; frame < 195; frame += kToggleEvery)
        cycle[frame].push_back(
            tap(kToggles[static_cast<size_t>(random.next() * double(kToggles.size()))])
        );
}

void addSizes(Cycle& cycle, const game::PictureSize& size) {
    const auto [width, height] = size;
    cycle[31].push_back(makeResize(width * 3 / 2, height * 3 / 2));
    cycle[72].push_back(makeResize(width / 2, height));
    cycle[113].push_back(makeResize(width + 1, height - height / 3));
    cycle[154].push_back(makeResize(width, height));
}

void addPlay(Cycle& cycle) {
    cycle[10].push_back({{"leftStick", {0.5, 1.0}}});
    cycle[20].push_back({{"key", "space"}, {"action", "press"}});
    cycle[60].push_back({{"leftStick", {-0.7, 0.3}}});
    cycle[120].push_back({{"key", "space"}, {"action", "release"}});
    cycle[130].push_back({{"leftStick", {0.0, 0.0}}});
    // Six, so that demos of two and of three cameras end a cycle with the one they began with.
    for (uint32_t frame = 12; frame < 190; frame += 30)
        cycle[frame].push_back(tap("c"));
}

/// Photo mode, a pause and single steps, and then everything as at the start, but sharp: what glass
/// and particles are drawn in depends on where they are. A window that changes its size gives back
/// what frames before were drawn in.
void addPauses(Cycle& cycle, const game::PictureSize& size) {
    // Tables of each frame in flight then reach their size, those of blurred shadows among them.
    cycle[196].push_back(tap("3"));
    cycle[200].push_back(tap("t"));
    cycle[204].push_back(tap("p")); // leaves photo mode and the pause that comes with it
    cycle[208].push_back(tap("p"));
    cycle[210].push_back(tap("period"));
    cycle[212].push_back(tap("period"));
    cycle[214].push_back(tap("p"));
    cycle[kReturn].push_back(tap("f9"));
    // As many as there are speeds: the last of them is the usual one.
    for (uint32_t i = 1; i <= 5; ++i)
        cycle[kReturn + i].push_back(tap("slash"));
    cycle[kReturn + 8].push_back(tap("1"));
    cycle[kReturn + 10].push_back(makeResize(size.width + 1, size.height));
    cycle[kReturn + 13].push_back(makeResize(size.width, size.height));
    cycle[2].push_back(tap("f9"));
}

/// The frames whose pictures are kept, counted from 0: at no two the same place of the cycle.
std::vector<uint32_t> chooseFrames(uint32_t frameCount) {
    std::vector<uint32_t> frames;
    const uint32_t count = std::min(kKeptPictures, frameCount);
    for (uint32_t i = 0; i < count; ++i) {
        const uint64_t spread = uint64_t{frameCount} * (i + 1) / (count + 1);
        frames.push_back(
            static_cast<uint32_t>(spread - spread % kCycleFrames) +
            kCycleFrames * (i + 1) / (count + 1)
        );
    }
    std::erase_if(frames, [&](uint32_t frame) { return frame >= frameCount; });
    return frames;
}

fs::path pictureFile(const fs::path& folder, uint32_t frame) {
    return folder / fmt::format("frame_{:06}.png", frame);
}

/// A script for `shutter play --script`: in each cycle methods, presets, views, the split, the
/// panel and the camera change every third frame, the window's size four times; there are pauses,
/// single steps and photo mode. Ends after `frameCount` frames.
ordered_json
makeSoakScript(uint32_t frameCount, const game::PictureSize& size, const fs::path& pictures) {
    Cycle cycle;
    addToggles(cycle);
    addSizes(cycle, size);
    addPlay(cycle);
    addPauses(cycle, size);
    const std::vector<uint32_t> kept = chooseFrames(frameCount);
    ordered_json events = ordered_json::array();
    const auto add = [&](uint32_t frame, ordered_json event) {
        // Half a frame before its frame: no rounding puts it into the next.
        event["time"] = std::max(double(frame) - 0.5, 0.0) * kFrameSeconds;
        events.push_back(std::move(event));
    };
    for (uint32_t frame = 0; frame < frameCount; ++frame) {
        if (const auto found = cycle.find(frame % kCycleFrames); found != cycle.end())
            for (const ordered_json& event : found->second)
                add(frame, event);
        if (std::find(kept.begin(), kept.end(), frame) != kept.end())
            add(frame, {{"screenshot", pictureFile(pictures, frame).string()}});
    }
    add(frameCount, {{"window", "quit"}});
    return {{"version", 1}, {"frameSeconds", kFrameSeconds}, {"events", std::move(events)}};
}

/// Settings that a cycle begins with: few samples, so that methods which draw many frames for a
/// picture take no longer than others.
ordered_json makeSoakSettings() {
    return {
        {"version", 1},
        {"method", "resolved"},
        {"instants", 2},
        {"rays", 1},
        {"denoisedRays", 1},
        {"showPanel", false}};
}

using math::dvec3;

constexpr uint32_t kSpawnFrames = 25; ///< from one spawn to the next
constexpr double kMaxMetres = 1.5;    ///< longest side of a mesh that is copied
constexpr double kMaxSpeed = 4.0;     ///< m/s
constexpr double kMaxTurn = 20.0;     ///< rad/s

/// Something that a spawn copies.
struct Model {
    scene::MeshInstance mesh;
    dvec3 scale{1.0};
};

/// Undeformed meshes, the small ones where there are any.
std::vector<Model> listModels(const scene::World& world) {
    std::vector<Model> small;
    std::vector<Model> all;
    for (auto [entity, mesh, local] :
         world.registry.view<scene::MeshInstance, scene::LocalTransform>()) {
        if (mesh.mesh == scene::kNone || world.registry.has<scene::Skinned>(entity) ||
            world.registry.has<scene::MorphWeights>(entity))
            continue;
        const Model model{mesh, local.transform.scale};
        const dvec3 size = world.assets.meshes[mesh.mesh].bounds.size() * model.scale;
        all.push_back(model);
        if (std::max({size.x, size.y, size.z}) <= kMaxMetres)
            small.push_back(model);
    }
    return small.empty() ? all : small;
}

dvec3 chooseVector(game::Random& random, const dvec3& most) {
    // One after another: the order in which arguments are evaluated is the compiler's.
    dvec3 chosen;
    for (int axis = 0; axis < 3; ++axis)
        chosen[axis] = random.between(-most[axis], most[axis]);
    return chosen;
}

/// Plays a stage. Every kSpawnFrames frames that are not paused, `count` copies of its smaller
/// meshes appear before the camera, every other one moving and turning; half a spawn later all are
/// despawned. Where they appear depends on the frame alone.
class StormStage : public game::Stage {
  public:
    StormStage(std::unique_ptr<game::Stage> stage, uint32_t count)
        : mStage(std::move(stage)), mModels(listModels(mStage->world())),
          mCount(mModels.empty() ? 0 : count) {}

    [[nodiscard]] std::string title() const override { return mStage->title(); }

    [[nodiscard]] scene::World& world() override { return mStage->world(); }

    [[nodiscard]] ecs::Entity camera() const override { return mStage->camera(); }

    [[nodiscard]] game::DemoAppearance appearance() const override { return mStage->appearance(); }

    void advance(const app::InputState& input, const game::StageFrame& frame) override {
        mStage->advance(input, frame);
        if (frame.paused)
            return;
        const uint32_t inStorm = mFrame++ % kSpawnFrames;
        if (inStorm == 0)
            spawn(frame.time.seconds + startSeconds());
        else if (inStorm == kSpawnFrames / 2)
            despawn();
    }

    void adjustShutter(double seconds, scene::CameraShutter& shutter) const override {
        mStage->adjustShutter(seconds, shutter);
    }

    [[nodiscard]] double startSeconds() const override { return mStage->startSeconds(); }

    [[nodiscard]] std::vector<game::HudLine> hud() const override { return mStage->hud(); }

    [[nodiscard]] bool isOver() const override { return mStage->isOver(); }

    [[nodiscard]] std::optional<int> score() const override { return mStage->score(); }

  private:
    void spawn(double seconds) {
        scene::World& into = mStage->world();
        const math::dmat4 worldFromCamera = scene::worldFromEntity(into, mStage->camera(), seconds);
        game::Random random(mFrame);
        for (uint32_t i = 0; i < mCount; ++i) {
            const Model& model =
                mModels[static_cast<size_t>(random.next() * double(mModels.size()))];
            const dvec3 place = chooseVector(random, {3.0, 1.5, 5.0}) - dvec3(0.0, 0.0, 7.0);
            math::Transform at;
            at.translation = dvec3(worldFromCamera * math::dvec4(place, 1.0));
            at.scale = model.scale;
            const ecs::Entity entity = into.registry.create();
            if (i % 2 == 0) {
                const dvec3 velocity = chooseVector(random, dvec3(kMaxSpeed));
                at.translation -= velocity * seconds; // it counts from time 0
                into.registry.add(entity, scene::LinearVelocity{velocity});
                into.registry.add(
                    entity, scene::AngularVelocity{chooseVector(random, dvec3(kMaxTurn))}
                );
            }
            into.registry.add(entity, scene::LocalTransform{at});
            into.registry.add(entity, model.mesh);
            scene::appear(into, entity, seconds);
            mSpawned.push_back(entity);
        }
    }

    void despawn() {
        for (const ecs::Entity entity : std::exchange(mSpawned, {}))
            scene::despawn(mStage->world(), entity);
    }

    std::unique_ptr<game::Stage> mStage;
    std::vector<Model> mModels;
    uint32_t mCount;
    uint32_t mFrame = 0; ///< that were not paused
    std::vector<ecs::Entity> mSpawned;
};

constexpr uint32_t kRuns = 2;
/// Not a whole number of cycles: the last sample is taken before the end.
constexpr uint32_t kShortestSoak = 1050;
constexpr uint32_t kStorm = 50;
constexpr game::PictureSize kSize{64, 36};

/// What allocators and drivers may take over a run of any length: over 20,000 frames a leak of one
/// kilobyte in each is beyond it.
constexpr uint64_t kProcessBytes = uint64_t{16} << 20u;
/// Objects made on first use, late in a run too: each frame in flight has a separate buffer for a
/// picture that is read back, and images with the usage that goes with it.
constexpr uint64_t kDeviceObjects = 4;
constexpr uint64_t kDeviceBytes = uint64_t{256} << 10u;

/// Memory use at the end of a cycle, when the device is idle.
struct Holdings {
    uint64_t processBytes = 0;
    gpu::LivingObjects device;
};

class SoakWatch : public game::SessionWatch {
  public:
    [[nodiscard]] std::unique_ptr<game::Stage> wrap(std::unique_ptr<game::Stage> stage) override {
        return std::make_unique<StormStage>(std::move(stage), kStorm);
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

/// Names memory that grew beyond its bound from the first to the last third of the counted cycles.
/// The first half of all cycles does not count: shaders are compiled in it, and each frame in
/// flight has separate tables (a 16 MiB buffer of shadow casters) that reach their size when the
/// largest frame first meets them, in the third cycle at the latest.
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

TEST_F(Soak, MemoryDoesNotGrowAndBothRunsGiveTheSamePictures) {
    const auto frames =
        std::max(uint32_t(std::stoul(readEnvironment("SHUTTER_SOAK_FRAMES", "0"))), kShortestSoak);
    const std::vector<SoakRun> runs = playTwice(frames);
    ASSERT_EQ(runs.size(), kRuns);
    ASSERT_TRUE(test::findResidentBytes()) << "the system does not report the memory of a process";
    EXPECT_EQ(countPicturesThatDiffer(runs[0], runs[1], frames), 0u);
    for (const SoakRun& run : runs)
        EXPECT_EQ(listGrowth(run), std::vector<std::string>()) << run.pictures;
}

} // namespace
} // namespace shutter::stability
