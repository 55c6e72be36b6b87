// SPDX-License-Identifier: MIT
// The longest motion of each entity on the device against a loop over the pixels.
#include "engine/render/longest_motion.h"
#include "tests/gpu/effect_rig.h"
#include "tests/support/gpu_fixture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace shutter {
namespace {

class LongestMotion : public test::GpuTest {};

constexpr uint32_t kWidth = 53; // the last groups hang over
constexpr uint32_t kHeight = 29;
constexpr uint32_t kRows = 7; // row 6 has no pixels

struct Scene {
    image::Image motionDepth{kWidth, kHeight, 4};
    image::Image id{kWidth, kHeight, 1};
    std::vector<float> longest = std::vector<float>(kRows + 1);

    Scene() {
        std::mt19937 random(11);
        std::uniform_real_distribution<float> component(-30.0f, 30.0f);
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x) {
                // Areas larger than a group, and a corner where every pixel is another's.
                const uint32_t row = x > 40 ? random() % (kRows + 1) : (x / 17 + 2 * (y / 15)) % 6;
                const bool isSky = row == kRows || row == 6;
                const float speed = x % 3 == 0 ? std::numeric_limits<float>::quiet_NaN()
                                               : component(random) / float(row + 1);
                motionDepth.at(x, y, 0) = speed;
                motionDepth.at(x, y, 1) = 0.5f * speed;
                id.at(x, y, 0) = isSky ? 4.0e9f : float(row);
                if (std::isnan(speed))
                    continue;
                float& own = longest[isSky ? kRows : row];
                own = std::max(own, std::hypot(speed, 0.5f * speed));
            }
    }
};

TEST_F(LongestMotion, ItIsThatOfThePixels) {
    const Scene scene;
    render::LongestMotion effect(device());
    for (int again = 0; again < 2; ++again) { // a frame's numbers are its own
        test::GraphRig rig(device());
        const auto motionDepth = rig.upload(scene.motionDepth);
        test::EffectRig around(rig, motionDepth, kWidth, kHeight);
        around.gbuffer.motionDepth = motionDepth;
        around.gbuffer.entityId = rig.uploadIds(scene.id);
        around.frame.entities.resize(kRows);
        effect.declare(around.context);
        test::run(rig);
        const std::vector<float> found = effect.take();
        ASSERT_EQ(found.size(), scene.longest.size());
        for (size_t row = 0; row < found.size(); ++row)
            EXPECT_NEAR(found[row], scene.longest[row], 1e-5f * scene.longest[row]) << row;
        EXPECT_EQ(found[6], 0.0f);
        EXPECT_GT(found[kRows], 0.0f);
    }
}

} // namespace
} // namespace shutter
