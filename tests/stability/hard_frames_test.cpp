// SPDX-License-Identifier: MIT
// Frames in which something has no past, frames of no and of great length, the light that a blur
// loses, the same bits in every run, and lenses of all sizes, focused anywhere, in front of bright,
// near and absent things.
#include "engine/image/metrics.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/history.h"
#include "engine/scene/lens.h"
#include "game/shot/methods.h"
#include "tests/stability/hard_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>

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

struct SharpCase {
    const char* name;
    Change happens;
    Change instead = changeNothing; ///< in the sharp picture
    double frameSeconds = scene::kStillFrameSeconds;
};

const SharpCase kSharpCases[] = {
    {"spawn",
     [](SceneBuilder& scene, ecs::Entity sphere) { scene::appear(scene.world, sphere, kOpening); }},
    {"despawn",
     [](SceneBuilder& scene, ecs::Entity sphere) { scene::despawn(scene.world, sphere); },
     [](SceneBuilder& scene, ecs::Entity sphere) { scene::hide(scene.world, sphere); }},
    {"teleport", teleportSphere, teleportSphere},
    {"camera cut", cutCamera, cutCamera},
    {"world begins", [](SceneBuilder& scene, ecs::Entity) { scene.world.startSeconds = kEvent; }},
    {"paused", changeNothing, changeNothing, 0.0},
};

TEST_F(HardCases, EveryMethodDrawsTheSharpPictureOfWhatHasNoPast) {
    for (const SharpCase& one : kSharpCases) {
        SCOPED_TRACE(one.name);
        SceneBuilder scene = makeEmptyScene();
        const ecs::Entity sphere = addWallAndSphere(scene);
        Stage stage(device(), scene);
        // Drawn once as it was: whatever the renderer keeps of a frame must not come back.
        (void)draw(stage, makeLitShot(), "hybrid");
        one.happens(scene, sphere);
        SceneBuilder other = makeEmptyScene();
        one.instead(other, addWallAndSphere(other));
        const image::Image sharp = test::renderOnce(device(), other, makeLitShot()).color;
        Shot shot = makeLitShot();
        shot.frameSeconds = one.frameSeconds;
        Worst worst;
        const auto judge = [&](std::string_view method, const Shot& drawn, const auto& frame) {
            if (drawn.phase != shot.phase)
                return; // it happened long before the shutter opened
            worst.addDifference(frame.color, sharp, method);
            const bool traces = method == "truth" || method == "denoised" || method == "adaptive";
            if (!traces) {
                EXPECT_TRUE(test::sameBits(frame.color, sharp)) << method;
            }
        };
        const std::string label = std::string(", ") + one.name;
        holdEveryMethod(device(), stage, shot, label, Phases::OfShot, judge);
        // Rays shade at their own hit, a few float steps from the raster's place.
        hold("the sharp picture" + label, worst, 1.0 / 255.0, "brightness");
    }
}

TEST_F(HardCases, AHitchUnderACappedShutterIsAFrameAtTheReferenceRate) {
    SceneBuilder scene = makeEmptyScene();
    // Fast enough to blur within a frame of 1/48 s.
    scene.place(addWallAndSphere(scene), {.position = {0, 0, -2.5}, .velocity = {12, 5, 2}});
    Stage stage(device(), scene);
    Shot hitch = makeLitShot();
    hitch.shutter.mode = scene::ShutterMode::Capped;
    hitch.frameSeconds = 10.0;
    hitch.settings.history = false; // the previous frame is as long ago as the hitch is long
    const double referenceSeconds = 1.0 / scene::CameraShutter{}.referenceFps;
    Worst worst;
    const auto judge = [&](std::string_view method, Shot drawn, const auto& frame) {
        drawn.frameSeconds = referenceSeconds;
        worst.addDifference(frame.color, draw(stage, drawn, method).color, method);
        drawn.frameSeconds = 0.5 * referenceSeconds;
        if (method == "gather") {
            EXPECT_FALSE(test::sameBits(frame.color, draw(stage, drawn, method).color));
        }
    };
    holdEveryMethod(device(), stage, hitch, "", Phases::OfShot, judge);
    hold("as at the reference rate", worst);
}

