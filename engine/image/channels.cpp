// SPDX-License-Identifier: MIT
#include "engine/image/channels.h"

#include <algorithm>
#include <string_view>

namespace shutter::image {

namespace {

/// "beauty." of "beauty.R", nothing of "R".
std::string_view layerOf(std::string_view name) {
    return name.substr(0, name.find_last_of('.') + 1); // npos + 1 is 0
}

std::optional<uint32_t>
findChannel(const Image& picture, std::string_view layer, std::string_view part) {
    const auto& names = picture.channelNames;
    const auto found =
        std::find(names.begin(), names.end(), std::string(layer) + std::string(part));
    if (found == names.end())
        return std::nullopt;
    return uint32_t(found - names.begin());
}

std::optional<ColorChannels> findLayerColor(const Image& picture, std::string_view layer) {
    const auto red = findChannel(picture, layer, "R");
    const auto green = findChannel(picture, layer, "G");
    const auto blue = findChannel(picture, layer, "B");
    const auto grey = findChannel(picture, layer, "Y");
    const auto alpha = findChannel(picture, layer, "A");
    if (red && green && blue)
        return ColorChannels{{*red, *green, *blue}, alpha};
    if (grey && !findChannel(picture, layer, "X")) // X, Y and Z are a place or a direction
        return ColorChannels{{*grey}, alpha};
    return std::nullopt;
}

std::optional<ColorChannels> findUnnamedColor(uint32_t channels) {
    switch (channels) {
    case 1:
        return ColorChannels{{0}, {}};
    case 2:
        return ColorChannels{{0}, 1};
    case 3:
        return ColorChannels{{0, 1, 2}, {}};
    case 4:
        return ColorChannels{{0, 1, 2}, 3};
    default:
        return std::nullopt;
    }
}

} // namespace

std::optional<ColorChannels> findColor(const Image& picture) {
    if (picture.channelNames.empty())
        return findUnnamedColor(picture.channels);
    if (auto color = findLayerColor(picture, ""))
        return color;
    for (const std::string& name : picture.channelNames)
        if (auto color = findLayerColor(picture, layerOf(name)))
            return color;
    return std::nullopt;
}

std::string listChannels(const Image& picture, std::span<const uint32_t> channels) {
    std::string text;
    for (const uint32_t channel : channels) {
        text += text.empty() ? "" : ", ";
        text +=
            picture.channelNames.empty() ? std::to_string(channel) : picture.channelNames[channel];
    }
    return text;
}

Image pickChannels(const Image& picture, std::span<const uint32_t> channels) {
    Image picked(picture.width, picture.height, uint32_t(channels.size()));
    if (!picture.channelNames.empty())
        for (const uint32_t channel : channels)
            picked.channelNames.push_back(picture.channelNames[channel]);
    const size_t pixels = size_t(picture.width) * picture.height;
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < channels.size(); ++c)
            picked.pixels[i * channels.size() + c] =
                picture.pixels[i * picture.channels + channels[c]];
    return picked;
}

} // namespace shutter::image
