// SPDX-License-Identifier: MIT
#include "engine/image/metric_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace shutter::image;

namespace {

Plane makePlane(uint32_t width, uint32_t height) {
    Plane plane(width, height);
    for (size_t i = 0; i < plane.values.size(); ++i)
        plane.values[i] = float((i * 37 + i * i * 11) % 101);
    return plane;
}

/// The definition, one pixel.
float filterDirectly(const Plane& plane, const Kernel& kernel, int x, int y, int dx, int dy) {
    const int radius = int(kernel.size()) / 2;
    float sum = 0.0f;
    for (int o = -radius; o <= radius; ++o) {
        const int fromX = std::clamp(x + o * dx, 0, int(plane.width) - 1);
        const int fromY = std::clamp(y + o * dy, 0, int(plane.height) - 1);
        sum +=
            kernel[size_t(o + radius)] * plane.values[size_t(fromY) * plane.width + size_t(fromX)];
    }
    return sum;
}

} // namespace

TEST(Convolution, FollowsTheDefinitionOnPicturesSmallerAndLargerThanTheKernel) {
    const Kernel kernel{0.5f, -1.0f, 3.0f, 2.0f, 0.25f};
    for (const uint32_t width : {1u, 2u, 5u, 13u})
        for (const uint32_t height : {1u, 3u, 9u}) {
            const Plane plane = makePlane(width, height);
            const Plane alongX = filterAlongX(plane, kernel);
            const Plane alongY = filterAlongY(plane, kernel);
            for (size_t i = 0; i < plane.values.size(); ++i) {
                const int x = int(i % width);
                const int y = int(i / width);
                EXPECT_EQ(alongX.values[i], filterDirectly(plane, kernel, x, y, 1, 0));
                EXPECT_EQ(alongY.values[i], filterDirectly(plane, kernel, x, y, 0, 1));
            }
        }
}

TEST(Convolution, ANanReachesTheKernelsRadius) {
    Plane plane(9, 1);
    plane.values[4] = std::numeric_limits<float>::quiet_NaN();
    const Plane filtered = filterAlongX(plane, {0.0f, 1.0f, 0.0f});
    for (size_t x = 0; x < 9; ++x)
        EXPECT_EQ(std::isnan(filtered.values[x]), x >= 3 && x <= 5) << x;
}

TEST(Convolution, NothingFilteredIsNothing) {
    EXPECT_TRUE(filterAlongX(Plane(0, 4), {1.0f}).values.empty());
    EXPECT_TRUE(filterAlongY(Plane(4, 0), {1.0f}).values.empty());
}

TEST(ConvolutionDeathTest, AKernelNeedsAMiddle) {
    EXPECT_DEATH((void)filterAlongX(Plane(3, 3), {1.0f, 1.0f}), "2 weights");
    EXPECT_DEATH((void)filterAlongY(Plane(3, 3), {}), "0 weights");
}
