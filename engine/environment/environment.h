// SPDX-License-Identifier: MIT
// Converts an equirectangular picture to image-based light.
#pragma once

#include "engine/core/result.h"
#include "engine/core/setting_row.h"
#include "engine/environment/sky_model.h"
#include "engine/image/image.h"
#include "engine/scene/environment.h"

#include <cstdint>

namespace shutter::environment {

/// Widest background: every device takes it. Wider pictures are halved.
inline constexpr uint32_t kMaxWidth = 4096;
/// Smallest and largest picture that is read.
inline constexpr uint32_t kMinPictureWidth = 8;
inline constexpr uint32_t kMaxPictureWidth = 32768;
/// Width of a sky: the sun's disc is three texels wide.
inline constexpr uint32_t kSkyWidth = 2048;

struct EnvironmentSettings {
    double intensity = 1.0;       ///< factor of the picture, [0, 1000]
    double rotationDegrees = 0.0; ///< about +Y, [-360, 360]: positive turns the surroundings left
};

/// Names, ranges and options of EnvironmentSettings.
[[nodiscard]] core::SettingRows<EnvironmentSettings> listEnvironmentRows();

/// \param picture linear, equirectangular, twice as wide as high; one channel is grey, channels
/// after the third are ignored. Negative values and NaN count as 0; values are clamped to the range
/// of half floats.
/// Error: a size or a setting out of its range, without the file's name.
[[nodiscard]] core::Result<scene::Environment>
makeEnvironment(image::Image picture, const EnvironmentSettings& settings);

/// A clear sky whose sun is the scene's.
[[nodiscard]] scene::Environment makeSky(const SkySettings& settings);

} // namespace shutter::environment
