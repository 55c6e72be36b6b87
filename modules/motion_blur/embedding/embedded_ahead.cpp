// SPDX-License-Identifier: MIT
// EmbeddedMotionBlur before the first frame: memory estimates and pipelines.
#include "engine/gpu/vulkan.h"
#include "engine/graph/compile.h"
#include "modules/motion_blur/embedding/embedded_parts.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <initializer_list>
#include <map>
#include <new>
#include <utility>

namespace shutter::motion_blur {

namespace {

using core::makeError;

/// Pipelines do not depend on the size of the picture; this one has all kinds of blocks.
constexpr uint32_t kWarmUpPixels = 64;

core::Status checkLens(const HostPlan& plan) {
    const Method& method = *complete(plan.settings).method;
    if (!plan.hasLens || (method.readsLens && method.readsInstantMotions))
        return {};
    return makeError(
        "motion blur: plan.hasLens is true, but the method {} has no lens; it must be false, or "
        "the method resolved or adaptive",
        method.name
    );
}

core::Status checkPlan(const HostPlan& plan, uint32_t framesInFlight) {
    if (plan.viewCount < 1 || plan.viewCount > framesInFlight)
        return makeError(
            "motion blur: plan.viewCount is {}, it must be 1 to framesInFlight {}",
            plan.viewCount,
            framesInFlight
        );
    return checkLens(plan);
}

/// Whether a view stores its rasters for the next frame.
bool keepsHistory(const HostInputs& inputs, const MotionBlurSettings& settings) {
    return settings.method->readsInstantMotions && settings.history && !inputs.last.color.image;
}

/// Images of a small picture, with placeholder handles.
class SmallImages {
  public:
    SmallImages(gpu::Device& device, HostInputs& inputs) : mDevice(device) {
        const VkExtent2D picture = pictureOf(inputs);
        for (auto [image, rule] : std::initializer_list<std::pair<HostImage*, HostImageRule>>{
                 {&inputs.color, colorRule(inputs)},
                 {&inputs.output, outputRule(inputs)},
                 {&inputs.motionDepth, kMotionRule},
                 {&inputs.convention.vectors.image, kVectorsRule},
                 {&inputs.convention.depth.image, kDepthRule},
                 {&inputs.normal, kNormalRule},
                 {&inputs.entityId, kIdRule},
                 {&inputs.last.color, kLastColorRule},
                 {&inputs.last.motionDepth, kLastMotionRule},
                 {&inputs.last.entityId, kLastIdRule},
                 {&inputs.deformedMotion, kDeformedRule},
                 {&inputs.lastDeformedMotion, kLastDeformedRule},
                 {&inputs.blended, kBlendedRule}})
            if (image->image)
                make(*image, rule, picture);
    }

  private:
    void make(HostImage& image, const HostImageRule& rule, VkExtent2D picture) {
        // A layer is planned as a part of a larger image.
        if (image.layer != 0)
            image.extent = {picture.width + 1, picture.height};
        image.layer = 0;
        const VkExtent2D extent = extentOf(image, picture);
        image.image = mImages
                          .emplace_back(gpu::Image(
                              mDevice,
                              "warm-up",
                              {extent.width, extent.height, formatOf(image, rule), rule.usage}
                          ))
                          .handle();
    }

    gpu::Device& mDevice;
    std::deque<gpu::Image> mImages;
};

/// A command buffer that is never submitted.
class DroppedCommands {
  public:
    DroppedCommands(VkDevice device, uint32_t queueFamily) : mDevice(device) {
        VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
        pool.queueFamilyIndex = queueFamily;
        gpu::require(vkCreateCommandPool(device, &pool, nullptr, &mPool), "warming up");
        VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
        info.commandPool = mPool;
        info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
        info.commandBufferCount = 1;
        VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
        const VkResult made = vkAllocateCommandBuffers(device, &info, &commands);
        const VkResult begun = made == VK_SUCCESS ? vkBeginCommandBuffer(commands, &begin) : made;
        if (begun != VK_SUCCESS)
            vkDestroyCommandPool(device, mPool, nullptr);
        gpu::require(begun, "warming up");
    }

