// SPDX-License-Identifier: MIT
// The vertices of geometries, deformed, each at one or several instants.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require
#extension GL_EXT_scalar_block_layout : require
#include "render/deform.glsl"
#include "render/scene_shared.h"

layout(local_size_x = kDeformThreads) in;
layout(push_constant, scalar) uniform Push { DeformBatch batch; };

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer JobArray {
    DeformJob values[];
};

layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer VertexArray {
    Vertex values[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer InfluenceArray {
    JointInfluences values[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer DeltaArray {
    MorphDelta values[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer JointArray {
    MotionKey values[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer WeightArray {
    float values[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer WaveArray {
    WaveRow values[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) writeonly buffer VertexSink {
    Vertex values[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) writeonly buffer PositionSink {
    vec4 values[];
};

DeformJob job; // the group's

/// The last job that begins at the group or before it.
uint findJob(uint group) {
    JobArray jobs = JobArray(batch.jobs);
    uint first = 0u;
    uint count = batch.jobCount;
    while (count > 1u) {
        uint half_ = count >> 1u;
        if (jobs.values[first + half_].firstGroup <= group) first += half_;
        count -= half_;
    }
    return first;
}

DeformedVertex morph(DeformedVertex shaped, uint index, uint instant) {
    for (uint target = 0u; target < job.targetCount; ++target) {
        float weight = WeightArray(job.weights).values[instant * job.weightStride + target];
        if (weight == 0.0f) continue; // contributes nothing
        MorphDelta delta = DeltaArray(job.deltas).values[target * job.vertexCount + index];
        shaped = morphVertex(shaped, delta, weight);
    }
    return shaped;
}

DeformedVertex wave(DeformedVertex shaped, uvec2 color, uint instant) {
    vec4 unpacked = vec4(unpackHalf2x16(color.x), unpackHalf2x16(color.y));
    WaveShareAt at = findWaveShare(job, shaped.position, unpacked);
    if (at.share == 0.0f) return shaped;
    WaveSum sum = noWave();
    for (uint i = 0u; i < job.waveCount; ++i)
        sum = addWave(
            sum, WaveArray(job.waves).values[instant * job.waveCount + i], at, shaped.position
        );
    return waveVertex(shaped, sum);
}

MotionKey blendJoints(uint index, uint instant) {
    JointArray joints = JointArray(job.joints);
    uint first = instant * job.jointCount;
    if (job.influenceCount == 0u) return joints.values[first];
    MotionKey blended = noJoint();
    uint groups = job.influenceCount >> 2u;
    for (uint group = 0u; group < groups; ++group) {
        JointInfluences influences = InfluenceArray(job.influences).values[index * groups + group];
        for (uint entry = 0u; entry < 4u; ++entry) {
            float weight = influences.weights[entry];
            if (weight == 0.0f) continue; // its joint may be anywhere
            uint joint = min(unpackJoint(influences.joints, entry), job.jointCount - 1u);
            blended = addJoint(blended, joints.values[first + joint], weight);
        }
    }
    return blended;
}

void main() {
    uint group = gl_WorkGroupID.y * kDeformRow + gl_WorkGroupID.x;
    if (group >= batch.groupCount) return;
    job = JobArray(batch.jobs).values[findJob(group)];
    group -= job.firstGroup;
    uint groupsPerInstant = (job.vertexCount + kDeformThreads - 1u) / kDeformThreads;
    uint instant = group / groupsPerInstant;
    uint index = (group - instant * groupsPerInstant) * kDeformThreads + gl_LocalInvocationID.x;
    if (index >= job.vertexCount) return;
    Vertex vertex = VertexArray(job.vertices).values[index];
    DeformedVertex shaped =
        DeformedVertex(vertex.positionU0.xyz, vertex.normalV0.xyz, vertex.tangent.xyz);
    shaped = morph(shaped, index, instant);
    if (job.waveCount > 0u) shaped = wave(shaped, vertex.color, instant);
    if (job.jointCount > 0u) shaped = skinVertex(shaped, blendJoints(index, instant));
    shaped = finishVertex(shaped);
    uint at = instant * job.vertexCount + index;
    if (job.positionsOnly != 0u) {
        PositionSink(job.output_).values[at] = vec4(shaped.position, 1.0f);
        return;
    }
    vertex.positionU0.xyz = shaped.position;
    vertex.normalV0.xyz = shaped.normal;
    vertex.tangent.xyz = shaped.tangent;
    VertexSink(job.output_).values[at] = vertex;
}
