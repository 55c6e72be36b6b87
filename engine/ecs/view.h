// SPDX-License-Identifier: MIT
// What Registry::view and Registry::entities return; included by registry.h.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/ecs/sparse_set.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <tuple>
#include <type_traits>

namespace shutter::ecs {

/// Counts the iterations under way, so that a registry can refuse to change its structure. The
/// count is atomic because several threads may read one const registry.
class IterationLock {
  public:
    explicit IterationLock(std::atomic<uint32_t>& count) : mCount(&count) { ++*mCount; }

    IterationLock(const IterationLock& other) : mCount(other.mCount) { ++*mCount; }

    IterationLock& operator=(const IterationLock& other) {
        ++*other.mCount; // first, for self-assignment
        --*mCount;
        mCount = other.mCount;
        return *this;
    }

    ~IterationLock() { --*mCount; }

  private:
    std::atomic<uint32_t>* mCount;
};

/// Every entity that has all of `Components`, as (Entity, Components&...). A const component type
/// gives a const reference. Driven by the smallest storage (the first of equals) in its dense
/// order, so equal histories give equal orders. From begin() until the iterator is gone the
/// registry's structure is locked; the components' values may change. Take a fresh view after
/// structural changes.
template <class... Components> class View {
    static_assert(sizeof...(Components) > 0, "name at least one component");

    template <class T>
    using Set = std::
        conditional_t<std::is_const_v<T>, const SparseSet<std::remove_const_t<T>>, SparseSet<T>>;
    using Sets = std::tuple<Set<Components>*...>;

  public:
    class Iterator {
      public:
        using value_type = std::tuple<Entity, Components&...>;
        using difference_type = std::ptrdiff_t;

        Iterator(IterationLock lock, std::span<const Entity> candidates, const Sets& sets)
            : mLock(lock), mCandidates(candidates), mSets(sets) {
            skipIncomplete();
        }

        value_type operator*() const {
            const Entity entity = mCandidates.front();
            const auto fetch = [entity](auto*... sets) {
                return value_type(entity, *sets->find(entity)...);
            };
            return std::apply(fetch, mSets);
        }

        Iterator& operator++() {
            mCandidates = mCandidates.subspan(1);
            skipIncomplete();
            return *this;
        }

        void operator++(int) { ++*this; }

        bool operator==(std::default_sentinel_t) const { return mCandidates.empty(); }

      private:
        void skipIncomplete() {
            while (!mCandidates.empty() && !isComplete(mCandidates.front()))
                mCandidates = mCandidates.subspan(1);
        }

        [[nodiscard]] bool isComplete(Entity entity) const {
            const auto all = [entity](auto*... sets) { return (sets->contains(entity) && ...); };
            return std::apply(all, mSets);
        }

        IterationLock mLock;
        std::span<const Entity> mCandidates; ///< the current entity and those after it
        Sets mSets;
    };

    /// A null set means that no entity has had the component yet: the view is empty.
    View(std::atomic<uint32_t>& iterationCount, Set<Components>*... sets)
        : mIterationCount(&iterationCount), mSets(sets...) {}

    [[nodiscard]] Iterator begin() const {
        return Iterator(IterationLock(*mIterationCount), findSmallest(), mSets);
    }

    [[nodiscard]] std::default_sentinel_t end() const { return {}; }

  private:
    [[nodiscard]] std::span<const Entity> findSmallest() const {
        const auto smallest = [](auto*... sets) -> std::span<const Entity> {
            if ((!sets || ...))
                return {};
            const SparseSetBase* best = nullptr;
            ((best = best && best->size() <= sets->size() ? best : sets), ...);
            return best->entities();
        };
        return std::apply(smallest, mSets);
    }

    std::atomic<uint32_t>* mIterationCount;
    Sets mSets;
};

/// One place of a registry that holds an entity, or held one.
struct EntitySlot {
    uint32_t generation = 0;
    bool alive = false;
};

/// Every entity alive, by rising index. Locks the registry's structure as View does.
class EntityRange {
  public:
    class Iterator {
      public:
        using value_type = Entity;
        using difference_type = std::ptrdiff_t;

        Iterator(IterationLock lock, std::span<const EntitySlot> slots)
            : mLock(lock), mSlots(slots) {
            skipDead();
        }

        Entity operator*() const { return {mIndex, mSlots[mIndex].generation}; }

        Iterator& operator++() {
            ++mIndex;
            skipDead();
            return *this;
        }

        void operator++(int) { ++*this; }

        bool operator==(std::default_sentinel_t) const { return mIndex >= mSlots.size(); }

      private:
        void skipDead() {
            while (mIndex < mSlots.size() && !mSlots[mIndex].alive)
                ++mIndex;
        }

        IterationLock mLock;
        std::span<const EntitySlot> mSlots;
        uint32_t mIndex = 0;
    };

    EntityRange(std::atomic<uint32_t>& iterationCount, std::span<const EntitySlot> slots)
        : mIterationCount(&iterationCount), mSlots(slots) {}

    [[nodiscard]] Iterator begin() const {
        return Iterator(IterationLock(*mIterationCount), mSlots);
    }

    [[nodiscard]] std::default_sentinel_t end() const { return {}; }

  private:
    std::atomic<uint32_t>* mIterationCount;
    std::span<const EntitySlot> mSlots;
};

} // namespace shutter::ecs
