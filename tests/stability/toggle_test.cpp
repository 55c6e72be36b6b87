// SPDX-License-Identifier: MIT
// Switching effects on and off every frame leaves no trace: no bit in a picture, no memory.
#include "engine/core/check.h"
#include "game/shot/picture_drawer.h"
#include "modules/tonemap/tonemap.h"
#include "tests/kit/process_use.h"
#include "tests/stability/hard_case.h"

#include <fmt/format.h>

#include <map>
#include <random>

namespace shutter::stability {
namespace {

constexpr double kExposureSeconds = 0.25;
constexpr double kTimes[] = {0.0, 0.1};

/// Frames after which the same switches are set again; memory is compared between ends of cycles.
constexpr uint32_t kCycle = 200;
constexpr uint32_t kFrames = 10 * kCycle;

/// The switches.
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

/// One renderer, and every method's effects as they are needed.
class Rig {
  public:
    explicit Rig(gpu::Device& device)
        : mRenderer(device, mScene.world.assets), mTonemap(device, {}), mDrawer(device, mRenderer) {
        mShot.width = 48;
        mShot.height = 32;
        mShot.background = math::vec3(0.1f, 0.2f, 0.3f);
        mShot.ambient = math::vec3(0.3f);
    }

    render::FrameResult draw(const Moment& moment) {
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
        return need(mDrawer.draw(mScene.world, picture));
    }

  private:
    static game::Shot buildShot() {
        SceneBuilder scene = makeBusyScene();
        return {std::move(scene.world), scene.camera, {}};
    }

    game::Shot mScene = buildShot();
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
    SHUTTER_CHECK(methods.size() * each <= kCycle, "a cycle is too short for all switches");
    std::vector<Moment> cycle;
    for (size_t frame = 0; frame < kCycle; ++frame)
        cycle.push_back(moments[frame % methods.size()][frame / methods.size() % each]);
    return cycle;
}

/// Hashes of the cycle's pictures, each by a renderer that has drawn these switches alone. There is
/// one such renderer at a time: a hundred and more together would take gigabytes, which the C
/// library keeps once they are free.
std::vector<uint64_t> drawUntoggled(gpu::Device& device, const std::vector<Moment>& cycle) {
    std::map<std::string, std::vector<size_t>> framesOf; // by switches
    for (size_t frame = 0; frame < cycle.size(); ++frame)
        framesOf[cycle[frame].switches.describe()].push_back(frame);
    std::vector<uint64_t> hashes(cycle.size());
    for (const auto& [switches, frames] : framesOf) {
        Rig rig(device);
        std::map<double, uint64_t> known; // by seconds
        for (const size_t frame : frames) {
            const Moment& moment = cycle[frame];
            auto found = known.find(moment.seconds);
            if (found == known.end())
                found = known.emplace(moment.seconds, hashFrame(rig.draw(moment))).first;
            hashes[frame] = found->second;
        }
    }
    return hashes;
}

/// Expects that no more than `bound` was gained for each of `frames`.
void holdGain(
    const char* check,
    uint64_t before,
    uint64_t after,
    double bound = 0.0,
    uint64_t frames = kFrames
) {
    Worst gain;
    gain.add(after > before ? double(after - before) : 0.0, fmt::format("{} at the end", after));
    hold(check, gain, bound * double(frames));
}

class Toggles : public test::GpuTest {};

TEST_F(Toggles, TwoThousandFramesOfOneRendererAreThoseOfRenderersThatDrewNothingElse) {
    const std::vector<Moment> cycle = listCycle(device());
    ASSERT_TRUE(test::findResidentBytes()) << "the system does not report the memory of a process";
    const uint64_t before = *test::findResidentBytes();
    const std::vector<uint64_t> expected = drawUntoggled(device(), cycle);
    device().collectIdle();
    // What the C library and the driver keep of a renderer's memory for the next one. All renderers
    // at a time leave six times as much.
    holdGain("bytes that renderers leave", before, *test::findResidentBytes(), 384u << 20u, 1);
    Rig rig(device());
    gpu::LivingObjects first;
    uint64_t firstBytes = 0;
    for (uint32_t frame = 0; frame < kFrames; ++frame) {
        const Moment& moment = cycle[frame % kCycle];
        EXPECT_EQ(hashFrame(rig.draw(moment)), expected[frame % kCycle])
            << frame << ", " << moment.switches.describe();
        if (frame + 1 != kCycle)
            continue;
        device().waitIdle();
        first = device().living();
        firstBytes = *test::findResidentBytes();
    }
    device().waitIdle();
    const gpu::LivingObjects last = device().living();
    holdGain("bytes of device memory", first.memoryBytes, last.memoryBytes);
    holdGain("blocks of device memory", first.memoryBlocks, last.memoryBlocks);
    holdGain("buffers", first.buffers, last.buffers);
    holdGain("images", first.images, last.images);
    holdGain("acceleration structures", first.accelerationStructures, last.accelerationStructures);
    // Less than what one more page a frame would come to; allocators and drivers may take some.
    holdGain(
        "bytes of the process", firstBytes, *test::findResidentBytes(), 2048.0, kFrames - kCycle
    );
}

} // namespace
} // namespace shutter::stability
