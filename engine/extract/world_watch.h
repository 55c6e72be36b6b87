// SPDX-License-Identifier: MIT
// Tracks which entities of a world changed since the last extraction.
#pragma once

#include "engine/core/result.h"
#include "engine/ecs/registry.h"
#include "engine/scene/camera.h"
#include "engine/scene/components.h"
#include "engine/scene/placing.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace shutter::extract {

struct WorldChanges {
    /// Entities were created, destroyed, shown or moved to another parent, or a log overflowed.
    bool structure = false;
    /// Unless `structure`: entities whose placement or motion may have changed. Without their
    /// descendants; may contain duplicates and entities that are no longer alive.
    std::vector<ecs::Entity> placed;
    /// Likewise: entities whose mesh may have changed.
    std::vector<ecs::Entity> drawn;
};

/// One reader of a registry's logs of changes (change_log.h).
class WorldWatch {
  public:
    /// The first call for a registry returns `structure`, unless the registry is empty.
    [[nodiscard]] WorldChanges update(const ecs::Registry& registry);

  private:
    /// A cursor of each component type of a list.
    template <class List> struct Cursors;

    template <class... Components> struct Cursors<scene::ComponentList<Components...>> {
        std::tuple<std::pair<Components*, ecs::ChangeCursor>...> all;
    };

    Cursors<scene::PlacingComponents> mPlacing;
    /// A change of these affects more than the entity itself.
    Cursors<scene::ComponentList<scene::Parent, scene::Hidden>> mHierarchy;
    /// Only the presence of these matters: adding or removing one changes which rows are drawn, or
    /// how.
    Cursors<scene::ComponentList<scene::Skinned, scene::MorphWeights, scene::VertexWaves>>
        mPresence;
    ecs::ChangeCursor mDrawn;
};

/// Validates paths, lenses, their keys and waves when they change, so that invalid values are
/// rejected before they are sampled.
class MotionCheck {
  public:
    /// Error: names the entity whose path, lens or waves are not valid (scene::validatePath,
    /// validateLens, validateFocus, validate, validateAutoFocus, validateWaves).
    [[nodiscard]] core::Status check(const ecs::Registry& registry);

  private:
    ecs::ChangeCursor mPaths;
    ecs::ChangeCursor mLenses;
    ecs::ChangeCursor mFocuses;
    ecs::ChangeCursor mOpenings;
    ecs::ChangeCursor mOverrides;
    ecs::ChangeCursor mAutoFocuses;
    ecs::ChangeCursor mWaves;
};

/// Children of all entities of a registry.
class Descendants {
  public:
    void build(const ecs::Registry& registry);

    void clear() { mBuilt = false; }

    [[nodiscard]] bool isBuilt() const { return mBuilt; }

    /// Returns the indices of `roots` and all their descendants, each once.
    [[nodiscard]] std::vector<uint32_t> collect(std::span<const ecs::Entity> roots);

  private:
    static constexpr uint32_t kNone = 0xFFFFFFFFu;

    void visit(uint32_t entity, std::vector<uint32_t>& visited);

    std::vector<uint32_t> mFirstChild;  ///< by entity index
    std::vector<uint32_t> mNextSibling; ///< by entity index
    std::vector<uint64_t> mVisit;       ///< by entity index: number of the last collect()
    uint64_t mCollects = 0;
    bool mBuilt = false;
};

} // namespace shutter::extract
