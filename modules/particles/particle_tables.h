// SPDX-License-Identifier: MIT
// The particles of one picture as the tables that they are drawn from. Pure.
#pragma once

#include "engine/core/result.h"
#include "engine/extract/extracted_frame.h"
#include "engine/extract/frame_view.h"
#include "engine/math/math.h"
#include "engine/scene/world.h"
#include "shaders/particles/particle_shared.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace shutter::particles {

/// Over which time particles are shown.
enum class ParticleTime : uint8_t {
    Instant,  ///< those alive at the raster instant, at their place then
    Exposure, ///< all that live during the exposure, with their motion
};

struct ParticleTables {
    std::vector<shader::ParticleRow> rows;            ///< far to near
    std::vector<shader::ParticleEmitterRow> emitters; ///< `texture` is an index of Assets::textures
    std::vector<shader::ParticleCamera> cameras;      ///< at rising times; one: it is static
    float rasterTime = 1.0f;
    bool isInstant = true;
    /// Parts of the exposure in which particles are drawn one after another in their order; [1,
    /// shader::kMaxParticleParts].
    uint32_t parts = 1;
    /// The longest path in the picture of any point of a visible particle within the exposure, from
    /// its motion, its growth and the rotation of its picture.
    float longestWayPx = 0.0f;
    /// A visible particle appears, disappears or changes colour within the exposure.
    bool areFleeting = false;
    /// Corners of the part of the picture that particles cover in the exposure, and some more.
    math::dvec2 leastPx{std::numeric_limits<double>::infinity()};
    math::dvec2 mostPx{-std::numeric_limits<double>::infinity()};
    bool hides = false; ///< some have opacity: they do not only add light
    /// Their sum may exceed the range of the picture.
    bool mayOverflow = false;

    [[nodiscard]] bool empty() const { return rows.empty(); }
};

/// \param view of the frame, made from `world` and `request`
/// Error: an emitter that cannot be drawn, or more particles than kMaxParticles.
[[nodiscard]] core::Result<ParticleTables> extractParticles(
    const scene::World& world,
    const extract::ViewRequest& request,
    const extract::FrameView& view,
    ParticleTime time
);

} // namespace shutter::particles
