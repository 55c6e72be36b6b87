// SPDX-License-Identifier: MIT
// Lookup of receivers in the layers of movers over the exposure, and the tiles.
#include "modules/shadows/shadow_runs.h"
#include "modules/shadows/shadow_tiles.h"
#include "shaders/shadows/shadow_filter.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <ranges>

namespace shutter::shadows {
namespace {

using math::dmat4;
using math::dvec3;
using math::dvec4;

constexpr uint32_t kLayerSize = 128;

/// A mover that turns about an axis through its middle and goes somewhere.
struct Way {
    dvec3 velocity{0.0}; ///< over the exposure, metres
    dvec3 axis{0.0, 1.0, 0.0};
    double turn = 0.0; ///< over the exposure, radians
};

/// A mover of two metres' radius before a light, over an exposure.
struct MoverBeforeLight {
    ShadowCaster caster;
    CasterPath path;
    std::vector<MoverLayer> layers;
    dvec3 toLight{0.0, 1.0, 0.0};

    /// \param parts layers of parts of the exposure
    MoverBeforeLight(const Way& way, const dvec3& light, uint32_t count, uint32_t parts)
        : toLight(light) {
        caster.sphere = {{1.0, 3.0, -8.0}, 2.0};
        path.swept = {caster.sphere.centre, caster.sphere.radius + 0.5 * glm::length(way.velocity)};
        path.instants = follow(way, count);
        layers.push_back({dmat4(1.0), fitLayer(toLight, caster.sphere, kLayerSize), kLayerSize, 0});
        for (const CasterInstant& part : follow(way, parts)) {
            const dvec3 seen(seeLight(part.rasterFromInstant, LightPlace(toLight, 0.0)));
            layers.push_back(
                {part.rasterFromInstant,
                 fitLayer(seen, caster.sphere, kLayerSize),
                 kLayerSize,
                 uint32_t(layers.size()) * kLayerSize * kLayerSize}
            );
        }
    }

    [[nodiscard]] std::vector<CasterInstant> follow(const Way& way, uint32_t count) const {
        std::vector<CasterInstant> instants;
        for (uint32_t i = 0; i < count; ++i) {
            const double s = (i + 0.5) / count - 0.5;
            const dmat4 motion =
                glm::translate(dmat4(1.0), s * way.velocity + caster.sphere.centre) *
                glm::rotate(dmat4(1.0), s * way.turn, way.axis) *
                glm::translate(dmat4(1.0), -caster.sphere.centre);
            instants.push_back({glm::inverse(motion), 0.0f});
        }
        return instants;
    }

    [[nodiscard]] uint32_t runInstants() const {
        return findRunInstants(caster, path, layers, toLight);
    }

    [[nodiscard]] std::vector<shader::CasterSpan> runs(const dvec3& eye = dvec3(0.0)) const {
        return makeRuns(caster, path, layers, toLight, runInstants(), eye);
    }

    /// The layer for an instant of the exposure.
    [[nodiscard]] const MoverLayer& layerOf(const shader::CasterSpan& run) const {
        return *std::find_if(layers.begin(), layers.end(), [&](const MoverLayer& layer) {
            return layer.firstTexel == run.firstTexel;
        });
    }
};

dvec3 apply(
    const math::vec4 rows[3], const math::vec4 steps[3], uint32_t instant, const dvec3& point
) {
    dvec3 at;
    for (int i = 0; i < 3; ++i)
        at[i] = glm::dot(dvec4(rows[i]) + double(instant) * dvec4(steps[i]), dvec4(point, 1.0));
    return at;
}

class RandomShadows : public ::testing::Test {
  protected:
    double uniform(double from, double to) {
        return std::uniform_real_distribution(from, to)(mRandom);
    }

    dvec3 direction() {
        dvec3 way(0.0);
        while (glm::length(way) < 0.2)
            way = dvec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
        return glm::normalize(way);
    }

