// SPDX-License-Identifier: MIT
// Entities, their components, views of them, commands that wait, and logs of what changed.
#include "engine/ecs/commands.h"
#include "engine/ecs/registry.h"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>
#include <tuple>
#include <type_traits>
#include <vector>

namespace shutter::ecs {
namespace {

struct Position {
    double x = 0.0;
};

struct Health {
    int points = 100;
};

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

TEST(Registry, DestroyRemovesEveryComponentAndRemoveReturnsWhetherOneWasThere) {
    const auto shared = std::make_shared<int>(0);
    Registry registry;
    const Entity entity = registry.create();
    registry.add(entity, shared);
    EXPECT_FALSE(registry.remove<Position>(entity));
    registry.add<Position>(entity);
    registry.add<Health>(entity);
    EXPECT_TRUE(registry.remove<Health>(entity));
    EXPECT_FALSE(registry.has<Health>(entity));
    EXPECT_TRUE(registry.has<Position>(entity));
    EXPECT_FALSE(registry.remove<Health>(entity));
    registry.destroy(entity);
    EXPECT_EQ(shared.use_count(), 1);
    for ([[maybe_unused]] auto row : registry.view<Position>())
        ADD_FAILURE();
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

TEST(Entity, IndexAndGenerationCountInComparisonsHashesAndText) {
    EXPECT_EQ((Entity{3, 1}), (Entity{3, 1}));
    EXPECT_NE((Entity{3, 1}), (Entity{3, 2}));
    EXPECT_NE((Entity{3, 1}), (Entity{4, 1}));
    EXPECT_LT((Entity{3, 9}), (Entity{4, 0}));
    EXPECT_LT((Entity{3, 1}), (Entity{3, 2}));
    const std::hash<Entity> hash;
    EXPECT_NE(hash({1, 0}), hash({1, 1}));
    EXPECT_NE(hash({1, 0}), hash({0, 1}));
    EXPECT_EQ(hash({1, 1}), hash({1, 1}));
    EXPECT_EQ(fmt::format("{}", Entity{3, 1}), "entity 3 (generation 1)");
    EXPECT_EQ(fmt::format("{}", kNullEntity), "the null entity");
}

using Indices = std::vector<uint32_t>;

Indices listIndices(const SparseSetBase& set) {
    Indices indices;
    for (const Entity entity : set.entities())
        indices.push_back(entity.index);
    return indices;
}

TEST(SparseSet, AValueIsFoundUnderItsEntityOnlyAndReplacedInPlace) {
    SparseSet<std::string> set;
    set.insert({7, 2}, "seven");
    set.insert({2, 0}, "two");
    ASSERT_NE(set.find({7, 2}), nullptr);
    EXPECT_EQ(*set.find({7, 2}), "seven");
    EXPECT_EQ(set.find({7, 1}), nullptr);
    EXPECT_EQ(set.find({6, 2}), nullptr);
    EXPECT_FALSE(set.erase({7, 1}));
    EXPECT_EQ(set.insert({7, 2}, "once more"), "once more");
    EXPECT_EQ(*set.find({7, 2}), "once more");
    EXPECT_EQ(listIndices(set), (Indices{7, 2}));
}

TEST(SparseSet, ErasingDestroysTheValueAndMovesTheLastIntoTheGap) {
    SparseSet<std::shared_ptr<uint32_t>> set;
    std::vector<std::shared_ptr<uint32_t>> values;
    for (uint32_t i = 0; i < 4; ++i)
        set.insert({i, 0}, values.emplace_back(std::make_shared<uint32_t>(i)));
    EXPECT_TRUE(set.erase({1, 0}));
    EXPECT_EQ(values[1].use_count(), 1);
    EXPECT_EQ(set.find({1, 0}), nullptr);
    EXPECT_EQ(listIndices(set), (Indices{0, 3, 2}));
    for (const uint32_t left : {0u, 3u, 2u}) {
        ASSERT_NE(set.find({left, 0}), nullptr) << left;
        EXPECT_EQ(**set.find({left, 0}), left);
    }
    for (const uint32_t last : {2u, 3u, 0u}) { // of the order; at the end the only one
        EXPECT_TRUE(set.erase({last, 0})) << last;
        EXPECT_EQ(values[last].use_count(), 1) << last;
    }
    EXPECT_EQ(set.size(), 0u);
    EXPECT_FALSE(set.erase({0, 0}));
}

struct NeverAdded {};

template <class Range> Indices listIndices(const Range& view) {
    Indices indices;
    for (const auto& row : view)
        indices.push_back(std::get<0>(row).index);
    return indices;
}

TEST(View, AViewVisitsExactlyTheEntitiesWithAllComponents) {
    Registry registry;
    EXPECT_EQ(listIndices(registry.view<Health>()), Indices{});
    for (int i = 0; i < 6; ++i) {
        const Entity entity = registry.create();
        if (i != 0)
            registry.add(entity, Health{i});
        if (i % 2 == 1 || i == 0)
            registry.add(entity, Position{10.0 * i});
    }
    Indices seen;
    for (auto [entity, health, position] : std::as_const(registry).view<Health, Position>()) {
        EXPECT_EQ(position.x, 10.0 * health.points);
        EXPECT_EQ(health.points, static_cast<int>(entity.index));
        seen.push_back(entity.index);
    }
    EXPECT_EQ(seen, (Indices{1, 3, 5}));
    EXPECT_EQ(listIndices(registry.view<Health, Position>()), seen);
    EXPECT_EQ(listIndices(registry.view<NeverAdded>()), Indices{});
    EXPECT_EQ(listIndices(registry.view<Health, NeverAdded>()), Indices{});
    EXPECT_EQ(listIndices(registry.view<NeverAdded, Health>()), Indices{});
}

TEST(View, AViewFollowsTheDenseOrderOfTheSmallestStorage) {
    Registry registry;
    std::vector<Entity> all;
    for (int i = 0; i < 4; ++i)
        all.push_back(registry.create());
    for (const Entity entity : all)
        registry.add<Health>(entity);
    registry.add<Position>(all[3]);
    registry.add<Position>(all[0]);
    registry.add<Position>(all[2]);
    EXPECT_EQ(listIndices(registry.view<Health, Position>()), (Indices{3, 0, 2}));
    EXPECT_EQ(listIndices(registry.view<Position, Health>()), (Indices{3, 0, 2}));
    registry.add<Position>(all[1]); // equally many: the first one named drives
    EXPECT_EQ(listIndices(registry.view<Health, Position>()), (Indices{0, 1, 2, 3}));
    EXPECT_EQ(listIndices(registry.view<Position, Health>()), (Indices{3, 0, 2, 1}));
}

using ViewOfConst = decltype(std::declval<const Registry&>().view<Health, const Position>());
using MixedView = decltype(std::declval<Registry&>().view<Health, const Position>());
static_assert(std::is_same_v<
              ViewOfConst::Iterator::value_type,
              std::tuple<Entity, const Health&, const Position&>>);
static_assert(std::is_same_v<
              MixedView::Iterator::value_type,
              std::tuple<Entity, Health&, const Position&>>);
static_assert(std::input_iterator<MixedView::Iterator>);

TEST(View, StructuralChangesAreAllowedAfterTheLoopAndAfterABreak) {
    Registry registry;
    const Entity entity = registry.create();
    registry.add<Health>(entity);
    registry.add<Health>(registry.create());
    for ([[maybe_unused]] auto row : registry.view<Health>()) {
    }
    registry.add<Position>(entity);
    for ([[maybe_unused]] auto row : registry.view<Health>())
        break;
    registry.destroy(entity);
    EXPECT_EQ(registry.aliveCount(), 1u);
}

TEST(ViewDeathTest, StructuralChangesDuringIterationAreRefused) {
    Registry registry;
    const Entity entity = registry.create();
    registry.add<Health>(entity);
    const auto during = [&](auto change) {
        for ([[maybe_unused]] auto row : registry.view<Health>())
            change();
    };
    EXPECT_DEATH(during([&] { (void)registry.create(); }), "create while a view");
    EXPECT_DEATH(during([&] { registry.destroy(entity); }), "destroy while a view");
    EXPECT_DEATH(during([&] { registry.add<Position>(entity); }), "add while a view");
    EXPECT_DEATH(during([&] { registry.remove<Health>(entity); }), "remove while a view");
    EXPECT_DEATH(during([&] { Registry taken(std::move(registry)); }), "move while a view");
    EXPECT_DEATH(during([&] { registry = Registry(); }), "move while a view");
    const auto duringConst = [&] {
        for ([[maybe_unused]] auto row : std::as_const(registry).view<Health>())
            (void)registry.create();
    };
    EXPECT_DEATH(duringConst(), "create while a view");
    const auto duringEntities = [&] {
        for (const Entity each : registry.entities())
            registry.destroy(each);
    };
    EXPECT_DEATH(duringEntities(), "destroy while a view");
}

TEST(Commands, RecordedWhileIteratingTheyApplyAfterwards) {
    Registry registry;
    for (int i = 0; i < 4; ++i)
        registry.add(registry.create(), Health{i});
    Commands commands;
    for (auto [entity, health] : registry.view<const Health>()) {
        if (health.points == 0)
            commands.destroy(entity);
        if (health.points == 1)
            commands.remove<Health>(entity);
        if (health.points == 2)
            commands.add(entity, Position{7.0});
    }
    commands.apply(registry);
    EXPECT_FALSE(registry.isAlive({0, 0}));
    EXPECT_TRUE(registry.isAlive({1, 0}));
    EXPECT_FALSE(registry.has<Health>({1, 0}));
    EXPECT_EQ(registry.get<Position>({2, 0}).x, 7.0);
    EXPECT_TRUE(registry.has<Health>({3, 0}));
    EXPECT_TRUE(commands.isEmpty());
}

TEST(Commands, ComponentsReachPendingEntitiesOfTheSameBatchOnly) {
    Registry registry;
    (void)registry.create();
    Commands commands;
    const PendingEntity first = commands.create();
    const PendingEntity second = commands.create();
    commands.add(second, Health{2});
    commands.add(first, Health{1});
    const std::vector<Entity> created = commands.apply(registry);
    ASSERT_EQ(created.size(), 2u);
    EXPECT_EQ(registry.get<Health>(created[first.order]).points, 1);
    EXPECT_EQ(registry.get<Health>(created[second.order]).points, 2);
    (void)commands.create();
    EXPECT_DEATH(commands.add(first, Health{}), "batch");
    EXPECT_DEATH(commands.add(PendingEntity{5, 1}, Health{}), "pending entity 5");
}

TEST(Commands, TheOrderOfRecordingIsTheOrderOfApplying) {
    Registry registry;
    const Entity entity = registry.create();
    Commands commands;
    commands.add(entity, Health{1});
    commands.add(entity, Health{2});
    commands.add(entity, Position{7.0});
    commands.remove<Position>(entity);
    commands.apply(registry);
    EXPECT_EQ(registry.get<Health>(entity).points, 2);
    EXPECT_FALSE(registry.has<Position>(entity));
    commands.remove<Health>(entity);
    commands.add(entity, Health{3});
    commands.apply(registry);
    EXPECT_EQ(registry.get<Health>(entity).points, 3);
}

TEST(Commands, CommandsOnAnEntityDestroyedMeanwhileAreSkipped) {
    Registry registry;
    const Entity entity = registry.create();
    Commands commands;
    commands.destroy(entity);
    (void)commands.create(); // takes the slot: a stale add must not reach it
    commands.destroy(entity);
    commands.add(entity, Health{});
    commands.remove<Health>(entity);
    const std::vector<Entity> created = commands.apply(registry);
    ASSERT_EQ(created.size(), 1u);
    EXPECT_EQ(created[0].index, entity.index);
    EXPECT_TRUE(registry.isAlive(created[0]));
    EXPECT_FALSE(registry.has<Health>(created[0]));
}

std::vector<Entity> list(const Changes& changes) {
    EXPECT_FALSE(changes.all);
    return {changes.entities.begin(), changes.entities.end()};
}

class ChangesOfARegistry : public testing::Test {
  protected:
    ChangesOfARegistry() {
        for (int i = 0; i < 3; ++i) {
            entities.push_back(registry.create());
            registry.add<Position>(entities.back());
        }
        (void)constant.changesSince<Position>(cursor);
    }

    [[nodiscard]] Changes changes() { return constant.changesSince<Position>(cursor); }

    Registry registry;
    const Registry& constant = registry;
    std::vector<Entity> entities;
    ChangeCursor cursor;
};

using Listed = std::vector<Entity>;

TEST_F(ChangesOfARegistry, TheFirstQueryReportsAll) {
    ChangeCursor fresh;
    const Changes first = constant.changesSince<Position>(fresh);
    EXPECT_TRUE(first.all);
    EXPECT_TRUE(first.structure);
    EXPECT_TRUE(list(constant.changesSince<Position>(fresh)).empty());
}

TEST_F(ChangesOfARegistry, ReadingAConstRegistryIsNoChange) {
    (void)constant.get<Position>(entities[0]);
    (void)constant.find<Position>(entities[1]);
    (void)registry.has<Position>(entities[1]);
    for ([[maybe_unused]] auto row : constant.view<Position>()) {
    }
    for ([[maybe_unused]] auto row : registry.view<const Position>()) {
    }
    EXPECT_TRUE(list(changes()).empty());
}

TEST_F(ChangesOfARegistry, EachWayToWriteIsAChange) {
    registry.get<Position>(entities[1]).x = 1.0;
    EXPECT_EQ(list(changes()), Listed{entities[1]});
    (void)registry.find<Position>(entities[0]);
    EXPECT_EQ(list(changes()), Listed{entities[0]});
    registry.add(entities[2], Position{2.0});
    const Changes replaced = changes();
    EXPECT_EQ(list(replaced), Listed{entities[2]});
    EXPECT_FALSE(replaced.structure) << "it had one before";
    for (auto [entity, position] : registry.view<Position>())
        position.x = entity.index;
    EXPECT_EQ(list(changes()), entities);
}

TEST_F(ChangesOfARegistry, AddingRemovingAndDestroyingChangeTheStructure) {
    const Entity fourth = registry.create();
    registry.add<Position>(fourth);
    const Changes added = changes();
    EXPECT_TRUE(added.structure);
    EXPECT_EQ(list(added), Listed{fourth});
    registry.remove<Position>(fourth);
    const Changes removed = changes();
    EXPECT_TRUE(removed.structure);
    EXPECT_EQ(list(removed), Listed{fourth});
    EXPECT_FALSE(registry.remove<Position>(fourth));
    EXPECT_TRUE(list(changes()).empty()) << "there was none to remove";
    Commands commands;
    commands.destroy(entities[0]);
    commands.apply(registry);
    const Changes destroyed = changes();
    EXPECT_TRUE(destroyed.structure);
    EXPECT_EQ(list(destroyed), Listed{entities[0]});
}

TEST_F(ChangesOfARegistry, RepeatsInARowAreOneEntryAndNoneIsLostToAnyReader) {
    ChangeCursor other = cursor;
    for (int i = 0; i < 100; ++i)
        registry.get<Position>(entities[0]).x += 1.0;
    EXPECT_EQ(list(changes()), Listed{entities[0]});
    registry.get<Position>(entities[0]).x += 1.0;
    EXPECT_EQ(list(changes()), Listed{entities[0]});
    registry.get<Position>(entities[2]).x = 1.0;
    EXPECT_EQ(list(changes()), Listed{entities[2]});
    const std::vector<Entity> seen = list(constant.changesSince<Position>(other));
    EXPECT_EQ(std::set(seen.begin(), seen.end()), (std::set{entities[0], entities[2]}));
}

TEST_F(ChangesOfARegistry, AnOverflowedLogReportsAllAsChanged) {
    ChangeCursor late = cursor;
    for (size_t i = 0; i < ChangeLog::kRemembered; ++i)
        registry.get<Position>(entities[i % 2]).x += 1.0;
    EXPECT_EQ(list(changes()).size(), ChangeLog::kRemembered);
    for (size_t i = 0; i < 2 * ChangeLog::kRemembered; ++i)
        registry.get<Position>(entities[i % 2]).x += 1.0;
    EXPECT_TRUE(constant.changesSince<Position>(late).all);
    EXPECT_TRUE(list(constant.changesSince<Position>(late)).empty());
}

TEST_F(ChangesOfARegistry, ChangesOfComponentTypesAreIndependentAndATypeNeverAddedHasNone) {
    ChangeCursor none;
    EXPECT_FALSE(constant.changesSince<Health>(none).all);
    EXPECT_FALSE(constant.changesSince<Health>(none).structure);
    registry.add<Health>(entities[0]);
    EXPECT_TRUE(constant.changesSince<Health>(none).all);
    EXPECT_TRUE(list(changes()).empty());
}

TEST_F(ChangesOfARegistry, AMovedRegistryGoesOnWhereItWasAndAnotherReportsAllAsChanged) {
    registry.get<Position>(entities[2]).x = 1.0;
    const Registry target(std::move(registry));
    EXPECT_EQ(list(target.changesSince<Position>(cursor)), Listed{entities[2]});
    Registry second;
    EXPECT_TRUE(second.changesSince<Position>(cursor).all) << "nobody has a position there";
    EXPECT_FALSE(second.changesSince<Position>(cursor).all);
    second.add<Position>(second.create());
    EXPECT_TRUE(second.changesSince<Position>(cursor).all);
    EXPECT_TRUE(target.changesSince<Position>(cursor).all);
}

} // namespace
} // namespace shutter::ecs
