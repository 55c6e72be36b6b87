// SPDX-License-Identifier: MIT
// Times at which entities may jump: at keys of STEP interpolation, between two keys at nearly the
// same time, and where a clip loops.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/scene/animation.h"
#include "engine/scene/assets.h"
#include "engine/scene/history.h"
#include "engine/scene/world.h"

#include <compare>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace shutter::scene {

/// At `before` nothing of it has happened, at `after` all has. Where a property steps, the two are
/// as near as rounding allows for them to be on different sides of it.
struct Jump {
    double before = 0.0; ///< seconds
    double after = 0.0;  ///< seconds

    [[nodiscard]] auto operator<=>(const Jump&) const = default;
};

class ClipJumps {
  public:
    /// Maximum number of loops of a clip within `span`; clips with more are ignored.
    static constexpr double kMaxRounds = 64.0;

    /// Collects the jumps of all entities that clips drive.
    /// \param span seconds; both ends included
    /// \param longestSeconds between two keys that count as one place in time
    ClipJumps(const World& world, const TimeSpan& span, double longestSeconds);

    [[nodiscard]] bool empty() const { return mPlaces.empty() && mShapes.empty(); }

    /// Returns jumps of what places the entity, or its joints, or deforms its mesh; in rising
    /// order, some of them at which nothing is seen to jump.
    [[nodiscard]] std::vector<Jump> of(const World& world, ecs::Entity entity) const;

  private:
    using Jumps = std::unordered_map<uint32_t, std::vector<Jump>>; ///< by entity index

    void addPlaces(const World& world, ecs::Entity entity, std::vector<Jump>& jumps) const;

    Jumps mPlaces; ///< of what clips place themselves
    Jumps mShapes; ///< of morph targets' weights
};

/// Returns the jumps of what places one entity, those of paths included, in rising order. For short
/// spans and one entity, where ClipJumps searches all.
[[nodiscard]] std::vector<Jump>
findPlaceJumps(const World& world, ecs::Entity entity, const TimeSpan& span, double longestSeconds);

} // namespace shutter::scene
