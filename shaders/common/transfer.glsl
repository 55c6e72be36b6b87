// SPDX-License-Identifier: MIT
// Transfer functions between stored values and light.
#ifndef SHUTTER_TRANSFER_GLSL
#define SHUTTER_TRANSFER_GLSL

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST uint kTransferLinear = 0u;
SHUTTER_CONST uint kTransferSrgb = 1u;  // IEC 61966-2-1, continued beyond 1
SHUTTER_CONST uint kTransferPower = 2u; // light is the value to a power

struct Transfer {
    uint curve;  // kTransferLinear ...
    float power; // of kTransferPower
    float scale; // of values before the curve
};

/// \param c 0 or more
SHUTTER_INLINE float encodeSrgbCurve(float c) {
    return c <= 0.0031308f ? 12.92f * c : 1.055f * pow(c, 1.0f / 2.4f) - 0.055f;
}

/// \param v 0 or more
SHUTTER_INLINE float decodeSrgbCurve(float v) {
    return v <= 0.04045f ? v / 12.92f : pow((v + 0.055f) / 1.055f, 2.4f);
}

/// \param value as it is stored; below 0 counts as 0 where the curve is not linear
SHUTTER_INLINE float lightOfValue(Transfer transfer, float value) {
    float v = value * transfer.scale;
    if (transfer.curve == kTransferLinear) return v;
    v = max(v, 0.0f);
    return transfer.curve == kTransferSrgb ? decodeSrgbCurve(v) : pow(v, transfer.power);
}

/// The inverse.
SHUTTER_INLINE float valueOfLight(Transfer transfer, float light) {
    float v = light;
    if (transfer.curve != kTransferLinear) v = max(v, 0.0f);
    if (transfer.curve == kTransferSrgb) v = encodeSrgbCurve(v);
    if (transfer.curve == kTransferPower) v = pow(v, 1.0f / transfer.power);
    return v / transfer.scale;
}

SHUTTER_INLINE vec3 lightOfColor(Transfer transfer, vec3 color) {
    return vec3(
        lightOfValue(transfer, color.x),
        lightOfValue(transfer, color.y),
        lightOfValue(transfer, color.z)
    );
}

SHUTTER_INLINE vec3 colorOfLight(Transfer transfer, vec3 light) {
    return vec3(
        valueOfLight(transfer, light.x),
        valueOfLight(transfer, light.y),
        valueOfLight(transfer, light.z)
    );
}

SHUTTER_SHADER_END

#endif
