// SPDX-License-Identifier: MIT
// The pixels whose background is revealed.
#pragma once

#include "engine/graph/graph.h"
#include "modules/motion_blur/params.h"
#include "modules/motion_blur/passes/clears.h"

#include <cstdint>

namespace shutter::motion_blur {

/// How masked pixels come into their list: one by one, or all of a block at once, which takes fewer
/// atomics and two barriers. The lists hold the same.
enum class MaskListing : uint8_t { PixelByPixel, BlockByBlock };

/// The listing that is faster on the device.
[[nodiscard]] MaskListing chooseMaskListing(const gpu::Device& device);

struct MaskedPixels {
    graph::ImageHandle mask;       ///< R8
    graph::BufferHandle list;      ///< MaskHeader, then the pixels
    graph::BufferHandle arguments; ///< DispatchArguments of the reveal

    /// With no pixel in it, to be cleared with other lists.
    [[nodiscard]] static MaskedPixels
    create(graph::Graph& graph, const PassParams& params, Clears& clears);

    /// \param created of create() \param clears after Clears::declare()
    [[nodiscard]] static MaskedPixels getCleared(const MaskedPixels& created, const Clears& clears);
};

} // namespace shutter::motion_blur
