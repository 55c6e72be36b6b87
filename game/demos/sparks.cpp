// SPDX-License-Identifier: MIT
#include "game/demos/sparks.h"

#include "game/demos/demo.h"

#include <algorithm>

namespace shutter::game {

namespace {

using math::dvec3;
using math::vec4;

constexpr dvec3 kFall{0.0, -9.81, 0.0};
/// Exceeds the longest life, since frames need the past exposure and frame.
constexpr double kKeptSeconds = 0.5;

particles::ParticleEmitter& emitterOf(ecs::Registry& registry, ecs::Entity entity) {
    return registry.get<particles::ParticleEmitter>(entity);
}

/// What began so long ago is gone.
double findForgotten(const particles::ParticleEmitter& emitter, double seconds) {
    return seconds - particles::findLongestLife(emitter) - kKeptSeconds;
}

} // namespace

particles::ParticleEmitter makeSparks(uint32_t seed) {
    particles::ParticleEmitter sparks;
    sparks.lifeSeconds = 0.35;
    sparks.lifeSpread = 0.5;
    sparks.velocity = {0.0, 4.0, 0.0};
    sparks.coneDegrees = 80.0;
    sparks.speedSpread = 0.6;
    sparks.inherit = 0.35;
    sparks.radius = 0.15;
    sparks.gravity = kFall;
    sparks.drag = 1.0;
    sparks.sizeBirth = 0.045;
    sparks.sizeDeath = 0.02;
    sparks.colors = {
        vec4(9.0f, 6.0f, 2.5f, 1.0f), vec4(6.0f, 2.2f, 0.5f, 1.0f), vec4(1.0f, 0.2f, 0.05f, 0.0f)};
    sparks.blend = particles::ParticleBlend::Add;
    sparks.seed = seed;
    return sparks;
}

particles::ParticleEmitter makeBrakeSparks(uint32_t seed) {
    particles::ParticleEmitter sparks = makeSparks(seed);
    sparks.velocity = {5.0, 1.4, 0.0};
    sparks.coneDegrees = 22.0;
    sparks.radius = 0.06;
    return sparks;
}

particles::ParticleEmitter makeDust(uint32_t seed) {
    particles::ParticleEmitter dust;
    dust.lifeSeconds = 0.9;
    dust.lifeSpread = 0.3;
    dust.velocity = {0.0, 0.9, 0.0};
    dust.coneDegrees = 60.0;
    dust.speedSpread = 0.5;
    dust.inherit = 0.25;
    dust.radius = 0.15;
    dust.drag = 1.5;
    dust.sizeBirth = 0.3;
    dust.sizeDeath = 1.3;
    dust.colors = {
        vec4(0.55f, 0.47f, 0.38f, 0.22f),
        vec4(0.55f, 0.48f, 0.40f, 0.10f),
        vec4(0.55f, 0.50f, 0.44f, 0.0f)};
    dust.softMetres = 0.3;
    dust.lit = true;
    dust.seed = seed;
    return dust;
}

particles::ParticleEmitter makeSplinters(uint32_t seed) {
    particles::ParticleEmitter splinters;
    splinters.lifeSeconds = 0.6;
    splinters.lifeSpread = 0.4;
    splinters.velocity = {0.0, 2.4, 0.0};
    splinters.coneDegrees = 180.0; // the ball spins
    splinters.speedSpread = 0.6;
    splinters.radius = 0.08;
    splinters.gravity = kFall;
    splinters.sizeBirth = 0.045;
    splinters.sizeDeath = 0.03;
    splinters.colors = {
        vec4(0.8f, 0.5f, 0.2f, 1.0f), vec4(0.7f, 0.4f, 0.15f, 1.0f), vec4(0.5f, 0.3f, 0.1f, 0.0f)};
    splinters.lit = true;
    splinters.seed = seed;
    return splinters;
}

particles::ParticleEmitter makeFlash(uint32_t seed) {
    particles::ParticleEmitter flash;
    flash.lifeSeconds = 0.07;
    flash.lifeSpread = 0.4;
    flash.velocity = {0.0, 7.0, 0.0};
    flash.coneDegrees = 180.0;
    flash.speedSpread = 0.7;
    flash.radius = 0.1;
    flash.drag = 12.0;
    flash.sizeBirth = 0.5;
    flash.sizeDeath = 0.12;
    flash.colors = {
        vec4(12.0f, 9.0f, 5.0f, 1.0f), vec4(6.0f, 3.0f, 1.0f, 1.0f), vec4(1.0f, 0.4f, 0.1f, 0.0f)};
    flash.blend = particles::ParticleBlend::Add;
    flash.softMetres = 0.05;
    flash.seed = seed;
    return flash;
}

void burst(ecs::Registry& registry, ecs::Entity entity, double seconds, uint32_t count) {
    particles::ParticleEmitter& emitter = emitterOf(registry, entity);
    const double forgotten = findForgotten(emitter, seconds);
    std::erase_if(emitter.bursts, [&](const particles::EmissionBurst& one) {
        return one.seconds < forgotten;
    });
    emitter.bursts.push_back({seconds, count});
}

void emitSteadily(ecs::Registry& registry, ecs::Entity entity, double seconds, double perSecond) {
    particles::ParticleEmitter& emitter = emitterOf(registry, entity);
    const double forgotten = findForgotten(emitter, seconds);
    std::erase_if(emitter.spans, [&](const particles::EmissionSpan& span) {
        return span.untilSeconds < forgotten;
    });
    if (perSecond <= 0.0)
        return;
    const double began = seconds - kDemoStepSeconds;
    // Steps that follow one another are one span: a span is known by when it begins.
    constexpr double kSlack = 0.5 * kDemoStepSeconds;
    if (!emitter.spans.empty()) {
        particles::EmissionSpan& last = emitter.spans.back();
        if (last.untilSeconds > began - kSlack && last.perSecond == perSecond) {
            last.untilSeconds = seconds;
            return;
        }
    }
    emitter.spans.push_back({began, seconds, perSecond});
}

} // namespace shutter::game
