// SPDX-License-Identifier: MIT
// A wall (entity 0) and a flag (entity 1) that waves: each vertex at four times.
#version 460
layout(push_constant) uniform Push {
    vec4 seconds; // of the raster, of shutter open and close, of the previous frame
    vec4 lens;    // what x and y are multiplied by; near plane
} push;
layout(location = 0) out vec4 vClips[4];
layout(location = 4) out vec2 vPlace;

const uvec2 kCells = uvec2(48u, 16u);

vec3 pose(vec2 place, float seconds) {
    if (gl_InstanceIndex == 0) return vec3(16.0f * place - 8.0f, -8.0f); // static
    float wave = sin(7.0f * place.x - 14.0f * seconds);
    vec3 rest = vec3(3.0f * place.x - 1.5f, 1.6f * place.y - 0.8f, -4.0f);
    return rest + place.x * wave * vec3(0.0f, 0.25f, 0.6f);
}

void main() {
    uint cell = gl_VertexIndex / 6u;
    uint corner = uint[](0u, 1u, 2u, 2u, 1u, 3u)[gl_VertexIndex % 6u];
    uvec2 knot = uvec2(cell % kCells.x, cell / kCells.x) + uvec2(corner & 1u, corner >> 1u);
    vPlace = vec2(knot) / vec2(kCells);
    for (int i = 0; i < 4; ++i) {
        vec3 view = pose(vPlace, push.seconds[i]);
        vClips[i] = vec4(push.lens.xy * view.xy, push.lens.z, -view.z); // reversed depth
    }
    gl_Position = vClips[0];
}
