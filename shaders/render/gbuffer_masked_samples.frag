// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#define SHUTTER_SEVERAL_SAMPLES
#define SHUTTER_MASKS_SAMPLES
#include "render/gbuffer.glsl"
