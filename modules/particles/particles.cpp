// SPDX-License-Identifier: MIT
#include "modules/particles/particles.h"

#include "engine/core/words.h"
#include "modules/particles/particle_instants.h"

#include <optional>
#include <utility>

namespace shutter::particles {

namespace {

core::Decision decide(const ParticleTables& particles, const ParticleSettings& settings) {
    if (!settings.areShown)
        return {false, "the view leaves them out"};
    if (particles.empty())
        return {false, "none lives in the picture's time"};
    const std::string count =
        core::countOf(particles.rows.size(), "particle lives", "particles live");
    return {true, count + (particles.isInstant ? " at its instant" : " in its exposure")};
}

} // namespace

Particles::Particles(gpu::Device& device, const gpu_scene::GpuScene& scene) : mPass(device, scene) {
    for (uint32_t i = 0; i < gpu::kMaxFramesInFlight; ++i)
        mBuffers.emplace_back(device);
}

core::Result<render::OverlayPlan> Particles::extract(const render::OverlayExtract& source) {
    ParticleTables& tables = mTables.at(source.slot);
    tables = {};
    if (mSettings.areShown) {
        auto extracted = extractParticles(
            source.world,
            source.view,
            source.frameView,
            source.isOverExposure ? ParticleTime::Exposure : ParticleTime::Instant
        );
        if (!extracted)
            return extracted.error();
        tables = std::move(extracted).value();
    }
    render::OverlayPlan plan;
    plan.label = "particle";
    plan.explanations = {{render::ExplainedKind::Work, "particles", decide(tables, mSettings)}};
    plan.draws = !tables.empty();
    const auto instants = planParticleInstants(
        {source.world, source.layout, source.view, source.frameView.motion(), source.frame},
        tables,
        source.limits
    );
    plan.readsSurfaces = instants.has_value();
    plan.instants = instants.value_or(shader::InstantSurfaces{});
    return plan;
}

graph::ImageHandle Particles::declare(const render::OverlayContext& context) {
    return mPass.declare(mTables.at(context.slot), mBuffers.at(context.slot), context);
}

core::Result<render::OverlayMotion>
Particles::measureMotion(const scene::World& world, const extract::ViewRequest& view) const {
    render::OverlayMotion motion;
    if (!mSettings.areShown)
        return motion;
    const auto tables =
        extractParticles(world, view, extract::FrameView(world, view), ParticleTime::Exposure);
    if (!tables)
        return tables.error();
    motion.longestPx = tables.value().longestWayPx;
    motion.isFleeting = tables.value().areFleeting;
    return motion;
}

} // namespace shutter::particles
