// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/toggle_law.h"

#include "engine/core/check.h"
#include "game/shot/picture_drawer.h"
#include "tests/conformance/stability/pictures.h"
#include "tests/conformance/stability/shapes.h"
#include "tests/kit/process_use.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <random>

namespace shutter::demand {

namespace {

using stability::Measured;
using stability::Measurements;

constexpr double kExposureSeconds = 0.25;
constexpr double kTimes[] = {0.0, 0.1};

/// Less than what one more page a frame would come to; allocators and drivers may take some.
constexpr double kProcessBytesAFrame = 2048.0;

/// What the C library and the driver keep of a renderer's memory for the next one. All renderers at
/// a time leave six times as much.
constexpr double kLeftBytes = double(384u << 20u);

/// What can be switched.
struct Switches {
    const game::MethodInfo* method = nullptr;
    bool exposed = false;
    bool toneMapped = false; ///< or the linear picture
    bool intermediates = false;

    [[nodiscard]] std::string describe() const {
        return fmt::format(
            "{}{}{}{}",
            method->name,
            exposed ? ", exposed" : "",
            toneMapped ? ", tone mapped" : "",
            intermediates ? ", intermediates" : ""
        );
    }
};

struct Moment {
    Switches switches;
    double seconds = 0.0;
};

/// Movers before each other, one with holes, light, a camera that turns.
game::Shot buildScene() {
    test::SceneBuilder scene = stability::makeEmptyScene();
    stability::addShape(
        scene, stability::makeSheetShape(6, 5), scene.addLitWaves(), {.position = {0, 0, -5}}
    );
    stability::addShape(
        scene,
        generator::sphere(0.5f, 16, 8),
        scene.addLitWaves(),
        test::Placement{
            .position = {0.1, 0, -2.5}, .velocity = {1.0, 0.2, 0.1}, .angularVelocity = {0, 0.9, 0}}
    );
    stability::addShape(
        scene,
        stability::makeSheetShape(0.8, 0.8),
        scene.addWaves(true),
        test::Placement{.position = {-0.3, 0.1, -2}, .velocity = {-0.8, 0.1, 0}}
    );
    scene.addSun(glm::normalize(math::dvec3(-0.4, -0.7, -0.6)), 3.0f);
    scene.place(scene.camera, {.angularVelocity = {0.02, 0.05, 0}});
    return {std::move(scene.world), scene.camera};
}

/// One renderer, and every method's effects as they are needed.
class Rig {
  public:
    Rig(gpu::Device& device, const ToggleOptions& options)
        : mScene(buildScene()), mRenderer(device, mScene.world.assets), mTonemap(device, {}),
          mDrawer(device, mRenderer) {
        mShot.width = options.width;
        mShot.height = options.height;
        mShot.background = math::vec3(0.1f, 0.2f, 0.3f);
        mShot.ambient = math::vec3(0.3f);
    }

    core::Result<render::FrameResult> draw(const Moment& moment) {
        const Switches& switches = moment.switches;
        mScene.world.registry.add(
            mScene.camera,
            scene::CameraShutter{
                switches.exposed ? kExposureSeconds : 0.0, scene::ShutterPhase::Centre}
        );
        game::PictureRequest picture =
            game::makePicture(mScene, mShot, game::makeMethod(*switches.method), moment.seconds);
        picture.frame.wantColor = !switches.toneMapped;
        picture.frame.wantDisplay = switches.toneMapped;
        if (switches.intermediates) {
            picture.frame.intermediates = game::listIntermediates(*switches.method);
            picture.frame.intermediates.erase("depth"); // it is in "motion"
        }
        picture.ending = {&mTonemap};
        return mDrawer.draw(mScene.world, picture);
    }

