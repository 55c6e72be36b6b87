// SPDX-License-Identifier: MIT
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define SHUTTER_DELIVERED r11f_g11f_b10f
#include "motion_blur/deliver.glsl"
