// SPDX-License-Identifier: MIT
// What the player of a soak does: an input script that switches everything that can be switched.
#pragma once

#include "game/options/picture_size.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <vector>

namespace shutter::stability {

/// Frames after which the same is done again. At a cycle's end everything is set as at its start,
/// so that what is held in memory then may be compared.
inline constexpr uint32_t kCycleFrames = 250;

/// The frames whose pictures are kept, counted from 0: at no two the same place of the cycle.
[[nodiscard]] std::vector<uint32_t> chooseFrames(uint32_t frameCount);

/// The file of a kept picture in the folder of a run's pictures.
[[nodiscard]] std::filesystem::path
pictureFile(const std::filesystem::path& folder, uint32_t frame);

/// A script for `shutter play --script` (engine/app/input_script.schema.json): in each cycle
/// methods, presets, views, the split, the panel and the camera change every third frame, the
/// window's size four times; there are pauses, single steps and photo mode. Ends after `frameCount`
/// frames. \param pictures folder of the kept pictures
[[nodiscard]] nlohmann::ordered_json makeSoakScript(
    uint32_t frameCount, const game::PictureSize& size, const std::filesystem::path& pictures
);

/// Settings that a cycle begins with (`shutter play --settings`): few samples, so that methods
/// which draw many frames for a picture take no longer than others.
[[nodiscard]] nlohmann::ordered_json makeSoakSettings();

} // namespace shutter::stability
