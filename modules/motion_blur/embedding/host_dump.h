// SPDX-License-Identifier: MIT
// Writes a host's inputs and the resulting picture to a folder, for `shutter replay`. For each
// frame, `frame_0000.json` holds the host's parameters and names a file of raw texels for each
// image (modules/motion_blur/embedding/README.md).
#pragma once

#include "engine/core/result.h"
#include "engine/gpu/memory.h"
#include "engine/gpu/pipeline.h"
#include "engine/graph/graph.h"
#include "modules/motion_blur/embedding/check/checker.h"
#include "modules/motion_blur/embedding/host_inputs.h"
#include "modules/motion_blur/host_answers.h"
#include "modules/motion_blur/passes/composite.h"
#include "modules/motion_blur/settings.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace shutter::motion_blur {

/// Describes a host's parameters of a recording: the part of a dump that is not images.
/// \param isPacked HostInputs::motionDepth is used, not the convention
/// \param hasResponse the dump holds the table of the shutter's response
[[nodiscard]] nlohmann::ordered_json describeInputs(
    const HostInputs& inputs, const MotionBlurSettings& settings, bool isPacked, bool hasResponse
);

class HostDump {
  public:
    /// \param frames in flight
    HostDump(gpu::Device& device, uint32_t frames, HostMessage message);
    ~HostDump();

    /// The next recordings will be written. Error: the folder cannot be made, holds a dump already,
    /// or one is being written.
    [[nodiscard]] core::Status start(const std::filesystem::path& folder, uint32_t frameCount);

    /// The next recording will be written.
    [[nodiscard]] bool wantsFrame() const { return mLeft > 0; }

    /// Whether the next recording of the view is the dump's first, which must not use history.
    [[nodiscard]] bool startsView(uint32_t view) const;

    /// Declares the passes that read the inputs of a recording under a frame's number.
    /// \param response the shutter's, in main memory; null: a box, or its address alone is known
    void
    add(graph::Graph& graph,
        uint32_t frame,
        const HostInputs& inputs,
        const ImportedInputs& images,
        const MotionBlurSettings& settings,
        const shader::ResponseTable* response);
    /// The same for the host's drawing over the picture, after add().
    void addDrawn(graph::Graph& graph, uint32_t frame, const std::vector<BlendedSums>& parts);
    /// The same for the blurred picture, after all else.
    void addPicture(graph::Graph& graph, uint32_t frame, graph::ImageHandle picture);
    /// Wraps the host's reveal so that its images are read back, too; it refers to this, `inputs`
    /// and `recorder`.
    /// \param recorder the recorder of commands
    [[nodiscard]] HostReveal
    wrapReveal(const HostInputs& inputs, uint32_t frame, gpu::Frame& recorder);
    /// The recording failed: discards it.
    void drop(uint32_t frame);

    /// The GPU is done with the frame, or will never run it: writes its files.
    void finish(uint32_t frame);
    void finishAll();

  private:
    struct Slot;
    struct Plane;
    struct Input;

    [[nodiscard]] static std::vector<Input>
    listInputs(const HostInputs& inputs, const ImportedInputs& images);
    void addPlanes(
        Slot& slot,
        const HostInputs& inputs,
        const MotionBlurSettings& settings,
        std::span<const Input> list
    ) const;
    Plane& addPlane(Slot& slot, const char* name, uint32_t texels, VkExtent2D extent) const;
    void addImagePass(graph::Graph& graph, Slot& slot, graph::ImageHandle image, const Plane& plane)
        const;
    [[nodiscard]] core::Status write(const Slot& slot) const;

    gpu::Device& mDevice;
    HostMessage mMessage;
    gpu::LazyPipeline mImage;
    gpu::LazyPipeline mIds;
    gpu::LazyPipeline mPicture;
    gpu::LazyPipeline mReveal;
    std::vector<std::unique_ptr<Slot>> mSlots;
    std::filesystem::path mFolder;
    uint32_t mLeft = 0; ///< recordings to come
    uint32_t mNext = 0; ///< number of the next file
    uint32_t mSerial = 0;
    std::vector<bool> mHasView; ///< by view: a frame of it is in the dump
};

} // namespace shutter::motion_blur
