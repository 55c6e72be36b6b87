// SPDX-License-Identifier: MIT
// Pictures of a renderer or compositor (colour, motion, depth, ids) in the motion blur's units.
#pragma once

#include "engine/core/result.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

namespace shutter::blur {

/// What the numbers of MOTION are. The words are those of --vectors.
enum class Vectors : uint8_t {
    Exposure, ///< pixels right and down from shutter open to close, as `render --aov motion`
    Previous, ///< pixels right and down from the previous frame to this one
    Next,     ///< the same from this frame to the next
    Blender,  ///< Cycles' pass Vector: X, Y to the previous frame, Z, W from the next; y up
    Nuke,     ///< forward.u, v to the next frame, backward.u, v to the previous one; y up
};

inline constexpr std::array<std::string_view, 5> kVectorsWords{
    "exposure", "previous", "next", "blender", "nuke"};

/// What the numbers of DEPTH are. The words are those of --depth.
enum class Depth : uint8_t {
    View,     ///< distance along the view
    Inverse,  ///< 1 / distance along the view, as Nuke's; 0 is the background
    Device,   ///< depth buffer: 0 near, 1 far
    Reversed, ///< depth buffer: 1 near, 0 far
};

inline constexpr std::array<std::string_view, 4> kDepthWords{
    "view", "inverse", "device", "reversed"};

struct PassFiles {
    std::filesystem::path color;
    std::filesystem::path motion;
    std::filesystem::path depth;
    std::filesystem::path ids; ///< empty: none
};

struct PassOptions {
    std::optional<Vectors> vectors; ///< nothing: by the names of the channels
    glm::vec2 motionScale{1.0f};    ///< to the unit and direction of `vectors`
    Depth depth = Depth::View;
    double near = 0.1; ///< of Device and Reversed; above 0
    double far = 0.0;  ///< above `near`; 0: infinite
    double rasterTime =
        1.0; ///< of two vectors of a pixel, which count: 0 next, 1 previous, else both
    double exposureShare = 0.5; ///< of the time between two frames; above 0
};

/// Pictures of one size, row 0 at the top.
struct Passes {
    uint32_t width = 0;
    uint32_t height = 0;
    bool isDisplayEncoded = false;  ///< `color` was of 8 or 16 bits; it is linear here
    bool hasAlpha = false;          ///< else alpha is 1
    std::vector<glm::vec4> color;   ///< linear
    std::vector<glm::vec2> motion;  ///< pixels right and down over the time between two frames
    std::vector<float> depth;       ///< distance along the view, shader::kSkyDepth at most
    std::vector<uint32_t> entityId; ///< shader::kNoEntity: none; empty without ids
};

/// Error: names the file, and the channel or pixel at fault.
[[nodiscard]] core::Result<Passes> readPasses(const PassFiles& files, const PassOptions& options);

} // namespace shutter::blur
