// SPDX-License-Identifier: MIT
// One triangle over the whole window.
#version 460

void main() {
    vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
    gl_Position = vec4(corner * 2.0f - 1.0f, 0.0f, 1.0f);
}
