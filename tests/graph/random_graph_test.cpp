// SPDX-License-Identifier: MIT
// Laws for every frame, tested on many random ones.
#include "tests/graph/hazard_simulator.h"
#include "tests/graph/story.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <set>

namespace shutter::graph {
namespace {

/// A random frame. Its imported images live as long as it does.
struct RandomFrame {
    Graph graph;
    std::array<gpu::Image, 3> imported;
};

template <class Handle> struct Known {
    std::vector<Handle> versions; ///< [0] is the initial version
    bool startsFilled = false;
    uint32_t size = 0; ///< images: side in texels
    VkFormat format = VK_FORMAT_UNDEFINED;
};

/// Fills a frame: the same seed gives the same frame everywhere. Every frame is well declared, but
/// now and then a pass reads an old version, and then the order may be impossible.
class Maker {
  public:
    Maker(RandomFrame& frame, uint32_t seed) : mGraph(frame.graph), mRandom(seed) {
        declareResources(frame);
        const uint32_t passCount = 1 + pick(14);
        for (uint32_t i = 0; i < passCount; ++i)
            addRandomPass(fmt::format("pass {}", i));
        markOutputs();
    }

  private:
    // Not std::uniform_int_distribution, which differs between standard libraries.
    uint32_t pick(uint32_t count) { return static_cast<uint32_t>(mRandom() % count); }

    bool chance(uint32_t percent) { return pick(100) < percent; }

    void declareResources(RandomFrame& frame) {
        for (uint32_t i = 0; i < 8; ++i) {
            const uint32_t size = 8u << pick(3);
            const VkFormat format = chance(25) ? kDepth : kColor;
            const ImageHandle image = makeImage(mGraph, fmt::format("image {}", i), size, format);
            mImages.push_back({{image}, false, size, format});
        }
        for (const gpu::Image& image : frame.imported) {
            const bool filled = chance(50);
            const ImageHandle handle = mGraph.importImage(
                "imported image",
                image,
                filled ? VK_IMAGE_LAYOUT_GENERAL : VK_IMAGE_LAYOUT_UNDEFINED,
                chance(50) ? VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED
            );
            mImages.push_back({{handle}, filled, 1, VK_FORMAT_UNDEFINED});
        }
        for (uint32_t i = 0; i < 4; ++i)
            mBuffers.push_back({{makeBuffer(mGraph, fmt::format("buffer {}", i))}, false});
        for (uint32_t i = 0; i < 2; ++i)
            mBuffers.push_back(
                {{mGraph.importBuffer("imported buffer", fakeBuffer(i + 1), 64)}, true}
            );
    }

    /// Mostly the newest version, now and then an older one; invalid if there are no contents.
    template <class Handle> Handle pickVersion(const Known<Handle>& known) {
        const size_t first = known.startsFilled ? 0 : 1;
        if (known.versions.size() <= first)
            return {};
        const auto count = static_cast<uint32_t>(known.versions.size() - first);
        return chance(85) ? known.versions.back() : known.versions[first + pick(count)];
    }

    void addRandomPass(const std::string& name) {
        static constexpr std::array kKinds{
            PassKind::Compute,
            PassKind::Compute,
            PassKind::Raster,
            PassKind::Transfer,
            PassKind::Build};
        const PassKind kind = kKinds[pick(kKinds.size())];
        addPass(mGraph, name, kind, [&](PassBuilder& builder) {
            if (chance(15))
                builder.sideEffect();
            mUsed.clear();
            if (kind == PassKind::Raster)
                attach(builder);
            const uint32_t useCount = 1 + pick(4);
            for (uint32_t i = 0; i < useCount; ++i) {
                if (chance(65) && kind != PassKind::Build)
                    useImage(builder, kind);
                else
                    useBuffer(builder, kind);
            }
        });
    }

    /// Whether this is the pass's first use; one pass may use it only once.
    bool claim(uint32_t resource) {
        if (std::find(mUsed.begin(), mUsed.end(), resource) != mUsed.end())
            return false;
        mUsed.push_back(resource);
        return true;
    }

    void attach(PassBuilder& builder) {
        const uint32_t size = mImages[pick(8)].size;
        for (Known<ImageHandle>& image : mImages) {
            const bool lone = mUsed.empty() && &image == &mImages.back(); // at least one target
            if (image.size != size && !lone)
                continue;
            if (image.format == kDepth) {
                if (!mUsed.empty() || chance(50)) // at most one depth target, as the first
                    continue;
                image.versions.push_back(builder.depthTarget(
                    image.versions.back(), chance(50) ? std::optional(0.0f) : std::nullopt
                ));
            } else if (lone || chance(60)) {
                image.versions.push_back(builder.colorTarget(
                    image.versions.back(),
                    chance(50) ? std::optional(ClearColor::uints(0)) : std::nullopt
                ));
            } else {
                continue;
            }
            mUsed.push_back(image.versions.back().resource);
        }
    }

    void useImage(PassBuilder& builder, PassKind kind) {
        Known<ImageHandle>& image = mImages[pick(static_cast<uint32_t>(mImages.size()))];
        const bool canStore = kind == PassKind::Compute && image.format != kDepth;
        if (!claim(image.versions[0].resource))
            return;
        if (chance(45) && (canStore || kind == PassKind::Transfer)) {
            const Access store = chance(50) ? Access::StorageWriteDisjoint : Access::StorageWrite;
            image.versions.push_back(
                builder.write(image.versions.back(), canStore ? store : Access::TransferWrite)
            );
            return;
        }
        const ImageHandle version = pickVersion(image);
        if (!version.isValid())
            return;
        if (kind == PassKind::Compute)
            builder.read(
                version, canStore && chance(40) ? Access::StorageRead : Access::SampledCompute
            );
        else
            builder.read(
                version, kind == PassKind::Raster ? Access::SampledFragment : Access::TransferRead
            );
    }

