// SPDX-License-Identifier: MIT
#include "engine/ecs/registry.h"
#include "engine/ecs/view.h"

#include <gtest/gtest.h>

#include <optional>
#include <tuple>
#include <type_traits>
#include <vector>

namespace shutter::ecs {
namespace {

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

TEST(View, IsEmptyWhereNoEntityHasTheComponent) {
    Registry registry;
    EXPECT_EQ(listIndices(registry.view<A>()), Indices{});
    registry.add<A>(registry.create());
    EXPECT_EQ(listIndices(registry.view<NeverAdded>()), Indices{});
    EXPECT_EQ(listIndices(registry.view<A, NeverAdded>()), Indices{});
    EXPECT_EQ(listIndices(registry.view<NeverAdded, A>()), Indices{});
}

TEST(View, VisitsExactlyTheEntitiesWithAllComponents) {
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

TEST(View, FollowsTheDenseOrderOfTheSmallestStorage) {
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

TEST(View, GivesReferencesThatChangeTheRegistry) {
    Registry registry;
    const Entity entity = registry.create();
    registry.add(entity, A{1});
    for (auto [e, a] : registry.view<A>())
        a.value = 9;
    EXPECT_EQ(registry.get<A>(entity).value, 9);
}

TEST(View, OfAConstRegistryOrAConstComponentGivesConstReferences) {
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

TEST(View, AllowsStructuralChangesAfterTheLoopAndAfterABreak) {
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

TEST(View, AnIteratorLocksFromItsCreationToItsEndAndCopiesCount) {
    std::atomic<uint32_t> count = 0;
    {
        std::optional<IterationLock> first(std::in_place, count);
        const IterationLock second = *first;
        EXPECT_EQ(count, 2u);
        *first = second;
        EXPECT_EQ(count, 2u);
        first.reset();
        EXPECT_EQ(count, 1u);
    }
    EXPECT_EQ(count, 0u);
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
