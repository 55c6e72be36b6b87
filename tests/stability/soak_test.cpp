// SPDX-License-Identifier: MIT
// What leaks, creeps or depends on chance shows after hundreds of frames: a demo is played without
// a window by a script that switches everything, and again. Nothing may grow from cycle to cycle of
// the script, and pictures of both runs have the same bits. SHUTTER_SOAK_FRAMES makes both longer,
// SHUTTER_SOAK_DEMO plays another demo.
#include "engine/io/file_bytes.h"
#include "engine/json/json_file.h"
#include "engine/scene/history.h"
#include "engine/scene/motion.h"
#include "game/demos/random.h"
#include "game/play/loop/play_loop.h"
#include "game/play/loop/stage.h"
#include "tests/kit/process_use.h"
#include "tests/kit/sweep.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
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
/// so that memory use may be compared then (makeCycle()).
constexpr uint32_t kCycleFrames = 125;
constexpr double kFrameSeconds = 1.0 / 30.0;
constexpr uint32_t kKeptPictures = 20;

/// The events of one cycle by frame.
using Cycle = std::map<uint32_t, std::vector<ordered_json>>;

/// Keys pressed every other frame from the fourth on: M walks through the methods, N through those
/// of the left side, V through the intermediates, all three backwards while the shift key is held.
/// 1 is the sharp picture, from which each method but `adaptive` is reached: its shaders take Mesa
/// minutes to compile. It is drawn with SHUTTER_ALL=1; Toggles holds what it leaves.
constexpr std::array kToggles = {"1",     "m",  "m", "x",  "m", "v",     "m", "m", "b", "m",
                                 "n",     "m",  "m", "f1", "x", "5",     "n", "v", "2", "comma",
                                 "x",     "n",  "3", "b",  "1", "m",     "n", "m", "v", "m",
                                 "slash", "f1", "x", "3",  "n", "comma", "2", "v", "b", "5"};
constexpr uint32_t kShiftPress = 53;
constexpr uint32_t kShiftRelease = 64;
/// From here on a cycle goes back to how it began.
constexpr uint32_t kReturn = 108;

ordered_json tap(const char* key) {
    return {{"key", key}};
}

ordered_json makeResize(uint32_t width, uint32_t height) {
    return {{"resize", {std::max(width, 1u), std::max(height, 1u)}}};
}

Cycle makeCycle(const game::PictureSize& size) {
    Cycle cycle;
    const auto at = [&](uint32_t frame, ordered_json event) {
        cycle[frame].push_back(std::move(event));
    };
    at(2, tap("f9"));
    for (uint32_t i = 0; i < kToggles.size(); ++i)
        at(4 + 2 * i, tap(kToggles[i]));
    at(kShiftPress, {{"key", "shift"}, {"action", "press"}});
    if (test::drawsAll())
        at(kShiftRelease - 1, tap("m"));
    at(kShiftRelease, {{"key", "shift"}, {"action", "release"}});
    const auto [width, height] = size;
    at(15, makeResize(width * 3 / 2, height * 3 / 2));
    at(35, makeResize(width / 2, height));
    at(55, makeResize(width + 1, height - height / 3));
    at(75, makeResize(width, height));
    at(5, {{"leftStick", {0.5, 1.0}}});
    at(10, {{"key", "space"}, {"action", "press"}});
    at(30, {{"leftStick", {-0.7, 0.3}}});
    at(60, {{"key", "space"}, {"action", "release"}});
    at(65, {{"leftStick", {0.0, 0.0}}});
    // Six, so that demos of two and of three cameras end a cycle with the one they began with.
    for (uint32_t frame = 6; frame < 80; frame += 14)
        at(frame, tap("c"));
    // Tables of each frame in flight then reach their size, those of blurred shadows among them.
    at(86, tap("3"));
    // Photo mode, a pause and single steps; the first P leaves photo mode and its pause.
    const std::pair<uint32_t, const char*> pauses[] = {
        {88, "t"}, {90, "p"}, {92, "p"}, {93, "period"}, {94, "period"}, {95, "p"}};
    for (const auto& [frame, key] : pauses)
        at(frame, tap(key));
    // Then everything as at the start, but sharp: what glass and particles are drawn in depends on
    // where they are. A window that changes its size gives back what frames before were drawn in.
    at(kReturn, tap("f9"));
    // As many as there are speeds: the last of them is the usual one.
    for (uint32_t i = 1; i <= 5; ++i)
        at(kReturn + i, tap("slash"));
    at(kReturn + 6, tap("1"));
    at(kReturn + 7, makeResize(width + 1, height));
    at(kReturn + 9, makeResize(width, height));
    return cycle;
}