    void useBuffer(PassBuilder& builder, PassKind kind) {
        static constexpr std::array kReads{
            Access::StorageRead, Access::ShaderRead, Access::IndirectRead};
        Known<BufferHandle>& buffer = mBuffers[pick(static_cast<uint32_t>(mBuffers.size()))];
        if (!claim(buffer.versions[0].resource))
            return;
        if (chance(45) && kind != PassKind::Raster) {
            const Access access = kind == PassKind::Compute    ? Access::StorageWrite
                                  : kind == PassKind::Transfer ? Access::TransferWrite
                                                               : Access::AccelerationBuild;
            buffer.versions.push_back(builder.write(buffer.versions.back(), access));
            return;
        }
        const BufferHandle version = pickVersion(buffer);
        if (!version.isValid())
            return;
        if (kind == PassKind::Compute)
            builder.read(version, chance(20) ? Access::AccelerationRead : kReads[pick(3)]);
        else if (kind == PassKind::Raster)
            builder.read(version, kReads[1 + pick(2)]);
        else if (kind == PassKind::Transfer)
            builder.read(version, Access::TransferRead);
        else
            builder.read(version, chance(50) ? Access::ShaderRead : Access::AccelerationRead);
    }

    void markOutputs() {
        const auto mark = [&](const auto& known) {
            if (chance(40) && (known.startsFilled || known.versions.size() > 1))
                mGraph.markOutput(known.versions.back());
        };
        for (const auto& image : mImages)
            mark(image);
        for (const auto& buffer : mBuffers)
            mark(buffer);
        if (chance(50))
            addPass(mGraph, "host", PassKind::Transfer, [&](PassBuilder& builder) {
                builder.read(mBuffers.back().versions.back(), Access::HostRead);
                builder.sideEffect();
            });
    }

    Graph& mGraph;
    std::mt19937 mRandom;
    std::vector<Known<ImageHandle>> mImages;
    std::vector<Known<BufferHandle>> mBuffers;
    std::vector<uint32_t> mUsed; ///< resources of the pass being declared
};

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
        RandomFrame frame;
        const Maker filled(frame, seed);
        const core::Result<Plan> plan = compile(frame.graph, requireMemory);
        if (plan) {
            ++compiled;
            check(frame.graph, plan.value());
        } else {
            ASSERT_EQ(plan.error().message.rfind("the passes form a cycle", 0), 0u)
                << plan.error().message;
            std::set<uint32_t> all;
            for (uint32_t i = 0; i < frame.graph.passes().size(); ++i)
                all.insert(i);
            EXPECT_FALSE(canBeOrdered(all, findEdges(frame.graph, all)));
        }
        if (testing::Test::HasFailure())
            return; // one failing seed is enough
    }
    EXPECT_GT(compiled, kSeedCount / 2) << "most frames should compile";
}

TEST(RandomGraphs, PassesThatAreNeededRunInAnOrderThatRespectsEveryDependence) {
    size_t moved = 0;
    size_t culled = 0;
    forEachFrame([&](const Graph& graph, const Plan& plan) {
        std::set<std::pair<uint32_t, uint32_t>> wanted(
            graph.outputs().begin(), graph.outputs().end()
        );
        std::set<uint32_t> kept;
        std::vector<size_t> position(graph.passes().size());
        for (size_t i = 0; i < plan.passes.size(); ++i) {
            const uint32_t pass = plan.passes[i].pass;
            EXPECT_TRUE(kept.insert(pass).second);
            position[pass] = i;
            moved += i > 0 && pass < plan.passes[i - 1].pass;
            for (const ResourceUse& use : graph.passes()[pass].uses)
                if (use.readVersion != kNoVersion)
                    wanted.insert({use.resource, use.readVersion});
        }
        culled += plan.culled.size();
        EXPECT_EQ(kept.size() + plan.culled.size(), graph.passes().size());
        for (const auto& [before, after] : findEdges(graph, kept))
            EXPECT_LT(position[before], position[after]);
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
    EXPECT_GT(moved, 0u) << "no frame needed another order than the declared one";
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

TEST(RandomGraphs, TheBarriersSufficeAndNoneIsForNothing) {
    size_t dropped = 0;
    forEachFrame([&](const Graph& graph, const Plan& plan) {
        EXPECT_EQ(findHazards(graph, plan), Names{});
        Plan without = plan;
        const auto expectNeeded = [&](auto& barriers, const std::string& where) {
            for (size_t i = 0; i < barriers.size(); ++i) {
                const auto place = barriers.begin() + static_cast<std::ptrdiff_t>(i);
                const auto barrier = *place;
                barriers.erase(place);
                EXPECT_NE(findHazards(graph, without), Names{}) << where << ", barrier " << i;
                barriers.insert(barriers.begin() + static_cast<std::ptrdiff_t>(i), barrier);
                ++dropped;
            }
        };
        for (PlannedPass& planned : without.passes) {
            const std::string& name = graph.passes()[planned.pass].name;
            expectNeeded(planned.imageBarriers, name);
            expectNeeded(planned.bufferBarriers, name);
        }
        expectNeeded(without.finalImageBarriers, "the end");
    });
    EXPECT_GT(dropped, kSeedCount);
}

} // namespace
} // namespace shutter::graph
