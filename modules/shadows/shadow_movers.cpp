// SPDX-License-Identifier: MIT
#include "modules/shadows/shadow_movers.h"

#include "modules/shadows/shadow_runs.h"

#include <algorithm>

namespace shutter::shadows {

namespace {

using math::dmat4;
using math::dvec3;

math::vec4 moveToEye(const Sphere& sphere, const dvec3& eye) {
    return {math::vec3(sphere.centre - eye), float(sphere.radius)};
}

shader::ShadowInstant makeInstant(const dmat4& rasterFromInstant, const dvec3& eye) {
    const dmat4 matrix =
        glm::translate(dmat4(1.0), -eye) * rasterFromInstant * glm::translate(dmat4(1.0), eye);
    shader::ShadowInstant row{};
    for (int i = 0; i < 3; ++i)
        row.rasterFromInstant[i] =
            math::vec4(matrix[0][i], matrix[1][i], matrix[2][i], matrix[3][i]);
    return row;
}

void addRow(
    ShadowPlan& plan, const PlannedMover& mover, uint32_t firstLayer, uint32_t instantCount
) {
    shader::ShadowMover row{};
    row.entity = mover.caster.row;
    row.sphere = row.sweptSphere = moveToEye(mover.caster.sphere, plan.eye);
    for (int i = 0; i < 3; ++i)
        row.shape[i] = math::vec4(math::vec3(mover.caster.shape[i]), 0.0f); // symmetric
    row.firstInstant = static_cast<uint32_t>(plan.instants.size());
    row.instantCount = 1;
    row.firstLayer = firstLayer;
    row.partCount = static_cast<uint32_t>(mover.parts.size());
    if (!mover.path.instants.empty()) {
        row.instantCount = instantCount;
        row.sweptSphere = moveToEye(mover.path.swept, plan.eye);
    }
    for (const CasterInstant& instant : mover.path.instants)
        plan.instants.push_back(makeInstant(instant.rasterFromInstant, plan.eye));
    for (const CasterInstant& part : mover.parts)
        plan.instants.push_back(makeInstant(part.rasterFromInstant, plan.eye));
    plan.movers.push_back(row);
}

/// The raster instant's layer of a mover, then those of its parts.
/// \param firstLayer of the mover, index of the plan's maps
std::vector<MoverLayer>
findLayers(const ShadowPlan& plan, const PlannedMover& mover, uint32_t firstLayer) {
    std::vector<MoverLayer> layers(1 + mover.parts.size());
    for (size_t i = 0; i < layers.size(); ++i) {
        const PlannedMap& map = plan.maps[firstLayer + i];
        layers[i].view = map.view;
        layers[i].sizePx = map.sizePx;
        layers[i].firstTexel = map.firstTexel;
        if (i > 0)
            layers[i].rasterFromInstant = mover.parts[i - 1].rasterFromInstant;
    }
    return layers;
}

/// \param lights those that are far away
void addRuns(
    ShadowPlan& plan,
    std::span<const PlannedMover> movers,
    std::span<const PlacedLight* const> lights
) {
    const auto layersOf = [&](const PlacedLight& light, size_t mover) {
        return findLayers(
            plan, movers[mover], plan.lights[light.index].firstLayer + plan.movers[mover].firstLayer
        );
    };
    for (const PlacedLight* light : lights)
        for (size_t i = 0; i < movers.size(); ++i) {
            const uint32_t length = findRunInstants(
                movers[i].caster, movers[i].path, layersOf(*light, i), -light->direction
            );
            uint32_t& least = plan.movers[i].runInstants; // of all lights
            least = light == lights.front() ? length : std::min(least, length);
        }
    for (const PlacedLight* light : lights) {
        const auto first = static_cast<uint32_t>(plan.runs.size());
        plan.lights[light->index].firstRun = first;
        for (size_t i = 0; i < movers.size(); ++i) {
            shader::ShadowMover& row = plan.movers[i];
            row.firstRun = static_cast<uint32_t>(plan.runs.size()) - first;
            const std::vector<shader::CasterSpan> runs = makeRuns(
                movers[i].caster,
                movers[i].path,
                layersOf(*light, i),
                -light->direction,
                row.runInstants,
                plan.eye
            );
            plan.runs.insert(plan.runs.end(), runs.begin(), runs.end());
        }
    }
}

} // namespace

uint32_t addMovers(
    ShadowPlan& plan,
    std::span<const PlannedMover> movers,
    std::span<const PlacedLight> lights,
    uint32_t instantCount
) {
    uint32_t layers = 0;
    uint32_t moving = 0;
    for (const PlannedMover& mover : movers) {
        addRow(plan, mover, layers, instantCount);
        layers += static_cast<uint32_t>(1 + mover.parts.size());
        moving += !mover.path.instants.empty();
    }
    std::vector<const PlacedLight*> far;
    for (const PlacedLight& light : lights)
        if (light.isDirectional())
            far.push_back(&light);
    addRuns(plan, movers, far);
    return moving;
}

} // namespace shutter::shadows
