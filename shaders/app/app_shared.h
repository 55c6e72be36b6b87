// SPDX-License-Identifier: MIT
// Drawing into the program's window: pictures, then the panels over them.
#ifndef SHUTTER_APP_SHARED_H
#define SHUTTER_APP_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// How pictures lie on the window.
struct WindowParams {
    vec2 originPx;         ///< of the pictures' upper left corner, window pixels
    vec2 extentPx;         ///< of the pictures on the window, above 0
    float dividerPx;       ///< window pixels: left of it the left picture; below 0: no left picture
    float lineHalfWidthPx; ///< of the line between them, pixels; 0: none
};

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
static_assert(sizeof(shutter::shader::WindowParams) == 24);
static_assert(sizeof(shutter::shader::UiVertex) == 20);
static_assert(sizeof(shutter::shader::UiParams) == 16);
#endif

#endif
