// SPDX-License-Identifier: MIT
// The disc of a bright point: finite at its middle, and of the light of its point.
#include "engine/math/math.h"
#include "shaders/common/shim.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace shutter::shader {

using glm::atan;

/// GLSL leaves the angle of 0, 0 undefined, which C++ defines.
inline float atan(float y, float x) {
    return x == 0.0f && y == 0.0f ? std::numeric_limits<float>::quiet_NaN() : std::atan2(y, x);
}

} // namespace shutter::shader

#include "shaders/common/disc_share.glsl"

namespace shutter {
namespace {

using math::vec2;
using shader::Aperture;

TEST(DiscShare, TheMiddleOfABladedDiscIsInside) {
    for (const uint32_t blades : {0u, 3u, 6u})
        for (const float confusion : {-8.0f, 8.0f}) {
            const Aperture aperture{blades, 0.4f, 0.0f, 1.0f};
            const float inside = shader::insideDisc(aperture, vec2(0.0f), confusion);
            EXPECT_TRUE(std::isfinite(inside)) << blades;
            EXPECT_GT(inside, 2.0f) << blades;
        }
}

TEST(DiscShare, ADiscHasTheLightOfItsPoint) {
    for (const Aperture& aperture :
         {Aperture{0, 0.0f, 0.0f, 1.0f},
          Aperture{0, 0.0f, 0.0f, 0.5f},
          Aperture{0, 0.0f, 0.0f, 2.0f},
          Aperture{3, 0.4f, 0.0f, 1.0f},
          Aperture{6, 1.0f, 0.3f, 1.5f}})
        for (const float narrowest : {-3.0f, 8.0f, 40.0f}) // 3 pixels is the smallest
            for (const float width : {0.5f, 2.0f}) {
                const float confusion = narrowest / std::min(aperture.squeeze, 1.0f);
                const float area = shader::apertureArea(aperture);
                double light = 0.0;
                for (int y = -90; y < 90; ++y)
                    for (int x = -90; x < 90; ++x)
                        light += double(shader::shareOfDisc(
                            aperture, vec2(float(x) + 0.3f, float(y) - 0.4f), confusion, area, width
                        ));
                EXPECT_NEAR(light, 1.0, aperture.blades == 3 && narrowest < 8.0f ? 0.01 : 0.005)
                    << aperture.blades << " " << aperture.squeeze << " " << confusion << " "
                    << width;
            }
}

} // namespace
} // namespace shutter
