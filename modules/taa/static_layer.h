// SPDX-License-Identifier: MIT
// What a view's static surfaces look like, gathered from frame to frame: their colour and whose it
// is. It stays where something moves in front of them.
#pragma once

#include "engine/extract/raster_record.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/render/post_effect.h"
#include "shaders/taa/taa_shared.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace shutter::taa {

class StaticLayer {
  public:
    struct Images {
        gpu::Image color; ///< RGBA32_SINT: shader::Kept
        gpu::Image row;   ///< R32_UINT: shader::kDoubted and a row of the frame's entity table
    };

    /// A frame's own share of it.
    struct Frame {
        const Images* images = nullptr;
        bool hasLast = false; ///< `images` hold what is known from before
        shader::StaticRows rows{};
        /// What is static may look different than in the last frame: a light, an entity that casts
        /// shadows or what is blended over it may be another.
        bool mayDiffer = false;
    };

    explicit StaticLayer(gpu::Device& device) : mDevice(device) {}

    /// Finds what is static. A view's frames come in their order.
    void extract(const render::ExtractContext& context);

    /// The camera of the frame that extract() was called for is at rest: else nothing is static.
    [[nodiscard]] bool isGathering() const { return mRecord.has_value(); }

    /// \param context of the frame that extract() was called for, which gathers; the slot's last
    /// frame must be finished
    [[nodiscard]] Frame turn(const render::PostContext& context);

    /// The next frame has none before it; the memory goes once the GPU is done with it.
    void forget();

  private:
    /// What a frame was drawn of.
    struct Record {
        extract::RasterRecord raster;
        std::vector<uint32_t> meshes; ///< by row
        std::vector<bool> rests;      ///< ExtractedFrame::atRest
        std::vector<shader::LightRow> lights;
        math::vec4 background{0.0f};
        math::vec4 ambient{0.0f};
        uint32_t flags = 0; ///< of shader::FrameConstants
        extract::ShadowSettings shadows;
        uint64_t shadowRevision = 0; ///< ExtractContext's
        bool hasPassers = false;     ///< something moves that is blended over what is static
    };

    [[nodiscard]] static Record makeRecord(const render::ExtractContext& context);
    /// \param last of the same view, from before
    void compare(const Record& now, const Record& last);
    [[nodiscard]] shader::StaticRows writeRows(gpu::Buffer& buffer) const;

    gpu::Device& mDevice;
    Images mImages;
    std::optional<Record> mRecord; ///< of the frame that was extracted last
    Frame mFrame;                  ///< of it, without images and rows
    bool mHasLast = false;
    std::vector<uint32_t> mStates;  ///< shader::StaticRows::states
    std::vector<uint32_t> mNowRows; ///< shader::StaticRows::nowRows
    std::array<gpu::Buffer, gpu::kMaxFramesInFlight> mBuffers;
};

} // namespace shutter::taa
