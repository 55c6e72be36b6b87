// SPDX-License-Identifier: MIT
#pragma once

#include "engine/image/image.h"
#include "engine/math/math.h"

#include <cstdint>

namespace shutter::environment {

inline constexpr double kMinTurbidity = 1.7;  ///< a clear sky in the mountains
inline constexpr double kMaxTurbidity = 10.0; ///< haze

struct SkySettings {
    double turbidity = 2.5;           ///< [kMinTurbidity, kMaxTurbidity]
    math::dvec3 toSun{0.0, 1.0, 0.0}; ///< unit, world
    math::vec3 sunIlluminance{1.0f};  ///< from the scene's sun on a surface facing it; linear
    double intensity = 1.0;           ///< factor over the physical sky, [0, 1000]
    math::vec3 groundAlbedo{0.20f, 0.19f, 0.17f};
};

/// Radiance of a clear sky: Preetham, Shirley and Smits 1999, appendix A.2, in the units of the
/// sun's illuminance, so that the ratio of sun to sky is physical. Finite and not negative. A sun
/// less than one degree above the horizon is taken to be there.
class Sky {
  public:
    explicit Sky(const SkySettings& settings);

    /// \param direction unit; below the horizon lies ground, lit by sun and sky
    [[nodiscard]] math::vec3 radianceOf(math::dvec3 direction) const;

    /// Radiance of the sun's disc, at most kMaxDiscRatio times the radiance of the brightest sky.
    [[nodiscard]] math::vec3 discRadiance() const { return mDisc; }

    /// Unit; where the disc is drawn.
    [[nodiscard]] math::dvec3 toSun() const { return mToSun; }

  private:
    [[nodiscard]] math::vec3 aboveHorizon(math::dvec3 direction) const;

    math::dvec3 mToSun{0.0};
    math::dvec3 mZenith{0.0}; ///< x, y, Y over what Perez gives towards the zenith
    math::dvec3 mPerez[5]{};  ///< A to E, each of x, y and Y
    double mScale = 1.0;      ///< from kcd/m2 to the scene's units
    math::vec3 mGround{0.0f};
    math::vec3 mDisc{0.0f};
};

inline constexpr double kSunRadius = 0.00465; ///< radians, seen from the earth
/// The sun is about 10^5 times as bright as the sky, which exceeds the range of half floats; this
/// clamped value is white at any exposure that shows the sky.
inline constexpr double kMaxDiscRatio = 500.0;

/// Equirectangular pictures: one for lighting, `width` / 4 wide because only the sun is sharp in a
/// sky; and the background, `width` wide, with the sun's disc, whose light comes from the scene's
/// sun.
struct SkyPictures {
    image::Image light;
    image::Image background;
};

[[nodiscard]] SkyPictures drawSky(const SkySettings& settings, uint32_t width);

} // namespace shutter::environment
