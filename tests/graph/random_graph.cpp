// SPDX-License-Identifier: MIT
#include "tests/graph/random_graph.h"

#include "tests/graph/story.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

namespace shutter::graph {

namespace {

template <class Handle> struct Known {
    std::vector<Handle> versions; ///< [0] is what it began as
    bool startsFilled = false;
    uint32_t size = 0; ///< images: side in texels
    VkFormat format = VK_FORMAT_UNDEFINED;
};

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

    /// Whether the pass is the first to ask for it; one pass may use it only once.
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

} // namespace

std::unique_ptr<RandomFrame> makeRandomFrame(uint32_t seed) {
    auto frame = std::make_unique<RandomFrame>();
    const Maker filled(*frame, seed);
    return frame;
}

} // namespace shutter::graph