    ~DroppedCommands() { vkDestroyCommandPool(mDevice, mPool, nullptr); }

    DroppedCommands(const DroppedCommands&) = delete;
    DroppedCommands& operator=(const DroppedCommands&) = delete;

    VkCommandBuffer commands = VK_NULL_HANDLE;

  private:
    VkDevice mDevice;
    VkCommandPool mPool = VK_NULL_HANDLE;
};

/// Runs a call and converts running out of memory to an error.
template <class Call> auto guard(const Call& call) -> decltype(call()) {
    try {
        return call();
    } catch (const gpu::DeviceError& error) {
        return core::Error{error.what()};
    } catch (const std::bad_alloc&) {
        return makeError("motion blur: out of main memory");
    }
}

} // namespace

/// What a graph::TransientPool holds that has realized several plans in turn.
struct EmbeddedMotionBlur::Transients {
    void add(const graph::Plan& plan) {
        blockBytes = std::max(blockBytes, plan.blockBytes);
        std::map<Key, uint32_t> counts;
        for (const graph::Placement& buffer : plan.buffers)
            ++counts[{buffer.bytes, buffer.bufferUsage}];
        for (const auto& [key, count] : counts)
            buffers[key] = std::max(buffers[key], count);
    }

    [[nodiscard]] uint64_t bytes() const {
        uint64_t sum = blockBytes;
        for (const auto& [key, count] : buffers)
            sum += key.first * count;
        return sum;
    }

