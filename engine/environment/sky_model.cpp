// SPDX-License-Identifier: MIT
#include "engine/environment/sky_model.h"

#include "engine/environment/directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace shutter::environment {

namespace {

using math::dvec3;
using std::numbers::pi;

constexpr double kMinElevation = pi / 180.0;

/// Perez et al. 1993, by x, y and Y. \param cosine of the angle from the zenith, above 0
/// \param gamma angle from the sun
dvec3 evaluatePerez(const dvec3 (&k)[5], double cosine, double gamma) {
    const double cosGamma = std::cos(gamma);
    return (1.0 + k[0] * glm::exp(k[1] / cosine)) *
           (1.0 + k[2] * glm::exp(k[3] * gamma) + k[4] * cosGamma * cosGamma);
}

/// Preetham 1999, A.2: of the zenith; theta of the sun, from there.
dvec3 zenithOf(double t, double theta) {
    const double theta2 = theta * theta;
    const double theta3 = theta2 * theta;
    const double chi = (4.0 / 9.0 - t / 120.0) * (pi - 2.0 * theta);
    const double luminance = (4.0453 * t - 4.9710) * std::tan(chi) - 0.2155 * t + 2.4192;
    const double x = t * t * (0.00166 * theta3 - 0.00375 * theta2 + 0.00209 * theta) +
                     t * (-0.02903 * theta3 + 0.06377 * theta2 - 0.03202 * theta + 0.00394) +
                     (0.11693 * theta3 - 0.21196 * theta2 + 0.06052 * theta + 0.25886);
    const double y = t * t * (0.00275 * theta3 - 0.00610 * theta2 + 0.00317 * theta) +
                     t * (-0.04214 * theta3 + 0.08970 * theta2 - 0.04153 * theta + 0.00516) +
                     (0.15346 * theta3 - 0.26756 * theta2 + 0.06670 * theta + 0.26688);
    return {x, y, std::max(luminance, 0.0)};
}

/// CIE xyY to linear Rec. 709, IEC 61966-2-1; values outside of its gamut are clipped.
dvec3 toRgb(dvec3 xyY) {
    const double y = std::max(xyY.y, 1.0e-6);
    const dvec3 xyz(xyY.x * xyY.z / y, xyY.z, (1.0 - xyY.x - xyY.y) * xyY.z / y);
    return glm::max(
        dvec3(
            3.2406 * xyz.x - 1.5372 * xyz.y - 0.4986 * xyz.z,
            -0.9689 * xyz.x + 1.8758 * xyz.y + 0.0415 * xyz.z,
            0.0557 * xyz.x - 0.2040 * xyz.y + 1.0570 * xyz.z
        ),
        dvec3(0.0)
    );
}

double luminanceOf(dvec3 rgb) {
    return glm::dot(rgb, dvec3(0.2126, 0.7152, 0.0722));
}

/// Illuminance that the sun gives a surface facing it under a clear sky, klx (IES, "Recommended
/// practice for the calculation of daylight availability", 1984). Below 15 degrees the sun of that
/// height counts: a scene's sun is as bright as its author made it, however low.
double directIlluminance(double elevation) {
    const double airMass = 1.0 / std::sin(std::max(elevation, pi / 12.0));
    return 127.5 * std::exp(-0.21 * airMass);
}

} // namespace

