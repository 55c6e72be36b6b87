// SPDX-License-Identifier: MIT
#ifndef SHUTTER_APP_UI_SHARED_H
#define SHUTTER_APP_UI_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// A corner of a triangle, as Dear ImGui lays it out.
struct UiVertex {
    vec2 positionPx; ///< from the upper left corner of the window
    vec2 uv;         ///< in the font atlas, [0, 1]
    uint color; ///< straight alpha, display-encoded; red in the lowest byte, alpha in the highest
};

struct UiParams {
    uvec2 vertices;    ///< address of UiVertex[]
    vec2 clipPerPixel; ///< 2 over the window's size
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::UiVertex) == 20);
static_assert(sizeof(shutter::shader::UiParams) == 16);
#endif

#endif