    using Key = std::pair<VkDeviceSize, VkBufferUsageFlags>;
    VkDeviceSize blockBytes = 0;       ///< of images
    std::map<Key, uint32_t> buffers{}; ///< how many of the size and usage
};

core::Status EmbeddedMotionBlur::recordOnce(const HostPlan& plan) {
    SHUTTER_TRY(checkLens(plan));
    HostPlan small = plan;
    small.settings = complete(plan.settings);
    small.width = small.height = kWarmUpPixels;
    small.moverCount = std::min(plan.moverCount, 1u);
    DryRunInputs dryRun;
    fillPlaceholders(small, dryRun);
    const SmallImages images(*mDevice, dryRun.inputs);
    SHUTTER_TRY(checkInputs(dryRun.inputs, small.settings, abilities()));
    Slot slot(*mDevice, 0);
    SHUTTER_TRY(recordAll(dryRun, small.settings, slot));
    if (!small.hasLens)
        return {};
    dryRun.inputs.motion.lens = {}; // a host may close it, too
    return recordAll(dryRun, small.settings, slot);
}

core::Status EmbeddedMotionBlur::recordAll(
    DryRunInputs& dryRun, const MotionBlurSettings& settings, Slot& slot
) {
    View view(*mDevice);
    const uint32_t plannedRows = dryRun.inputs.motion.rowCount;
    // Without a frame before and with one; with few rows, with those planned, which may be more
    // than a tile's list holds, and with all that may come.
    for (uint32_t i = 0; i < 4; ++i) {
        const DroppedCommands dropped(mHost.device, mHost.queueFamily);
        graph::Graph graph;
        dryRun.inputs.motion.rowCount = i < 2 ? std::min(plannedRows, 1u) : plannedRows;
        Frame frame{0, slot, graph, dryRun.inputs, settings};
        frame.hasAll = i == 3;
        SHUTTER_TRY(record(frame, view, dropped.commands));
        dryRun.moveCamera();
    }
    return {};
}

core::Status EmbeddedMotionBlur::warmUp(const HostPlan& plan) {
    const OneThread::Call call(mThread);
    SHUTTER_TRY(call.status());
    return makePipelines(plan);
}

core::Status EmbeddedMotionBlur::makePipelines(const HostPlan& plan) {
    return guard([&]() -> core::Status {
        core::Status done = recordOnce(plan);
        mSlots[0]->counts = false; // the effect has declared a frame with that number
        // Never submitted: resources that it retired are freed when the earlier frames are
        // complete.
        mDevice->markDone(mDevice->handOver());
        return done;
    });
}

core::Status EmbeddedMotionBlur::startWarmUp(const HostPlan& plan) {
    const OneThread::Call call(mThread);
    SHUTTER_TRY(call.status());
    if (mWarmUp.valid())
        return makeError("motion blur: shutterBlurStartWarmUp: another is under way; "
                         "shutterBlurIsWarm() reports when it "
                         "is done");
    return guard([&]() -> core::Status {
        // Another effect on the same device makes them, and leaves them in the cache.
        HostDevice host = mHost;
        host.pipelineCache = mDevice->pipelineCache();
        host.framesInFlight = 1;
        host.measures = false;
        HostPlan one = plan;
        one.viewCount = 1;
        mWarming = plan;
        mWarmUp = std::async(std::launch::async, [host, one]() -> core::Status {
            auto other = create(host);
            if (!other)
                return other.error();
            return other.value()->warmUp(one);
        });
        return {};
    });
}

core::Result<bool> EmbeddedMotionBlur::isWarm() {
    const OneThread::Call call(mThread);
    SHUTTER_TRY(call.status());
    if (!mWarmUp.valid())
        return true;
    if (mWarmUp.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return false;
    SHUTTER_TRY(mWarmUp.get());
    SHUTTER_TRY(makePipelines(mWarming));
    return true;
}

core::Result<uint64_t>
EmbeddedMotionBlur::estimateMemory(const HostDevice& host, const HostPlan& plan) {
    auto made = create(host);
    if (!made)
        return made.error();
    return guard([&] { return made.value()->estimate(plan); });
}

core::Result<uint64_t> EmbeddedMotionBlur::estimate(const HostPlan& plan) {
    SHUTTER_TRY(checkPlan(plan, mHost.framesInFlight));
    DryRunInputs dryRun;
    fillPlaceholders(plan, dryRun);
    HostAbilities host = abilities();
    host.images.device = VK_NULL_HANDLE;
    const MotionBlurSettings settings = complete(plan.settings);
    SHUTTER_TRY(checkInputs(dryRun.inputs, settings, host));
    Slot slot(*mDevice, 0);
    Transients held;
    SHUTTER_TRY(addTransients(dryRun, settings, slot, held));
    if (plan.hasLens) {
        dryRun.inputs.motion.lens = {}; // a host may close it, and then has other buffers
        SHUTTER_TRY(addTransients(dryRun, settings, slot, held));
    }
    uint64_t slotBytes = 0;
    for (const gpu::Buffer* buffer : {&slot.instants, &slot.convention})
        slotBytes += buffer->bytes();
    const uint64_t constant = mDevice->living().memoryBytes - slotBytes;
    const uint64_t pixels = uint64_t(plan.width) * plan.height;
    constexpr uint64_t kHistoryBytesPerPixel = 32; // two rasters of half floats and surfaces
    return constant + mHost.framesInFlight * (held.bytes() + slotBytes) +
           (keepsHistory(dryRun.inputs, settings) ? plan.viewCount * pixels * kHistoryBytesPerPixel
                                                  : 0);
}

core::Status EmbeddedMotionBlur::addTransients(
    DryRunInputs& dryRun, const MotionBlurSettings& settings, Slot& slot, Transients& held
) {
    View view(*mDevice);
    graph::Plan plan;
    // The second frame has one before it.
    for (uint32_t i = 0; i < 2; ++i) {
        if (keepsHistory(dryRun.inputs, settings))
            view.history.fillPlaceholders({dryRun.inputs.width, dryRun.inputs.height});
        graph::Graph graph;
        Frame frame{0, slot, graph, dryRun.inputs, settings, false, true, true};
        declare(frame, view);
        auto compiled = graph::compile(graph, slot.pool.requirementFunction());
        if (!compiled)
            return compiled.error();
        plan = std::move(compiled).value();
        dryRun.moveCamera();
    }
    held.add(plan);
    return {};
}

} // namespace shutter::motion_blur
