// SPDX-License-Identifier: MIT
// Tiles of a picture in which shadows of movers are looked up.
#include "engine/extract/shadow_tiles.h"
#include "shaders/render/shadow_filter.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <ranges>

namespace shutter::extract {

namespace {

using math::dvec3;
using math::dvec4;

constexpr uint32_t kTile = shader::kShadowTilePx;

class ShadowTilesOfScenes : public testing::Test {
  protected:
    double uniform(double least, double most) {
        return std::uniform_real_distribution(least, most)(mRandom);
    }

    dvec3 pointIn(const math::Bounds& box) {
        return {
            uniform(box.min.x, box.max.x),
            uniform(box.min.y, box.max.y),
            uniform(box.min.z, box.max.z)};
    }

    /// A camera somewhere in the scene, or beside it, that looks at a place in it.
    ShadowPicture makePicture() {
        ShadowPicture picture;
        picture.sizePx = {333, 177}; // not of whole tiles
        picture.scene = {dvec3(-20, -2, -30), dvec3(25, 6, 10)};
        const dvec3 eye = pointIn({dvec3(-40, 0, -40), dvec3(40, 20, 40)});
        picture.clipFromWorld =
            math::clipFromViewPerspective(uniform(0.3, 1.2), 333.0 / 177.0, 0.1) *
            glm::lookAt(eye, pointIn(picture.scene), dvec3(0, 1, 0));
        return picture;
    }

    LightPlace makeLight() {
        const dvec3 way(uniform(-1, 1), uniform(0.05, 1), uniform(-1, 1));
        return uniform(0, 1) < 0.5 ? LightPlace(glm::normalize(way), 0.0)
                                   : LightPlace(8.0 * way, 1.0);
    }

