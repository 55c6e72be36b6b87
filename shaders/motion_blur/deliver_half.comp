// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define SHUTTER_DELIVERED rgba16f
#include "motion_blur/deliver.glsl"
