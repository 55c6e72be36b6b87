// SPDX-License-Identifier: MIT
// What a picture of a sequence depends on, as a hash: two frames of equal numbers and fingerprints
// are the same bits.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device_select.h"
#include "game/output/render_options.h"
#include "game/shot/shot.h"

#include <string>

namespace shutter::game {

/// Hashes everything that a frame's picture depends on except its number and the device: the
/// options, the contents of the files that they name, and this program. A film's frames are named
/// from the first on, so their names depend on that.
/// \param shot loaded from `options.shot`
/// Error: a file cannot be read; names it.
[[nodiscard]] core::Result<std::string>
computeFingerprint(const RenderOptions& options, const Shot& shot);

/// The fingerprint of the same pictures drawn by this device and its driver.
[[nodiscard]] std::string
addDevice(const std::string& fingerprint, const std::string& device, const std::string& driver);

} // namespace shutter::game
