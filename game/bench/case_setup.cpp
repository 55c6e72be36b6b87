// SPDX-License-Identifier: MIT
#include "game/bench/case_setup.h"

#include "engine/gltf/gltf_loader.h"
#include "engine/io/file_bytes.h"

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

} // namespace

core::Result<CaseSetup>
setUpCase(const Case& shot, const gpu::DeviceInfo& device, const fs::path& folder) {
    auto scene = writeScene(shot, folder);
    if (!scene)
        return scene.error();
    auto sceneHash = gltf::computeSceneHash(scene.value());
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
        game::describe(shot.shot)
    );
    return CaseSetup{scene.value(), io::computeContentHash(facts)};
}

} // namespace shutter::bench
