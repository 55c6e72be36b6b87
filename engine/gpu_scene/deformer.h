// SPDX-License-Identifier: MIT
// Deforms vertices on the device (shaders/render/deform.comp).
#pragma once

#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/scene/deformation.h"
#include "shaders/render/deform_shared.h"
#include "shaders/render/timed_scene_shared.h"

#include <cstdint>
#include <vector>

namespace shutter::gpu_scene {

/// Poses for upload. Those of one entity at several instants are consecutive.
class PoseTable {
  public:
    struct Place {
        size_t firstJoint = 0;
        size_t firstWeight = 0;
        size_t firstWave = 0;
        uint32_t jointCount = 0;
        uint32_t weightCount = 0;
        uint32_t waveCount = 0;
        scene::WaveShares shares; ///< of the waves
    };

    /// \return where the pose is
    Place add(const scene::Deformation& pose);

    /// Writes all poses; `buffer` grows if it is too small. The GPU must have finished with its
    /// contents.
    void upload(gpu::Device& device, gpu::Buffer& buffer);

    /// The job of one geometry, without its output; call upload() first.
    /// \param place of the first instant
    [[nodiscard]] shader::DeformJob
    makeJob(const GpuScene& scene, uint32_t geometry, const Place& place) const;

  private:
    std::vector<shader::MotionKey> mJoints;
    std::vector<float> mWeights;
    std::vector<shader::WaveRow> mWaves;
    VkDeviceAddress mJointsAt = 0;
    VkDeviceAddress mWeightsAt = 0;
    VkDeviceAddress mWavesAt = 0;
};

/// Any number of jobs for one dispatch.
class DeformJobs {
  public:
    /// \param instantCount one behind the other, from the job's first
    void add(const shader::DeformJob& job, uint32_t instantCount);

    /// Writes the jobs; `buffer` grows if it is too small. The GPU must have finished with its
    /// contents.
    void upload(gpu::Device& device, gpu::Buffer& buffer);

    /// upload() was called.
    [[nodiscard]] const shader::DeformBatch& batch() const { return mBatch; }

  private:
    std::vector<shader::DeformJob> mJobs; ///< non-empty jobs
    shader::DeformBatch mBatch{};
};

/// The pipelines, made when they are first used.
class Deformer {
  public:
    explicit Deformer(gpu::Device& device) : mDevice(device) {}

    /// Records one dispatch for all jobs, whose order does not matter; none where there are none.
    void deform(VkCommandBuffer commands, const shader::DeformBatch& batch);
    /// Records boxes of the triangles for each of `intervalCount` intervals.
    void boundTriangles(
        VkCommandBuffer commands, const shader::DeformedBoxJob& job, uint32_t intervalCount
    );

  private:
    gpu::Device& mDevice;
    gpu::Pipeline mDeform;
    gpu::Pipeline mBound;
};

} // namespace shutter::gpu_scene
