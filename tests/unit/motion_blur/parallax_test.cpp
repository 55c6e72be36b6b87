// SPDX-License-Identifier: MIT
// How differently the surfaces of an entity move by their depth, and the bins that tell them apart.
#include "engine/math/layer_tables.h"
#include "shaders/motion_blur/parallax_bins.glsl"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace shutter {
namespace {

using math::dmat4;
using math::dvec3;

constexpr math::uvec2 kParallaxSizePx{640, 360};
constexpr double kParallaxFov = 0.9;
const float kFocalPx = static_cast<float>(180.0 / std::tan(kParallaxFov / 2.0));

/// A camera at open, half way and close; the raster is at the first of them.
class Exposure {
  public:
    explicit Exposure(const std::vector<dmat4>& viewsFromWorld, bool perspective = true) {
        dmat4 clip = perspective ? glm::perspective(kParallaxFov, 640.0 / 360.0, 0.1, 100.0)
                                 : glm::ortho(-4.0, 4.0, 2.25, -2.25, 0.1, 100.0);
        if (perspective)
            clip[1][1] *= -1.0;
        const dmat4 picture = math::pictureFromView(clip, kParallaxSizePx, math::dvec2(0.0));
        for (const dmat4& view : viewsFromWorld)
            mPictures.push_back(picture * view);
        mLayers.times.assign(mPictures.size(), 0.0f);
        mLayers.isPerspective = perspective;
        mBuilder.emplace(mPictures.front(), mPictures, perspective, 3);
    }

    math::LayerBuilder& builder() { return *mBuilder; }

    math::InstantLayers& layers() { return mLayers; }

    /// By row: three, and the sky.
    std::vector<float> parallaxes() {
        return math::findParallaxes(mBuilder->take(), mLayers, kParallaxSizePx);
    }

