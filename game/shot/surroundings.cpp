// SPDX-License-Identifier: MIT
#include "game/shot/surroundings.h"

#include "engine/core/log.h"
#include "engine/environment/environment.h"
#include "engine/image/channels.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/math/srgb.h"
#include "engine/scene/motion.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace shutter::game {

namespace {

bool isOpaque(const image::Image& picture, uint32_t alpha) {
    for (size_t i = alpha; i < picture.pixels.size(); i += picture.channels)
        if (picture.pixels[i] != 1.0f)
            return false;
    return true;
}

/// Warns of channels that no environment has.
void warnOfOthers(
    const std::string& file, const image::Image& picture, const image::ColorChannels& color
) {
    std::vector<uint32_t> others;
    for (uint32_t c = 0; c < picture.channels; ++c) {
        const bool isColor =
            std::find(color.color.begin(), color.color.end(), c) != color.color.end();
        if (!isColor && !(color.alpha == c && isOpaque(picture, c)))
            others.push_back(c);
    }
    if (!others.empty())
        core::logWarning(
            "--environment: '{}' has channels that are left out: {}",
            file,
            image::listChannels(picture, others)
        );
}

/// The colours of the whole picture. Error: it has none, or lacks a part; names the file.
core::Result<image::Image> takeColors(io::StoredImage stored, const std::string& file) {
    io::cropToDisplay(stored);
    if (stored.data != stored.display)
        return core::makeError(
            "'{}' has pixels in a part of its display window only, and an environment shows all "
            "directions",
            file
        );
    const auto color = image::findColor(stored.image);
    if (!color)
        return core::makeError(
            "'{}' holds no colour but {}", file, fmt::join(stored.image.channelNames, ", ")
        );
    warnOfOthers(file, stored.image, *color);
    return image::pickChannels(stored.image, color->color);
}

core::Result<scene::Environment> readEnvironment(const ShotOptions& options) {
    auto read = io::readStoredImage(options.environment);
    if (!read)
        return read.error();
    const bool isDisplayEncoded = read.value().isDisplayEncoded;
    auto colors = takeColors(std::move(read).value(), options.environment.string());
    if (!colors)
        return colors.error();
    image::Image picture = std::move(colors).value();
    if (isDisplayEncoded)
        for (float& value : picture.pixels)
            value = math::decodeSrgb(value);
    auto made = environment::makeEnvironment(std::move(picture), options.surroundings);
    if (!made)
        return core::makeError("{}: {}", options.environment.string(), made.error().message);
    return std::move(made).value();
}

} // namespace

void addSky(scene::World& world, double turbidity, double intensity, double seconds) {
    environment::SkySettings sky;
    sky.turbidity = turbidity;
    sky.intensity = intensity;
    sky.toSun = glm::normalize(math::dvec3(-0.45, 0.7, 0.55));
    sky.sunIlluminance = math::vec3(3.0f);
    for (auto [entity, light] : world.registry.view<scene::Light>()) {
        if (light.kind != scene::LightKind::Directional)
            continue;
        const math::dvec3 back(scene::worldFromLight(world, entity, seconds)[2]);
        if (!(glm::length(back) > 0.0))
            continue;
        sky.toSun = glm::normalize(back); // a light shines along its -Z
        sky.sunIlluminance = light.color * light.intensity;
        break;
    }
    world.assets.environment = environment::makeSky(sky);
}

core::Status addSurroundings(scene::World& world, const ShotOptions& options) {
    if (options.turbidity > 0.0)
        addSky(
            world, options.turbidity, options.surroundings.intensity, options.frameTimes.front()
        );
    if (options.environment.empty())
        return {};
    auto made = readEnvironment(options);
    if (!made)
        return core::makeError("--environment: {}", made.error().message);
    world.assets.environment = std::move(made).value();
    return {};
}

core::Result<std::string> computeSurroundingsHash(const std::filesystem::path& file) {
    if (file.empty())
        return std::string();
    auto hash = io::computeFileHash(file);
    if (!hash)
        return core::makeError("--environment: {}", hash.error().message);
    return hash;
}

} // namespace shutter::game
