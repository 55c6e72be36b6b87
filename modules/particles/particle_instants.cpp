// SPDX-License-Identifier: MIT
#include "modules/particles/particle_instants.h"

#include <algorithm>

namespace shutter::particles {

namespace {

/// Beyond these, what hides particles moves little from one instant to the next.
constexpr uint32_t kMaxParticleInstants = 16;

/// Grows `all` around what `one` and `within` share.
void addShared(
    extract::SweptBox& all, const extract::SweptBox& one, const extract::SweptBox& within
) {
    all.least = glm::min(all.least, glm::max(one.least, within.least));
    all.most = glm::max(all.most, glm::min(one.most, within.most));
}

/// The part of `seen` that opaque movers come over.
extract::SweptBox findMet(const extract::SweptScene& scene, const extract::SweptBox& seen) {
    const auto movers = scene.sweepOpaqueMovers();
    if (!movers)
        return seen;
    extract::SweptBox met;
    for (const extract::SweptBox& mover : *movers)
        if (extract::overlap(mover, seen))
            addShared(met, mover, seen);
    return met;
}

} // namespace

std::optional<shader::InstantSurfaces> planParticleInstants(
    const extract::SweptSource& source,
    const ParticleTables& particles,
    const render::OverlayLimits& limits
) {
    if (particles.empty() || particles.isInstant || !limits.findsInstants)
        return std::nullopt;
    extract::SweptBox seen;
    seen.least = glm::max(particles.leastPx, math::dvec2(0.0));
    seen.most = glm::min(particles.mostPx, math::dvec2(source.view.width, source.view.height));
    if (!(seen.least.x < seen.most.x && seen.least.y < seen.most.y))
        return std::nullopt;
    const extract::SweptScene scene(source);
    // The tables of particles have no depth along the view of an orthographic camera that moves.
    if (scene.cameraMoves && !scene.isPerspective)
        return std::nullopt;
    const extract::SweptBox box = scene.cameraMoves ? seen : findMet(scene, seen);
    if (!(box.least.x < box.most.x && box.least.y < box.most.y))
        return std::nullopt;
    shader::InstantSurfaces wanted{};
    wanted.originPx = math::uvec2(glm::floor(box.least));
    wanted.sizePx = math::uvec2(glm::ceil(box.most)) - wanted.originPx;
    wanted.instantCount = std::min(limits.instants, kMaxParticleInstants);
    wanted.partCount = particles.hides ? shader::kMaxSurfaceParts : 1;
    wanted.instantCount = render::fitInstants(wanted, limits.surfaceBytes);
    // Parts of as many instants each: particles are drawn in equal parts.
    if (wanted.instantCount > wanted.partCount)
        wanted.instantCount -= wanted.instantCount % wanted.partCount;
    wanted.partCount = std::min(wanted.partCount, wanted.instantCount);
    if (wanted.instantCount == 0)
        return std::nullopt;
    return wanted;
}

} // namespace shutter::particles
