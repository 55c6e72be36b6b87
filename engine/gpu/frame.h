// SPDX-License-Identifier: MIT
// Frames in flight: each has its command buffer, its descriptors and its timestamps.
#pragma once

#include "engine/gpu/descriptors.h"
#include "engine/gpu/device.h"
#include "engine/gpu/pipeline.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace shutter::gpu {

/// Maximum number of frames that the CPU may be ahead of the GPU; buffers that the CPU reads back
/// or writes per frame exist as often. A frame's slot, below this number, selects its buffer.
inline constexpr uint32_t kMaxFramesInFlight = 3;

/// Ticks from one timestamp to a later one of a counter that has wrapped once at most between them:
/// one of 36 bits, which Intel has, does so every hour.
/// \param validBits of the counter, [1, 64]; those above are zero in timestamps
[[nodiscard]] uint64_t countTicks(uint64_t begin, uint64_t end, uint32_t validBits);

/// GPU time of one labelled span, milliseconds.
struct PassTime {
    std::string name;
    double gpuMilliseconds = 0.0;
    double cpuMilliseconds = 0.0; ///< time to record it
};

/// One frame being recorded.
class Frame {
  public:
    explicit Frame(Device& device);
    /// Makes a frame for command buffers of a host (beginIn), which also submits them.
    /// \param timestampBits that count of the queue's timestamps; 0: spans are labels alone, and
    /// take no times of the GPU
    [[nodiscard]] static std::unique_ptr<Frame>
    createForHost(Device& device, uint32_t timestampBits = 0);
    ~Frame();
    Frame(const Frame&) = delete;
    Frame& operator=(const Frame&) = delete;

    [[nodiscard]] Device& device() const { return mDevice; }

    [[nodiscard]] VkCommandBuffer commands() const { return mCommands; }

    /// Binds `pipeline` with `bindings` as set 0, `sceneSet` as set 1 where the pipeline has one,
    /// and the push constants. CHECKed: as many bindings as the pipeline has, and storage images of
    /// the formats that its shaders declare.
    void bind(
        const Pipeline& pipeline,
        const BindingList& bindings,
        const void* pushConstants,
        uint32_t pushConstantBytes,
        VkDescriptorSet sceneSet = VK_NULL_HANDLE
    );

    /// A labelled, timed span of commands. Spans do not nest.
    void beginSpan(const std::string& name);
    void endSpan();

    /// Waits until the GPU has finished this frame's last use and starts recording. The commands
    /// start when all earlier submissions are complete: frames in flight overlap with the CPU, not
    /// with one another, and may share resources that only the GPU writes.
    void begin();
    /// One for a host: starts recording into `commands`, which are being recorded. The GPU must
    /// have finished with this frame's last use.
    void beginIn(VkCommandBuffer commands);
    /// Starts a second batch, which alone waits for the semaphore of the submission. At most once
    /// per frame; not between beginSpan() and endSpan() nor while rendering. Afterwards commands()
    /// returns another command buffer.
    void startBatch();
    /// Ends recording and submits.
    void submit(const SubmitSemaphores& semaphores = {});
    /// Waits for the GPU, then returns the times of the spans in the order they were recorded.
    [[nodiscard]] std::vector<PassTime> waitForTimes();
    /// For a host's frames: the same without waiting. Empty if the GPU has not run the commands
    /// yet, or no times are measured.
    [[nodiscard]] std::vector<PassTime> findTimes() const;
    /// Waits for this frame's submission.
    void wait();

  private:
    struct ForHost {};

    Frame(Device& device, ForHost) : mDevice(device), mDescriptors(device) {}

    void createQueries();
    /// Empty: they are not there, and `flags` do not wait for them.
    [[nodiscard]] std::vector<PassTime> readTimes(VkQueryResultFlags flags) const;

    Device& mDevice;
    // Null for a host.
    VkCommandPool mPool = VK_NULL_HANDLE;
    VkCommandBuffer mCommands = VK_NULL_HANDLE; ///< that is being recorded
    std::array<VkCommandBuffer, 2> mBuffers{};  ///< one per batch
    size_t mBatches = 1;
    VkQueryPool mQueries = VK_NULL_HANDLE; ///< null: no times are taken
    uint32_t mTimestampBits = 0;
    DescriptorArena mDescriptors;
    std::vector<PassTime> mSpans;
    double mSpanStartCpuMs = 0.0;
    uint64_t mSubmittedValue = 0;
};

} // namespace shutter::gpu
