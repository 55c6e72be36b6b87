// SPDX-License-Identifier: MIT
// A scene under a camera that moves and turns, as a host would draw it.
#pragma once

#include "assets/generator/gltf_writer.h"
#include "engine/core/result.h"
#include "engine/extract/frame_view.h"
#include "game/options/shot_arguments.h"
#include "game/shot/shot.h"
#include "modules/motion_blur/embedding/host_convention.h"

#include <string>

namespace shutter::test {

struct CheckScene {
    std::string name;
    generator::GltfWriter (*build)(); ///< null: a file of the shared scenes
    std::string path;                 ///< of that
    std::string keys;                 ///< of a flythrough
    double orthographicYMag = 0.0;    ///< half height of what is seen, metres; 0: perspective
    /// Too much moves by itself for mistakes to be seen.
    bool hidesMistakes = false;
    void (*prepare)(scene::World& world) = nullptr; ///< moves what the file has at rest
};

struct CheckedShot {
    game::ShotOptions options;
    game::Shot shot;
};

/// Unlit, the raster instant at the end of the exposure. Error: a file cannot be read or written.
[[nodiscard]] core::Result<CheckedShot>
loadCheckedShot(const CheckScene& scene, const math::uvec2& sizePx, double exposureSeconds);

/// The camera when the shutter closes, and, as the one before, when it opens.
[[nodiscard]] motion_blur::HostCameras
tellCameras(const scene::World& world, const extract::ViewRequest& view);

} // namespace shutter::test
