// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/check.h"
#include "engine/ecs/entity.h"
#include "engine/ecs/sparse_set.h"
#include "engine/ecs/view.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace shutter::ecs {

/// A number for a component type, the same in every registry of the process. Not the same in every
/// run: never store it, never order by it.
[[nodiscard]] uint32_t takeTypeIndex();

template <class T> [[nodiscard]] uint32_t typeIndex() {
    static const uint32_t index = takeTypeIndex();
    return index;
}

/// Entities and their components. Structural changes are create, destroy, add and remove; they
/// invalidate references to components of the types concerned, and they are a CHECK failure while a
/// view or entities() is being iterated: record them in Commands instead. Several threads may read
/// a const registry while no thread writes it; non-const access to a component counts as a write
/// (changesSince).
class Registry {
  public:
    Registry() = default;
    ~Registry() = default;
    Registry(const Registry&) = delete;
    Registry& operator=(const Registry&) = delete;
    /// The source is empty afterwards and may be used again. Neither may be under iteration.
    Registry(Registry&& other) noexcept;
    Registry& operator=(Registry&& other) noexcept;

    /// Reuses the slot of the entity destroyed last, under a new generation.
    [[nodiscard]] Entity create();

    /// Removes the entity, which must be alive, with all its components.
    void destroy(Entity entity);

    /// False for the null entity and for stale handles.
    [[nodiscard]] bool isAlive(Entity entity) const {
        return entity.index < mSlots.size() && mSlots[entity.index].alive &&
               mSlots[entity.index].generation == entity.generation;
    }

    [[nodiscard]] size_t aliveCount() const { return mAliveCount; }

    /// Adds a component to an entity that is alive, or replaces the one it has.
    template <class T> T& add(Entity entity, T value = {}) {
        checkUnlocked("add");
        SHUTTER_CHECK(isAlive(entity), "add: {} is not alive", entity);
        return ensureSet<T>().insert(entity, std::move(value));
    }

    /// Returns whether the entity, which must be alive, had the component.
    template <class T> bool remove(Entity entity) {
        checkUnlocked("remove");
        SHUTTER_CHECK(isAlive(entity), "remove: {} is not alive", entity);
        SparseSet<T>* set = findSet<T>();
        return set && set->erase(entity);
    }

    /// The component, or nullptr when the entity lacks it or is not alive.
    template <class T> [[nodiscard]] T* find(Entity entity) {
        SparseSet<T>* set = findSet<T>();
        return set ? set->find(entity) : nullptr;
    }

    template <class T> [[nodiscard]] const T* find(Entity entity) const {
        const SparseSet<T>* set = findSet<T>();
        return set ? set->find(entity) : nullptr;
    }

    /// The component, which must be there.
    template <class T> [[nodiscard]] T& get(Entity entity) {
        T* component = find<T>(entity);
        SHUTTER_CHECK(component != nullptr, "{} lacks the component", entity);
        return *component;
    }

    template <class T> [[nodiscard]] const T& get(Entity entity) const {
        const T* component = find<T>(entity);
        SHUTTER_CHECK(component != nullptr, "{} lacks the component", entity);
        return *component;
    }

    template <class T> [[nodiscard]] bool has(Entity entity) const {
        return find<T>(entity) != nullptr;
    }

    /// for (auto [entity, a, b] : registry.view<A, const B>()); order and rules: view.h.
    template <class... Components> [[nodiscard]] View<Components...> view() {
        return {mIterationCount, findSet<std::remove_const_t<Components>>()...};
    }

    template <class... Components> [[nodiscard]] View<const Components...> view() const {
        return {mIterationCount, findSet<std::remove_const_t<Components>>()...};
    }

    /// Which components of type T may have changed since `cursor`, and advances `cursor` to now.
    /// Every non-const access counts: add, remove, destroy, and non-const find, get and views.
    /// Later writes through a stored reference are not detected.
    template <class T> [[nodiscard]] Changes changesSince(ChangeCursor& cursor) const {
        if (const SparseSet<T>* set = findSet<T>())
            return set->changes().since(cursor);
        const bool other = cursor.log != 0; // of another registry
        cursor = {};
        return {other, other, {}};
    }

    /// for (Entity entity : registry.entities()), by rising index.
    [[nodiscard]] EntityRange entities() const { return {mIterationCount, mSlots}; }

  private:
    void checkUnlocked(const char* change) const {
        SHUTTER_CHECK(
            mIterationCount.load(std::memory_order_relaxed) == 0,
            "{} while a view is being iterated; record it in Commands",
            change
        );
    }

    template <class T> [[nodiscard]] SparseSet<T>* findSet() {
        const uint32_t index = typeIndex<T>();
        return index < mSets.size() ? static_cast<SparseSet<T>*>(mSets[index].get()) : nullptr;
    }

    template <class T> [[nodiscard]] const SparseSet<T>* findSet() const {
        const uint32_t index = typeIndex<T>();
        return index < mSets.size() ? static_cast<const SparseSet<T>*>(mSets[index].get())
                                    : nullptr;
    }

    template <class T> SparseSet<T>& ensureSet() {
        const uint32_t index = typeIndex<T>();
        if (index >= mSets.size())
            mSets.resize(index + size_t{1});
        if (!mSets[index])
            mSets[index] = std::make_unique<SparseSet<T>>();
        return static_cast<SparseSet<T>&>(*mSets[index]);
    }

    std::vector<EntitySlot> mSlots;     ///< by entity index
    std::vector<uint32_t> mFreeIndices; ///< dead slots, the last is used next
    size_t mAliveCount = 0;
    std::vector<std::unique_ptr<SparseSetBase>> mSets; ///< by typeIndex; null: never added
    mutable std::atomic<uint32_t> mIterationCount = 0; ///< iterators alive over this registry
};

} // namespace shutter::ecs
