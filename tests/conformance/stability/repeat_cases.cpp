// SPDX-License-Identifier: MIT
// The same bits: in twenty runs, and whatever number of threads the driver has.
#include "tests/conformance/stability/case_lists.h"
#include "tests/conformance/stability/pictures.h"

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

namespace shutter::stability {

namespace {

namespace fs = std::filesystem;

constexpr uint32_t kRuns = 20;

/// Every pass has something to do: movers before each other, holes, light, a camera that turns.
void buildBusy(SceneBuilder& scene) {
    addShape(scene, makeSheetShape(6, 5), scene.addLitWaves(), Placement{.position = {0, 0, -5}});
    addShape(
        scene,
        generator::sphere(0.5f, 24, 12),
        scene.addLitWaves(),
        Placement{
            .position = {0.1, 0, -2.5},
            .velocity = {0.5, 0.2, 0.1},
            .angularVelocity = {0.2, 0.9, 0.1}}
    );
    addShape(
        scene,
        makeSheetShape(0.8, 0.8),
        scene.addWaves(true),
        Placement{.position = {-0.3, 0.1, -2}, .velocity = {-0.4, 0.1, 0}}
    );
    scene.addSun(glm::normalize(math::dvec3(-0.4, -0.7, -0.6)), 3.0f);
    scene.place(scene.camera, {.angularVelocity = {0.02, 0.05, 0}});
}

const View kView{
    .width = 80,
    .height = 56,
    .background = math::vec3(0.1f, 0.2f, 0.3f),
    .ambient = math::vec3(0.3f)};

/// Hash of the picture and every intermediate, by method.
using Hashes = std::map<std::string, uint64_t>;

core::Result<Hashes> hashEveryMethod(Drawer& drawer) {
    Hashes hashes;
    for (const game::MethodInfo& method : game::listMethods()) {
        if (!game::canRun(method, drawer.device()))
            continue;
        auto frame = drawer.draw(method.name, kView);
        if (!frame)
            return frame.error();
        hashes[method.name] = hashFrame(frame.value());
    }
    return hashes;
}

void compareHashes(Worst& worst, const Hashes& expected, const Hashes& found) {
    for (const auto& [method, hash] : expected)
        worst.add(found.at(method) == hash ? 0.0 : 1.0, method);
}

core::Result<Measurements> measureRuns(gpu::Device& device) {
    SceneBuilder scene = makeEmptyScene();
    buildBusy(scene);
    Drawer drawer(device, std::move(scene));
    const auto first = hashEveryMethod(drawer);
    if (!first)
        return first.error();
    Worst worst;
    for (uint32_t run = 1; run < kRuns; ++run) {
        // Another picture in between must leave nothing behind.
        View other = kView;
        other.seconds = 0.1 * run;
        if (const auto drawn = drawer.draw("hybrid", other); !drawn)
            return drawn.error();
        const auto again = hashEveryMethod(drawer);
        if (!again)
            return again.error();
        compareHashes(worst, first.value(), again.value());
    }
    return Measurements{describe(worst, "runs that differ", "", 0.0)};
}

/// Sets a variable of the environment, and puts it back.
class ScopedVariable {
  public:
    ScopedVariable(const char* name, const char* value) : mName(name) {
        if (const char* before = std::getenv(name))
            mBefore = before;
        setenv(name, value, 1);
    }

    ~ScopedVariable() {
        if (mBefore)
            setenv(mName, mBefore->c_str(), 1);
        else
            unsetenv(mName);
    }

    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

  private:
    const char* mName;
    std::optional<std::string> mBefore;
};

/// Threads of this process that draw for lavapipe, whose name it gives them.
uint32_t countDriverThreads() {
    uint32_t count = 0;
    std::error_code failure;
    for (const auto& task : fs::directory_iterator("/proc/self/task", failure)) {
        std::ifstream file(task.path() / "comm");
        std::string name;
        count += std::getline(file, name) && name.starts_with("llvmpipe-");
    }
    return count;
}

/// How many of the driver's threads there are beyond those asked for, or too few. A thread takes
/// its name once it runs, which may be some time after the device was made.
double findSurplusThreads(uint32_t before, uint32_t wanted) {
    constexpr int kLooks = 200;
    double surplus = 0.0;
    for (int i = 0; i < kLooks; ++i) {
        surplus = std::abs(double(countDriverThreads()) - double(before) - double(wanted));
        if (surplus == 0.0)
            break;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return surplus;
}

core::Result<Measurements> measureThreads(gpu::Device& device) {
    const auto hashOn = [](gpu::Device& with) {
        SceneBuilder scene = makeEmptyScene();
        buildBusy(scene);
        Drawer drawer(with, std::move(scene));
        return hashEveryMethod(drawer);
    };
    const auto expected = hashOn(device);
    if (!expected)
        return expected.error();
    Worst worst;
    Worst threads;
    for (const uint32_t count : {1u, 2u}) {
        const uint32_t before = countDriverThreads();
        // Read when a device is opened.
        const ScopedVariable wanted("LP_NUM_THREADS", std::to_string(count).c_str());
        gpu::DeviceOptions options;
        options.wanted = device.info().name;
        auto opened = gpu::Device::create(options);
        if (!opened)
            return opened.error();
        if (device.info().kind == "software")
            threads.add(findSurplusThreads(before, count));
        const auto found = hashOn(*opened.value());
        if (!found)
            return found.error();
        compareHashes(worst, expected.value(), found.value());
    }
    Measurements all = {describe(worst, "methods that differ with 1 and 2 threads", "", 0.0)};
    if (device.info().kind == "software")
        all.push_back(describe(threads, "threads beyond those asked for", "", 0.0));
    return all;
}

} // namespace

std::vector<HardCase> listRepeatCases() {
    return {
        {"TwentyRuns",
         "The same bits in 20 runs",
         "Pictures and intermediates of every method, drawn twenty times.",
         measureRuns},
        {"DriverThreads",
         "The same bits on one thread and on two",
         "A software device with one thread, with two, and as it comes.",
         measureThreads},
    };
}

} // namespace shutter::stability
