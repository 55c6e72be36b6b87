// SPDX-License-Identifier: MIT
#include "game/demos/stage.h"

#include "engine/core/log.h"
#include "engine/gltf/gltf_loader.h"
#include "engine/scene/history.h"
#include "engine/scene/recorded_motion.h"
#include "modules/particles/particle_extras.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace shutter::game {

core::Result<scene::World> loadDemoScene(const std::filesystem::path& file) {
    auto loaded = gltf::loadGltf(file, {}, {&particles::kParticleExtras, 1});
    if (!loaded)
        return loaded.error();
    for (const std::string& warning : loaded.value().warnings)
        core::logWarning("{}: {}", file.string(), warning);
    scene::World world = std::move(loaded.value().world);
    world.startSeconds = 0.0;
    return world;
}

math::Transform restOf(const scene::World& world, ecs::Entity entity) {
    return world.registry.get<scene::LocalTransform>(entity).transform;
}

NodeNames::NodeNames(const scene::World& world) : mWorld(world) {
    for (auto [entity, name, rest] : world.registry.view<scene::Name, scene::LocalTransform>())
        mEntities.emplace(name.value, entity);
}

ecs::Entity NodeNames::miss(std::string_view name) {
    if (mMissing.empty())
        mMissing = name;
    return ecs::kNullEntity;
}

ecs::Entity NodeNames::find(std::string_view name) {
    const auto found = mEntities.find(name);
    return found != mEntities.end() ? found->second : miss(name);
}

ecs::Entity NodeNames::findMesh(std::string_view name) {
    const ecs::Entity entity = find(name);
    return mWorld.registry.has<scene::MeshInstance>(entity) ? entity : miss(name);
}

std::vector<ecs::Entity> NodeNames::findAll(std::string_view prefix) {
    std::vector<ecs::Entity> found;
    for (auto at = mEntities.lower_bound(prefix);
         at != mEntities.end() && at->first.starts_with(prefix);
         ++at)
        found.push_back(at->second);
    return found;
}

core::Status NodeNames::check(std::string_view file) const {
    if (mMissing.empty())
        return {};
    return core::makeError("{}: it has no node '{}' that the demo can use", file, mMissing);
}

SimulatedPose& simulate(scene::World& world, ecs::Entity entity) {
    const auto* rest = std::as_const(world).registry.find<scene::LocalTransform>(entity);
    SimulatedPose pose;
    if (rest)
        pose.transform = rest->transform;
    return world.registry.add(entity, pose);
}

ecs::Entity copyHidden(scene::World& world, ecs::Entity model) {
    const scene::World& known = world;
    const ecs::Entity copy = world.registry.create();
    world.registry.add(copy, known.registry.get<scene::MeshInstance>(model));
    world.registry.add(copy, known.registry.get<scene::LocalTransform>(model));
    scene::hide(world, copy);
    (void)simulate(world, copy);
    return copy;
}

void recordPoses(scene::World& world, double seconds) {
    // First listed: recording may add components, which a view under way forbids.
    std::vector<std::pair<ecs::Entity, SimulatedPose>> poses;
    for (auto [entity, pose] : world.registry.view<SimulatedPose>()) {
        poses.emplace_back(entity, pose);
        pose.jumped = false;
    }
    for (const auto& [entity, pose] : poses) {
        if (pose.jumped)
            scene::recordJump(world, entity, pose.transform, seconds);
        else
            scene::recordMotion(world, entity, pose.transform, seconds);
    }
}

DemoControls clampControls(const DemoControls& controls) {
    const auto clampAxis = [](double value) {
        return std::isnan(value) ? 0.0 : std::clamp(value, -1.0, 1.0);
    };
    DemoControls clamped = controls;
    clamped.turn = clampAxis(controls.turn);
    clamped.drive = clampAxis(controls.drive);
    return clamped;
}

} // namespace shutter::game