    std::mt19937 mRandom{7};
};

/// Pixels; nothing: it is not in the picture.
std::optional<math::dvec2> project(const ShadowPicture& picture, const dvec3& point) {
    const dvec4 clip = picture.clipFromWorld * dvec4(point, 1.0);
    const math::dvec2 size(picture.sizePx);
    const math::dvec2 at = (math::dvec2(clip) / clip.w * 0.5 + 0.5) * size;
    const bool isSeen =
        clip.w > 0.0 && at.x >= 0.0 && at.y >= 0.0 && at.x < size.x && at.y < size.y;
    return isSeen ? std::optional(at) : std::nullopt;
}

bool isMarked(const ShadowTiles& tiles, const math::dvec2& pixel, uint32_t mover) {
    const uint32_t at = uint32_t(pixel.y) / kTile * tiles.across() + uint32_t(pixel.x) / kTile;
    return (tiles.movers().at(at) >> mover & 1u) != 0;
}

bool isShaded(const dvec3& point, const LightPlace& light, const Sphere& caster) {
    const dvec3 way = light.w == 0.0 ? dvec3(light) : dvec3(light) - point;
    return shader::meetsSphere(
        math::vec3(point),
        math::vec3(glm::normalize(way)),
        light.w == 0.0 ? 1.0e15f : float(glm::length(way)),
        math::vec4(math::vec3(caster.centre), float(caster.radius))
    );
}

TEST_F(ShadowTilesOfScenes, HoldEveryPointThatAShadowMayReach) {
    size_t shaded = 0;
    size_t spared = 0;
    for (int scene = 0; scene < 400; ++scene) {
        const ShadowPicture picture = makePicture();
        const LightPlace light = makeLight();
        const Sphere caster{pointIn(picture.scene), uniform(0.05, 1.5)};
        ShadowTiles tiles(picture.sizePx);
        tiles.mark(3, boundShadow(picture, caster, light));
        spared += size_t(std::ranges::count(tiles.movers(), 0u));
        for (int i = 0; i < 400; ++i) {
            // Half of the receivers are behind the caster's outline.
            dvec3 point = pointIn(picture.scene);
            if (i % 2 == 0) {
                const dvec3 near =
                    caster.centre + caster.radius * glm::normalize(pointIn({dvec3(-1), dvec3(1)}));
                const dvec3 way = light.w == 0.0 ? -dvec3(light) : near - dvec3(light);
                point = near + way * uniform(0.0, light.w == 0.0 ? 40.0 : 3.0);
                if (point != glm::clamp(point, picture.scene.min, picture.scene.max))
                    continue;
            }
            const auto pixel = project(picture, point);
            if (!pixel || !isShaded(point, light, caster))
                continue;
            ++shaded;
            ASSERT_TRUE(isMarked(tiles, *pixel, 3)) << "scene " << scene;
        }
    }
    EXPECT_GT(shaded, 5000u);
    EXPECT_GT(spared, 400u * 66u / 4u) << "tiles that nothing reaches are marked";
}

TEST_F(ShadowTilesOfScenes, AShadowGrowsBelowALamp) {
    ShadowPicture picture{{}, {333, 177}, {dvec3(-3, 0, -13), dvec3(3, 4, -7)}};
    picture.clipFromWorld = math::clipFromViewPerspective(0.8, 333.0 / 177.0, 0.1) *
                            glm::lookAt(dvec3(0, 1, 0), dvec3(0, 1, -1), dvec3(0, 1, 0));
    const LightPlace lamp(0, 4, -10, 1);
    const Sphere caster{{0, 3, -10}, 0.25}; // whose shadow is 2 metres wide on the floor
    const auto box = boundShadow(picture, caster, lamp);
    ASSERT_TRUE(box);
    for (const double side : {-1.0, 1.0}) {
        const dvec3 edge(side, 0, -10);
        ASSERT_TRUE(isShaded(edge, lamp, caster));
        const auto pixel = project(picture, edge);
        ASSERT_TRUE(pixel);
        EXPECT_GE(pixel->x, box->min.x);
        EXPECT_LE(pixel->x, box->max.x);
    }
}

TEST_F(ShadowTilesOfScenes, KeepMoversApart) {
    ShadowTiles tiles({4 * kTile, 2 * kTile + 1});
    tiles.mark(0, PixelBox{{0.0, 0.0}, {kTile - 1.0, 1.0}});
    tiles.mark(31, PixelBox{{2.0 * kTile, -9.0}, {9000.0, 1.5 * kTile}});
    tiles.mark(5, PixelBox{{-50.0, 0.0}, {-1.0, 1.0}}); // left of the picture
    const uint32_t last = 1u << 31;
    EXPECT_EQ(tiles.across(), 4u);
    EXPECT_EQ(
        tiles.movers(), (std::vector<uint32_t>{1, 0, last, last, 0, 0, last, last, 0, 0, 0, 0})
    );
}

TEST_F(ShadowTilesOfScenes, MayBeAnywhereWhereThereIsNoBox) {
    ShadowPicture picture = makePicture();
    picture.clipFromWorld = math::clipFromViewPerspective(0.8, 333.0 / 177.0, 0.1);
    const LightPlace sun(0.0, 1.0, 0.0, 0.0);
    EXPECT_TRUE(boundShadow(picture, {{0, 0, -9}, 1.0}, sun));
    EXPECT_FALSE(boundShadow(picture, {{0, 0, -9}, 10.0}, sun)) << "around the camera";
    EXPECT_FALSE(boundShadow(picture, {{0, 0, -9}, 1.0}, {0, 0, -9.5, 1})) << "around the light";
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(boundShadow(picture, {{nan, 0, -9}, 1.0}, sun));
    ShadowTiles tiles(picture.sizePx);
    tiles.mark(1, std::nullopt);
    EXPECT_EQ(std::ranges::count(tiles.movers(), 2u), 11 * 6);
}

TEST_F(ShadowTilesOfScenes, AShadowIsAsWideAsTheCameraIsNearToIt) {
    ShadowPicture picture = makePicture();
    picture.scene = {dvec3(-20, 0, -40), dvec3(20, 10, 0)};
    picture.eye = {0, 2, 0};
    picture.pixelFootprint = {0.01, 0.0};
    const Sphere caster{{0, 2, -20.5}, 0.5};
    // Straight down the shadow is nowhere nearer than the caster.
    EXPECT_NEAR(findShadowWidth(picture, caster, {0, 1, 0}), 1.0 / (0.01 * 20.0), 1e-9);
    // The sun is behind it, and its shadow comes as near to the camera as its radius.
    const dvec3 low = glm::normalize(dvec3(0, 0.05, -1));
    EXPECT_GT(findShadowWidth(picture, caster, low), 150.0);
    // It ends where the scene does.
    picture.scene.max.z = -15.0;
    EXPECT_LT(findShadowWidth(picture, caster, low), 8.0);
    // Behind the caster the shadow goes away from the camera.
    EXPECT_NEAR(findShadowWidth(picture, caster, -low), 1.0 / (0.01 * 20.0), 1e-9);
    picture.eye = caster.centre;
    EXPECT_FALSE(std::isfinite(findShadowWidth(picture, caster, {0, 1, 0}))) << "around the camera";
    picture.pixelFootprint = {0.0, 0.02};
    EXPECT_NEAR(findShadowWidth(picture, caster, {0, 1, 0}), 50.0, 1e-9) << "orthographic";
}

} // namespace

} // namespace shutter::extract
