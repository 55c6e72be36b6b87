// SPDX-License-Identifier: MIT
#include "modules/particles/particle_extras.h"

#include "modules/particles/particle_emitter.h"

#include <algorithm>
#include <utility>

namespace shutter::particles {

namespace {

/// Far more than one writes by hand.
constexpr size_t kMaxEmissions = 1024;

/// Replaces the value where the object has one.
void read(const gltf::ExtraObject& object, const char* key, double& value) {
    value = object.findNumber(key).value_or(value);
}

void readEmissions(const gltf::ExtraObject& object, ParticleEmitter& emitter) {
    for (const gltf::ExtraObject& source : object.listObjects("spans", kMaxEmissions)) {
        source.warnOfOthers({"fromSeconds", "untilSeconds", "perSecond"});
        EmissionSpan span;
        read(source, "fromSeconds", span.fromSeconds);
        read(source, "untilSeconds", span.untilSeconds);
        read(source, "perSecond", span.perSecond);
        emitter.spans.push_back(span);
    }
    for (const gltf::ExtraObject& source : object.listObjects("bursts", kMaxEmissions)) {
        source.warnOfOthers({"seconds", "count"});
        EmissionBurst burst;
        read(source, "seconds", burst.seconds);
        burst.count = source.findIndex("count").value_or(burst.count);
        emitter.bursts.push_back(burst);
    }
}

void readNumbers(const gltf::ExtraObject& object, ParticleEmitter& emitter) {
    read(object, "lifeSeconds", emitter.lifeSeconds);
    read(object, "lifeSpread", emitter.lifeSpread);
    read(object, "coneDegrees", emitter.coneDegrees);
    read(object, "speedSpread", emitter.speedSpread);
    read(object, "inherit", emitter.inherit);
    read(object, "radius", emitter.radius);
    read(object, "drag", emitter.drag);
    read(object, "sizeBirth", emitter.sizeBirth);
    emitter.sizeDeath = emitter.sizeBirth;
    read(object, "sizeDeath", emitter.sizeDeath);
    read(object, "spin", emitter.spin);
    read(object, "softMetres", emitter.softMetres);
    emitter.velocity = object.findVec3("velocity").value_or(emitter.velocity);
    emitter.gravity = object.findVec3("gravity").value_or(emitter.gravity);
    emitter.lit = object.findBool("lit").value_or(emitter.lit);
    emitter.seed = object.findIndex("seed").value_or(emitter.seed);
}

void readEmitter(const gltf::ExtraObject& object, ecs::Registry& registry, ecs::Entity entity) {
    object.warnOfOthers({"spans",       "bursts",      "lifeSeconds", "lifeSpread", "velocity",
                         "coneDegrees", "speedSpread", "inherit",     "radius",     "gravity",
                         "drag",        "sizeBirth",   "sizeDeath",   "spin",       "colors",
                         "texture",     "blend",       "softMetres",  "lit",        "seed"});
    ParticleEmitter emitter;
    readEmissions(object, emitter);
    readNumbers(object, emitter);
    if (const auto colors = object.findColors("colors", emitter.colors.size()))
        std::copy(colors->begin(), colors->end(), emitter.colors.begin());
    emitter.blend =
        static_cast<ParticleBlend>(object.findName("blend", {"alpha", "add"}).value_or(0));
    emitter.texture = object.findTexture("texture").value_or(emitter.texture);
    if (const core::Status valid = validateEmitter(emitter); !valid)
        object.fail(valid.error().message);
    addEmitter(registry, entity, std::move(emitter));
}

} // namespace

const gltf::ExtraReader kParticleExtras{"particles", "texture", readEmitter};

} // namespace shutter::particles
