// SPDX-License-Identifier: MIT
// Shared by the demos: finds the entities of a scene, and writes simulated placements to the scene.
#pragma once

#include "engine/core/result.h"
#include "engine/math/transform.h"
#include "engine/scene/world.h"
#include "game/demos/demo.h"

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::game {

/// Component: where the simulation has put an entity, in its parent's space. Systems write it;
/// recordPoses() makes it motion.
struct SimulatedPose {
    math::Transform transform;
    bool jumped = false; ///< put there in this step, not moved
};

/// Reads a demo's scene; nothing in it has a past before 0 s. Its warnings are logged.
[[nodiscard]] core::Result<scene::World> loadDemoScene(const std::filesystem::path& file);

/// Where the scene put an entity that has a place (scene::LocalTransform), in its parent's
/// space.
[[nodiscard]] math::Transform restOf(const scene::World& world, ecs::Entity entity);

/// A scene's entities by scene::Name; only those with a scene::LocalTransform.
class NodeNames {
  public:
    /// \param world outlives this
    explicit NodeNames(const scene::World& world);

    /// Null, and remembered as missing, where no entity has the name.
    [[nodiscard]] ecs::Entity find(std::string_view name);
    /// Likewise, of those that draw a mesh.
    [[nodiscard]] ecs::Entity findMesh(std::string_view name);
    /// All whose names begin so, by name; none is remembered as missing.
    [[nodiscard]] std::vector<ecs::Entity> findAll(std::string_view prefix);
    /// Error: names `file` and the first name that was missing.
    [[nodiscard]] core::Status check(std::string_view file) const;

  private:
    [[nodiscard]] ecs::Entity miss(std::string_view name);

    const scene::World& mWorld;
    std::map<std::string, ecs::Entity, std::less<>> mEntities;
    std::string mMissing;
};

/// Gives the entity a SimulatedPose: the one it has at rest.
SimulatedPose& simulate(scene::World& world, ecs::Entity entity);

/// A root that draws the model's mesh, simulated, hidden.
[[nodiscard]] ecs::Entity copyHidden(scene::World& world, ecs::Entity model);

/// Every SimulatedPose becomes where its entity is at `seconds` (scene/recorded_motion.h).
void recordPoses(scene::World& world, double seconds);

/// In their ranges, NaN as 0.
[[nodiscard]] DemoControls clampControls(const DemoControls& controls);

} // namespace shutter::game
