// SPDX-License-Identifier: MIT
// A dump's images and the host's answers to a reveal, brought back to the device.
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "game/replay/dump_reader.h"
#include "modules/motion_blur/embedding/embedded_motion_blur.h"
#include "modules/motion_blur/host_answers.h"

#include <deque>
#include <memory>
#include <optional>

namespace shutter::replay {

/// Use of an image after the effect: it is copied to memory.
inline constexpr graph::OutsideUse kCopied{
    VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
    VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
    VK_ACCESS_2_TRANSFER_READ_BIT};

/// An image of the dump on the device.
class UploadedImage {
  public:
    UploadedImage(gpu::Device& device, const DumpImage& from);

    /// Copies the texels; the image is in the state that describe() returns.
    void record(VkCommandBuffer commands) const;
    [[nodiscard]] motion_blur::HostImage describe() const;

  private:
    VkRect2D mArea;
    gpu::Image mImage;
    gpu::Buffer mStaging;
};

/// Replays the host's answers to the reveal.
class ReplayedReveal {
  public:
    explicit ReplayedReveal(gpu::Device& device);

    /// \param frame holds DumpedReveal::Own. Frees the earlier answers: the GPU must have finished
    /// with them.
    motion_blur::HostReveal answer(const DumpFrame& frame);

  private:
    void record(const motion_blur::RevealTask& task);

    gpu::Device& mDevice;
    std::unique_ptr<gpu::Frame> mFrame;
    std::optional<gpu::Pipeline> mPipeline;
    std::deque<gpu::Image> mTargets;
    std::deque<gpu::Buffer> mTexels;
};

/// Replays the host's drawing over the picture.
class ReplayedDraws {
  public:
    explicit ReplayedDraws(gpu::Device& device) : mDevice(device) {}

    /// \param frame holds DumpFrame::drawn. Frees the earlier drawing: the GPU must have finished
    /// with it.
    motion_blur::HostBlended answer(const DumpFrame& frame);

  private:
    void record(const motion_blur::BlendedTask& task) const;

    gpu::Device& mDevice;
    std::deque<gpu::Buffer> mColors; ///< by part
    std::deque<gpu::Buffer> mOpacities;
};

} // namespace shutter::replay
