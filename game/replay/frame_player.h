// SPDX-License-Identifier: MIT
// Draws one frame after another from images in memory, as a host of the motion blur does.
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/device.h"
#include "engine/gpu/memory.h"
#include "engine/image/image.h"
#include "engine/render/readback.h"
#include "game/replay/dump_on_device.h"
#include "game/replay/dump_reader.h"
#include "modules/motion_blur/embedding/embedded_motion_blur.h"
#include "modules/motion_blur/settings.h"
#include "shaders/common/shutter_response_shared.h"

#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace shutter::replay {

struct PlayOptions {
    /// Names of intermediates to read back, or "all".
    std::vector<std::string> aovs;
    bool checksInputs = false; ///< HostDevice::checksInputs: prints what it finds
    bool showsInputs = false;  ///< HostInputs::showsInputs
};

/// RGBA of half floats.
[[nodiscard]] image::Image unpackPicture(const uint8_t* bytes, uint32_t width, uint32_t height);

class FramePlayer {
  public:
    FramePlayer(gpu::Device& device, PlayOptions options)
        : mOptions(std::move(options)), mDevice(device), mReveal(device), mDraws(device),
          mReadback(device) {}

    /// \param views DumpFrame::view is below it
    [[nodiscard]] core::Status create(uint32_t views);

    /// Draws the frame, whose texels are read, and waits for it. Error: names the frame.
    [[nodiscard]] core::Result<image::Image>
    draw(const DumpFrame& frame, const motion_blur::MotionBlurSettings& settings);

    /// Writes the intermediates of the frame drawn last next to its picture, if that has a name.
    /// \return their files
    /// Error: among others, that the frame has none of a name.
    [[nodiscard]] core::Result<std::vector<std::filesystem::path>>
    writeIntermediates(const std::string& frame, const std::filesystem::path& picture) const;

  private:
    motion_blur::HostInputs describe(const DumpFrame& frame);
    core::Status giveResponse(const DumpFrame& frame, motion_blur::HostInputs& inputs);
    /// Copies the intermediates that are wanted to where the CPU reads them.
    void readBack(
        graph::Graph& graph,
        const motion_blur::MotionBlurInputs& own,
        const motion_blur::MotionBlurOutputs& made
    );

    PlayOptions mOptions;
    gpu::Device& mDevice;
    std::unique_ptr<motion_blur::EmbeddedMotionBlur> mBlur;
    std::deque<UploadedImage> mUploads;
    std::vector<motion_blur::HostMover> mMovers;
    ReplayedReveal mReveal;
    ReplayedDraws mDraws;
    shader::ResponseTable mResponse{};
    gpu::Buffer mResponseBuffer;
    render::Readback mReadback;
    std::map<std::string, size_t> mTickets;
    std::vector<std::string> mKnown; ///< names of the frame's intermediates
};

} // namespace shutter::replay
