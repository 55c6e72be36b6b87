// SPDX-License-Identifier: MIT
// How texels of UNORM images lie in words.
#ifndef SHUTTER_DELIVER_SHARED_H
#define SHUTTER_DELIVER_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST uint kPackRgba8 = 0u;
SHUTTER_CONST uint kPackBgra8 = 1u;
SHUTTER_CONST uint kPackRgb10a2 = 2u; // red in the lowest bits: A2B10G10R10
SHUTTER_CONST uint kPackBgr10a2 = 3u;
SHUTTER_CONST uint kPackRgba16 = 4u; // two words

SHUTTER_SHADER_END

#endif
