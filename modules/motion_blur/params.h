// SPDX-License-Identifier: MIT
// Settings as shaders get them.
#pragma once

#include "modules/motion_blur/settings.h"
#include "shaders/motion_blur/motion_blur_shared.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace shutter::motion_blur {

/// Maximum number of frames in flight, times views; each has its own counters.
inline constexpr uint32_t kMaxSlots = 64;

/// Push constants of every pass: the common part, followed by the method's own block.
struct PassParams : shader::MotionBlurParams {
    static constexpr size_t kMethodBytes = 64;

    /// shader::GatherParams, ...
    template <class Block> void setMethod(const Block& block) {
        static_assert(std::is_trivially_copyable_v<Block> && sizeof(Block) <= kMethodBytes);
        std::memcpy(method.data(), &block, sizeof(Block));
    }

    template <class Block> [[nodiscard]] Block getMethod() const {
        static_assert(std::is_trivially_copyable_v<Block> && sizeof(Block) <= kMethodBytes);
        Block block;
        std::memcpy(&block, method.data(), sizeof(Block));
        return block;
    }

    std::array<std::byte, kMethodBytes> method{};
};

static_assert(sizeof(PassParams) == 128, "the push constants that every device has");

/// Maximum displacement of a tile's lookup by tileJitter() (taps.glsl), pixels.
[[nodiscard]] float measureTileJitter(const PassParams& params);

/// Converts settings to the parameters of the method's shaders. Pure function.
/// \param rasterTime raster instant in the exposure, clamped to [0, 1]
[[nodiscard]] PassParams
resolve(const MotionBlurSettings& settings, uint32_t width, uint32_t height, double rasterTime);

} // namespace shutter::motion_blur
