// SPDX-License-Identifier: MIT
#include "game/cli/compare_input.h"

#include "engine/io/image_file.h"
#include "game/output/extra_files.h"
#include "modules/tonemap/display.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace shutter::game {

namespace {

/// "R" of "R" and of "layer.R".
std::string_view lastPart(std::string_view channelName) {
    return channelName.substr(channelName.find_last_of('.') + 1);
}

/// Whether the channels are red, green, blue or grey, by name. Motion or depth is no colour.
bool isColor(const image::Image& picture) {
    const auto& names = picture.channelNames;
    if (picture.channels == 1)
        return names.empty() || lastPart(names[0]) == "Y";
    constexpr std::array<std::string_view, 3> kRgb{"R", "G", "B"};
    return picture.channels == 3 &&
           (names.empty() ||
            std::equal(kRgb.begin(), kRgb.end(), names.begin(), [](auto a, auto& b) {
                return a == lastPart(b);
            }));
}

image::Image dropAlpha(image::Image picture) {
    if (picture.channels == 2 && picture.channelNames.size() == 2 &&
        lastPart(picture.channelNames[1]) == "A")
        return selectChannels(picture, {{0, "Y"}});
    if (picture.channels <= 3)
        return picture;
    std::vector<std::string> names = std::move(picture.channelNames);
    image::Image color = selectChannels(picture, {{0, "R"}, {1, "G"}, {2, "B"}});
    if (names.size() >= 3)
        color.channelNames.assign(names.begin(), names.begin() + 3);
    return color;
}

} // namespace

core::Result<CompareInput>
readCompareInput(const std::string& path, bool stored, const tonemap::TonemapSettings& settings) {
    auto file = io::readStoredImage(path);
    if (!file)
        return file.error();
    CompareInput input;
    input.image = dropAlpha(std::move(file.value().image));
    input.isDisplay = file.value().isDisplayEncoded;
    if (input.isDisplay || stored)
        return input;
    if (!isColor(input.image))
        return core::makeError(
            "'{}' holds no colour that can be tone mapped but {}: compare its values with --linear",
            path,
            fmt::join(input.image.channelNames, ", ")
        );
    input.image = tonemap::computeDisplayImage(input.image, settings);
    input.isDisplay = true;
    input.isToneMapped = true;
    return input;
}

} // namespace shutter::game
