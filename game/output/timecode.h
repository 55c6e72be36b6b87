// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/result.h"
#include "engine/io/image_file.h"
#include "game/output/render_options.h"

#include <cstddef>
#include <optional>
#include <string>

namespace shutter::game {

/// The time code of a frame of a sequence by --timecode and --fps; after 24 hours it begins anew.
/// Empty without --timecode.
/// \param frame index among the sequence's frames
/// Error: names --timecode.
[[nodiscard]] core::Result<std::optional<io::Timecode>>
findTimecode(const RenderOptions& options, size_t frame);

/// What the EXR pictures of a frame of a sequence say of their place in time; a single picture has
/// none. \param frame index among the sequence's frames
/// Error: names --timecode.
[[nodiscard]] core::Result<std::optional<io::FrameStamp>>
findStamp(const RenderOptions& options, size_t frame);

/// "01:00:00:00"
[[nodiscard]] std::string describe(const io::Timecode& timecode);

} // namespace shutter::game
