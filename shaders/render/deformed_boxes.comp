// SPDX-License-Identifier: MIT
// A box for each triangle over its way between two keys of its shape. Each vertex goes straight, so
// the boxes of both ends hold it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#include "render/deform_shared.h"
#include "render/scene_shared.h"

layout(local_size_x = kDeformThreads) in;
layout(push_constant, scalar) uniform Push { DeformedBoxJob job; };

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer VertexArray {
    Vertex values[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer IndexArray {
    uint values[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer BoxSink {
    float values[];
};

/// Boxes grow by this much of their largest coordinate, for the rounding of interpolation and of
/// the ray's way into object space.
const float kGrowth = 1.0e-5f;

void main() {
    uint triangle = gl_GlobalInvocationID.x;
    uint interval = gl_GlobalInvocationID.y;
    if (triangle >= job.triangleCount) return;
    IndexArray indices = IndexArray(job.indices);
    VertexArray vertices = VertexArray(job.vertices);
    vec3 low = vec3(3.402823e38f);
    vec3 high = -low;
    for (uint corner = 0u; corner < 3u; ++corner) {
        uint index = indices.values[3u * triangle + corner];
        for (uint key = interval; key < interval + 2u; ++key) {
            vec3 position = vertices.values[key * job.vertexCount + index].positionU0.xyz;
            low = min(low, position);
            high = max(high, position);
        }
    }
    vec3 largest = max(abs(low), abs(high));
    float margin = kGrowth * max(max(largest.x, largest.y), max(largest.z, 1.0e-6f));
    uint at = 6u * (interval * job.boxStride + triangle);
    for (int axis = 0; axis < 3; ++axis) {
        BoxSink(job.boxes).values[at + axis] = low[axis] - margin;
        BoxSink(job.boxes).values[at + 3 + axis] = high[axis] + margin;
    }
}
