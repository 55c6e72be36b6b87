// SPDX-License-Identifier: MIT
// Which entities' components of one type may have changed: every storage has a bounded log, and a
// returning reader gets the entries since its last visit.
#pragma once

#include "engine/ecs/entity.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace shutter::ecs {

/// A reader's position in the log of one component type. A default cursor has read nothing.
struct ChangeCursor {
    uint64_t log = 0;      ///< which log; 0: there was none, since no entity had had the component
    uint64_t sequence = 0; ///< entries read
    uint64_t structureChanges = 0; ///< components added and removed by then
};

/// The changes since a cursor.
struct Changes {
    /// The log overflowed, or this is the first read: everything may have changed.
    bool all = false;
    /// A component was added to an entity that lacked it, or removed.
    bool structure = false;
    /// Unless `all`: entities whose component was added, removed, or accessed for writing. May
    /// contain duplicates and entities that are no longer alive. Valid until the next change.
    std::span<const Entity> entities;
};

/// Returns a process-unique log number above 0.
[[nodiscard]] uint64_t takeLogNumber();

/// Private to SparseSetBase.
class ChangeLog {
  public:
    /// Minimum number of stored entries; the maximum is twice this.
    static constexpr size_t kRemembered = 1024;

    void note(Entity entity) {
        // Repeated writes to one entity add a single entry between two reads.
        if (!mEntries.empty() && mEntries.back() == entity &&
            !mWasRead.load(std::memory_order_relaxed))
            return;
        if (mEntries.size() == 2 * kRemembered) {
            mEntries.erase(mEntries.begin(), mEntries.begin() + kRemembered);
            mForgotten += kRemembered;
        }
        mEntries.push_back(entity);
        mWasRead.store(false, std::memory_order_relaxed);
    }

    void noteStructure(Entity entity) {
        ++mStructureChanges;
        note(entity);
    }

    /// Several threads may read at once.
    [[nodiscard]] Changes since(ChangeCursor& cursor) const {
        Changes changes;
        changes.all = cursor.log != mNumber || cursor.sequence < mForgotten;
        changes.structure = changes.all || cursor.structureChanges != mStructureChanges;
        if (!changes.all)
            changes.entities = std::span(mEntries).subspan(cursor.sequence - mForgotten);
        cursor = {mNumber, mForgotten + mEntries.size(), mStructureChanges};
        mWasRead.store(true, std::memory_order_relaxed);
        return changes;
    }

  private:
    uint64_t mNumber = takeLogNumber();
    std::vector<Entity> mEntries;
    uint64_t mForgotten = 0; ///< entries before the first of mEntries
    uint64_t mStructureChanges = 0;
    mutable std::atomic<bool> mWasRead = false; ///< up to the last entry
};

} // namespace shutter::ecs
