// SPDX-License-Identifier: MIT
#include "engine/ecs/registry.h"
#include "tests/unit/ecs/components.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <type_traits>
#include <vector>

namespace shutter::ecs {
namespace {

struct Tag {};

static_assert(!std::is_copy_constructible_v<Registry> && !std::is_copy_assignable_v<Registry>);
static_assert(std::is_nothrow_move_constructible_v<Registry>);
static_assert(std::is_same_v<
              decltype(std::declval<const Registry&>().get<Position>(Entity{})),
              const Position&>);
static_assert(std::is_same_v<
              decltype(std::declval<const Registry&>().find<Position>(Entity{})),
              const Position*>);

TEST(Registry, AnEmptyRegistryHasNoEntities) {
    const Registry registry;
    EXPECT_EQ(registry.aliveCount(), 0u);
    EXPECT_FALSE(registry.isAlive(kNullEntity));
    EXPECT_FALSE(registry.isAlive({0, 0}));
    EXPECT_EQ(registry.find<Position>({0, 0}), nullptr);
    EXPECT_TRUE(registry.entities().begin() == registry.entities().end());
}

TEST(Registry, ADestroyedEntityIsNoLongerAlive) {
    Registry registry;
    const Entity kept = registry.create();
    const Entity gone = registry.create();
    EXPECT_TRUE(registry.isAlive(gone));
    registry.destroy(gone);
    EXPECT_FALSE(registry.isAlive(gone));
    EXPECT_TRUE(registry.isAlive(kept));
    EXPECT_EQ(registry.aliveCount(), 1u);
}

TEST(Registry, AReusedSlotDoesNotReviveStaleHandles) {
    Registry registry;
    const Entity stale = registry.create();
    registry.add(stale, Health{1});
    registry.destroy(stale);
    const Entity fresh = registry.create();
    ASSERT_EQ(fresh.index, stale.index);
    EXPECT_NE(fresh, stale);
    EXPECT_FALSE(registry.isAlive(stale));
    EXPECT_FALSE(registry.has<Health>(fresh));
    registry.add(fresh, Health{2});
    EXPECT_EQ(registry.find<Health>(stale), nullptr);
    EXPECT_EQ(registry.get<Health>(fresh).points, 2);
}

TEST(Registry, DestroyRemovesEveryComponent) {
    const auto shared = std::make_shared<int>(0);
    Registry registry;
    const Entity entity = registry.create();
    registry.add(entity, shared);
    registry.add<Position>(entity);
    registry.destroy(entity);
    EXPECT_EQ(shared.use_count(), 1);
    for ([[maybe_unused]] auto row : registry.view<Position>())
        ADD_FAILURE();
}

TEST(Registry, AddGivesTheComponentAndReplacesAnOlderOne) {
    Registry registry;
    const Entity entity = registry.create();
    registry.add(entity, Health{5}).points += 1;
    EXPECT_EQ(registry.get<Health>(entity).points, 6);
    registry.add(entity, Health{7});
    EXPECT_EQ(registry.get<Health>(entity).points, 7);
    EXPECT_EQ(registry.add<Position>(entity).x, 0.0);
}

TEST(Registry, RemoveSaysWhetherTheComponentWasThere) {
    Registry registry;
    const Entity entity = registry.create();
    EXPECT_FALSE(registry.remove<Health>(entity));
    registry.add<Health>(entity);
    registry.add<Tag>(entity);
    EXPECT_TRUE(registry.remove<Health>(entity));
    EXPECT_FALSE(registry.has<Health>(entity));
    EXPECT_TRUE(registry.has<Tag>(entity));
    EXPECT_FALSE(registry.remove<Health>(entity));
}

TEST(Registry, MoveOnlyComponentsWork) {
    Registry registry;
    const Entity entity = registry.create();
    registry.add(entity, std::make_unique<int>(3));
    EXPECT_EQ(*registry.get<std::unique_ptr<int>>(entity), 3);
}

TEST(Registry, EntitiesListsTheAliveByRisingIndex) {
    Registry registry;
    std::vector<Entity> all;
    for (int i = 0; i < 5; ++i)
        all.push_back(registry.create());
    registry.destroy(all[0]);
    registry.destroy(all[2]);
    registry.destroy(all[4]);
    std::vector<Entity> seen;
    for (const Entity entity : registry.entities())
        seen.push_back(entity);
    EXPECT_EQ(seen, (std::vector<Entity>{all[1], all[3]}));
}

TEST(Registry, AMovedRegistryKeepsEverythingAndItsSourceIsEmpty) {
    Registry source;
    const Entity entity = source.create();
    source.add(entity, Health{42});
    Registry target(std::move(source));
    EXPECT_EQ(target.get<Health>(entity).points, 42);
    EXPECT_EQ(target.aliveCount(), 1u);
    // NOLINTBEGIN(bugprone-use-after-move): the header promises an empty registry
    EXPECT_EQ(source.aliveCount(), 0u);
    EXPECT_FALSE(source.isAlive(entity));
    const Entity again = source.create();
    EXPECT_FALSE(source.has<Health>(again));
    // NOLINTEND(bugprone-use-after-move)
    target = std::move(source);
    EXPECT_FALSE(target.has<Health>(again));
    EXPECT_EQ(target.aliveCount(), 1u);
}

TEST(Registry, TwoRegistriesShareNoState) {
    Registry first;
    Registry second;
    const Entity a = first.create();
    const Entity b = second.create();
    EXPECT_EQ(a, b);
    first.add(a, Health{1});
    EXPECT_FALSE(second.has<Health>(b));
    for ([[maybe_unused]] auto row : first.view<Health>())
        second.add(b, Health{2});
    EXPECT_EQ(first.get<Health>(a).points, 1);
}

TEST(Registry, ManyEntitiesComeAndGoConsistently) {
    Registry registry;
    std::vector<Entity> alive;
    std::set<Entity> everSeen;
    uint32_t random = 1;
    for (int step = 0; step < 20000; ++step) {
        random = random * 1664525u + 1013904223u;
        if (alive.empty() || random % 3u != 0) {
            const Entity entity = registry.create();
            EXPECT_TRUE(everSeen.insert(entity).second) << "a handle was given out twice";
            registry.add(entity, Health{static_cast<int>(entity.index)});
            alive.push_back(entity);
        } else {
            const size_t victim = (random >> 8u) % alive.size();
            registry.destroy(alive[victim]);
            alive[victim] = alive.back();
            alive.pop_back();
        }
    }
    EXPECT_EQ(registry.aliveCount(), alive.size());
    for (const Entity entity : alive)
        ASSERT_EQ(registry.get<Health>(entity).points, static_cast<int>(entity.index));
}

TEST(RegistryDeathTest, UsingAStaleHandleIsAProgrammersMistake) {
    Registry registry;
    const Entity stale = registry.create();
    registry.add<Health>(stale);
    registry.destroy(stale);
    EXPECT_DEATH(registry.destroy(stale), "destroy: entity 0 \\(generation 0\\) is not alive");
    EXPECT_DEATH(registry.add<Health>(stale), "add: entity 0");
    EXPECT_DEATH(registry.remove<Health>(stale), "remove: entity 0");
    EXPECT_DEATH((void)registry.get<Health>(stale), "lacks the component");
    EXPECT_DEATH((void)std::as_const(registry).get<Health>(stale), "lacks the component");
    EXPECT_DEATH(registry.add<Health>(kNullEntity), "the null entity is not alive");
}

} // namespace
} // namespace shutter::ecs
