// SPDX-License-Identifier: MIT
// Makes one surface per pixel, and at edges two, of a raster with several samples.
#pragma once

#include "engine/gpu/device.h"
#include "engine/gpu/pipeline.h"
#include "engine/math/math.h"
#include "engine/render/gbuffer_images.h"

namespace shutter::render {

class SampleSplit {
  public:
    explicit SampleSplit(gpu::Device& device);

    /// A raster of shader::kSampleCount samples per pixel.
    struct Samples {
        graph::ImageHandle color; ///< of kColorFormat
        /// Of kSampleSurfaceFormat: bits of motion and depth as in GBuffer::motionDepth, and the
        /// word of the entity (rowOfSample()).
        graph::ImageHandle surface;
        graph::ImageHandle normal; ///< of kSampleNormalFormat: packNormal(); invalid: none
    };

    struct Request {
        /// GBuffer::edgeSurface is read: a pixel there has its own surface's colour.
        bool keepsEdges = false;
        math::vec2 confusion{0.0f}; ///< InstantMotions::confusion; 0: a pinhole
        bool hasBlended = false;    ///< blended surfaces are in the colours
    };

    /// \return one sample per pixel
    [[nodiscard]] GBuffer
    declare(graph::Graph& graph, const Samples& samples, const Request& request) const;

  private:
    gpu::Device& mDevice;
    gpu::LazyPipeline mSplit;
    gpu::LazyPipeline mEdges;
};

} // namespace shutter::render