  private:
    std::vector<dmat4> mPictures;
    math::InstantLayers mLayers;
    std::optional<math::LayerBuilder> mBuilder;
};

dmat4 moved(const dvec3& by) {
    return glm::translate(dmat4(1.0), by);
}

TEST(Parallax, ACameraThatSlidesHasItsWayInPixelsTimesMetres) {
    Exposure exposure({moved({0, 0, 0}), moved({0.05, 0, 0}), moved({0.1, 0, 0})});
    const std::vector<float> found = exposure.parallaxes();
    ASSERT_EQ(found.size(), 4u);
    EXPECT_NEAR(found[0], kFocalPx * 0.1f, 1.0e-3f);
    EXPECT_EQ(found[3], 0.0f) << "the sky";
}

TEST(Parallax, APanARollAndAStaticCameraHaveNone) {
    const dmat4 turned = glm::rotate(dmat4(1.0), 0.1, dvec3(0.3, 1.0, 0.2));
    for (const dmat4& view : {turned, dmat4(1.0)})
        EXPECT_NEAR(Exposure({dmat4(1.0), view, view}).parallaxes()[0], 0.0f, 1.0e-3f);
}

TEST(Parallax, ADollyHasThatOfThePicturesCorner) {
    Exposure exposure({moved({0, 0, 0}), moved({0, 0, 0.1}), moved({0, 0, 0.2})});
    EXPECT_NEAR(exposure.parallaxes()[0], std::hypot(320.0f, 180.0f) * 0.2f, 0.01f);
}

TEST(Parallax, BeforeAnOrthographicCameraOnlyTurnsHaveOne) {
    const dmat4 turned = glm::rotate(dmat4(1.0), 0.1, dvec3(0, 1, 0));
    Exposure turns({dmat4(1.0), turned, turned}, false);
    EXPECT_NEAR(turns.parallaxes()[0], 80.0f * std::tan(0.1f), 0.5f);
    Exposure slides({dmat4(1.0), moved({0.3, 0, 0}), moved({0.6, 0, 0})}, false);
    EXPECT_NEAR(slides.parallaxes()[0], 0.0f, 1.0e-4f);
}

TEST(Parallax, AMoverHasItsOwnAndWhatDeformsOrIsNowhereHasNone) {
    Exposure exposure({dmat4(1.0), dmat4(1.0), dmat4(1.0)});
    const auto turning = [](size_t instant) {
        return glm::rotate(moved({0, 0, -5}), 0.1 * static_cast<double>(instant), dvec3(0, 1, 0));
    };
    exposure.builder().addMover(0, turning(0), turning);
    exposure.builder().setMover(1, shader::kDeformedMover);
    exposure.builder().addMover(2, dmat4(1.0), [](size_t) { return dmat4(0.0); });
    const std::vector<float> found = exposure.parallaxes();
    EXPECT_GT(found[0], 100.0f) << "its near side and its far side move apart";
    EXPECT_EQ(found[1], 0.0f);
    EXPECT_EQ(found[2], 0.0f);
}

TEST(Parallax, CornersBehindTheCameraDoNotCountAndWhatIsNotFiniteHasNone) {
    const dmat4 around = glm::rotate(dmat4(1.0), 3.0, dvec3(0, 1, 0));
    Exposure turns({dmat4(1.0), around, moved({0.1, 0, 0}) * around});
    EXPECT_TRUE(std::isfinite(turns.parallaxes()[0]));
    Exposure leaps({dmat4(1.0), moved({1.0e38, 0, 0}), moved({1.0e38, 0, 0})});
    const float found = leaps.parallaxes()[0];
    EXPECT_TRUE(std::isfinite(found));
}

TEST(Parallax, PlacesOfALensAddTheirReach) {
    Exposure exposure({dmat4(1.0), dmat4(1.0), dmat4(1.0)});
    math::InstantLayers& layers = exposure.layers();
    layers.times.assign(3 * size_t{shader::kLensSets}, 0.0f);
    layers.lens.assign(layers.times.size(), math::vec4(0, 0, 3.0f, 4.0f));
    const std::vector<float> found = exposure.parallaxes();
    EXPECT_FLOAT_EQ(found[0], 5.0f);
    EXPECT_EQ(found[3], 0.0f) << "the sky";
}

TEST(ParallaxBins, RiseWithTheParallaxAndBeginWhereTheyEnd) {
    EXPECT_EQ(shader::parallaxBin(0.0f), 0u);
    EXPECT_EQ(
        shader::parallaxBin(std::numeric_limits<float>::infinity()), shader::kParallaxBins - 1
    );
    uint32_t last = 0;
    for (float parallax = 0.01f; parallax < 1000.0f; parallax *= 1.01f) {
        const uint32_t bin = shader::parallaxBin(parallax);
        EXPECT_LE(last, bin);
        EXPECT_LE(bin, last + 1) << "no bin is left out";
        last = bin;
    }
    EXPECT_EQ(last, shader::kParallaxBins - 1);
    for (uint32_t bin = 0; bin < shader::kParallaxBins; ++bin)
        EXPECT_EQ(shader::parallaxBin(shader::parallaxOfBin(float(bin) + 0.5f)), bin);
}

/// Depths of all sizes, from the camera's plane to infinity.
std::vector<float> depths() {
    std::vector<float> made{0.0f, std::numeric_limits<float>::infinity()};
    for (float depth = 1.0e-3f; depth < 1.0e5f; depth *= 1.003f)
        made.push_back(depth);
    return made;
}

uint32_t binOfDepth(float depth, float perAlong, bool perspective) {
    return shader::parallaxBin(
        perspective ? perAlong / std::max(depth, 1.0e-6f) : perAlong * depth
    );
}

TEST(ParallaxBins, ADepthIsWithinTheRangeOfItsBinAndOfNoneThatAnEmptyBinSeparates) {
    for (const bool perspective : {true, false})
        for (const float perAlong : {0.3f, 23.0f, 4000.0f})
            for (const float depth : depths()) {
                const uint32_t bin = binOfDepth(depth, perAlong, perspective);
                const auto isWithin = [&](uint32_t low, uint32_t high) {
                    return shader::isWithin(
                        depth, shader::rangeOfBins(low, high, perAlong, perspective)
                    );
                };
                ASSERT_TRUE(isWithin(bin, bin)) << depth << " in bin " << bin;
                ASSERT_TRUE(isWithin(0, shader::kParallaxBins - 1)) << depth;
                ASSERT_FALSE(bin >= 2 && isWithin(0, bin - 2)) << depth << " in bin " << bin;
                ASSERT_FALSE(
                    bin + 2 < shader::kParallaxBins && isWithin(bin + 2, shader::kParallaxBins - 1)
                ) << depth;
                ASSERT_TRUE(shader::isWithin(depth, shader::kAnyRange));
            }
}

TEST(ParallaxBins, NoDepthIsWithinTwoRangesThatAnEmptyBinSeparates) {
    for (const bool perspective : {true, false})
        for (const float depth : depths())
            for (uint32_t gap = 1; gap + 1 < shader::kParallaxBins; ++gap) {
                const uint32_t below = shader::rangeOfBins(0, gap - 1, 23.0f, perspective);
                const uint32_t above =
                    shader::rangeOfBins(gap + 1, shader::kParallaxBins - 1, 23.0f, perspective);
                ASSERT_FALSE(shader::isWithin(depth, below) && shader::isWithin(depth, above))
                    << depth << ", gap " << gap;
            }
}

} // namespace
} // namespace shutter
