// SPDX-License-Identifier: MIT
#include "game/bench/case_setup.h"

#include "engine/io/content_hash.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <vector>

namespace shutter::bench {

namespace {

namespace fs = std::filesystem;

core::Result<fs::path> writeScene(const Case& shot, const fs::path& folder) {
    if (!shot.writeScene)
        return fs::path(shot.shot.scene);
    const fs::path file = folder / "scenes" / (shot.name + ".glb");
    if (core::Status written = shot.writeScene(file); !written)
        return written.error();
    return file;
}

/// A .gltf names other files; all that lies in its folder counts as its content.
core::Result<std::string> hashScene(const fs::path& scene) {
    auto own = io::computeFileHash(scene);
    if (!own || scene.extension() != ".gltf")
        return own;
    std::vector<fs::path> files;
    std::error_code failure;
    for (const auto& entry : fs::recursive_directory_iterator(
             scene.has_parent_path() ? scene.parent_path() : fs::path("."), failure
         ))
        if (entry.is_regular_file())
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::string all;
    for (const fs::path& file : files) {
        auto hash = io::computeFileHash(file);
        if (!hash)
            return hash;
        all += hash.value();
    }
    return io::computeContentHash(all);
}

/// Every option that changes a picture; the order is part of the hash.
std::string describeShot(const game::RenderArguments& shot) {
    return fmt::format(
        "camera {} time {} clips {} loop {} shutter {} fps {} pixel {} seed {} size {} unlit {} "
        "background {} ambient {} ev {} tonemap {} set {}",
        shot.camera,
        shot.time,
        fmt::join(shot.clips, ","),
        shot.loop,
        game::describeShutter(shot),
        shot.fps,
        shot.pixel,
        shot.seed,
        shot.size,
        shot.unlit,
        shot.background,
        shot.ambient,
        shot.exposureValue,
        shot.tonemap,
        fmt::join(shot.settings, ",")
    );
}

} // namespace

core::Result<CaseSetup>
setUpCase(const Case& shot, const gpu::DeviceInfo& device, const fs::path& folder) {
    auto scene = writeScene(shot, folder);
    if (!scene)
        return scene.error();
    auto sceneHash = hashScene(scene.value());
    if (!sceneHash)
        return sceneHash.error();
    auto program = io::computeFileHash("/proc/self/exe");
    if (!program)
        return program.error();
    const std::string facts = fmt::format(
        "scene {} program {} device {} {} {}",
        sceneHash.value(),
        program.value(),
        device.name,
        device.driver,
        describeShot(shot.shot)
    );
    return CaseSetup{scene.value(), io::computeContentHash(facts)};
}

} // namespace shutter::bench
