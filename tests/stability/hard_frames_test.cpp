// SPDX-License-Identifier: MIT
// Frames in which something has no past, frames of no and of great length, the light that a blur
// loses, and the same bits in every run.
#include "engine/scene/history.h"
#include "game/shot/methods.h"
#include "tests/stability/hard_case.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <ostream>
#include <thread>

namespace shutter::stability {
namespace {

/// Inside the frame in each phase of the shutter: shortly before the raster instant.
constexpr double kEvent = -0.01;
/// As the shutter opens: what appears later is there for the rest of the exposure alone.
constexpr double kOpening = -0.4999;

/// A change to the stage. \param sphere its mover
using Change = void (*)(SceneBuilder& scene, ecs::Entity sphere);

void changeNothing(SceneBuilder&, ecs::Entity) {}

void teleportSphere(SceneBuilder& scene, ecs::Entity sphere) {
    scene::teleport(scene.world, sphere, {.translation = {-0.6, 0.3, -2.2}}, kEvent);
}

/// Another view: a step aside and a turn.
void cutCamera(SceneBuilder& scene, ecs::Entity) {
    const math::Transform transform{
        .translation = {0.4, 0.2, 0.3}, .rotation = glm::angleAxis(0.3, math::dvec3(0, 1, 0))};
    scene::cutTo(scene.world, scene.camera, transform, kEvent);
}

void spawnSphere(SceneBuilder& scene, ecs::Entity sphere) {
    scene::appear(scene.world, sphere, kOpening);
}

void beginWorld(SceneBuilder& scene, ecs::Entity) {
    scene.world.startSeconds = kEvent;
}

void despawnSphere(SceneBuilder& scene, ecs::Entity sphere) {
    scene::despawn(scene.world, sphere);
}

void hideSphere(SceneBuilder& scene, ecs::Entity sphere) {
    scene::hide(scene.world, sphere);
}

struct SharpCase {
    const char* name;
    Change happens;
    Change instead = changeNothing; ///< in the sharp picture
    double frameSeconds = scene::kStillFrameSeconds;
};

/// How googletest prints a parameter.
void PrintTo(const SharpCase& one, std::ostream* stream) {
    *stream << one.name;
}

const SharpCase kSharpCases[] = {
    {"Spawn", spawnSphere},
    {"Despawn", despawnSphere, hideSphere},
    {"Teleport", teleportSphere, teleportSphere},
    {"CameraCut", cutCamera, cutCamera},
    {"WorldBegins", beginWorld},
    {"Paused", changeNothing, changeNothing, 0.0},
};

class WithoutAPast : public test::GpuTest, public ::testing::WithParamInterface<SharpCase> {};

TEST_P(WithoutAPast, EveryMethodDrawsTheSharpPicture) {
    SceneBuilder scene = makeEmptyScene();
    const ecs::Entity sphere = addWallAndSphere(scene);
    Stage stage(device(), scene);
    // Drawn once as it was: whatever the renderer keeps of a frame must not come back.
    (void)draw(stage, makeLitShot(), "hybrid");
    GetParam().happens(scene, sphere);
    SceneBuilder other = makeEmptyScene();
    GetParam().instead(other, addWallAndSphere(other));
    const image::Image sharp = test::renderOnce(device(), other, makeLitShot()).color;
    Shot shot = makeLitShot();
    shot.frameSeconds = GetParam().frameSeconds;
    holdEveryMethod(device(), stage, shot);
    Worst worst;
    for (const std::string_view method : listMethods(device())) {
        const image::Image picture = draw(stage, shot, method).color;
        worst.addDifference(picture, sharp, method);
        const bool traces = method == "truth" || method == "denoised" || method == "adaptive";
        if (!traces) {
            EXPECT_TRUE(test::sameBits(picture, sharp)) << method;
        }
    }
    // Rays shade at their own hit, a few float steps from the raster's place.
    hold("the sharp picture", worst, 1.0 / 255.0, "brightness");
}

INSTANTIATE_TEST_SUITE_P(
    Stability,
    WithoutAPast,
    ::testing::ValuesIn(kSharpCases),
    [](const auto& instance) { return std::string(instance.param.name); }
);

class HardFrames : public test::GpuTest {};

TEST_F(HardFrames, AHitchUnderACappedShutterIsAFrameAtTheReferenceRate) {
    SceneBuilder scene = makeEmptyScene();
    // Fast enough to blur within a frame of 1/48 s.
    scene.place(addWallAndSphere(scene), {.position = {0, 0, -2.5}, .velocity = {12, 5, 2}});
    Stage stage(device(), scene);
    Shot hitch = makeLitShot();
    hitch.shutter.mode = scene::ShutterMode::Capped;
    hitch.frameSeconds = 10.0;
    hitch.settings.history = false; // the previous frame is as long ago as the hitch is long
    holdEveryMethod(device(), stage, hitch);
    Shot reference = hitch;
    reference.frameSeconds = 1.0 / scene::CameraShutter{}.referenceFps;
    Shot faster = hitch;
    faster.frameSeconds = 0.5 / scene::CameraShutter{}.referenceFps;
    Worst worst;
    for (const std::string_view method : listMethods(device())) {
        const image::Image picture = draw(stage, hitch, method).color;
        worst.addDifference(picture, draw(stage, reference, method).color, method);
    }
    hold("as at the reference rate", worst);
    EXPECT_FALSE(
        test::sameBits(draw(stage, hitch, "gather").color, draw(stage, faster, "gather").color)
    );
}

/// Change of light, percent of the sharp picture's. A truth conserves light to 0.5 %. No published
/// filter does: a gather's weights do not sum to a pixel's coverage, so the filters are held to
/// values measured here.
struct Light {
    std::string_view method;
    double expected;
    double bound; ///< of the difference from that
};

constexpr Light kLight[] = {
    {"own_velocity", -20.6, 2.0},
    {"mcguire2012", 22.7, 2.0},
    {"guertin2014", 37.9, 2.0},
    {"jimenez2014", 0.0, 0.5},
    {"gather", 22.7, 2.0},
    {"hybrid", 7.5, 2.0},
    {"resolved", 0.2, 0.5},
    {"denoised", -2.1, 1.0},
    {"accumulate", 0.0, 0.5},
    {"truth", 0.0, 0.5},
};

TEST_F(HardFrames, TheLightOfAMoverWithinThePictureIsWhatItsMethodKeeps) {
    // A sheet of one colour moves by 16 pixels before black and never leaves the picture.
    SceneBuilder scene = makeEmptyScene();
    scene.setPixelView(64);
    scene.add(
        test::makeQuad(24, 20, scene.addColor({0.8f, 0.5f, 0.2f})),
        {.position = {0.3, 0.2, -5}, .velocity = {16, 4, 0}}
    );
    Stage stage(device(), scene);
    Shot shot = makeShot();
    shot.width = 96;
    shot.height = 64;
    shot.instants = 64;
    const auto sumLight = [&](std::string_view method) {
        const image::Image picture = draw(stage, shot, method, false).color;
        double sum = 0.0;
        for (size_t i = 0; i + 2 < picture.pixels.size(); i += picture.channels)
            for (size_t c = 0; c < 3; ++c)
                sum += picture.pixels[i + c];
        return sum;
    };
    const double light = sumLight("sharp");
    for (const auto& [method, expected, bound] : kLight) {
        const double change = 100.0 * (sumLight(method) - light) / light;
        Worst worst;
        worst.add(std::abs(change - expected), fmt::format("{:+.2f} %", change));
        hold(fmt::format("{}, from {} percent", method, expected), worst, bound, "percent");
    }
}

/// Hash of the picture and every intermediate, by method.
using Hashes = std::map<std::string_view, uint64_t>;

Hashes hashEveryMethod(gpu::Device& device, Stage& stage) {
    Hashes hashes;
    Shot shot = makeLitShot();
    shot.width = 80;
    shot.height = 56;
    for (const std::string_view method : listMethods(device))
        hashes[method] = hashFrame(draw(stage, shot, method));
    return hashes;
}

TEST_F(HardFrames, TwentyRunsHaveTheSameBits) {
    const SceneBuilder scene = makeBusyScene();
    Stage stage(device(), scene);
    const Hashes first = hashEveryMethod(device(), stage);
    for (int run = 1; run < 20; ++run) {
        // Another picture in between must leave nothing behind.
        Shot other = makeLitShot();
        other.seconds = 0.1 * run;
        (void)draw(stage, other, "hybrid");
        EXPECT_EQ(hashEveryMethod(device(), stage), first) << run;
    }
}

/// Threads of this process that draw for lavapipe, whose name it gives them.
uint32_t countDriverThreads() {
    uint32_t count = 0;
    for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) {
        std::ifstream file(task.path() / "comm");
        std::string name;
        count += std::getline(file, name) && name.starts_with("llvmpipe-");
    }
    return count;
}

/// Whether the driver comes to have `wanted` threads. A thread takes its name once it runs, which
/// may be some time after the device was made.
bool awaitDriverThreads(uint32_t wanted) {
    for (int i = 0; i < 200 && countDriverThreads() != wanted; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return countDriverThreads() == wanted;
}

TEST_F(HardFrames, FramesHaveTheSameBitsWithOneAndTwoDriverThreads) {
    const SceneBuilder scene = makeBusyScene();
    const auto hashOn = [&](gpu::Device& with) {
        Stage stage(with, scene);
        return hashEveryMethod(with, stage);
    };
    const Hashes expected = hashOn(device());
    const char* usual = std::getenv("LP_NUM_THREADS");
    const std::optional<std::string> before =
        usual ? std::optional<std::string>(usual) : std::nullopt;
    for (const uint32_t count : {1u, 2u}) {
        const uint32_t others = countDriverThreads();
        setenv("LP_NUM_THREADS", std::to_string(count).c_str(), 1); // read when a device is opened
        gpu::DeviceOptions options;
        options.wanted = device().info().name;
        const auto opened = need(gpu::Device::create(options));
        if (device().info().kind == "software") {
            EXPECT_TRUE(awaitDriverThreads(others + count)) << count;
        }
        EXPECT_EQ(hashOn(*opened), expected) << count;
    }
    if (before)
        setenv("LP_NUM_THREADS", before->c_str(), 1);
    else
        unsetenv("LP_NUM_THREADS");
}

} // namespace
} // namespace shutter::stability
