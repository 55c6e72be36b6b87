// SPDX-License-Identifier: MIT
// Which of a frame's passes are the motion blur's.
#pragma once

#include "engine/render/renderer.h"
#include "game/methods.h"

#include <cstdint>
#include <string_view>

namespace shutter::game {

enum class PassGroup : uint8_t {
    Scene,   ///< what a frame without blur draws as well
    Blur,    ///< what the method adds to it, what is built for its rays included
    Display, ///< what brings the linear picture to the window or to memory
};

/// A method that draws the scene in its own way (many frames, rays alone) adds all it draws.
[[nodiscard]] PassGroup groupOf(const MethodInfo& method, std::string_view pass);

/// GPU milliseconds of the passes of PassGroup::Blur.
[[nodiscard]] double
sumBlurMilliseconds(const MethodInfo& method, const render::FrameStatistics& statistics);

} // namespace shutter::game
