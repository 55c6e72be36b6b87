// SPDX-License-Identifier: MIT
#include "engine/environment/directions.h"
#include "engine/environment/prefilter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace shutter::environment {
namespace {

using math::dvec3;

image::Image draw(uint32_t width, double (*radiance)(dvec3)) {
    image::Image picture(width, width / 2, 3);
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            for (uint32_t c = 0; c < 3; ++c)
                picture.at(x, y, c) =
                    float(radiance(directionAt({(x + 0.5) / width, (y + 0.5) / picture.height})));
    return picture;
}

/// Karis 2013 by the sum over all texels: light l about n = v = r, weighted by GGX's distribution
/// of the half vector (as the density of l) and by n.l.
double integrate(const image::Image& picture, dvec3 axis, double roughness) {
    const double alpha2 = std::pow(roughness, 4.0);
    double sum = 0.0;
    double weights = 0.0;
    for (uint32_t y = 0; y < picture.height; ++y)
        for (uint32_t x = 0; x < picture.width; ++x) {
            const dvec3 l = directionAt({(x + 0.5) / picture.width, (y + 0.5) / picture.height});
            const double cosine = glm::dot(l, axis);
            if (cosine <= 0.0)
                continue;
            const double nDotH = glm::dot(glm::normalize(l + axis), axis);
            const double d = nDotH * nDotH * (alpha2 - 1.0) + 1.0;
            // D nDotH / (4 vDotH), and v = n.
            const double weight =
                alpha2 / (d * d) * cosine * texelSolidAngle(y, picture.width, picture.height);
            sum += weight * picture.at(x, y, 0);
            weights += weight;
        }
    return sum / weights;
}

TEST(Prefilter, EachLevelIsHalfAsWideDownToTheRoughest) {
    const auto levels = prefilterMirrored(draw(512, [](dvec3) { return 2.0; }));
    ASSERT_EQ(levels.size(), 5u);
    for (size_t i = 0; i < levels.size(); ++i) {
        EXPECT_EQ(levels[i].width, 512u >> i);
        EXPECT_EQ(levels[i].height, 256u >> i);
        for (const float value : levels[i].pixels)
            ASSERT_NEAR(value, 2.0f, 1e-4f) << i;
    }
}

TEST(Prefilter, AWidePictureIsMirroredNoSharperThanTheLimitAndASmallOneAsItIs) {
    EXPECT_EQ(prefilterMirrored(draw(2048, [](dvec3) { return 1.0; })).front().width, kMirrorWidth);
    const auto small = prefilterMirrored(draw(8, [](dvec3 d) { return 1.0 + d.y; }));
    ASSERT_EQ(small.size(), 1u);
    EXPECT_EQ(small.front().width, 8u);
}

TEST(Prefilter, IsTheIntegralOverGgx) {
    const image::Image picture = draw(256, [](dvec3 d) {
        return 1.0 + (d.x > 0.3 ? 2.0 : 0.0) + std::max(d.y, 0.0) * (d.z < 0.0 ? 1.0 : 0.2);
    });
    const auto levels = prefilterMirrored(picture);
    ASSERT_EQ(levels.size(), 4u);
    for (size_t i = 1; i < levels.size(); ++i)
        for (int k = 0; k < 24; ++k) {
            const math::dvec2 uv((k + 0.5) / 24.0, ((k * 5) % 24 + 0.5) / 24.0);
            const dvec3 axis = directionAt(uv);
            EXPECT_NEAR(
                sampleDirection(levels[i], axis).x, integrate(picture, axis, double(i) / 3.0), 0.16
            ) << "level "
              << i << " place " << k;
        }
}

TEST(Prefilter, APoleShowsNoSeam) {
    // The roughest level about the pole: what lies in all its columns must agree.
    const auto levels =
        prefilterMirrored(draw(256, [](dvec3 d) { return 1.0 + (d.x > 0.0 ? 1.0 : 0.0); }));
    const image::Image& roughest = levels.back();
    for (uint32_t x = 0; x < roughest.width; ++x)
        EXPECT_NEAR(roughest.at(x, 0, 0), 1.5, 0.12) << x;
}

} // namespace
} // namespace shutter::environment
