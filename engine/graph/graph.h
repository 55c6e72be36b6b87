// SPDX-License-Identifier: MIT
// Declaring a frame: passes with typed inputs and outputs. Setup runs now (capture by reference),
// execute runs later (capture by copy). Nothing here touches the GPU; compile.h checks and orders,
// execute.h records.
#pragma once

#include "engine/graph/types.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace shutter::gpu {
class Frame;
class Image;
class Buffer;
} // namespace shutter::gpu

namespace shutter::graph {

class PassResources;

/// Arguments of an execute callback: the frame to record into and the real resources behind
/// handles.
struct PassContext {
    gpu::Frame& frame;
    const PassResources& resources;
    VkCommandBuffer commands = VK_NULL_HANDLE;
};

using ExecuteFunction = std::function<void(PassContext&)>;

struct ClearColor {
    union {
        float f[4];
        uint32_t u[4];
    };

    static ClearColor floats(float r, float g, float b, float a);
    static ClearColor uints(uint32_t r);
};

inline constexpr uint32_t kNoVersion = UINT32_MAX;

/// One use of one resource by one pass.
struct ResourceUse {
    uint32_t resource = 0;
    /// Version whose contents the pass needs; kNoVersion: none (a first write, a cleared target).
    uint32_t readVersion = kNoVersion;
    uint32_t writeVersion = kNoVersion; ///< version the pass makes; kNoVersion: read only
    Access access = Access::SampledCompute;
};

struct ColorTarget {
    uint32_t resource = 0;
    std::optional<ClearColor> clear; ///< none: the previous version's contents are loaded
};

struct DepthTarget {
    uint32_t resource = 0;
    std::optional<float> clear;
};

struct PassRecord {
    std::string name;
    PassKind kind = PassKind::Compute;
    std::vector<ResourceUse> uses;
    std::vector<ColorTarget> colorTargets; ///< Raster only, in attachment order
    std::optional<DepthTarget> depthTarget;
    bool hasSideEffect = false; ///< never culled
    bool startsBatch = false;   ///< alone with what follows waits for the frame's semaphore
    ExecuteFunction execute;
};

struct ResourceRecord {
    std::string name;
    bool isImage = true;
    bool imported = false;
    TransientImageDesc imageDesc;   ///< images, imported too
    TransientBufferDesc bufferDesc; ///< buffers
    const gpu::Image* importedImage = nullptr;
    VkBuffer importedBuffer = VK_NULL_HANDLE;
    /// Imported images: layout before and after the frame. UNDEFINED before: contents are dropped.
    VkImageLayout initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkImageLayout finalLayout = VK_IMAGE_LAYOUT_UNDEFINED; ///< UNDEFINED: any layout
    /// Users of an imported image outside of the frame; nothing: any command may be one.
    std::optional<OutsideUse> before;
    std::optional<OutsideUse> after;
    uint32_t versionCount =
        1; ///< version 0: the contents before any pass (undefined for transients)

    /// Whether version 0 holds anything.
    [[nodiscard]] bool hasContentsAtStart() const {
        return imported && (!isImage || initialLayout != VK_IMAGE_LAYOUT_UNDEFINED);
    }
};

class Graph;

/// Passed to a pass's setup.
class PassBuilder {
  public:
    PassBuilder(Graph& graph, PassRecord& pass) : mGraph(graph), mPass(pass) {}

    /// Reads; returns the same handle for storing in Data.
    ImageHandle read(ImageHandle image, Access access);
    BufferHandle read(BufferHandle buffer, Access access);
    /// Writes all or part. The returned version holds the former contents and what the pass writes
    /// (for a fresh transient: only the latter).
    [[nodiscard]] ImageHandle write(ImageHandle image, Access access);
    [[nodiscard]] BufferHandle write(BufferHandle buffer, Access access);
    /// Attachments in the order of the calls.
    [[nodiscard]] ImageHandle colorTarget(ImageHandle image, std::optional<ClearColor> clear);
    [[nodiscard]] ImageHandle depthTarget(ImageHandle image, std::optional<float> clear);
    /// The pass is never culled (it writes to memory unknown to the graph).
    void sideEffect();
    /// Work before the pass does not wait for the semaphore of the frame's submission: for what
    /// draws on an image that the window system lends. One pass a frame, after the others.
    void startBatch();

