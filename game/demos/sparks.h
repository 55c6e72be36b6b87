// SPDX-License-Identifier: MIT
// What flies off in the demos: sparks, dust, splinters, a flash.
#pragma once

#include "engine/ecs/registry.h"
#include "modules/particles/particle_emitter.h"

#include <cstdint>

namespace shutter::game {

/// Struck metal: its sparks glow, fall and die within half a second.
[[nodiscard]] particles::ParticleEmitter makeSparks(uint32_t seed);
/// Under a brake, along the entity's +X.
[[nodiscard]] particles::ParticleEmitter makeBrakeSparks(uint32_t seed);
/// Behind a wheel that slides.
[[nodiscard]] particles::ParticleEmitter makeDust(uint32_t seed);
/// Splinters of a plate that a ball hits, away from the ball.
[[nodiscard]] particles::ParticleEmitter makeSplinters(uint32_t seed);
/// Flash of the same hit: far brighter than the picture, and gone within a tenth of a second.
[[nodiscard]] particles::ParticleEmitter makeFlash(uint32_t seed);

/// Emits at once. The entity has an emitter (CHECKed); bursts without living particles are dropped.
void burst(ecs::Registry& registry, ecs::Entity entity, double seconds, uint32_t count);

/// Emits, or does not, over the step that ends at `seconds`; likewise.
/// \param perSecond 0: nothing
void emitSteadily(ecs::Registry& registry, ecs::Entity entity, double seconds, double perSecond);

} // namespace shutter::game