/// Change of light, percent of the sharp picture's. A truth conserves light to 0.5 %. No published
/// filter does: a gather's weights do not sum to a pixel's coverage, so the filters are held to
/// values measured here. Counted taps do, in `hybrid`.
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
    {"hybrid", 0.0, 0.5},
    {"resolved", 0.2, 0.5},
    {"denoised", -2.1, 1.0},
    {"accumulate", 0.0, 0.5},
    {"truth", 0.0, 0.5},
};

TEST_F(HardCases, TheLightOfAMoverWithinThePictureIsWhatItsMethodKeeps) {
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

TEST_F(HardCases, FramesHaveTheSameBitsInEachRunAndWithOneAndTwoDriverThreads) {
    const SceneBuilder scene = makeBusyScene();
    Stage stage(device(), scene);
    const Hashes expected = hashEveryMethod(device(), stage);
    const int runs = test::drawsAll() ? 20 : 4;
    for (int run = 1; run < runs; ++run) {
        // Another picture in between must leave nothing behind.
        Shot other = makeLitShot();
        other.seconds = 0.1 * run;
        (void)draw(stage, other, "hybrid");
        EXPECT_EQ(hashEveryMethod(device(), stage), expected) << run;
    }
    const uint32_t others = countDriverThreads();
    for (const uint32_t count : {1u, 2u}) {
        if (count == others)
            continue;                                               // the device above has as many
        setenv("LP_NUM_THREADS", std::to_string(count).c_str(), 1); // read when a device is opened
        gpu::DeviceOptions options;
        options.wanted = device().info().name;
        const auto opened = need(gpu::Device::create(options));
        Stage own(*opened, scene);
        EXPECT_EQ(hashEveryMethod(*opened, own), expected) << count;
        if (device().info().kind == "software") {
            EXPECT_EQ(countDriverThreads(), others + count);
        }
    }
    unsetenv("LP_NUM_THREADS");
}

using scene::CameraLens;

constexpr double kNearPlane = 0.05; ///< of makeEmptyScene()'s camera

struct LensCase {
    const char* name;
    CameraLens lens;
    /// Of `resolved` against `accumulate`, linear, of values up to 1; what moves over a second is
    /// blurred as well.
    double leastDecibels = 0.0;
    void (*change)(SceneBuilder& scene) = [](SceneBuilder&) {};
    uint32_t width = 64;
    uint32_t height = 48;
};

void addBright(SceneBuilder& scene) {
    scene::Material lamp;
    lamp.baseColorFactor = {0, 0, 0, 1};
    lamp.emissive = math::vec3(65000.0f);
    scene.add(test::makeQuad(0.2, 0.2, scene.addMaterial(lamp)), {.position = {0.5, 0.4, -1.2}});
}

void addAtNearPlane(SceneBuilder& scene) {
    scene.add(
        test::makeQuad(0.02, 0.02, scene.addColor({1, 1, 1})),
        {.position = {0, 0, -1.001 * kNearPlane}}
    );
}

void removeAll(SceneBuilder& scene) {
    std::vector<ecs::Entity> drawn;
    for (auto [entity, instance] : scene.world.registry.view<scene::MeshInstance>()) {
        (void)instance;
        drawn.push_back(entity);
    }
    for (const ecs::Entity entity : drawn)
        scene::despawn(scene.world, entity);
}

/// The camera is cut while its autofocus is on its way to the sphere.
void cutDuringEasing(SceneBuilder& scene) {
    const ecs::Entity target = scene.add(
        test::makeSphere(0.2, scene.addLitWaves()),
        {.position = {-0.4, -0.3, -1.5}, .velocity = {0, 0, -4}}
    );
    scene.world.registry.add(scene.camera, scene::AutoFocus{target, 0.3});
    scene::advanceAutoFocus(scene.world, -0.6);
    scene::cut(scene.world, scene.camera, 0.1);
    scene::advanceAutoFocus(scene.world, 0.6);
}

const LensCase kLensCases[] = {
    {"focus at the near plane", {.fStop = 0.5, .focusDistance = kNearPlane}, 27.5},
    {"focus at a millimetre", {.fStop = 2.0, .focusDistance = 1.0e-3}, 21.0},
    {"focus at a thousand kilometres", {.fStop = 0.2, .focusDistance = 1.0e6}, 31.5},
    {"widest lens", {.fStop = 0.01, .focusDistance = 2.5}, 26.5},
    {"smallest lens", {.fStop = 1.0e9, .focusDistance = 2.5}, 32.0},
    {"confusion wider than the picture", {.fStop = 0.02, .focusDistance = 0.1}, 21.0},
    {"sky only", {.fStop = 0.05, .focusDistance = 1.0}, 60.0, removeAll},
    // One sample's colour is the pixel's: nothing is held.
    {"one pixel", {.fStop = 0.1, .focusDistance = 2.5}, 0.0, addAtNearPlane, 1, 1},
    {"odd size", {.fStop = 0.1, .focusDistance = 2.5}, 21.0, addAtNearPlane, 41, 39},
    {"at the near plane", {.fStop = 0.1, .focusDistance = 2.5}, 21.5, addAtNearPlane},
    {"bright as 65000", {.fStop = 0.1, .focusDistance = 2.5}, 20.5, addBright},
    {"cut during easing", {.fStop = 0.2, .focusDistance = 2.5}, 33.5, cutDuringEasing},
};

image::Image clampToOne(image::Image picture) {
    for (float& value : picture.pixels)
        value = std::min(value, 1.0f);
    return picture;
}

void holdLens(gpu::Device& device, const LensCase& one) {
    SceneBuilder scene = makeBusyScene();
    scene.world.registry.add(scene.camera, one.lens);
    one.change(scene);
    Stage stage(device, scene);
    Shot shot = makeLitShot();
    shot.width = one.width;
    shot.height = one.height;
    shot.instants = 256;
    const render::FrameResult mean = draw(stage, shot, "accumulate");
    shot.instants = 64;
    Worst notFinite;
    Worst negative;
    Worst beyond;
    Worst decibels;
    float brightest = 65504.0f;
    if (one.change != addBright)
        brightest = *std::max_element(mean.color.pixels.begin(), mean.color.pixels.end());
    for (const game::MethodInfo& method : game::listMethods()) {
        if (!method.hasLens || !game::canRun(method, device))
            continue;
        const std::string_view name = method.name;
        const render::FrameResult frame = name == "accumulate" ? mean : draw(stage, shot, name);
        notFinite.addNotFinite(frame.color, name);
        for (const auto& [view, picture] : frame.intermediates)
            notFinite.addNotFinite(picture, fmt::format("{}, {}", name, view));
        for (const float value : frame.color.pixels) {
            negative.add(-double(value), name);
            beyond.add(double(value) - 1.5 * brightest, name);
        }
        const double near = image::computePsnr(clampToOne(frame.color), clampToOne(mean.color));
        testing::Test::RecordProperty(
            fmt::format("{}, {}, dB", one.name, name), std::to_string(near)
        );
        if (name == "resolved")
            decibels.add(one.leastDecibels - near, name);
    }
    const std::string label = std::string(", ") + one.name;
    hold("values that are not finite" + label, notFinite);
    hold("values below 0" + label, negative);
    hold("values beyond the brightest, half as much again" + label, beyond);
    hold("dB below the bound of resolved" + label, decibels, 0.0, "dB");
}

TEST_F(HardCases, EveryMethodWithALensIsFiniteInRangeAndNearTheMeanOfManyPictures) {
    for (const LensCase& one : kLensCases) {
        SCOPED_TRACE(one.name);
        holdLens(device(), one);
    }
}

} // namespace
} // namespace shutter::stability