  private:
    void addRead(uint32_t resource, uint32_t version, Access access);
    uint32_t addWrite(uint32_t resource, uint32_t version, Access access, bool clears);
    [[nodiscard]] std::string title() const;

    Graph& mGraph;
    PassRecord& mPass;
};

/// One frame's passes and resources. Mistakes in declaring are stored and reported by compile().
class Graph {
  public:
    Graph();

    [[nodiscard]] ImageHandle createImage(std::string name, const TransientImageDesc& desc);
    [[nodiscard]] BufferHandle createBuffer(std::string name, const TransientBufferDesc& desc);
    /// \param initialLayout layout the image is in when the frame starts
    /// \param finalLayout layout it shall be left in; UNDEFINED: any
    [[nodiscard]] ImageHandle importImage(
        std::string name,
        const gpu::Image& image,
        VkImageLayout initialLayout,
        VkImageLayout finalLayout
    );
    /// The frame waits for `before` alone, and `after` for the frame: no barrier outside is needed.
    [[nodiscard]] ImageHandle importImage(
        std::string name, const gpu::Image& image, const OutsideUse& before, const OutsideUse& after
    );
    /// \param bytes for the dump only
    [[nodiscard]] BufferHandle importBuffer(std::string name, VkBuffer buffer, VkDeviceSize bytes);

    /// Setup fills `Data` and is called before this returns; execute is called while recording.
    template <class Data, class Setup, class Execute>
    const Data& addPass(std::string name, PassKind kind, Setup&& setup, Execute&& execute) {
        PassRecord pass; // added to the graph once complete: a setup may add further passes
        pass.name = std::move(name);
        pass.kind = kind;
        auto data = std::make_shared<Data>();
        PassBuilder builder(*this, pass);
        setup(builder, *data);
        pass.execute = [data, run = std::forward<Execute>(execute)](PassContext& context) {
            run(*data, context);
        };
        mPasses.push_back(std::move(pass));
        return *data;
    }

    /// Contents are used after the frame (readback, swapchain, debug view): its writers are not
    /// culled.
    void markOutput(ImageHandle image);
    void markOutput(BufferHandle buffer);

    [[nodiscard]] const TransientImageDesc& describeImage(ImageHandle image) const;

    /// Returns the handle of a declared version of an image (CHECKed), for later inspection of
    /// passes().
    [[nodiscard]] ImageHandle findImage(uint32_t resource, uint32_t version) const;

    [[nodiscard]] const std::vector<PassRecord>& passes() const { return mPasses; }

    [[nodiscard]] const std::vector<ResourceRecord>& resources() const { return mResources; }

    /// (resource, version) pairs.
    [[nodiscard]] const std::vector<std::pair<uint32_t, uint32_t>>& outputs() const {
        return mOutputs;
    }

    /// Errors found while declaring, one sentence each.
    [[nodiscard]] const std::vector<std::string>& problems() const { return mProblems; }

  private:
    friend class PassBuilder;
    /// Whether the handle is one of this graph's; if not, that is a problem of `user`.
    bool admit(uint32_t graph, uint32_t resource, uint32_t version, const std::string& user);
    template <class Handle> Handle addResource(ResourceRecord record);

    uint32_t mId;
    std::vector<PassRecord> mPasses;
    std::vector<ResourceRecord> mResources;
    std::vector<std::pair<uint32_t, uint32_t>> mOutputs;
    std::vector<std::string> mProblems;
};

} // namespace shutter::graph
