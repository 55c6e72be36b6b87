// SPDX-License-Identifier: MIT
// Commands that wait, and logs of what changed.
#include "engine/ecs/commands.h"
#include "engine/ecs/registry.h"
#include "tests/unit/ecs/components.h"

#include <gtest/gtest.h>

#include <vector>

namespace shutter::ecs {
namespace {

struct Name {
    char letter = '?';
};

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
            commands.add(entity, Name{'x'});
    }
    commands.apply(registry);
    EXPECT_FALSE(registry.isAlive({0, 0}));
    EXPECT_TRUE(registry.isAlive({1, 0}));
    EXPECT_FALSE(registry.has<Health>({1, 0}));
    EXPECT_EQ(registry.get<Name>({2, 0}).letter, 'x');
    EXPECT_TRUE(registry.has<Health>({3, 0}));
    EXPECT_TRUE(commands.isEmpty());
}

TEST(Commands, ComponentsReachPendingEntities) {
    Registry registry;
    (void)registry.create();
    Commands commands;
    const PendingEntity first = commands.create();
    const PendingEntity second = commands.create();
    commands.add(second, Name{'b'});
    commands.add(first, Name{'a'});
    const std::vector<Entity> created = commands.apply(registry);
    ASSERT_EQ(created.size(), 2u);
    EXPECT_EQ(registry.get<Name>(created[first.order]).letter, 'a');
    EXPECT_EQ(registry.get<Name>(created[second.order]).letter, 'b');
}

TEST(Commands, TheOrderOfRecordingIsTheOrderOfApplying) {
    Registry registry;
    const Entity entity = registry.create();
    Commands commands;
    commands.add(entity, Health{1});
    commands.add(entity, Health{2});
    commands.add(entity, Name{'a'});
    commands.remove<Name>(entity);
    commands.apply(registry);
    EXPECT_EQ(registry.get<Health>(entity).points, 2);
    EXPECT_FALSE(registry.has<Name>(entity));
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

TEST(CommandsDeathTest, APendingEntityOfAnAppliedBatchIsRefused) {
    Registry registry;
    Commands commands;
    const PendingEntity old = commands.create();
    commands.apply(registry);
    (void)commands.create();
    EXPECT_DEATH(commands.add(old, Health{}), "batch");
    EXPECT_DEATH(commands.add(PendingEntity{5, 1}, Health{}), "pending entity 5");
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

TEST_F(ChangesOfARegistry, ChangesOfComponentTypesAreIndependent) {
    registry.add<Health>(entities[0]);
    EXPECT_TRUE(list(changes()).empty());
}

TEST_F(ChangesOfARegistry, RepeatsInARowAreOneEntryButNoneIsLostToAReaderInBetween) {
    for (int i = 0; i < 100; ++i)
        registry.get<Position>(entities[1]).x += 1.0;
    EXPECT_EQ(list(changes()), Listed{entities[1]});
    registry.get<Position>(entities[1]).x += 1.0;
    EXPECT_EQ(list(changes()), Listed{entities[1]});
}

TEST_F(ChangesOfARegistry, ReadersAreIndependent) {
    ChangeCursor other = cursor;
    registry.get<Position>(entities[0]).x = 1.0;
    EXPECT_EQ(list(changes()), Listed{entities[0]});
    registry.get<Position>(entities[2]).x = 1.0;
    EXPECT_EQ(list(constant.changesSince<Position>(other)), (Listed{entities[0], entities[2]}));
    EXPECT_EQ(list(changes()), Listed{entities[2]});
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

TEST_F(ChangesOfARegistry, ATypeNobodyHasHadNeverChangesUntilItIsAdded) {
    ChangeCursor none;
    EXPECT_FALSE(constant.changesSince<Health>(none).all);
    EXPECT_FALSE(constant.changesSince<Health>(none).structure);
    registry.add<Health>(entities[0]);
    EXPECT_TRUE(constant.changesSince<Health>(none).all);
}

TEST_F(ChangesOfARegistry, AnotherRegistryReportsAllAsChanged) {
    Registry second;
    EXPECT_TRUE(second.changesSince<Position>(cursor).all) << "nobody has a position there";
    EXPECT_FALSE(second.changesSince<Position>(cursor).all);
    second.add<Position>(second.create());
    EXPECT_TRUE(second.changesSince<Position>(cursor).all);
    EXPECT_TRUE(changes().all);
}

TEST_F(ChangesOfARegistry, AMovedRegistryGoesOnWhereItWas) {
    registry.get<Position>(entities[2]).x = 1.0;
    const Registry target(std::move(registry));
    EXPECT_EQ(list(target.changesSince<Position>(cursor)), Listed{entities[2]});
}

} // namespace
} // namespace shutter::ecs
