// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/environment/directions.h"
#include "engine/environment/environment.h"
#include "engine/gltf/gltf_parts.h"
#include "engine/gltf/gltf_values.h"
#include "engine/math/srgb.h"

#include <array>
#include <cmath>
#include <utility>

namespace shutter::gltf {

namespace {

constexpr const char* kExtension = "EXT_lights_image_based";

/// The light that the default scene names; nothing where it names none.
std::optional<uint32_t> findSceneLight(const tinygltf::Model& model) {
    if (model.scenes.empty())
        return std::nullopt;
    const size_t scene = size_t(std::max(model.defaultScene, 0));
    const auto* extension = findExtension(model.scenes[scene].extensions, kExtension);
    if (!extension)
        return std::nullopt;
    const std::string path = fmt::format("scenes[{}].extensions.{}", scene, kExtension);
    const auto index = findIndex(*extension, "light", path);
    if (!index)
        failGltf("{}.light is missing", path);
    return index;
}

/// Members of arrays that checkGltfSchema does not validate.
const tinygltf::Value&
itemOf(const tinygltf::Value& array, size_t index, size_t count, const std::string& path) {
    if (!array.IsArray() || array.ArrayLen() < count)
        failGltf("{} is not an array of at least {}", path, core::countOf(count, "element"));
    return array.Get(int(index));
}

/// RGBD, where there is an alpha channel: colours that are divided by it; sRGB.
float decode(uint8_t color, uint8_t divisor) {
    return math::decodeSrgb(float(color) / 255.0f) / (std::max(float(divisor), 1.0f) / 255.0f);
}

image::Image readSide(GltfContext& context, const tinygltf::Value& value, const std::string& path) {
    const double number = value.IsNumber() ? value.GetNumberAsDouble() : -1.0;
    if (!(number >= 0.0 && number < double(context.resources.imageCount()) &&
          number == std::floor(number)))
        failGltf(
            "{} is no index of an image: {}",
            path,
            core::thereAre(context.resources.imageCount(), "image")
        );
    const scene::TextureImage stored = decodeImage(context, size_t(number));
    context.spendImageBytes(stored.rgba.size());
    if (stored.width != stored.height)
        failGltf("{} is {}x{}, no side of a cube", path, stored.width, stored.height);
    image::Image side(stored.width, stored.height, 3);
    for (size_t i = 0; i < size_t(stored.width) * stored.height; ++i)
        for (size_t c = 0; c < 3; ++c)
            side.pixels[i * 3 + c] = decode(stored.rgba[i * 4 + c], stored.rgba[i * 4 + 3]);
    return side;
}

std::array<image::Image, 6>
readSides(GltfContext& context, const tinygltf::Value& light, const std::string& path) {
    const std::string at = path + ".specularImages";
    if (!light.Has("specularImages"))
        failGltf("{} is missing", at);
    const tinygltf::Value& sharpest = itemOf(light.Get("specularImages"), 0, 1, at);
    std::array<image::Image, 6> sides;
    for (size_t i = 0; i < sides.size(); ++i) {
        const std::string one = fmt::format("{}[0][{}]", at, i);
        sides[i] = readSide(context, itemOf(sharpest, i, sides.size(), at + "[0]"), one);
        if (sides[i].width != sides[0].width)
            failGltf("{} is {} wide and {}[0][0] {}", one, sides[i].width, at, sides[0].width);
    }
    return sides;
}

math::mat3 readRotation(const tinygltf::Value& light, const std::string& path) {
    if (!light.Has("rotation"))
        return math::mat3(1.0f);
    const std::string at = path + ".rotation";
    double q[4];
    for (size_t i = 0; i < 4; ++i) {
        const tinygltf::Value& value = itemOf(light.Get("rotation"), i, 4, at);
        q[i] = value.IsNumber() ? value.GetNumberAsDouble() : std::nan("");
    }
    const math::dquat rotation(q[3], q[0], q[1], q[2]);
    const double length = glm::length(rotation);
    // Written so that NaN fails.
    if (!(length > 1e-6 && length < kMaxMagnitude))
        failGltf("{} is no rotation", at);
    return glm::transpose(math::mat3(glm::mat3_cast(rotation / length)));
}

} // namespace

void loadEnvironment(GltfContext& context, scene::Assets& assets) {
    const std::optional<uint32_t> index = findSceneLight(context.model);
    if (!index)
        return;
    const auto* root = findExtension(context.model.extensions, kExtension);
    const std::string path = fmt::format("{}.lights[{}]", kExtension, *index);
    if (!root || !root->Has("lights"))
        failGltf("{}.lights is missing", kExtension);
    const tinygltf::Value& light = itemOf(
        root->Get("lights"), *index, size_t(*index) + 1, fmt::format("{}.lights", kExtension)
    );
    if (!light.IsObject())
        failGltf("{} is not an object", path);
    const std::array<image::Image, 6> sides = readSides(context, light, path);
    environment::EnvironmentSettings settings;
    settings.intensity = findNumber(light, "intensity", path).value_or(settings.intensity);
    // As many texels round the horizon as four sides have.
    const uint32_t width =
        std::clamp(4 * sides[0].width, environment::kMinPictureWidth, environment::kMaxWidth);
    auto made = environment::makeEnvironment(environment::unwrapCube(sides, width), settings);
    if (!made)
        failGltf("{}: {}", path, made.error().message);
    assets.environment = std::move(made).value();
    assets.environment->mapFromWorld = readRotation(light, path);
}

} // namespace shutter::gltf