Sky::Sky(const SkySettings& settings) {
    const double t = std::clamp(settings.turbidity, kMinTurbidity, kMaxTurbidity);
    const double elevation =
        std::max(std::asin(std::clamp(settings.toSun.y, -1.0, 1.0)), kMinElevation);
    const double azimuth = std::atan2(settings.toSun.x, settings.toSun.z);
    mToSun = {
        std::cos(elevation) * std::sin(azimuth),
        std::sin(elevation),
        std::cos(elevation) * std::cos(azimuth)};
    mPerez[0] = {-0.0193 * t - 0.2592, -0.0167 * t - 0.2608, 0.1787 * t - 1.4630};
    mPerez[1] = {-0.0665 * t + 0.0008, -0.0950 * t + 0.0092, -0.3554 * t + 0.4275};
    mPerez[2] = {-0.0004 * t + 0.2125, -0.0079 * t + 0.2102, -0.0227 * t + 5.3251};
    mPerez[3] = {-0.0641 * t - 0.8989, -0.0441 * t - 1.6537, 0.1206 * t - 2.5771};
    mPerez[4] = {-0.0033 * t + 0.0452, -0.0109 * t + 0.0529, -0.0670 * t + 0.3703};
    const double theta = pi / 2.0 - elevation;
    mZenith = zenithOf(t, theta) / evaluatePerez(mPerez, 1.0, theta);
    const dvec3 sun(settings.sunIlluminance);
    mScale = settings.intensity * std::max(luminanceOf(sun), 0.0) / directIlluminance(elevation);
    // The ground is as bright as what falls on it: the sky's half sphere, in steps of five degrees.
    dvec3 falling = sun * mToSun.y;
    constexpr int kSteps = 18;
    for (int row = 0; row < kSteps; ++row)
        for (int column = 0; column < 4 * kSteps; ++column) {
            const dvec3 direction =
                directionAt({(column + 0.5) / (4.0 * kSteps), (row + 0.5) / (2.0 * kSteps)});
            falling += dvec3(aboveHorizon(direction)) *
                       (direction.y * texelSolidAngle(uint32_t(row), 4 * kSteps, 2 * kSteps));
        }
    mGround = settings.groundAlbedo * math::vec3(falling / pi);
    const double skyNearSun = luminanceOf(dvec3(aboveHorizon(mToSun)));
    const dvec3 disc = sun / (pi * kSunRadius * kSunRadius);
    const double bright = std::max(luminanceOf(disc), 1.0e-12);
    mDisc = math::vec3(disc * std::min(kMaxDiscRatio * skyNearSun / bright, 1.0));
}

math::vec3 Sky::aboveHorizon(math::dvec3 direction) const {
    const double cosine = std::max(direction.y, 1.0e-3);
    const double gamma = std::acos(std::clamp(glm::dot(direction, mToSun), -1.0, 1.0));
    dvec3 color = mZenith * evaluatePerez(mPerez, cosine, gamma);
    color.z = std::max(color.z, 0.0);
    return math::vec3(toRgb(color) * mScale);
}

math::vec3 Sky::radianceOf(math::dvec3 direction) const {
    // Haze hides the horizon itself: over a degree and a half the one turns into the other.
    constexpr double kHaze = 0.026;
    if (direction.y >= 0.0)
        return aboveHorizon(direction);
    const dvec3 level =
        glm::normalize(dvec3(direction.x, 0.0, direction.z) + dvec3(0.0, 1.0e-9, 0.0));
    const double share = std::clamp(-direction.y / kHaze, 0.0, 1.0);
    if (share == 1.0)
        return mGround;
    return glm::mix(
        aboveHorizon(level), mGround, static_cast<float>(share * share * (3.0 - 2.0 * share))
    );
}

namespace {

void addDisc(const Sky& sky, image::Image& picture) {
    constexpr int kFine = 8; // places across a texel
    const math::dvec2 centre = placeOf(sky.toSun());
    const double reach = kSunRadius / pi * picture.height + 1.0;
    const int first = std::max(int(centre.y * picture.height - reach), 0);
    const int last = std::min(int(centre.y * picture.height + reach), int(picture.height) - 1);
    const double cosRadius = std::cos(kSunRadius);
    for (int y = first; y <= last; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            int inside = 0;
            for (int i = 0; i < kFine * kFine; ++i) {
                const dvec3 direction = directionAt(
                    {(x + (i % kFine + 0.5) / kFine) / picture.width,
                     (y + (i / kFine + 0.5) / kFine) / picture.height}
                );
                inside += glm::dot(direction, sky.toSun()) >= cosRadius;
            }
            const float share = float(inside) / float(kFine * kFine);
            for (uint32_t c = 0; c < 3; ++c) {
                float& value = picture.at(x, uint32_t(y), c);
                value += share * (sky.discRadiance()[int(c)] - value);
            }
        }
}

} // namespace

SkyPictures drawSky(const SkySettings& settings, uint32_t width) {
    const Sky sky(settings);
    SkyPictures pictures{image::Image(width / 4, width / 8, 3), image::Image(width, width / 2, 3)};
    const auto draw = [](image::Image& picture, const auto& radiance) {
        for (uint32_t y = 0; y < picture.height; ++y)
            for (uint32_t x = 0; x < picture.width; ++x) {
                const math::dvec2 place((x + 0.5) / picture.width, (y + 0.5) / picture.height);
                const math::vec3 color(radiance(directionAt(place)));
                for (uint32_t c = 0; c < 3; ++c)
                    picture.at(x, y, c) = color[int(c)];
            }
    };
    draw(pictures.light, [&](dvec3 direction) { return sky.radianceOf(direction); });
    draw(pictures.background, [&](dvec3 direction) {
        return sampleDirection(pictures.light, direction);
    });
    addDisc(sky, pictures.background);
    return pictures;
}

} // namespace shutter::environment
