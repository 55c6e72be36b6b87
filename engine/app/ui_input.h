// SPDX-License-Identifier: MIT
#pragma once

#include "engine/app/input.h"

namespace shutter::app {

/// Tells the current ImGui context once which of our keys its widgets read.
void mapKeys();

/// One frame's input to the current ImGui context. What went down and up again within the frame
/// counts as down in this frame.
void feedInput(const InputState& input);

} // namespace shutter::app
