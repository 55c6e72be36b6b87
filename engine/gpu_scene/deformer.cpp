// SPDX-License-Identifier: MIT
#include "engine/gpu_scene/deformer.h"

#include "spirv/render/deform.comp.h"
#include "spirv/render/deformed_boxes.comp.h"

#include "engine/core/check.h"
#include "engine/extract/motion_keys.h"
#include "engine/gpu/vulkan.h"

#include <algorithm>
#include <span>

namespace shutter::gpu_scene {

namespace {

constexpr VkDeviceSize kTableAlignment = 256;
/// Groups of a dispatch: rows are limited by the guaranteed minimum of maxComputeWorkGroupCount.
constexpr uint64_t kMaxGroups = uint64_t{65535} * shader::kDeformRow;

gpu::ComputePipelineDesc
describePipeline(const char* name, std::span<const uint32_t> spirv, uint32_t pushBytes) {
    gpu::ComputePipelineDesc desc;
    desc.name = name;
    desc.spirv = spirv;
    desc.interface.pushConstantBytes = pushBytes;
    return desc;
}

uint32_t countGroups(uint32_t elements) {
    return (elements + shader::kDeformThreads - 1) / shader::kDeformThreads;
}

/// The shaders bind nothing but addresses.
template <class Job>
void dispatch(
    VkCommandBuffer commands,
    const gpu::Pipeline& pipeline,
    const Job& job,
    uint32_t groupsX,
    uint32_t groupsY
) {
    if (groupsX == 0 || groupsY == 0)
        return;
    vkCmdBindPipeline(commands, pipeline.bindPoint(), pipeline.handle());
    vkCmdPushConstants(commands, pipeline.layout(), pipeline.stages(), 0, sizeof(job), &job);
    vkCmdDispatch(commands, groupsX, groupsY, 1);
}

uint32_t packShare(const scene::WaveShares& shares) {
    switch (shares.share) {
    case scene::WaveShare::All:
        return shader::kWaveShareAll;
    case scene::WaveShare::Height:
        return shader::kWaveShareHeight;
    case scene::WaveShare::Color:
        break;
    }
    return shader::kWaveShareColor + shares.channel;
}

/// A buffer that has room for `bytes`, with some in reserve.
void fit(gpu::Device& device, gpu::Buffer& buffer, const char* name, VkDeviceSize bytes) {
    if (!buffer || buffer.bytes() < bytes)
        buffer = gpu::Buffer(
            device,
            name,
            bytes + bytes / 2,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
            gpu::MemoryUse::Stream
        );
}

} // namespace

PoseTable::Place PoseTable::add(const scene::Deformation& pose) {
    const Place place{
        mJoints.size(),
        mWeights.size(),
        mWaves.size(),
        static_cast<uint32_t>(pose.objectFromBind.size()),
        static_cast<uint32_t>(pose.morphWeights.size()),
        static_cast<uint32_t>(pose.waves.waves.size()),
        pose.waves.shares};
    for (const math::dmat4& matrix : pose.objectFromBind)
        mJoints.push_back(extract::makeKey(matrix));
    for (const double weight : pose.morphWeights)
        mWeights.push_back(static_cast<float>(weight));
    for (const scene::WavePose::Wave& wave : pose.waves.waves)
        mWaves.push_back(
            {math::vec4(math::vec3(wave.displacement), float(wave.phase)),
             math::vec4(math::vec3(wave.waveVector), 0.0f)}
        );
    return place;
}

void PoseTable::upload(gpu::Device& device, gpu::Buffer& buffer) {
    const VkDeviceSize jointBytes = mJoints.size() * sizeof(shader::MotionKey);
    const auto align = [](VkDeviceSize bytes) {
        return (bytes + kTableAlignment - 1) / kTableAlignment * kTableAlignment;
    };
    const VkDeviceSize weightsAt = align(jointBytes);
    const VkDeviceSize wavesAt = align(weightsAt + mWeights.size() * sizeof(float));
    fit(device, buffer, "poses", wavesAt + mWaves.size() * sizeof(shader::WaveRow));
    buffer.write(std::span<const shader::MotionKey>(mJoints));
    buffer.write(std::span<const float>(mWeights), weightsAt);
    buffer.write(std::span<const shader::WaveRow>(mWaves), wavesAt);
    mJointsAt = buffer.address();
    mWeightsAt = buffer.address() + weightsAt;
    mWavesAt = buffer.address() + wavesAt;
}

shader::DeformJob
PoseTable::makeJob(const GpuScene& scene, uint32_t geometry, const Place& place) const {
    const shader::Geometry& row = scene.geometryRows()[geometry];
    const DeformSource& source = scene.deformSource(geometry);
    shader::DeformJob job{};
    job.vertices = row.vertices;
    job.influences = source.influences;
    job.deltas = source.deltas;
    job.joints = gpu::splitAddress(mJointsAt + place.firstJoint * sizeof(shader::MotionKey));
    job.weights = gpu::splitAddress(mWeightsAt + place.firstWeight * sizeof(float));
    job.vertexCount = row.vertexCount;
    job.influenceCount = source.influenceCount;
    job.jointCount = place.jointCount;
    // Weights without targets and targets without weights change nothing.
    job.targetCount = std::min(source.targetCount, place.weightCount);
    job.weightStride = place.weightCount;
    job.waves = gpu::splitAddress(mWavesAt + place.firstWave * sizeof(shader::WaveRow));
    job.waveCount = place.waveCount;
    job.waveShare = packShare(place.shares);
    job.waveExponent = static_cast<float>(place.shares.exponent);
    job.waveHeight = math::vec4(place.shares.height);
    return job;
}

void DeformJobs::add(const shader::DeformJob& job, uint32_t instantCount) {
    const uint64_t groups = uint64_t{countGroups(job.vertexCount)} * instantCount;
    if (groups == 0)
        return;
    SHUTTER_CHECK(
        mBatch.groupCount + groups <= kMaxGroups, "{} vertices are deformed", job.vertexCount
    );
    mJobs.push_back(job);
    mJobs.back().firstGroup = mBatch.groupCount;
    mBatch.groupCount += static_cast<uint32_t>(groups);
}

void DeformJobs::upload(gpu::Device& device, gpu::Buffer& buffer) {
    if (mJobs.empty())
        return;
    fit(device, buffer, "deformation jobs", mJobs.size() * sizeof(shader::DeformJob));
    buffer.write(std::span<const shader::DeformJob>(mJobs));
    mBatch.jobs = gpu::splitAddress(buffer.address());
    mBatch.jobCount = static_cast<uint32_t>(mJobs.size());
}

void Deformer::deform(VkCommandBuffer commands, const shader::DeformBatch& batch) {
    if (!mDeform.handle())
        mDeform = gpu::Pipeline(
            mDevice, describePipeline("deform", render_deform_comp, sizeof(shader::DeformBatch))
        );
    const uint32_t rows = (batch.groupCount + shader::kDeformRow - 1) / shader::kDeformRow;
    dispatch(commands, mDeform, batch, std::min(batch.groupCount, shader::kDeformRow), rows);
}

void Deformer::boundTriangles(
    VkCommandBuffer commands, const shader::DeformedBoxJob& job, uint32_t intervalCount
) {
    if (!mBound.handle())
        mBound = gpu::Pipeline(
            mDevice,
            describePipeline(
                "deformed boxes", render_deformed_boxes_comp, sizeof(shader::DeformedBoxJob)
            )
        );
    dispatch(commands, mBound, job, countGroups(job.triangleCount), intervalCount);
}

} // namespace shutter::gpu_scene
