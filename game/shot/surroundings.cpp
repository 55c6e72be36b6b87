// SPDX-License-Identifier: MIT
#include "game/shot/surroundings.h"

#include "engine/environment/environment.h"
#include "engine/io/file_bytes.h"
#include "engine/io/image_file.h"
#include "engine/scene/motion.h"

#include <cmath>
#include <utility>

namespace shutter::game {

namespace {

/// IEC 61966-2-1.
float toLinear(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

core::Result<scene::Environment> readEnvironment(const ShotOptions& options) {
    auto read = io::readStoredImage(options.environment);
    if (!read)
        return read.error();
    image::Image picture = std::move(read.value().image);
    if (read.value().isDisplayEncoded)
        for (float& value : picture.pixels)
            value = toLinear(value);
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
        const math::dvec3 back(scene::worldFromEntity(world, entity, seconds)[2]);
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
