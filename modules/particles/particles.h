// SPDX-License-Identifier: MIT
// Particles of the world's emitters as an overlay (README.md).
#pragma once

#include "engine/render/overlay.h"
#include "modules/particles/particle_pass.h"
#include "modules/particles/particle_settings.h"
#include "modules/particles/particle_tables.h"

#include <array>
#include <string>
#include <vector>

namespace shutter::particles {

class Particles : public render::Overlay {
  public:
    /// \param scene outlives this
    Particles(gpu::Device& device, const gpu_scene::GpuScene& scene);

    /// For the frames to come.
    void configure(const ParticleSettings& settings) { mSettings = settings; }

    [[nodiscard]] std::string name() const override { return "particles"; }

    /// Error: an emitter that cannot be drawn, or more particles than kMaxParticles.
    [[nodiscard]] core::Result<render::OverlayPlan> extract(const render::OverlayExtract& source
    ) override;
    [[nodiscard]] graph::ImageHandle declare(const render::OverlayContext& context) override;
    [[nodiscard]] core::Result<render::OverlayMotion>
    measureMotion(const scene::World& world, const extract::ViewRequest& view) const override;

  private:
    ParticleSettings mSettings;
    ParticlePass mPass;
    std::array<ParticleTables, gpu::kMaxFramesInFlight> mTables; ///< by slot
    std::vector<ParticleBuffer> mBuffers;                        ///< likewise
};

} // namespace shutter::particles
