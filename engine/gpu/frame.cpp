// SPDX-License-Identifier: MIT
#include "engine/gpu/frame.h"

#include "engine/core/check.h"
#include "engine/gpu/upload.h"

#include <algorithm>
#include <chrono>
#include <span>

namespace shutter::gpu {

namespace {

/// Spans of a frame whose times the GPU takes; further ones have none.
constexpr uint32_t kMaxSpans = 256;

double nowMilliseconds() {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(now).count();
}

} // namespace

uint64_t countTicks(uint64_t begin, uint64_t end, uint32_t validBits) {
    SHUTTER_CHECK(validBits >= 1 && validBits <= 64, "timestamps of {} bits", validBits);
    return (end - begin) & (UINT64_MAX >> (64 - validBits));
}

// Delegates, so that members are destroyed if it throws.
Frame::Frame(Device& device) : Frame(device, ForHost{}) {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = device.queueFamily();
    require(vkCreateCommandPool(device.handle(), &pool, nullptr, &mPool), "creating a frame");
    VkCommandBufferAllocateInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    commands.commandPool = mPool;
    commands.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    commands.commandBufferCount = static_cast<uint32_t>(mBuffers.size());
    require(
        vkAllocateCommandBuffers(device.handle(), &commands, mBuffers.data()), "creating a frame"
    );
    mTimestampBits = device.timestampBits();
    createQueries();
}

void Frame::createQueries() {
    VkQueryPoolCreateInfo queries{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
    queries.queryCount = 2 * kMaxSpans;
    require(vkCreateQueryPool(mDevice.handle(), &queries, nullptr, &mQueries), "creating a frame");
}

std::unique_ptr<Frame> Frame::createForHost(Device& device, uint32_t timestampBits) {
    std::unique_ptr<Frame> frame(new Frame(device, ForHost{}));
    frame->mTimestampBits = timestampBits;
    if (timestampBits > 0)
        frame->createQueries();
    return frame;
}

Frame::~Frame() {
    mDevice.retire([device = mDevice.handle(), pool = mPool, queries = mQueries] {
        vkDestroyCommandPool(device, pool, nullptr);
        vkDestroyQueryPool(device, queries, nullptr);
    });
}

void Frame::beginIn(VkCommandBuffer commands) {
    SHUTTER_CHECK(mPool == VK_NULL_HANDLE, "a frame with commands of its own starts with begin()");
    mDescriptors.reset();
    mSpans.clear();
    mCommands = commands;
    // By command: hosts need not enable hostQueryReset.
    if (mQueries)
        vkCmdResetQueryPool(mCommands, mQueries, 0, 2 * kMaxSpans);
}

void Frame::begin() {
    SHUTTER_CHECK(mPool != VK_NULL_HANDLE, "a host's frame starts with beginIn()");
    wait();
    mDescriptors.reset();
    mSpans.clear();
    require(vkResetCommandPool(mDevice.handle(), mPool, 0), "starting a frame");
    vkResetQueryPool(mDevice.handle(), mQueries, 0, 2 * kMaxSpans);
    VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    mCommands = mBuffers[0];
    mBatches = 1;
    require(vkBeginCommandBuffer(mCommands, &info), "starting a frame");
    fullBarrier(mCommands);
}

void Frame::startBatch() {
    SHUTTER_CHECK(mPool != VK_NULL_HANDLE, "a host's frame is submitted by the host");
    SHUTTER_CHECK(mBatches < mBuffers.size(), "a frame has {} batches at most", mBuffers.size());
    require(vkEndCommandBuffer(mCommands), "ending a part of a frame");
    mCommands = mBuffers[mBatches++];
    VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    require(vkBeginCommandBuffer(mCommands, &info), "starting a part of a frame");
}

void Frame::submit(const SubmitSemaphores& semaphores) {
    require(vkEndCommandBuffer(mCommands), "ending a frame");
    mSubmittedValue =
        mDevice.submit(std::span<const VkCommandBuffer>(mBuffers).first(mBatches), semaphores);
}

void Frame::wait() {
    mDevice.wait(mSubmittedValue);
}

void Frame::bind(
    const Pipeline& pipeline,
    const BindingList& bindings,
    const void* pushConstants,
    uint32_t pushConstantBytes,
    VkDescriptorSet sceneSet
) {
    SHUTTER_CHECK_EQ(bindings.count(), pipeline.bindingCount());
    const core::Status formats = bindings.checkFormats(pipeline);
    SHUTTER_CHECK(formats.ok(), "{}", formats.error().message);
    vkCmdBindPipeline(mCommands, pipeline.bindPoint(), pipeline.handle());
    const VkDescriptorSet set = mDescriptors.allocate(pipeline.setLayout());
    bindings.write(mDevice, set);
    const std::array sets{set, sceneSet};
    vkCmdBindDescriptorSets(
        mCommands,
        pipeline.bindPoint(),
        pipeline.layout(),
        0,
        sceneSet ? 2 : 1,
        sets.data(),
        0,
        nullptr
    );
    if (pushConstantBytes > 0)
        vkCmdPushConstants(
            mCommands, pipeline.layout(), pipeline.stages(), 0, pushConstantBytes, pushConstants
        );
}

void Frame::beginSpan(const std::string& name) {
    if (mDevice.functions().cmdBeginDebugUtilsLabel) {
        VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
        label.pLabelName = name.c_str();
        mDevice.functions().cmdBeginDebugUtilsLabel(mCommands, &label);
    }
    if (mQueries && mSpans.size() < kMaxSpans)
        vkCmdWriteTimestamp2(
            mCommands,
            VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
            mQueries,
            static_cast<uint32_t>(2 * mSpans.size())
        );
    mSpans.push_back({name, 0.0, 0.0});
    mSpanStartCpuMs = nowMilliseconds();
}

void Frame::endSpan() {
    mSpans.back().cpuMilliseconds = nowMilliseconds() - mSpanStartCpuMs;
    if (mQueries && mSpans.size() <= kMaxSpans)
        vkCmdWriteTimestamp2(
            mCommands,
            VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
            mQueries,
            static_cast<uint32_t>(2 * mSpans.size() - 1)
        );
    if (mDevice.functions().cmdEndDebugUtilsLabel)
        mDevice.functions().cmdEndDebugUtilsLabel(mCommands);
}

std::vector<PassTime> Frame::waitForTimes() {
    SHUTTER_CHECK(mPool != VK_NULL_HANDLE, "a host waits for its frames itself");
    wait();
    return readTimes(VK_QUERY_RESULT_WAIT_BIT);
}

std::vector<PassTime> Frame::findTimes() const {
    return mQueries ? readTimes(0) : std::vector<PassTime>();
}

std::vector<PassTime> Frame::readTimes(VkQueryResultFlags flags) const {
    if (mSpans.empty())
        return {};
    const size_t timed = std::min<size_t>(mSpans.size(), kMaxSpans);
    std::vector<uint64_t> ticks(2 * timed);
    const VkResult read = vkGetQueryPoolResults(
        mDevice.handle(),
        mQueries,
        0,
        static_cast<uint32_t>(ticks.size()),
        ticks.size() * 8,
        ticks.data(),
        8,
        VK_QUERY_RESULT_64_BIT | flags
    );
    if (read == VK_NOT_READY)
        return {};
    require(read, "reading timestamps");
    const double millisecondsPerTick = static_cast<double>(mDevice.limits().timestampPeriod) * 1e-6;
    std::vector<PassTime> times = mSpans;
    for (size_t i = 0; i < timed; ++i)
        times[i].gpuMilliseconds =
            static_cast<double>(countTicks(ticks[2 * i], ticks[2 * i + 1], mTimestampBits)) *
            millisecondsPerTick;
    return times;
}

} // namespace shutter::gpu
