// SPDX-License-Identifier: MIT
// Draws particles over a picture: at one instant, or with their motion over an exposure.
#pragma once

#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/render/overlay.h"
#include "modules/particles/particle_tables.h"

#include <compare>
#include <map>
#include <span>

namespace shutter::particles {

/// One for each frame in flight: the GPU must have finished the frame that it was last declared
/// for.
class ParticleBuffer {
  public:
    explicit ParticleBuffer(gpu::Device& device) : mDevice(device) {}

    /// \param tables not empty
    /// \return without the fields that come from OverlayContext
    [[nodiscard]] shader::ParticleDraw upload(const ParticleTables& tables);

    /// The buffer that upload() wrote.
    [[nodiscard]] VkBuffer handle() const { return mBuffer.handle(); }

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
        const ParticleTables& tables, ParticleBuffer& buffer, const render::OverlayContext& context
    );

  private:
    struct DrawKey {
        VkFormat format; ///< of the target
        bool isLayer;    ///< that is composited later
        bool readsInstants;

        auto operator<=>(const DrawKey&) const = default;
    };

    struct CompositeKey {
        VkFormat format; ///< of the target
        bool readsParts; ///< the background differs between the parts of the exposure

        auto operator<=>(const CompositeKey&) const = default;
    };

    /// Data shared by all draws of a picture.
    struct Draws {
        const render::OverlayContext& context;
        VkBuffer tables; ///< placeholder if there are no instants
        uint32_t count;  ///< of particles
    };

    const gpu::Pipeline& findDraw(const DrawKey& key);
    const gpu::Pipeline& findComposite(const CompositeKey& key);
    graph::ImageHandle declareDraw(
        const Draws& draws,
        graph::ImageHandle target,
        const shader::ParticleDraw& draw,
        bool isLayer
    );
    graph::ImageHandle
    declareComposite(const Draws& draws, std::span<const graph::ImageHandle> layers);

    gpu::Device& mDevice;
    const gpu_scene::GpuScene& mScene;
    std::map<DrawKey, gpu::Pipeline> mDraws;
    std::map<CompositeKey, gpu::Pipeline> mComposites;
};

} // namespace shutter::particles
