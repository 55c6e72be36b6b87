// SPDX-License-Identifier: MIT
// Storage of one component type: values lie densely in the order they were added, a sparse array
// finds them by entity index. Adding, removing and finding are O(1); iteration touches no holes.
// Every access that may change a value is recorded in the storage's log of changes.
#pragma once

#include "engine/ecs/change_log.h"
#include "engine/ecs/entity.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace shutter::ecs {

/// The part that does not depend on the component's type.
class SparseSetBase {
  public:
    SparseSetBase() = default;
    virtual ~SparseSetBase() = default;
    SparseSetBase(const SparseSetBase&) = delete;
    SparseSetBase& operator=(const SparseSetBase&) = delete;

    /// False also for a stale handle to an entity whose slot has been used again.
    [[nodiscard]] bool contains(Entity entity) const { return positionOf(entity) != kAbsent; }

    [[nodiscard]] size_t size() const { return mEntities.size(); }

    /// In dense order: the order of adding, except that a removal moves the last one into the gap.
    [[nodiscard]] std::span<const Entity> entities() const { return mEntities; }

    /// Removes the entity's component. Returns whether there was one.
    virtual bool erase(Entity entity) = 0;

    [[nodiscard]] const ChangeLog& changes() const { return mChanges; }

  protected:
    static constexpr uint32_t kAbsent = 0xFFFFFFFFu;

    /// Position in the dense arrays, kAbsent when the entity is not in the set.
    [[nodiscard]] uint32_t positionOf(Entity entity) const {
        if (entity.index >= mPositions.size())
            return kAbsent;
        const uint32_t position = mPositions[entity.index];
        return position != kAbsent && mEntities[position] == entity ? position : kAbsent;
    }

    /// The entity must not be in the set.
    void appendEntity(Entity entity) {
        if (entity.index >= mPositions.size())
            mPositions.resize(entity.index + size_t{1}, kAbsent);
        mPositions[entity.index] = static_cast<uint32_t>(mEntities.size());
        mEntities.push_back(entity);
        mChanges.noteStructure(entity);
    }

    /// Moves the last entity into `position`.
    void eraseEntityAt(uint32_t position) {
        mChanges.noteStructure(mEntities[position]);
        mPositions[mEntities[position].index] = kAbsent;
        if (position + size_t{1} < mEntities.size()) {
            mEntities[position] = mEntities.back();
            mPositions[mEntities[position].index] = position;
        }
        mEntities.pop_back();
    }

    void noteChange(Entity entity) { mChanges.note(entity); }

  private:
    std::vector<uint32_t> mPositions; ///< by entity index
    std::vector<Entity> mEntities;    ///< dense
    ChangeLog mChanges;
};

/// Components of type T. References stay valid until the next insert or erase.
template <class T> class SparseSet final : public SparseSetBase {
    static_assert(std::is_same_v<T, std::decay_t<T>>, "a component is a plain value");
    static_assert(
        !std::is_same_v<T, bool>, "vector<bool> gives no references: wrap it in a struct"
    );

  public:
    /// Marks the component as changed; use the const overload for read-only access.
    [[nodiscard]] T* find(Entity entity) {
        const uint32_t position = positionOf(entity);
        if (position == kAbsent)
            return nullptr;
        noteChange(entity);
        return &mValues[position];
    }

    [[nodiscard]] const T* find(Entity entity) const {
        const uint32_t position = positionOf(entity);
        return position == kAbsent ? nullptr : &mValues[position];
    }

    /// Adds the value, or replaces the one that is there.
    T& insert(Entity entity, T value) {
        if (T* present = find(entity))
            return *present = std::move(value);
        mValues.push_back(std::move(value));
        appendEntity(entity);
        return mValues.back();
    }

    bool erase(Entity entity) override {
        const uint32_t position = positionOf(entity);
        if (position == kAbsent)
            return false;
        if (position + size_t{1} < mValues.size())
            mValues[position] = std::move(mValues.back());
        mValues.pop_back();
        eraseEntityAt(position);
        return true;
    }

  private:
    std::vector<T> mValues; ///< dense, parallel to entities()
};

} // namespace shutter::ecs
