// SPDX-License-Identifier: MIT
// Interface between the pass that composites blended surfaces over the blurred picture and its
// shader.
#ifndef SHUTTER_COMPOSITE_SHARED_H
#define SHUTTER_COMPOSITE_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// Push constants.
struct CompositeParams {
    uvec2 originPx; // of the rectangle in the picture
    uvec2 sizePx;
    uint part; // of the exposure
    uint partCount;
    float share;           // of the exposure that the part is
    uint isOpacityInAlpha; // of the colours; 0: in red of a separate image
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::CompositeParams) == 32);
#endif

#endif
