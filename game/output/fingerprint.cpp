// SPDX-License-Identifier: MIT
#include "game/output/fingerprint.h"

#include "engine/gltf/gltf_loader.h"
#include "engine/io/file_bytes.h"
#include "game/shot/surroundings.h"

#include <fmt/format.h>

namespace shutter::game {

core::Result<std::string> computeFingerprint(const RenderOptions& options, const Shot& shot) {
    auto scene = gltf::computeSceneHash(options.shot.scene, options.shot.reach);
    if (!scene)
        return scene.error();
    auto program = io::computeFileHash("/proc/self/exe");
    if (!program)
        return program.error();
    auto surroundings = computeSurroundingsHash(options.shot.environment);
    if (!surroundings)
        return surroundings.error();
    return io::computeContentHash(fmt::format(
        "scene {} surroundings {} program {} flythrough {} clip {} fps {} first {} framed {} "
        "options {}",
        scene.value(),
        surroundings.value(),
        program.value(),
        options.shot.flythroughHash,
        options.shot.flythroughClip,
        core::describe(options.shot.fps),
        options.output.film.empty() ? 0 : options.shot.firstFrame,
        shot.framedAt ? fmt::format("at {}", *shot.framedAt) : "by none",
        options.fingerprint
    ));
}

std::string
addDevice(const std::string& fingerprint, const std::string& device, const std::string& driver) {
    return io::computeContentHash(fmt::format("{} device {} {}", fingerprint, device, driver));
}

} // namespace shutter::game
