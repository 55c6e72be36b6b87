// SPDX-License-Identifier: MIT
// Checks a host's inputs: passes gather totals and samples, which are compared once the GPU has
// finished the frame. Never waits.
#pragma once

#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu/vulkan.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/embedding/check/checked_frame.h"
#include "modules/motion_blur/embedding/host_inputs.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace shutter::motion_blur {

struct MotionBlurSettings;

/// The host's images in the graph, as they were imported. Invalid: not given.
struct ImportedInputs {
    graph::ImageHandle color;
    graph::ImageHandle light;       ///< of `color`, prepared; invalid where that is light already
    graph::ImageHandle motionDepth; ///< the host's own; else the two below
    graph::ImageHandle vectors;
    graph::ImageHandle depth;
    graph::ImageHandle blurScale;
    graph::ImageHandle normal;
    graph::ImageHandle entityId;
    graph::ImageHandle deformed;
    graph::ImageHandle lastDeformed;
    graph::ImageHandle blended;
};

class HostChecker {
  public:
    /// \param frames in flight; views are as many
    HostChecker(gpu::Device& device, uint32_t frames, HostMessage message);

    /// Declares the passes of a recording under a frame's number.
    void
    add(graph::Graph& graph,
        uint32_t frame,
        const HostInputs& inputs,
        const ImportedInputs& images,
        const MotionBlurSettings& settings);

    /// The recording failed: nothing will be read of it.
    void drop(uint32_t frame) { mSlots[frame].isPending = false; }

    /// The GPU has finished the frame, or will never run it: reports the findings.
    void finish(uint32_t frame);
    /// The same of all frames, in the order of their recordings.
    void finishAll();

    /// The view was closed.
    void forget(uint32_t view) { mLast[view].reset(); }

    /// The last evaluated frame of a view; null: none yet.
    [[nodiscard]] const CheckedFrame* last(uint32_t view) const { return mLast[view].get(); }

  private:
    struct Slot {
        gpu::Buffer totals; ///< shader::CheckTotals
        CheckFacts facts;
        uint32_t serial = 0;
        bool isPending = false;
    };

    void report(const Finding& finding);

    gpu::Device& mDevice;
    HostMessage mMessage;
    gpu::LazyPipeline mPicture;
    gpu::LazyPipeline mIds;
    gpu::LazyPipeline mDeformed;
    gpu::LazyPipeline mBlended;
    std::vector<Slot> mSlots;
    std::vector<std::unique_ptr<CheckedFrame>> mLast; ///< by view
    std::vector<uint32_t> mNumbers;                   ///< by view: recordings so far
    std::unique_ptr<CheckedFrame> mNow;               ///< is filled and becomes the last one
    uint32_t mSerial = 0;
    uint64_t mEvaluated = 0;
    std::array<uint64_t, size_t(CheckKind::Count)> mReported{}; ///< evaluation that reported it; 0:
                                                                ///< never
};

class HostUndeclared {
  public:
    /// \param device of the host's images
    explicit HostUndeclared(VkDevice device) : mDevice(device) {}

    /// Reports large images with unknown extent, each once. Unknown usage and sample count are left
    /// to the validation layer: most hosts do not set them.
    void report(const HostInputs& inputs, const HostMessage& message);

  private:
    VkDevice mDevice;
    uint32_t mReported = 0; ///< a bit for each image reported
};

} // namespace shutter::motion_blur
