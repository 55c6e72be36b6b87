// SPDX-License-Identifier: MIT
// What became of a world's entities since the last look, as extraction has to know it.
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
    /// Entities came or went, changed their parents or came into sight, or more than is remembered.
    bool structure = false;
    /// Unless `structure`: what tells where these are, or what moves them, may have changed. Holds
    /// no descendants; may hold one more than once, and entities that are no longer alive.
    std::vector<ecs::Entity> placed;
    /// Likewise: which mesh they draw may have changed.
    std::vector<ecs::Entity> drawn;
};

/// One reader of a registry's logs of changes (change_log.h).
class WorldWatch {
  public:
    /// The first look at a registry says `structure`, unless the registry is empty.
    [[nodiscard]] WorldChanges look(const ecs::Registry& registry);

  private:
    /// A cursor of each component type of a list.
    template <class List> struct Cursors;

    template <class... Components> struct Cursors<scene::ComponentList<Components...>> {
        std::tuple<std::pair<Components*, ecs::ChangeCursor>...> all;
    };

    Cursors<scene::PlacingComponents> mPlacing;
    /// Any change of these concerns more than the entity itself.
    Cursors<scene::ComponentList<scene::Parent, scene::Hidden>> mHierarchy;
    /// These are there or not; with one more or less, other rows are drawn, or in another way.
    Cursors<scene::ComponentList<scene::Skinned, scene::MorphWeights, scene::VertexWaves>>
        mPresence;
    ecs::ChangeCursor mDrawn;
};

/// Checks paths, lenses, their keys and waves when they change, so that whatever a game writes into
/// them is refused before anything samples them.
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

    /// Indices of `roots` and of all that hangs on them, each once.
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
