// SPDX-License-Identifier: MIT
// Particles: small surfaces that face the camera, as sparks, dust and smoke. Which of them live at
// a time, and where they are then, follows from that time, the entity's own motion and a seed
// alone: there is no state and no step, so a picture does not depend on those drawn before it.
#pragma once

#include "engine/core/result.h"
#include "engine/ecs/registry.h"
#include "engine/math/math.h"
#include "engine/scene/assets.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace shutter::particles {

/// Most particles that a picture shows.
inline constexpr size_t kMaxParticles = 65536;

/// A steady emission, identified by `fromSeconds`: adding or removing other spans does not change
/// its particles.
struct EmissionSpan {
    double fromSeconds = 0.0;  ///< within 1e9
    double untilSeconds = 1e9; ///< above fromSeconds, within 1e9
    double perSecond = 0.0;    ///< [0, 1e6]
};

/// Particles that are born at once.
struct EmissionBurst {
    double seconds = 0.0; ///< within 1e9
    uint32_t count = 0;   ///< up to kMaxParticles
};

enum class ParticleBlend : uint8_t {
    Alpha, ///< covers the background
    Add,   ///< adds light and hides nothing
};

/// Component: emits where its entity is. After its birth, a particle moves in world space.
struct ParticleEmitter {
    std::vector<EmissionSpan> spans;   ///< no two begin at the same time
    std::vector<EmissionBurst> bursts; ///< no two at the same time
    double lifeSeconds = 1.0;          ///< (0, 1e4]
    double lifeSpread = 0.0;           ///< share of it that varies, either way, [0, 1)
    math::dvec3 velocity{0.0};         ///< m/s at birth, entity's space, each within 1e6
    double coneDegrees = 0.0;          ///< off that direction at most, [0, 180]
    double speedSpread = 0.0;          ///< share of the speed that varies, either way, [0, 1]
    double inherit = 0.0;              ///< share of the entity's own velocity, [-10, 10]
    double radius = 0.0;               ///< births lie in this ball, m, entity's space, [0, 1e6]
    math::dvec3 gravity{0.0};          ///< m/s^2, world, each within 1e6
    double drag = 0.0;                 ///< 1/s: the velocity falls by e in 1 / drag, [0, 1e4]
    double sizeBirth = 0.1;            ///< metres across, [0, 1e6]; 0: nothing is seen
    double sizeDeath = 0.1;            ///< the same at death; linear between
    double spin = 0.0;                 ///< fastest turn of a picture, either way, rad/s, [0, 1e4]
    /// At birth, half of the life and death, linear between: linear RGB, [0, 1000], and opacity,
    /// [0, 1]. For lit particles the colour is the reflectance.
    std::array<math::vec4, 3> colors{
        math::vec4(1.0f), math::vec4(1.0f), math::vec4(1.0f, 1.0f, 1.0f, 0.0f)};
    scene::AssetIndex texture =
        scene::kNone; ///< of Texture::isLoose; scene::kNone: round, soft towards the rim
    ParticleBlend blend = ParticleBlend::Alpha;
    double softMetres = 0.0; ///< fades this far before a surface, [0, 1e6]
    bool lit = false; ///< by lights, without shadows, and by the environment; else it shines itself
    uint32_t seed = 0; ///< of all that is random
};

/// Adds the emitter to an entity, and scene::NeedsPast with the longest life: particles start from
/// where their emitter was at their birth.
void addEmitter(ecs::Registry& registry, ecs::Entity entity, ParticleEmitter emitter);

/// Error: one sentence that names the field and the fault.
[[nodiscard]] core::Status validateEmitter(const ParticleEmitter& emitter);

/// Seconds that the longest life may last.
[[nodiscard]] double findLongestLife(const ParticleEmitter& emitter);

/// One particle as it is born, in the space that its entity has then.
struct ParticleBirth {
    double seconds = 0.0;
    double lifeSeconds = 0.0;
    math::dvec3 place{0.0};    ///< metres
    math::dvec3 velocity{0.0}; ///< m/s, without the inherited velocity
    double angle = 0.0;        ///< of its picture, radians
    double spin = 0.0;         ///< rad/s
};

/// Those that live at some time of [open, close], which may be one instant, in an order that does
/// not depend on when that is. A life begins with its first instant and ends before its last.
/// \param emitter valid
/// Error: there may be more than about kMaxParticles.
[[nodiscard]] core::Result<std::vector<ParticleBirth>>
listLiving(const ParticleEmitter& emitter, double open, double close);

} // namespace shutter::particles
