// SPDX-License-Identifier: MIT
// Draws particles over a picture: at one instant, or with their motion over an exposure.
#pragma once

#include "engine/extract/particles.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu_scene/gpu_scene.h"
#include "engine/graph/graph.h"
#include "shaders/common/instant_surfaces.glsl"

#include <compare>
#include <map>
#include <optional>
#include <span>

namespace shutter::render {

/// Surfaces visible in the pixels of a rectangle at instants of the exposure.
struct ParticleInstants {
    shader::InstantSurfaces rectangle;
    graph::BufferHandle words; ///< the rectangle, and data for shaders/common/instant_surfaces.glsl
};

/// Targets and inputs of drawing particles.
struct ParticleTargets {
    graph::ImageHandle color;           ///< linear HDR
    graph::ImageHandle motionDepth;     ///< GBuffer::motionDepth: hides them
    VkDeviceAddress frameConstants = 0; ///< shader::FrameConstants
    VkDeviceAddress response = 0;       ///< shader::ResponseTable of the shutter; 0: a box
    math::dvec2 jitterPx{0.0};          ///< of the colour (ViewRequest::jitterPx)
    /// Instants of the blurred picture that is drawn on. Without, the raster's depth hides
    /// everywhere.
    std::optional<ParticleInstants> instants{};
};

/// One for each frame in flight: the GPU must have finished the frame that it was last declared
/// for.
class ParticleBuffer {
  public:
    explicit ParticleBuffer(gpu::Device& device) : mDevice(device) {}

    /// \param tables not empty
    /// \return without the fields that come from ParticleTargets
    [[nodiscard]] shader::ParticleDraw upload(const extract::ParticleTables& tables);

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
        graph::Graph& graph,
        const extract::ParticleTables& tables,
        ParticleBuffer& buffer,
        const ParticleTargets& targets
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
        graph::Graph& graph;
        const ParticleTargets& targets;
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

} // namespace shutter::render
