// SPDX-License-Identifier: MIT
// Which of a picture's passes count as the motion blur's.
#pragma once

#include "engine/render/frame_statistics.h"
#include "game/shot/methods.h"

#include <cstdint>

namespace shutter::game {

enum class PassGroup : uint8_t {
    Scene,   ///< what a picture without blur draws as well
    Blur,    ///< what the method adds to it, acceleration structures for its rays included
    Display, ///< what brings the linear picture to the window or to memory
};

/// `sharp` adds nothing to a picture. Everything that a method draws counts as its own if it draws
/// the scene in its own way (many frames, rays alone).
[[nodiscard]] PassGroup groupOf(const MethodInfo& method, render::PassOwner owner);

/// GPU milliseconds of the passes of PassGroup::Blur.
[[nodiscard]] double
sumBlurMilliseconds(const MethodInfo& method, const render::FrameStatistics& statistics);

/// GPU milliseconds from the G-buffer to the linear picture.
[[nodiscard]] double sumFrameMilliseconds(const render::FrameStatistics& statistics);

} // namespace shutter::game
