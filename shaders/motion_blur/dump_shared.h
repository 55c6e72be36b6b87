// SPDX-License-Identifier: MIT
// How texels of a dumped image lie in its file, row by row.
#ifndef SHUTTER_DUMP_SHARED_H
#define SHUTTER_DUMP_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST uint kDumpHalf4 = 0u; // four half floats
SHUTTER_CONST uint kDumpFloat1 = 1u;
SHUTTER_CONST uint kDumpFloat2 = 2u;
SHUTTER_CONST uint kDumpFloat4 = 4u;
SHUTTER_CONST uint kDumpUint1 = 5u;

SHUTTER_SHADER_END

#endif
