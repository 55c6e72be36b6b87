// SPDX-License-Identifier: MIT
// Which channels of a picture are a colour, by their names.
#pragma once

#include "engine/image/image.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace shutter::image {

/// Indices of a picture's channels.
struct ColorChannels {
    std::vector<uint32_t> color;   ///< red, green and blue, or grey alone
    std::optional<uint32_t> alpha; ///< of the same layer
};

/// The colour of a picture: R, G and B, or Y, of the layer without a name, else of the first layer
/// that has them ("beauty.R"). Without names, one or two channels are grey and three or four a
/// colour, the last of an even number alpha. Nothing if there is none: motion and depth are not
/// colours.
[[nodiscard]] std::optional<ColorChannels> findColor(const Image& picture);

/// The channels' names, or their indices where they have none, separated by commas.
[[nodiscard]] std::string listChannels(const Image& picture, std::span<const uint32_t> channels);

/// The picture's channels in the order of `channels`, with their names.
[[nodiscard]] Image pickChannels(const Image& picture, std::span<const uint32_t> channels);

} // namespace shutter::image
