// SPDX-License-Identifier: MIT
#include "engine/ecs/commands.h"
#include "tests/unit/ecs/components.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace shutter::ecs {
namespace {

struct Name {
    char letter = '?';
};

TEST(Commands, ApplyingNothingChangesNothing) {
    Registry registry;
    Commands commands;
    EXPECT_TRUE(commands.isEmpty());
    EXPECT_TRUE(commands.apply(registry).empty());
    EXPECT_EQ(registry.aliveCount(), 0u);
}

TEST(Commands, NothingHappensBeforeApply) {
    Registry registry;
    const Entity entity = registry.create();
    registry.add<Health>(entity);
    Commands commands;
    commands.destroy(entity);
    (void)commands.create();
    EXPECT_FALSE(commands.isEmpty());
    EXPECT_TRUE(registry.isAlive(entity));
    EXPECT_EQ(registry.aliveCount(), 1u);
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

TEST(Commands, MoveOnlyComponentsCanBeDeferred) {
    Registry registry;
    const Entity entity = registry.create();
    Commands commands;
    commands.add(entity, std::make_unique<int>(8));
    commands.apply(registry);
    EXPECT_EQ(*registry.get<std::unique_ptr<int>>(entity), 8);
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

} // namespace
} // namespace shutter::ecs
