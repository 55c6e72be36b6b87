// SPDX-License-Identifier: MIT
// Between two instants of the layer: resets the transmittance and preserves the sums.
#version 460

layout(location = 0) out vec4 outColor;
layout(location = 1) out vec4 outOpacity;

void main() {
    outColor = vec4(0.0f, 0.0f, 0.0f, 1.0f);
    outOpacity = vec4(0.0f, 0.0f, 0.0f, 1.0f);
}
