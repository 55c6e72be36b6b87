// SPDX-License-Identifier: MIT
// Boxes without vertices of their own: 36 for each.
#version 460

layout(push_constant) uniform Push { mat4 clipFromObject; } params;
layout(location = 0) in vec3 inCorner;
layout(location = 1) in vec3 inSize;
layout(location = 2) in vec4 inColor;
layout(location = 0) out vec4 outColor;

void main() {
    int side = gl_VertexIndex / 6;
    int corner = gl_VertexIndex % 6; // of two triangles
    int axis = (side / 2 + 2) % 3;
    vec3 place;
    place[axis] = side % 2;
    place[(axis + 1) % 3] = corner == 1 || corner == 2 || corner == 4 ? 1.0f : 0.0f;
    place[(axis + 2) % 3] = corner == 2 || corner > 3 ? 1.0f : 0.0f;
    gl_Position = params.clipFromObject * vec4(inCorner + inSize * place, 1.0f);
    float light = axis == 1 ? 1.0f : axis == 0 ? 0.6f : 0.8f;
    outColor = vec4(light * inColor.rgb, inColor.a);
}