/// The frames whose pictures are kept, counted from 0.
std::vector<uint32_t> chooseFrames(uint32_t frameCount) {
    std::vector<uint32_t> frames;
    for (uint32_t i = 1; i <= kKeptPictures; ++i)
        frames.push_back(i * frameCount / (kKeptPictures + 1));
    return frames;
}

fs::path pictureFile(const fs::path& folder, uint32_t frame) {
    return folder / fmt::format("frame_{:06}.png", frame);
}

/// A script for `shutter play --script`: in each cycle methods, presets, views, the split, the
/// panel and the camera change every other frame, the window's size six times; there are pauses,
/// single steps and photo mode. Ends after `frameCount` frames. \param kept frames whose pictures
/// go to the folder `pictures`
ordered_json makeSoakScript(
    uint32_t frameCount,
    const game::PictureSize& size,
    const std::vector<uint32_t>& kept,
    const fs::path& pictures
) {
    const Cycle cycle = makeCycle(size);
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

/// Settings that a cycle begins with: few samples and small maps, so that no method and no shadow
/// takes many times as long as the rest.
ordered_json makeSoakSettings() {
    return {
        {"version", 1},
        {"method", "resolved"},
        {"instants", 2},
        {"rays", 1},
        {"denoisedRays", 1},
        {"shadowMapSize", 64},
        {"shadowInstants", 2},
        {"showPanel", false}};
}

using math::dvec3;

constexpr uint32_t kStorm = 50;
constexpr uint32_t kSpawnFrames = 12; ///< from one spawn to the next
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

/// Plays a stage. Every kSpawnFrames frames that are not paused, kStorm copies of its smaller
/// meshes appear before the camera, every other one moving and turning; half a spawn later all are
/// despawned. Where they appear depends on the frame alone.
class StormStage : public game::Stage {
  public:
    explicit StormStage(std::unique_ptr<game::Stage> stage)
        : mStage(std::move(stage)), mModels(listModels(mStage->world())) {}

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

    [[nodiscard]] double startSeconds() const override { return mStage->startSeconds(); }

    [[nodiscard]] std::vector<game::HudLine> hud() const override { return mStage->hud(); }

  private:
    void spawn(double seconds) {
        scene::World& into = mStage->world();
        const math::dmat4 worldFromCamera = scene::worldFromEntity(into, mStage->camera(), seconds);
        game::Random random(mFrame);
        for (uint32_t i = 0; i < kStorm && !mModels.empty(); ++i) {
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
    uint32_t mFrame = 0; ///< that were not paused
    std::vector<ecs::Entity> mSpawned;
};

/// Nine cycles (listGrowth()): pipelines are made when first needed, the last of them in the sixth,
/// after which memory stays. Not a whole number: the last sample is taken before the end.
constexpr uint32_t kShortestSoak = 9 * kCycleFrames + 10;
/// The other run is for its pictures alone.
constexpr uint32_t kShortestRepetition = kCycleFrames;
constexpr game::PictureSize kSize{64, 36};

/// What allocators and drivers may take from one cycle to the next: in each frame a leak of 1.1 KiB
/// of device memory or of 66 KiB of the process is beyond it.
constexpr uint64_t kProcessBytes = uint64_t{8} << 20u;
/// Objects made on first use, late in a run too: each frame in flight has a separate buffer for a
/// picture that is read back, and images with the usage that goes with it. A leak of one in 40
/// frames is beyond it.
constexpr uint64_t kDeviceObjects = 2;
constexpr uint64_t kDeviceBytes = uint64_t{128} << 10u;

/// Memory use at the end of a cycle, when the device is idle.
struct Holdings {
    uint64_t processBytes = 0;
    gpu::LivingObjects device;
};

class SoakWatch : public game::SessionWatch {
  public:
    [[nodiscard]] std::unique_ptr<game::Stage> wrap(std::unique_ptr<game::Stage> stage) override {
        return std::make_unique<StormStage>(std::move(stage));
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

core::Result<SoakRun> play(
    const std::string& demo,
    uint32_t frames,
    const std::vector<uint32_t>& kept,
    uint32_t number,
    const fs::path& folder
) {
    SoakRun run{folder / fmt::format("pictures_{}", number), {}};
    fs::create_directories(run.pictures);
    const fs::path script = folder / fmt::format("script_{}.json", number);
    const fs::path settings = folder / "settings.json";
    SHUTTER_TRY(json::writeJsonFile(script, makeSoakScript(frames, kSize, kept, run.pictures)));
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

/// Names memory of which all of the last third of the cycles hold more, beyond its bound, than any
/// of the second third. What a picture needs depends on what is in view, and is released 120 frames
/// later: one cycle may hold more than others, and what leaks is held by all that follow. The first
/// third does not count: shaders are compiled in it, and each frame in flight has separate tables
/// (a 16 MiB buffer of shadow casters) that reach their size when the largest frame first meets
/// them, in the fourth cycle at the latest.
std::vector<std::string> listGrowth(const SoakRun& run) {
    std::vector<std::string> grown;
    const auto hold = [&](const char* what, uint64_t bound, const auto& value) {
        std::vector<uint64_t> held;
        for (const Holdings& cycle : run.cycles)
            held.push_back(value(cycle));
        ::testing::Test::RecordProperty(what, fmt::format("{}", fmt::join(held, ", ")));
        const auto late = held.begin() + std::ptrdiff_t(2 * held.size() / 3);
        const auto early = held.begin() + std::ptrdiff_t(held.size() / 3);
        if (*std::min_element(late, held.end()) > *std::max_element(early, late) + bound)
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

std::string readEnvironment(const char* name, const std::string& fallback) {
    const char* text = std::getenv(name); // NOLINT(concurrency-mt-unsafe)
    return text == nullptr ? fallback : text;
}

class Soak : public test::GpuTest {};

TEST_F(Soak, MemoryDoesNotGrowAndBothRunsGiveTheSamePictures) {
    ASSERT_TRUE(test::findResidentBytes()) << "the system does not report the memory of a process";
    const std::string demo = readEnvironment("SHUTTER_SOAK_DEMO", "gallery");
    const auto wanted = uint32_t(std::stoul(readEnvironment("SHUTTER_SOAK_FRAMES", "0")));
    const uint32_t frames = std::max(wanted, kShortestSoak);
    const uint32_t repeated = wanted > kShortestSoak ? wanted : kShortestRepetition;
    const std::vector<uint32_t> kept = chooseFrames(repeated);
    const test::TempFolder folder;
    std::vector<SoakRun> runs;
    for (const uint32_t count : {frames, repeated}) {
        auto played = play(demo, count, kept, uint32_t(runs.size()), folder.path());
        ASSERT_TRUE(played) << played.error().message;
        EXPECT_EQ(played.value().cycles.size(), count / kCycleFrames);
        runs.push_back(std::move(played).value());
    }
    EXPECT_EQ(listGrowth(runs.front()), std::vector<std::string>());
    for (const uint32_t frame : kept) {
        const auto first = io::computeFileHash(pictureFile(runs[0].pictures, frame));
        const auto second = io::computeFileHash(pictureFile(runs[1].pictures, frame));
        ASSERT_TRUE(first && second) << frame;
        EXPECT_EQ(first.value(), second.value()) << frame;
    }
}

} // namespace
} // namespace shutter::stability
