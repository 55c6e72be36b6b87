// SPDX-License-Identifier: MIT
// Accumulated appearance of a view's static surfaces: their colour and entity. It is preserved
// behind movers.
#pragma once

#include "engine/extract/raster_record.h"
#include "engine/gpu/frame.h"
#include "engine/gpu/memory.h"
#include "engine/render/contexts.h"
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
        bool hasLast = false; ///< `images` hold earlier frames' data
        shader::StaticRows rows{};
        /// Static surfaces may differ from the last frame: lights, what holds them back or blended
        /// surfaces may have changed.
        bool mayDiffer = false;
    };

    explicit StaticLayer(gpu::Device& device) : mDevice(device) {}

    /// Finds static entities. Must be called in the order of a view's frames.
    void extract(const render::ExtractContext& context);

    /// Whether the camera of the frame of extract() is at rest; otherwise nothing is static.
    [[nodiscard]] bool isGathering() const { return mRecord.has_value(); }

    /// \param context of the frame that extract() was called for, which gathers; the slot's last
    /// frame must be finished
    [[nodiscard]] Frame turn(const render::PictureContext& context);

    /// Drops the history; its memory is freed once the GPU has finished with it.
    void forget();

  private:
    /// The contents of a frame.
    struct Record {
        extract::RasterRecord raster;
        std::vector<uint32_t> meshes; ///< by row
        std::vector<bool> rests;      ///< ExtractedFrame::atRest
        std::vector<shader::LightRow> lights;
        math::vec4 background{0.0f};
        math::vec4 ambient{0.0f};
        uint32_t flags = 0;           ///< of shader::FrameConstants
        bool hasShading = false;      ///< ExtractContext's
        uint64_t shadingRevision = 0; ///< likewise
        bool hasPassers = false;      ///< a moving blended surface lies over static ones
        bool mayReach = false;        ///< an entity may show in pixels that show another
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