  private:
    game::Shot mScene;
    game::ShotOptions mShot;
    render::Renderer mRenderer;
    tonemap::Tonemap mTonemap;
    game::PictureDrawer mDrawer;
};

/// The truths take many times as long and are no effect that a game would switch.
std::vector<const game::MethodInfo*> listSwitched(const gpu::Device& device) {
    std::vector<const game::MethodInfo*> methods;
    for (const game::MethodInfo& method : game::listMethods()) {
        const bool isEffect = method.family == game::MethodFamily::Sharp ||
                              method.family == game::MethodFamily::MotionBlur;
        if (isEffect && game::canRun(method, device))
            methods.push_back(&method);
    }
    return methods;
}

/// Every combination of switches and times, the methods by turns, the rest in an order of chance
/// that is the same in every run; from the beginning again where the cycle is longer.
std::vector<Moment> listCycle(const gpu::Device& device) {
    const std::vector<const game::MethodInfo*> methods = listSwitched(device);
    std::minstd_rand random(7);
    std::vector<std::vector<Moment>> moments;
    for (const game::MethodInfo* method : methods) {
        std::vector<Moment>& own = moments.emplace_back();
        for (const double seconds : kTimes)
            for (int bits = 0; bits < 8; ++bits)
                own.push_back({{method, (bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0}, seconds}
                );
        for (size_t i = own.size() - 1; i > 0; --i) // std::shuffle differs between libraries
            std::swap(own[i], own[random() % (i + 1)]);
    }
    const size_t each = moments.front().size();
    SHUTTER_CHECK(methods.size() * each <= kToggleCycle, "a cycle is too short for all switches");
    std::vector<Moment> cycle;
    for (size_t frame = 0; frame < kToggleCycle; ++frame)
        cycle.push_back(moments[frame % methods.size()][frame / methods.size() % each]);
    return cycle;
}

/// Hashes of the cycle's pictures, each by a renderer that has drawn these switches alone. There is
/// one such renderer at a time: a hundred and more together would take gigabytes, which the C
/// library keeps once they are free.
core::Result<std::vector<uint64_t>>
drawUntoggled(gpu::Device& device, const ToggleOptions& options, const std::vector<Moment>& cycle) {
    std::map<std::string, std::vector<size_t>> framesOf; // by switches
    for (size_t frame = 0; frame < cycle.size(); ++frame)
        framesOf[cycle[frame].switches.describe()].push_back(frame);
    std::vector<uint64_t> hashes(cycle.size());
    for (const auto& [switches, frames] : framesOf) {
        Rig rig(device, options);
        std::map<double, uint64_t> known; // by seconds
        for (const size_t frame : frames) {
            const Moment& moment = cycle[frame];
            auto found = known.find(moment.seconds);
            if (found == known.end()) {
                auto drawn = rig.draw(moment);
                if (!drawn)
                    return drawn.error();
                found = known.emplace(moment.seconds, stability::hashFrame(drawn.value())).first;
            }
            hashes[frame] = found->second;
        }
    }
    return hashes;
}

/// At the end of a cycle, once the GPU is done.
struct Holdings {
    gpu::LivingObjects device;
    std::optional<uint64_t> processBytes;
};

double countGained(uint64_t before, uint64_t after) {
    return after > before ? double(after - before) : 0.0;
}

void addHoldings(
    Measurements& rows, const Holdings& before, const Holdings& after, uint32_t frames
) {
    const gpu::LivingObjects& a = before.device;
    const gpu::LivingObjects& b = after.device;
    const auto add = [&](const char* check, uint64_t from, uint64_t to, const char* unit) {
        rows.push_back(
            {check,
             countGained(from, to),
             0.0,
             unit,
             frames,
             0,
             fmt::format("{} after {} frames", to, frames)}
        );
    };
    add("device memory gained", a.memoryBytes, b.memoryBytes, "bytes");
    add("blocks of device memory gained", a.memoryBlocks, b.memoryBlocks, "");
    add("buffers gained", a.buffers, b.buffers, "");
    add("images gained", a.images, b.images, "");
    add("acceleration structures gained", a.accelerationStructures, b.accelerationStructures, "");
    Measured process{"memory of the process gained", 0.0, kProcessBytesAFrame, "bytes a frame"};
    if (before.processBytes && after.processBytes) {
        process.samples = frames - kToggleCycle;
        process.worst =
            countGained(*before.processBytes, *after.processBytes) / double(process.samples);
        process.note = fmt::format("{:.1f} MiB at the end", double(*after.processBytes) / 0x1p20);
    }
    rows.push_back(std::move(process));
}

/// What renderers leave that are gone.
Measured weighRenderers(
    const std::optional<uint64_t>& before, const std::optional<uint64_t>& after, uint64_t frames
) {
    Measured row{"memory of the process that renderers leave", 0.0, kLeftBytes, "bytes"};
    if (before && after) {
        row.samples = frames;
        row.worst = countGained(*before, *after);
    }
    return row;
}

} // namespace

core::Result<Measurements> measureToggles(gpu::Device& device, const ToggleOptions& options) {
    SHUTTER_CHECK(
        options.frames >= 2 * kToggleCycle && options.frames % kToggleCycle == 0,
        "{} frames are no two cycles or more",
        options.frames
    );
    const std::vector<Moment> cycle = listCycle(device);
    const std::optional<uint64_t> before = test::findResidentBytes();
    const auto expected = drawUntoggled(device, options, cycle);
    if (!expected)
        return expected.error();
    device.collectIdle();
    Measurements rows{weighRenderers(before, test::findResidentBytes(), cycle.size())};
    Rig rig(device, options);
    Measured differing{"pictures that differ from a run without toggling", 0.0, 0.0, ""};
    std::optional<Holdings> first;
    Holdings last;
    for (uint32_t frame = 0; frame < options.frames; ++frame) {
        const size_t at = frame % kToggleCycle;
        auto drawn = rig.draw(cycle[at]);
        if (!drawn)
            return drawn.error();
        ++differing.samples;
        if (stability::hashFrame(drawn.value()) != expected.value()[at]) {
            if (differing.worst == 0.0)
                differing.note =
                    fmt::format("first: frame {}, {}", frame, cycle[at].switches.describe());
            differing.worst += 1.0;
        }
        if (at + 1 < kToggleCycle)
            continue;
        device.waitIdle();
        last = {device.living(), test::findResidentBytes()};
        if (!first)
            first = last;
    }
    rows.insert(rows.begin(), std::move(differing));
    addHoldings(rows, *first, last, options.frames);
    return rows;
}

} // namespace shutter::demand
