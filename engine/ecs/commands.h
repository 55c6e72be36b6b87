// SPDX-License-Identifier: MIT
#pragma once

#include "engine/core/check.h"
#include "engine/ecs/entity.h"
#include "engine/ecs/registry.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace shutter::ecs {

/// An entity that Commands::apply will create.
struct PendingEntity {
    uint32_t order = 0; ///< index into what apply() returns
    uint32_t batch = 0; ///< which apply() of its Commands creates it
};

/// Structural changes recorded while a registry is being iterated and applied afterwards, in the
/// order of recording. A command on an entity that is no longer alive when its turn comes is
/// skipped: two systems may decide independently to destroy one entity.
class Commands {
  public:
    [[nodiscard]] PendingEntity create() {
        mSteps.push_back(std::make_unique<Create>());
        return {mCreateCount++, mBatch};
    }

    void destroy(Entity entity) { mSteps.push_back(std::make_unique<Destroy>(entity)); }

    /// As Registry::add: adds or replaces.
    template <class T> void add(Entity entity, T value = {}) {
        mSteps.push_back(std::make_unique<Add<T>>(entity, std::nullopt, std::move(value)));
    }

    /// `pending` comes from create() of this object since the last apply().
    template <class T> void add(PendingEntity pending, T value = {}) {
        SHUTTER_CHECK_EQ(pending.batch, mBatch);
        SHUTTER_CHECK(pending.order < mCreateCount, "pending entity {}", pending.order);
        mSteps.push_back(std::make_unique<Add<T>>(kNullEntity, pending.order, std::move(value)));
    }

    template <class T> void remove(Entity entity) {
        mSteps.push_back(std::make_unique<Remove<T>>(entity));
    }

    [[nodiscard]] bool isEmpty() const { return mSteps.empty(); }

    /// Applies and forgets everything recorded. Returns the entities created, in order; the place
    /// of a PendingEntity is its `order`.
    std::vector<Entity> apply(Registry& registry) {
        std::vector<Entity> created;
        for (const auto& step : mSteps)
            step->apply(registry, created);
        mSteps.clear();
        mCreateCount = 0;
        ++mBatch;
        return created;
    }

  private:
    // Own polymorphism, not std::function, for components that can be moved but not copied.
    struct Step {
        Step() = default;
        virtual ~Step() = default;
        Step(const Step&) = delete;
        Step& operator=(const Step&) = delete;
        virtual void apply(Registry& registry, std::vector<Entity>& created) = 0;
    };

    struct Create final : Step {
        void apply(Registry& registry, std::vector<Entity>& created) override {
            created.push_back(registry.create());
        }
    };

    struct Destroy final : Step {
        explicit Destroy(Entity target) : entity(target) {}

        void apply(Registry& registry, std::vector<Entity>& /*created*/) override {
            if (registry.isAlive(entity))
                registry.destroy(entity);
        }

        Entity entity;
    };

    template <class T> struct Add final : Step {
        Add(Entity target, std::optional<uint32_t> pendingOrder, T component)
            : entity(target), order(pendingOrder), value(std::move(component)) {}

        void apply(Registry& registry, std::vector<Entity>& created) override {
            const Entity target = order ? created[*order] : entity;
            if (registry.isAlive(target))
                registry.add<T>(target, std::move(value));
        }

        Entity entity;                 ///< unless `order` is set
        std::optional<uint32_t> order; ///< of a pending entity
        T value;
    };

    template <class T> struct Remove final : Step {
        explicit Remove(Entity target) : entity(target) {}

        void apply(Registry& registry, std::vector<Entity>& /*created*/) override {
            if (registry.isAlive(entity))
                registry.remove<T>(entity);
        }

        Entity entity;
    };

    std::vector<std::unique_ptr<Step>> mSteps;
    uint32_t mCreateCount = 0; ///< of the current batch
    uint32_t mBatch = 0;       ///< number of apply() calls so far
};

} // namespace shutter::ecs
