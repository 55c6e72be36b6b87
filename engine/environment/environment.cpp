// SPDX-License-Identifier: MIT
#include "engine/environment/environment.h"

#include "engine/core/words.h"
#include "engine/environment/directions.h"
#include "engine/environment/image_based_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace shutter::environment {

namespace {

using core::makeError;

constexpr float kMaxHalf = 65504.0f;

core::Status validate(const image::Image& picture, const EnvironmentSettings& settings) {
    // In words, since a glTF file and the command line name the settings differently.
    for (const auto& [what, name, value] :
         {std::tuple("an intensity", "environmentIntensity", settings.intensity),
          std::tuple("a rotation", "environmentRotation", settings.rotationDegrees)}) {
        const core::NumberRange& range = core::getRow(listEnvironmentRows(), name).range;
        if (!core::contains(range, value))
            return makeError(
                "{} of {} must lie in [{}, {}]", what, value, range.lowest, range.highest
            );
    }
    if (picture.width < kMinPictureWidth || picture.width > kMaxPictureWidth)
        return makeError(
            "it is {} wide; an environment is {} to {}",
            core::countOf(picture.width, "pixel"),
            kMinPictureWidth,
            kMaxPictureWidth
        );
    if (picture.width != 2 * picture.height)
        return makeError(
            "it is {}x{}; an environment shows all directions (equirectangular) and is twice as "
            "wide as high",
            picture.width,
            picture.height
        );
    return {};
}

/// Three channels of numbers that half floats hold.
image::Image clean(const image::Image& picture, float intensity) {
    image::Image result(picture.width, picture.height, 3);
    for (size_t i = 0; i < size_t(picture.width) * picture.height; ++i)
        for (uint32_t c = 0; c < 3; ++c) {
            const float value =
                picture.pixels[i * picture.channels + (picture.channels < 3 ? 0 : c)];
            // Written so that NaN gives 0. Bounded first: infinity times 0 is NaN.
            const float bounded = value > 0.0f ? std::min(value, kMaxHalf) : 0.0f;
            result.pixels[i * 3 + c] = std::min(bounded * intensity, kMaxHalf);
        }
    return result;
}

scene::DirectionPicture pack(const image::Image& picture) {
    image::Image rgba(picture.width, picture.height, 4);
    for (size_t i = 0; i < size_t(picture.width) * picture.height; ++i) {
        for (uint32_t c = 0; c < 3; ++c)
            rgba.pixels[i * 4 + c] = std::min(picture.pixels[i * 3 + c], kMaxHalf);
        rgba.pixels[i * 4 + 3] = 1.0f;
    }
    return {picture.width, picture.height, image::packHalf(rgba)};
}

scene::Environment gather(const image::Image& background, const image::Image& light) {
    scene::Environment environment;
    for (const image::Image& level : makePyramid(background, 1))
        environment.background.push_back(pack(level));
    for (const image::Image& level : prefilterMirrored(light))
        environment.mirrored.push_back(pack(level));
    // Harmonics of second order see nothing that this many texels do not show.
    constexpr uint32_t kHarmonicsWidth = 128;
    environment.irradiance = projectIrradiance(makePyramid(light, kHarmonicsWidth).back());
    return environment;
}

} // namespace

core::SettingRows<EnvironmentSettings> listEnvironmentRows() {
    using S = EnvironmentSettings;
    static const std::array<core::SettingRow<S>, 2> kRows = {{
        {"environmentIntensity",
         &S::intensity,
         "x",
         {.lowest = 0, .highest = 1000},
         "Factor of the light of --environment or --sky.",
         "Light of the surroundings",
         "--environment-intensity"},
        {"environmentRotation",
         &S::rotationDegrees,
         "degrees",
         {.lowest = -360, .highest = 360},
         "Turns the environment to the left.",
         "Turn of the surroundings",
         "--environment-rotation"},
    }};
    return kRows;
}

core::Result<scene::Environment>
makeEnvironment(image::Image picture, const EnvironmentSettings& settings) {
    SHUTTER_TRY(validate(picture, settings));
    picture = clean(picture, static_cast<float>(settings.intensity));
    while (picture.width > kMaxWidth)
        picture = halve(picture);
    scene::Environment environment = gather(picture, picture);
    const double angle = -glm::radians(settings.rotationDegrees);
    environment.mapFromWorld =
        math::mat3(glm::rotate(math::dmat4(1.0), angle, math::dvec3(0.0, 1.0, 0.0)));
    return environment;
}

scene::Environment makeSky(const SkySettings& settings) {
    const SkyPictures pictures = drawSky(settings, kSkyWidth);
    return gather(clean(pictures.background, 1.0f), clean(pictures.light, 1.0f));
}

} // namespace shutter::environment