    std::mt19937 mRandom{11};
};

class ShadowRuns : public RandomShadows {};

TEST_F(ShadowRuns, RunsMapPointsToTheirPlaceAtEachInstant) {
    size_t lengths[shader::kMaxRunInstants + 1] = {};
    for (int i = 0; i < 300; ++i) {
        const Way way{uniform(0, 3) * direction(), direction(), std::exp(uniform(-4.0, 1.5))};
        const MoverBeforeLight mover(way, direction(), 3 + uint32_t(i % 17), uint32_t(i % 3) * 2);
        const dvec3 eye(uniform(-9, 9), uniform(0, 4), uniform(-9, 9));
        const uint32_t length = mover.runInstants();
        ++lengths[length];
        const auto runs = mover.runs(eye);
        for (uint32_t instant = 0; instant < mover.path.instants.size(); ++instant) {
            const shader::CasterSpan& run = runs.at(1 + instant / length);
            const dmat4& back = mover.path.instants[instant].rasterFromInstant;
            const dmat4 exact = mapToLayer(mover.caster, back, mover.toLight, mover.layerOf(run));
            // A point of the mover at this instant, or one in its shadow.
            const dvec3 point = dvec3(glm::inverse(back) * dvec4(mover.caster.sphere.centre, 1.0)) +
                                uniform(0, 2) * direction() - uniform(0, 20) * mover.toLight;
            const dvec3 wanted(exact * dvec4(point, 1.0));
            const dvec3 found = apply(run.first, run.step, instant % length, point - eye);
            ASSERT_LT(std::abs(found.x - wanted.x), kMaxRunError + 0.01) << i << ": " << length;
            ASSERT_LT(std::abs(found.y - wanted.y), kMaxRunError + 0.01) << i << ": " << length;
            ASSERT_LT(std::abs(found.z - wanted.z) * kLayerSize, kMaxRunError + 0.01) << i;
        }
    }
    for (const uint32_t length : {1u, 2u, 4u})
        EXPECT_GT(lengths[length], 10u) << "runs of " << length << " instants were hardly tried";
}

TEST_F(ShadowRuns, RunsBeginWithTheRasterInstants) {
    const MoverBeforeLight mover({{1, 0, 0}, {0, 0, 1}, 0.4}, direction(), 16, 2);
    const shader::CasterSpan run = mover.runs().front();
    EXPECT_EQ(run.firstTexel, 0u);
    const dvec3 point = mover.caster.sphere.centre + dvec3(0.3, -0.2, 0.5);
    const dvec4 clip = mover.layers.front().view.clipFromWorld * dvec4(point, 1.0);
    const dvec3 found = apply(run.first, run.step, 0, point);
    EXPECT_NEAR(found.x, (0.5 * clip.x + 0.5) * kLayerSize, 1e-3);
    EXPECT_NEAR(found.y, (0.5 * clip.y + 0.5) * kLayerSize, 1e-3);
    EXPECT_NEAR(found.z, clip.z, 1e-5);
    const double scaled = clip.z * (1.0 + double(shader::kDepthScaleRounding));
    EXPECT_GT(found.z, scaled + 0.5 * double(shader::kDepthRounding)) << "without a bias";
    for (const math::vec4& step : run.step)
        EXPECT_EQ(step, math::vec4(0.0f));
}

TEST_F(ShadowRuns, RunsAreAsShortAsTheMoversLayers) {
    const MoverBeforeLight still({}, direction(), 0, 0);
    EXPECT_EQ(still.runInstants(), 0u);
    EXPECT_EQ(still.runs().size(), 1u);
    const Way straight{{2, 0, 0}, {0, 1, 0}, 0.0};
    EXPECT_EQ(MoverBeforeLight(straight, direction(), 16, 0).runInstants(), 4u);
    EXPECT_EQ(MoverBeforeLight(straight, direction(), 16, 4).runInstants(), 4u);
    const MoverBeforeLight mover(straight, direction(), 16, 8);
    EXPECT_EQ(mover.runInstants(), 2u);
    const auto runs = mover.runs();
    ASSERT_EQ(runs.size(), 9u);
    for (uint32_t i = 1; i < runs.size(); ++i)
        EXPECT_EQ(runs[i].firstTexel, i * kLayerSize * kLayerSize);
    // The layer of a run is that of its middle.
    const auto uneven = MoverBeforeLight(straight, direction(), 16, 3).runs();
    ASSERT_EQ(uneven.size(), 5u);
    const std::array<uint32_t, 5> wanted{0, 1, 2, 2, 3};
    for (uint32_t i = 1; i < uneven.size(); ++i)
        EXPECT_EQ(uneven[i].firstTexel / (kLayerSize * kLayerSize), wanted[i]);
}

TEST_F(ShadowRuns, RunsCoverAllInstantsReadAtATime) {
    const Way turning{{0, 0, 0}, {0, 0, 1}, 6.0};
    for (const uint32_t count : {1u, 3u, 5u, 6u, 63u, 64u}) {
        const MoverBeforeLight mover(turning, {0, 1, 0}, count, 0);
        const uint32_t length = mover.runInstants();
        const size_t groups = (count + shader::kMaxRunInstants - 1) / shader::kMaxRunInstants;
        EXPECT_EQ(
            mover.runs().size() - 1,
            length == shader::kMaxRunInstants ? groups : groups * (shader::kMaxRunInstants / length)
        ) << count;
    }
}

TEST_F(ShadowRuns, ASlopeIsExactOnAPlane) {
    for (int i = 0; i < 50; ++i) {
        const Way way{direction(), direction(), 0.2};
        const MoverBeforeLight mover(way, direction(), 1, 0);
        shader::CasterSpan run = mover.runs().back();
        dvec3 normal = direction();
        const double cosine = glm::dot(normal, mover.toLight);
        if (cosine < 0.1)
            continue;
        const math::vec2 slope =
            shader::planeSlopeOnRun(run.slope, math::vec3(normal), float(cosine));
        const dvec3 across = glm::normalize(glm::cross(normal, direction()));
        const dvec3 from = apply(run.first, run.step, 0, mover.caster.sphere.centre);
        for (const dvec3& along : {across, glm::cross(normal, across)}) {
            const dvec3 to = apply(run.first, run.step, 0, mover.caster.sphere.centre + along);
            const double depth = slope.x * (to.x - from.x) + slope.y * (to.y - from.y);
            EXPECT_NEAR(depth, to.z - from.z, 1e-4 / cosine);
        }
    }
}

/// Lookup position of the ray to a point along the light in a rotated mover's space: the point
/// itself in the layer's view.
dvec3 lookUp(
    const ShadowCaster& caster, const dmat4& turn, const dvec3& toLight, const dvec3& point
) {
    const MoverLayer layer{dmat4(1.0), fitLayer(toLight, caster.sphere, kLayerSize), kLayerSize, 0};
    const dmat4 own = mapToLayer(caster, dmat4(1.0), toLight, layer);
    return dvec3(glm::inverse(own) * mapToLayer(caster, turn, toLight, layer) * dvec4(point, 1.0));
}

TEST_F(ShadowRuns, ARayGoesAlongWithAMoverAndThroughTheSamePlaceOfItsMiddleWhenItTurns) {
    ShadowCaster caster;
    caster.sphere = {{3.0, 2.0, 1.0}, 2.0};
    const dvec3 centre = caster.sphere.centre;
    const dvec3 way(0.2, -0.1, 0.4);
    const dvec3 point(1.0, -2.0, 0.5);
    const dvec3 toSun = glm::normalize(dvec3(0.2, 1.0, 0.1));
    const dvec3 gone = lookUp(caster, glm::translate(dmat4(1.0), way), toSun, point);
    EXPECT_NEAR(glm::length(gone - point - way), 0.0, 1e-9);
    const dmat4 turn = glm::translate(dmat4(1.0), centre) *
                       glm::rotate(dmat4(1.0), 0.1, dvec3(0, 0, 1)) *
                       glm::translate(dmat4(1.0), -centre);
    const dvec3 below = centre + dvec3(0, -8, 0); // a ray through the middle
    EXPECT_NEAR(glm::length(lookUp(caster, turn, {0, 1, 0}, below) - below), 0.0, 1e-9);
}

TEST_F(ShadowRuns, RotationOfAFlatMoverPreservesTheRaysPlanePoint) {
    ShadowCaster disc;
    disc.sphere = {dvec3(0.0), 2.0};
    disc.shape[1][1] = 2500.0;
    const dmat4 turn = glm::rotate(dmat4(1.0), 0.7, dvec3(0.3, 0.0, -0.9));
    // The disc has turned under the light; the ray passes it off its middle.
    const dvec3 turned(turn * dvec4(0, 1, 0, 0));
    const dvec3 passed(0.7, 0.0, -0.4);
    const dvec3 point(glm::inverse(turn) * dvec4(passed - 5.0 * turned, 1.0));
    const dvec3 found = lookUp(disc, turn, {0, 1, 0}, point);
    EXPECT_NEAR(found.x, passed.x, 2e-3);
    EXPECT_NEAR(found.z, passed.z, 2e-3);
}

TEST_F(ShadowRuns, FlatThingsNeedFewerLayersThanThickOnes) {
    const LightPlace light(glm::normalize(dvec3(1.0, 1.0, 0.0)), 0.0);
    const MoverBeforeLight mover({{0, 0, 0}, {0, 0, 1}, 0.8}, dvec3(light), 16, 0);
    ShadowCaster caster = mover.caster;
    const uint32_t thick = countParts(caster, mover.path, {&light, 1});
    EXPECT_EQ(thick, 6u);
    caster.thinness = 0.7;
    EXPECT_EQ(countParts(caster, mover.path, {&light, 1}), 5u);
    caster.thinness = 0.02;
    EXPECT_EQ(countParts(caster, mover.path, {&light, 1}), 3u) << "however flat it is";
}

constexpr uint32_t kTile = shader::kChangingTilePx;

class ShadowTilesOfScenes : public RandomShadows {
  protected:
    dvec3 pointIn(const math::Bounds& box) {
        return {
            uniform(box.min.x, box.max.x),
            uniform(box.min.y, box.max.y),
            uniform(box.min.z, box.max.z)};
    }

    /// A camera in the scene, or next to it, that faces a place in it.
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

TEST_F(ShadowTilesOfScenes, TilesContainEveryPointThatAShadowMayReach) {
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

TEST_F(ShadowTilesOfScenes, TilesSeparateMovers) {
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

TEST_F(ShadowTilesOfScenes, AMoverWithoutABoxIsInAllTiles) {
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
} // namespace shutter::shadows
