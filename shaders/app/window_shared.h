// SPDX-License-Identifier: MIT
#ifndef SHUTTER_APP_WINDOW_SHARED_H
#define SHUTTER_APP_WINDOW_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// How pictures lie on the window.
struct WindowParams {
    vec2 originPx;         ///< of the pictures' upper left corner, window pixels
    vec2 extentPx;         ///< of the pictures on the window, above 0
    float dividerPx;       ///< window pixels: left of it the left picture; below 0: no left picture
    float lineHalfWidthPx; ///< of the line between them, pixels; 0: none
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::WindowParams) == 24);
#endif

#endif
