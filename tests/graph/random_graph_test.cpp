// SPDX-License-Identifier: MIT
// Laws that hold for every frame, tried on many.
#include "tests/graph/hazard_simulator.h"
#include "tests/graph/random_graph.h"
#include "tests/graph/story.h"

#include <algorithm>
#include <cstddef>
#include <set>

namespace shutter::graph {
namespace {

constexpr uint32_t kSeedCount = 600;

using Edges = std::set<std::pair<uint32_t, uint32_t>>; ///< (before, after), passes by index

/// Straight from the meaning of versions, pair by pair.
Edges findEdges(const Graph& graph, const std::set<uint32_t>& among) {
    Edges edges;
    for (uint32_t a : among)
        for (uint32_t b : among)
            for (const ResourceUse& x : graph.passes()[a].uses)
                for (const ResourceUse& y : graph.passes()[b].uses) {
                    if (a == b || x.resource != y.resource || x.writeVersion == kNoVersion)
                        continue;
                    if (y.readVersion != kNoVersion && x.writeVersion > y.readVersion)
                        edges.insert({b, a}); // y reads before x overwrites
                    else if (y.readVersion != kNoVersion || y.writeVersion > x.writeVersion)
                        edges.insert({a, b});
                }
    return edges;
}

bool canBeOrdered(std::set<uint32_t> passes, const Edges& edges) {
    while (!passes.empty()) {
        const auto free = std::find_if(passes.begin(), passes.end(), [&](uint32_t pass) {
            return std::none_of(edges.begin(), edges.end(), [&](const auto& edge) {
                return edge.second == pass && passes.count(edge.first);
            });
        });
        if (free == passes.end())
            return false;
        passes.erase(free);
    }
    return true;
}

/// Frames that compile, with their plans. A refusal must be a cycle that is really there.
template <class Check> void forEachFrame(Check&& check) {
    uint32_t compiled = 0;
    for (uint32_t seed = 0; seed < kSeedCount; ++seed) {
        SCOPED_TRACE(seed);
        const auto frame = makeRandomFrame(seed);
        const core::Result<Plan> plan = compile(frame->graph, requireMemory);
        if (plan) {
            ++compiled;
            check(frame->graph, plan.value());
        } else {
            ASSERT_EQ(plan.error().message.rfind("the passes form a cycle", 0), 0u)
                << plan.error().message;
            std::set<uint32_t> all;
            for (uint32_t i = 0; i < frame->graph.passes().size(); ++i)
                all.insert(i);
            EXPECT_FALSE(canBeOrdered(all, findEdges(frame->graph, all)));
        }
        if (testing::Test::HasFailure())
            return; // one seed is enough to look into
    }
    EXPECT_GT(compiled, kSeedCount / 2) << "most frames should say something";
}

TEST(RandomGraphs, TheOrderRespectsEveryDependence) {
    size_t moved = 0;
    forEachFrame([&](const Graph& graph, const Plan& plan) {
        std::set<uint32_t> kept;
        std::vector<size_t> position(graph.passes().size());
        for (size_t i = 0; i < plan.passes.size(); ++i) {
            EXPECT_TRUE(kept.insert(plan.passes[i].pass).second);
            position[plan.passes[i].pass] = i;
            moved += i > 0 && plan.passes[i].pass < plan.passes[i - 1].pass;
        }
        EXPECT_EQ(kept.size() + plan.culled.size(), graph.passes().size());
        for (const auto& [before, after] : findEdges(graph, kept))
            EXPECT_LT(position[before], position[after]);
    });
    EXPECT_GT(moved, 0u) << "no frame needed another order than the declared one";
}

TEST(RandomGraphs, NothingThatStaysNeedsWhatWasCulled) {
    size_t culled = 0;
    forEachFrame([&](const Graph& graph, const Plan& plan) {
        culled += plan.culled.size();
        std::set<std::pair<uint32_t, uint32_t>> wanted(
            graph.outputs().begin(), graph.outputs().end()
        );
        std::set<uint32_t> kept;
        for (const PlannedPass& planned : plan.passes) {
            kept.insert(planned.pass);
            for (const ResourceUse& use : graph.passes()[planned.pass].uses)
                if (use.readVersion != kNoVersion)
                    wanted.insert({use.resource, use.readVersion});
        }
        for (uint32_t pass = 0; pass < graph.passes().size(); ++pass) {
            const PassRecord& record = graph.passes()[pass];
            bool needed = record.hasSideEffect;
            for (const ResourceUse& use : record.uses)
                needed |= use.writeVersion != kNoVersion &&
                          (graph.resources()[use.resource].imported ||
                           wanted.count({use.resource, use.writeVersion}));
            EXPECT_EQ(kept.count(pass) == 1, needed) << record.name;
        }
    });
    EXPECT_GT(culled, 0u);
}

TEST(RandomGraphs, NoTwoLiveImagesOverlapAndSharingSavesMemory) {
    VkDeviceSize block = 0;
    VkDeviceSize unaliased = 0;
    forEachFrame([&](const Graph&, const Plan& plan) {
        for (const Placement& a : plan.images) {
            EXPECT_EQ(a.offset % a.alignment, 0u);
            EXPECT_LE(a.offset + a.bytes, plan.blockBytes);
            for (const Placement& b : plan.images) {
                const bool together = a.firstPass <= b.lastPass && b.firstPass <= a.lastPass;
                const bool apart = a.offset + a.bytes <= b.offset || b.offset + b.bytes <= a.offset;
                EXPECT_TRUE(a.resource == b.resource || !together || apart);
            }
        }
        block += plan.blockBytes;
        unaliased += plan.unaliasedBytes;
    });
    EXPECT_LT(block, unaliased);
}

TEST(RandomGraphs, TheBarriersSuffice) {
    forEachFrame([](const Graph& graph, const Plan& plan) {
        EXPECT_EQ(findHazards(graph, plan), Names{});
    });
}

TEST(RandomGraphs, NoBarrierIsForNothing) {
    size_t dropped = 0;
    forEachFrame([&](const Graph& graph, const Plan& plan) {
        const auto expectNeeded = [&](auto member, size_t pass) {
            const size_t count = (plan.passes[pass].*member).size();
            for (size_t i = 0; i < count; ++i) {
                Plan without = plan;
                auto& barriers = without.passes[pass].*member;
                barriers.erase(barriers.begin() + static_cast<std::ptrdiff_t>(i));
                EXPECT_NE(findHazards(graph, without), Names{}) << pass << ", barrier " << i;
                ++dropped;
            }
        };
        for (size_t pass = 0; pass < plan.passes.size(); ++pass) {
            expectNeeded(&PlannedPass::imageBarriers, pass);
            expectNeeded(&PlannedPass::bufferBarriers, pass);
        }
        for (size_t i = 0; i < plan.finalImageBarriers.size(); ++i) {
            Plan without = plan;
            without.finalImageBarriers.erase(
                without.finalImageBarriers.begin() + static_cast<std::ptrdiff_t>(i)
            );
            EXPECT_NE(findHazards(graph, without), Names{}) << "final barrier " << i;
        }
    });
    EXPECT_GT(dropped, kSeedCount);
}

} // namespace
} // namespace shutter::graph
