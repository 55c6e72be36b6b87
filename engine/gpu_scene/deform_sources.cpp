// SPDX-License-Identifier: MIT
#include "engine/gpu_scene/deform_sources.h"

#include "engine/core/check.h"
#include "engine/gpu/upload.h"
#include "engine/gpu/vulkan.h"

#include <span>

namespace shutter::gpu_scene {

namespace {

using shader::JointInfluences;
using shader::MorphDelta;

void appendInfluences(const scene::Primitive& primitive, std::vector<JointInfluences>& rows) {
    const size_t count = primitive.positions.size() * primitive.influenceCount;
    SHUTTER_CHECK(
        primitive.influenceCount % 4 == 0, "{} joints a vertex", primitive.influenceCount
    );
    SHUTTER_CHECK_EQ(primitive.joints.size(), count);
    SHUTTER_CHECK_EQ(primitive.weights.size(), count);
    for (size_t i = 0; i < count; i += 4) {
        const uint16_t* joints = &primitive.joints[i];
        const float* weights = &primitive.weights[i];
        rows.push_back(
            {{uint32_t{joints[0]} | uint32_t{joints[1]} << 16u,
              uint32_t{joints[2]} | uint32_t{joints[3]} << 16u},
             {weights[0], weights[1], weights[2], weights[3]}}
        );
    }
}

void appendDeltas(const scene::Primitive& primitive, std::vector<MorphDelta>& rows) {
    const auto pick = [](const std::vector<math::vec3>& values, size_t i) {
        return values.empty() ? math::vec4(0.0f) : math::vec4(values[i], 0.0f);
    };
    for (const scene::MorphTarget& target : primitive.morphTargets)
        for (size_t i = 0; i < primitive.positions.size(); ++i)
            rows.push_back(
                {pick(target.positions, i), pick(target.normals, i), pick(target.tangents, i)}
            );
}

template <class T>
gpu::Buffer upload(gpu::Device& device, const char* name, const std::vector<T>& rows) {
    if (rows.empty())
        return {};
    gpu::Buffer buffer(
        device,
        name,
        rows.size() * sizeof(T),
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
        gpu::MemoryUse::Device
    );
    gpu::uploadBuffer(device, buffer, std::as_bytes(std::span(rows)));
    return buffer;
}

} // namespace

DeformSources::DeformSources(gpu::Device& device, const scene::Assets& assets) {
    struct First {
        size_t influence;
        size_t delta;
    };

    std::vector<First> firsts;
    std::vector<JointInfluences> influences;
    std::vector<MorphDelta> deltas;
    for (const scene::Mesh& mesh : assets.meshes)
        for (const scene::Primitive& primitive : mesh.primitives) {
            firsts.push_back({influences.size(), deltas.size()});
            mSources.push_back(
                {{},
                 {},
                 primitive.influenceCount,
                 static_cast<uint32_t>(primitive.morphTargets.size())}
            );
            appendInfluences(primitive, influences);
            appendDeltas(primitive, deltas);
        }
    mInfluences = upload(device, "joint influences", influences);
    mDeltas = upload(device, "morph deltas", deltas);
    for (size_t i = 0; i < firsts.size(); ++i) {
        if (mSources[i].influenceCount > 0)
            mSources[i].influences = gpu::splitAddress(
                mInfluences.address() + firsts[i].influence * sizeof(JointInfluences)
            );
        if (mSources[i].targetCount > 0)
            mSources[i].deltas =
                gpu::splitAddress(mDeltas.address() + firsts[i].delta * sizeof(MorphDelta));
    }
}

} // namespace shutter::gpu_scene
