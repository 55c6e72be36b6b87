// SPDX-License-Identifier: MIT
#include "game/output/intermediates.h"

#include "engine/io/image_file.h"

#include <map>
#include <vector>

namespace shutter::game {

namespace {

const std::map<std::string, std::vector<Channel>>& channelTable() {
    static const std::map<std::string, std::vector<Channel>> kTable = {
        {"motion", {{0, "motion.x"}, {1, "motion.y"}}},
        {"depth", {{2, "Z"}}},
        {"normal", {{0, "N.x"}, {1, "N.y"}, {2, "N.z"}}},
        {"mesh_id", {{0, "mesh_id"}}}, // -1: nothing
        {"tiles", {{0, "motion.x"}, {1, "motion.y"}}},
        {"variance", {{0, "variance"}}},
        {"edge", {{0, "candidate"}, {1, "measure"}, {2, "edge"}}},
        {"mask", {{0, "mask"}}},
        {"reveal", {{0, "R"}, {1, "G"}, {2, "B"}}},
        {"error", {{0, "R"}, {1, "G"}, {2, "B"}}},
        {"noisy", {{0, "R"}, {1, "G"}, {2, "B"}}},
    };
    return kTable;
}

} // namespace

image::Image selectChannels(const image::Image& image, const std::vector<Channel>& channels) {
    image::Image chosen(image.width, image.height, static_cast<uint32_t>(channels.size()));
    for (const Channel& channel : channels)
        chosen.channelNames.push_back(channel.name);
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x)
            for (uint32_t c = 0; c < chosen.channels; ++c)
                chosen.at(x, y, c) = image.at(x, y, channels[c].source);
    return chosen;
}

std::filesystem::path intermediateFile(const std::filesystem::path& out, const std::string& aov) {
    std::filesystem::path file = out;
    return file.replace_extension(aov + ".exr");
}

core::Status writeIntermediate(
    const std::filesystem::path& path, const std::string& aov, const image::Image& image
) {
    return io::writeImage(path, selectChannels(image, channelTable().at(aov)));
}

} // namespace shutter::game
