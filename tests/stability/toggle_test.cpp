// SPDX-License-Identifier: MIT
// Switching effects on and off every frame leaves no trace: no bit in a picture, no memory.
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

/// How often the same switches are set again; memory is compared between ends of cycles.
constexpr uint32_t kCycles = 4;

enum Switches : unsigned {
    kExposed = 1,
    kToneMapped = 2, ///< or the linear picture
    kIntermediates = 4,
};

struct Moment {
    const game::MethodInfo* method = nullptr;
    unsigned switches = 0;
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
        const auto [method, switches, seconds] = moment;
        mScene.world.registry.add(
            mScene.camera,
            scene::CameraShutter{
                (switches & kExposed) != 0 ? kExposureSeconds : 0.0, scene::ShutterPhase::Centre}
        );
        game::PictureRequest picture =
            game::makePicture(mScene, mShot, game::makeMethod(*method), seconds);
        picture.frame.wantDisplay = (switches & kToneMapped) != 0;
        picture.frame.wantColor = !picture.frame.wantDisplay;
        if ((switches & kIntermediates) != 0) {
            picture.frame.intermediates = game::listIntermediates(*method);
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

/// Each pair of values of any two switches; all combinations with SHUTTER_ALL=1.
std::vector<unsigned> listCombinations() {
    if (test::drawsAll())
        return {0, 1, 2, 3, 4, 5, 6, 7};
    return {0, kExposed | kToneMapped, kExposed | kIntermediates, kToneMapped | kIntermediates};
}

/// Every combination with every method and time, the methods by turns, the rest in an order of
/// chance that is the same in every run.
std::vector<Moment> listCycle(const gpu::Device& device) {
    std::minstd_rand random(7);
    std::vector<std::vector<Moment>> moments; // by method
    for (const game::MethodInfo* method : listSwitched(device)) {
        std::vector<Moment>& own = moments.emplace_back();
        for (const double seconds : kTimes)
            for (const unsigned switches : listCombinations())
                own.push_back({method, switches, seconds});
        for (size_t i = own.size() - 1; i > 0; --i) // std::shuffle differs between libraries
            std::swap(own[i], own[random() % (i + 1)]);
    }
    std::vector<Moment> cycle;
    for (size_t turn = 0; turn < moments.front().size(); ++turn)
        for (const std::vector<Moment>& own : moments)
            cycle.push_back(own[turn]);
    return cycle;
}

/// Hashes of the cycle's pictures, each by a renderer that has drawn these switches alone. There is
/// one such renderer at a time: a hundred and more together would take gigabytes, which the C
/// library keeps once they are free.
std::vector<uint64_t> drawUntoggled(gpu::Device& device, const std::vector<Moment>& cycle) {
    std::map<std::pair<const game::MethodInfo*, unsigned>, std::vector<size_t>> framesOf;
    for (size_t frame = 0; frame < cycle.size(); ++frame)
        framesOf[{cycle[frame].method, cycle[frame].switches}].push_back(frame);
    std::vector<uint64_t> hashes(cycle.size());
    for (const auto& [switches, frames] : framesOf) {
        Rig rig(device);
        for (const size_t frame : frames)
            hashes[frame] = hashFrame(rig.draw(cycle[frame]));
    }
    return hashes;
}

/// Expects that no more than `bound` was gained for each of `frames`.
void holdGain(
    const char* check, uint64_t before, uint64_t after, double bound = 0.0, uint64_t frames = 1
) {
    Worst gain;
    gain.add(after > before ? double(after - before) : 0.0, fmt::format("{} at the end", after));
    hold(check, gain, bound * double(frames));
}

class Toggles : public test::GpuTest {};

TEST_F(Toggles, FramesOfOneRendererAreThoseOfRenderersThatDrewNothingElse) {
    const std::vector<Moment> cycle = listCycle(device());
    ASSERT_TRUE(test::findResidentBytes()) << "the system does not report the memory of a process";
    Rig rig(device());
    std::vector<uint64_t> drawn;
    for (const Moment& moment : cycle)
        drawn.push_back(hashFrame(rig.draw(moment)));
    device().waitIdle();
    const gpu::LivingObjects first = device().living();
    // Every shader is compiled by now.
    const uint64_t before = *test::findResidentBytes();
    const std::vector<uint64_t> expected = drawUntoggled(device(), cycle);
    device().collectIdle();
    const uint64_t firstBytes = *test::findResidentBytes();
    // What the C library and the driver keep of a renderer's memory for the next one.
    holdGain("bytes that renderers leave", before, firstBytes, 384u << 20u);
    for (size_t turn = 1; turn < kCycles; ++turn)
        for (const Moment& moment : cycle)
            drawn.push_back(hashFrame(rig.draw(moment)));
    for (size_t frame = 0; frame < drawn.size(); ++frame) {
        const Moment& moment = cycle[frame % cycle.size()];
        EXPECT_EQ(drawn[frame], expected[frame % cycle.size()])
            << frame << ", " << moment.method->name << ", " << moment.switches;
    }
    device().waitIdle();
    const gpu::LivingObjects last = device().living();
    holdGain("bytes of device memory", first.memoryBytes, last.memoryBytes);
    holdGain("blocks of device memory", first.memoryBlocks, last.memoryBlocks);
    holdGain("buffers", first.buffers, last.buffers);
    holdGain("images", first.images, last.images);
    holdGain("acceleration structures", first.accelerationStructures, last.accelerationStructures);
    // Less than what one more page a frame would come to; allocators and drivers may take some.
    const uint64_t frames = (kCycles - 1) * cycle.size();
    holdGain("bytes of the process", firstBytes, *test::findResidentBytes(), 2048.0, frames);
}

} // namespace
} // namespace shutter::stability
