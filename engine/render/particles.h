// SPDX-License-Identifier: MIT
// Draws particles over a picture: as they are at one instant, or on their way through an exposure.
#pragma once

#include "engine/extract/particles.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/graph/graph.h"

#include <map>
#include <string>

namespace shutter::render {

/// What particles are drawn on, and what they are drawn with.
struct ParticleTargets {
    graph::ImageHandle color;           ///< linear HDR
    graph::ImageHandle motionDepth;     ///< GBuffer::motionDepth: what hides them
    VkDeviceAddress frameConstants = 0; ///< shader::FrameConstants
    VkDeviceAddress response = 0;       ///< shader::ResponseTable of the shutter; 0: a box
    math::dvec2 jitterPx{0.0};          ///< of the colour (ViewRequest::jitterPx)
};

/// One for each frame in flight: the GPU must be done with the frame that it was declared for last.
class ParticleBuffer {
  public:
    explicit ParticleBuffer(gpu::Device& device) : mDevice(device) {}

    /// \param tables not empty
    /// \return without what ParticleTargets says
    [[nodiscard]] shader::ParticleDraw upload(const extract::ParticleTables& tables);

  private:
    gpu::Device& mDevice;
    gpu::Buffer mBuffer; ///< mapped
};

class ParticlePass {
  public:
    ParticlePass(gpu::Device& device, const gpu_scene::GpuScene& scene)
        : mDevice(device), mScene(scene) {}

    /// Declares the passes "particles". `tables` must live until they were declared and not be
    /// empty; `buffer` until they have run.
    /// \return the picture with them
    [[nodiscard]] graph::ImageHandle declare(
        graph::Graph& graph,
        const extract::ParticleTables& tables,
        ParticleBuffer& buffer,
        const ParticleTargets& targets
    );

  private:
    const gpu::Pipeline& findDraw(VkFormat format, bool isLayer);
    const gpu::Pipeline& findComposite(VkFormat format);
    graph::ImageHandle declareDraw(
        graph::Graph& graph,
        const std::string& name,
        const ParticleTargets& targets,
        graph::ImageHandle target,
        const shader::ParticleDraw& draw,
        uint32_t count,
        bool isLayer
    );

    gpu::Device& mDevice;
    const gpu_scene::GpuScene& mScene;
    std::map<std::pair<VkFormat, bool>, gpu::Pipeline> mDraws; ///< by format of the target
    std::map<VkFormat, gpu::Pipeline> mComposites;
};

} // namespace shutter::render
