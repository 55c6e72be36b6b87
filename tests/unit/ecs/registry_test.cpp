// SPDX-License-Identifier: MIT
// Entities, their components, and views of them.
#include "engine/ecs/entity.h"
#include "engine/ecs/registry.h"
#include "engine/ecs/sparse_set.h"
#include "engine/ecs/view.h"
#include "tests/unit/ecs/components.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <type_traits>
#include <unordered_set>
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

TEST(Registry, RemoveReturnsWhetherTheComponentWasThere) {
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

TEST(Registry, EntitiesListsTheAliveByRisingIndex) {
    const Registry empty;
    EXPECT_TRUE(empty.entities().begin() == empty.entities().end());
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

TEST(Entity, ComparisonIsOfIndexAndGeneration) {
    EXPECT_EQ((Entity{3, 1}), (Entity{3, 1}));
    EXPECT_NE((Entity{3, 1}), (Entity{3, 2}));
    EXPECT_NE((Entity{3, 1}), (Entity{4, 1}));
    EXPECT_LT((Entity{3, 9}), (Entity{4, 0}));
    EXPECT_LT((Entity{3, 1}), (Entity{3, 2}));
}

TEST(Entity, HashedContainersSeparateGenerations) {
    const std::unordered_set<Entity> set = {{1, 0}, {1, 1}, {0, 1}, {1, 0}};
    EXPECT_EQ(set.size(), 3u);
    EXPECT_TRUE(set.contains({1, 1}));
    EXPECT_NE(std::hash<Entity>{}({1, 0}), std::hash<Entity>{}({1, 1}));
    EXPECT_NE(std::hash<Entity>{}({1, 0}), std::hash<Entity>{}({0, 1}));
}

TEST(Entity, FormatNamesIndexAndGeneration) {
    EXPECT_EQ(fmt::format("{}", Entity{3, 1}), "entity 3 (generation 1)");
    EXPECT_EQ(fmt::format("{}", kNullEntity), "the null entity");
}

std::vector<uint32_t> listIndices(const SparseSetBase& set) {
    std::vector<uint32_t> indices;
    for (const Entity entity : set.entities())
        indices.push_back(entity.index);
    return indices;
}

TEST(SparseSet, AValueIsFoundUnderItsEntityOnly) {
    SparseSet<std::string> set;
    set.insert({7, 2}, "seven");
    ASSERT_NE(set.find({7, 2}), nullptr);
    EXPECT_EQ(*set.find({7, 2}), "seven");
    EXPECT_EQ(set.find({7, 1}), nullptr);
    EXPECT_EQ(set.find({6, 2}), nullptr);
    EXPECT_FALSE(set.erase({7, 1}));
    EXPECT_EQ(set.size(), 1u);
}

TEST(SparseSet, InsertingAgainReplacesTheValueInPlace) {
    SparseSet<int> set;
    set.insert({1, 0}, 10);
    set.insert({2, 0}, 20);
    EXPECT_EQ(set.insert({1, 0}, 11), 11);
    EXPECT_EQ(set.size(), 2u);
    EXPECT_EQ(*set.find({1, 0}), 11);
    EXPECT_EQ(listIndices(set), (std::vector<uint32_t>{1, 2}));
}

TEST(SparseSet, ErasingMovesTheLastIntoTheGap) {
    SparseSet<std::string> set;
    for (uint32_t i = 0; i < 4; ++i)
        set.insert({i, 0}, std::to_string(i));
    EXPECT_TRUE(set.erase({1, 0}));
    EXPECT_EQ(listIndices(set), (std::vector<uint32_t>{0, 3, 2}));
    EXPECT_EQ(*set.find({0, 0}), "0");
    EXPECT_EQ(set.find({1, 0}), nullptr);
    EXPECT_EQ(*set.find({2, 0}), "2");
    EXPECT_EQ(*set.find({3, 0}), "3");
}

TEST(SparseSet, ErasingTheLastAndTheOnlyOneWorks) {
    SparseSet<std::string> set;
    set.insert({0, 0}, "a long enough string that it owns memory of its own");
    set.insert({9, 0}, "another");
    EXPECT_TRUE(set.erase({9, 0}));
    EXPECT_EQ(*set.find({0, 0}), "a long enough string that it owns memory of its own");
    EXPECT_TRUE(set.erase({0, 0}));
    EXPECT_EQ(set.size(), 0u);
    EXPECT_FALSE(set.erase({0, 0}));
}

TEST(SparseSet, ErasingDestroysTheValue) {
    const auto shared = std::make_shared<int>(1);
    SparseSet<std::shared_ptr<int>> set;
    set.insert({0, 0}, shared);
    set.insert({1, 0}, shared);
    EXPECT_EQ(shared.use_count(), 3);
    set.erase({0, 0});
    EXPECT_EQ(shared.use_count(), 2);
}

struct A {
    int value = 0;
};

struct B {
    int value = 0;
};

struct NeverAdded {};

template <class Range> std::vector<uint32_t> listIndices(const Range& view) {
    std::vector<uint32_t> indices;
    for (const auto& row : view)
        indices.push_back(std::get<0>(row).index);
    return indices;
}

using Indices = std::vector<uint32_t>;

TEST(View, AViewIsEmptyIfNoEntityHasTheComponent) {
    Registry registry;
    EXPECT_EQ(listIndices(registry.view<A>()), Indices{});
    registry.add<A>(registry.create());
    EXPECT_EQ(listIndices(registry.view<NeverAdded>()), Indices{});
    EXPECT_EQ(listIndices(registry.view<A, NeverAdded>()), Indices{});
    EXPECT_EQ(listIndices(registry.view<NeverAdded, A>()), Indices{});
}

TEST(View, AViewVisitsExactlyTheEntitiesWithAllComponents) {
    Registry registry;
    for (int i = 0; i < 6; ++i) {
        const Entity entity = registry.create();
        if (i != 0)
            registry.add(entity, A{i});
        if (i % 2 == 1 || i == 0)
            registry.add(entity, B{10 * i});
    }
    Indices seen;
    for (auto [entity, a, b] : registry.view<A, B>()) {
        EXPECT_EQ(b.value, 10 * a.value);
        EXPECT_EQ(a.value, static_cast<int>(entity.index));
        seen.push_back(entity.index);
    }
    EXPECT_EQ(seen, (Indices{1, 3, 5}));
}

TEST(View, AViewFollowsTheDenseOrderOfTheSmallestStorage) {
    Registry registry;
    std::vector<Entity> all;
    for (int i = 0; i < 4; ++i)
        all.push_back(registry.create());
    for (const Entity entity : all)
        registry.add<A>(entity);
    registry.add<B>(all[3]);
    registry.add<B>(all[0]);
    registry.add<B>(all[2]);
    EXPECT_EQ(listIndices(registry.view<A, B>()), (Indices{3, 0, 2}));
    EXPECT_EQ(listIndices(registry.view<B, A>()), (Indices{3, 0, 2}));
    registry.add<B>(all[1]); // equally many: the first one named drives
    EXPECT_EQ(listIndices(registry.view<A, B>()), (Indices{0, 1, 2, 3}));
    EXPECT_EQ(listIndices(registry.view<B, A>()), (Indices{3, 0, 2, 1}));
}

TEST(View, ConstRegistriesAndComponentsGiveConstReferences) {
    using FromConst = decltype(std::declval<const Registry&>().view<A, const B>());
    using Mixed = decltype(std::declval<Registry&>().view<A, const B>());
    static_assert(std::is_same_v<
                  FromConst::Iterator::value_type,
                  std::tuple<Entity, const A&, const B&>>);
    static_assert(std::is_same_v<Mixed::Iterator::value_type, std::tuple<Entity, A&, const B&>>);
    static_assert(std::input_iterator<Mixed::Iterator>);
    Registry registry;
    const Entity entity = registry.create();
    registry.add(entity, A{4});
    registry.add(entity, B{5});
    int sum = 0;
    for (auto [e, a, b] : std::as_const(registry).view<A, B>())
        sum += a.value + b.value;
    EXPECT_EQ(sum, 9);
}

TEST(View, StructuralChangesAreAllowedAfterTheLoopAndAfterABreak) {
    Registry registry;
    const Entity entity = registry.create();
    registry.add<A>(entity);
    registry.add<A>(registry.create());
    for ([[maybe_unused]] auto row : registry.view<A>()) {
    }
    registry.add<B>(entity);
    for ([[maybe_unused]] auto row : registry.view<A>())
        break;
    registry.destroy(entity);
    EXPECT_EQ(registry.aliveCount(), 1u);
}

TEST(ViewDeathTest, StructuralChangesDuringIterationAreRefused) {
    Registry registry;
    const Entity entity = registry.create();
    registry.add<A>(entity);
    const auto during = [&](auto change) {
        for ([[maybe_unused]] auto row : registry.view<A>())
            change();
    };
    EXPECT_DEATH(during([&] { (void)registry.create(); }), "create while a view");
    EXPECT_DEATH(during([&] { registry.destroy(entity); }), "destroy while a view");
    EXPECT_DEATH(during([&] { registry.add<B>(entity); }), "add while a view");
    EXPECT_DEATH(during([&] { registry.remove<A>(entity); }), "remove while a view");
    EXPECT_DEATH(during([&] { Registry taken(std::move(registry)); }), "move while a view");
    EXPECT_DEATH(during([&] { registry = Registry(); }), "move while a view");
}

TEST(ViewDeathTest, StructuralChangesAreRefusedWhileReadingAConstViewOrTheEntities) {
    Registry registry;
    registry.add<A>(registry.create());
    const auto duringConst = [&] {
        for ([[maybe_unused]] auto row : std::as_const(registry).view<A>())
            (void)registry.create();
    };
    EXPECT_DEATH(duringConst(), "create while a view");
    const auto duringEntities = [&] {
        for (const Entity entity : registry.entities())
            registry.destroy(entity);
    };
    EXPECT_DEATH(duringEntities(), "destroy while a view");
}

} // namespace
} // namespace shutter::ecs
