// SPDX-License-Identifier: MIT
// A host's motion vectors, depth and cameras in the motion blur's own terms, against formulas that
// know the points themselves.
#include "engine/math/math.h"
#include "engine/math/transform.h"
#include "modules/motion_blur/embedding/host_convention.h"
#include "modules/motion_blur/embedding/host_input_check.h"
#include "shaders/motion_blur/prepare.glsl"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace shutter::motion_blur {
namespace {

using math::dmat4;
using math::dvec3;
using math::dvec4;

constexpr VkExtent2D kPicture{200, 100};
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// Any image but null.
const auto kSomeImage = reinterpret_cast<VkImage>(uintptr_t{16});

HostImage makeImage(VkFormat format) {
    HostImage image;
    image.image = kSomeImage;
    image.before.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    image.format = format;
    return image;
}

struct Projection {
    const char* name;
    dmat4 clipFromView;
    bool aheadIsPlusZ = false;
};

constexpr double kNear = 0.1;
constexpr double kFar = 50.0;

/// Depth from 0 near to 1 far, as GLM makes it; y down.
dmat4 forward() {
    dmat4 clip = glm::perspectiveRH_ZO(0.9, 2.0, kNear, kFar);
    clip[1].y = -clip[1].y;
    return clip;
}

dmat4 aheadPlusZ() {
    dmat4 clip = glm::perspectiveLH_ZO(0.9, 2.0, kNear, kFar);
    clip[1].y = -clip[1].y;
    return clip;
}

/// With a lens that is shifted.
dmat4 shifted() {
    dmat4 clip = math::clipFromViewPerspective(0.9, 2.0, kNear);
    clip[2].x = 0.3;
    clip[2].y = -0.2;
    return clip;
}

std::vector<Projection> listProjections() {
    return {
        {"reversed, infinite", math::clipFromViewPerspective(0.9, 2.0, kNear)},
        {"forward", forward()},
        {"ahead is +Z", aheadPlusZ(), true},
        {"shifted", shifted()},
        {"scaled as a whole", 3.0 * forward()},
        {"orthographic", math::clipFromViewOrthographic(6.0, 3.0, kNear, kFar)}};
}

HostConvention makeConvention(const Projection& projection) {
    HostConvention convention;
    convention.vectors.image = makeImage(VK_FORMAT_R32G32_SFLOAT);
    convention.depth.image = makeImage(VK_FORMAT_D32_SFLOAT);
    convention.depth.skyValue = kNaN;
    HostCameras& cameras = convention.cameras;
    cameras.areGiven = true;
    cameras.clipFromView = projection.clipFromView;
    cameras.clipFromViewBefore = projection.clipFromView;
    cameras.aheadIsPlusZ = projection.aheadIsPlusZ;
    convention.scales.exposureShare = 1.0f;
    return convention;
}

/// A camera's way from one frame to the next.
dmat4 viewBefore() {
    return glm::rotate(
        glm::translate(dmat4(1.0), dvec3(0.2, -0.1, 0.3)), 0.05, dvec3(0.3, 1.0, 0.2)
    );
}

/// Clip space of a point `metres` ahead of the camera, off its axis.
dvec3 pointAhead(const Projection& projection, double metres) {
    return {0.12 * metres, -0.07 * metres, projection.aheadIsPlusZ ? metres : -metres};
}

dvec3 project(const dmat4& clipFromWorld, const dvec3& point) {
    const dvec4 clip = clipFromWorld * dvec4(point, 1.0);
    return {
        (clip.x / clip.w * 0.5 + 0.5) * kPicture.width,
        (clip.y / clip.w * 0.5 + 0.5) * kPicture.height,
        clip.z / clip.w};
}

TEST(HostConvention, RawDepthOfEachProjectionIsMetres) {
    for (const Projection& projection : listProjections()) {
        SCOPED_TRACE(projection.name);
        const shader::PrepareTable table = makePrepareTable(makeConvention(projection), kPicture);
        for (const double metres : {0.2, 1.0, 7.0, 40.0}) {
            const double value = project(projection.clipFromView, pointAhead(projection, metres)).z;
            EXPECT_NEAR(shader::metresOfDepth(table, float(value)), metres, 2.0e-3 * metres);
        }
    }
}

TEST(HostConvention, AViewModelsDepthIsDecodedByItsOwnProjection) {
    // Forward depth: the weapon below 0.25, the world above.
    const auto intoRange = [](const dmat4& clipFromView, double least, double most) {
        dmat4 range(1.0);
        range[2].z = most - least;
        range[3].z = least;
        return range * clipFromView;
    };
    const dmat4 weapon = intoRange(math::clipFromViewPerspective(0.6, 2.0, 0.01), 0.0, 0.25);
    const dmat4 world = intoRange(math::clipFromViewPerspective(0.9, 2.0, kNear), 0.25, 1.0);
    HostConvention convention = makeConvention({"", world});
    convention.depth.skyValue = 0.25f;
    convention.viewModel = {.depthMin = 0.0f, .depthMax = 0.25f, .clipFromView = weapon};
    ASSERT_TRUE(checkConvention(convention, kPicture).ok());
    const shader::PrepareTable table = makePrepareTable(convention, kPicture);
    const auto valueOf = [](const dmat4& clipFromView, double metres) {
        return float(project(clipFromView, {0.0, 0.0, -metres}).z);
    };
    EXPECT_NEAR(shader::metresOfDepth(table, valueOf(weapon, 0.4)), 0.4f, 1e-4f);
    EXPECT_TRUE(shader::isViewModel(table, valueOf(weapon, 0.4)));
    EXPECT_NEAR(shader::metresOfDepth(table, valueOf(world, 7.0)), 7.0f, 1e-2f);
    EXPECT_FALSE(shader::isViewModel(table, valueOf(world, 7.0)));
    EXPECT_FALSE(shader::isViewModel(table, 0.25f)) << "the sky";
    EXPECT_FALSE(shader::isViewModel(table, kNaN));
    convention.viewModel.depthMin = 0.3f;
    EXPECT_FALSE(checkConvention(convention, kPicture).ok()) << "the range falls";
    convention.viewModel = {.depthMax = kInfinity};
    EXPECT_FALSE(checkConvention(convention, kPicture).ok());
    convention.viewModel = {
        .depthMax = 0.25f, .clipFromView = math::clipFromViewOrthographic(6.0, 3.0, 0.1, 100.0)};
    EXPECT_FALSE(checkConvention(convention, kPicture).ok()) << "another kind of projection";
}

TEST(HostConvention, TheSkyIsKnownByItsValueAndAnInvalidDepthIsTheSky) {
    HostConvention convention = makeConvention({"", forward()});
    convention.depth.skyValue = 1.0f;
    const shader::PrepareTable raw = makePrepareTable(convention, kPicture);
    EXPECT_EQ(shader::metresOfDepth(raw, 1.0f), shader::kSkyDepth);
    EXPECT_NEAR(shader::metresOfDepth(raw, 0.5f), 0.2f, 1.0e-3f);
    convention.depth = {makeImage(VK_FORMAT_R32_SFLOAT), true, 0.01f, 6000.0f};
    const shader::PrepareTable linear = makePrepareTable(convention, kPicture);
    EXPECT_EQ(shader::metresOfDepth(linear, 500.0f), 5.0f) << "centimetres";
    EXPECT_EQ(shader::metresOfDepth(linear, 6000.0f), shader::kSkyDepth);
    EXPECT_EQ(shader::metresOfDepth(linear, 7000.0f), shader::kSkyDepth);
    // Reversed and infinite: the buffer's 0 is infinitely far, regardless of skyValue.
    const shader::PrepareTable infinite = makePrepareTable(
        makeConvention({"", math::clipFromViewPerspective(0.9, 2.0, kNear)}), kPicture
    );
    EXPECT_EQ(shader::metresOfDepth(infinite, 0.0f), shader::kSkyDepth);
    const shader::PrepareTable table = makePrepareTable(makeConvention({"", forward()}), kPicture);
    for (const float value : {kNaN, kInfinity, -kInfinity, 3.0f})
        EXPECT_EQ(shader::metresOfDepth(table, value), shader::kSkyDepth) << value;
}

TEST(HostConvention, TheCamerasPartComesFromDepth) {
    for (const Projection& projection : listProjections()) {
        SCOPED_TRACE(projection.name);
        HostConvention convention = makeConvention(projection);
        convention.vectors.lackCamera = true;
        convention.cameras.viewFromWorldBefore = viewBefore();
        for (const bool hasJitter : {false, true}) {
            const math::dvec2 jitter = hasJitter ? math::dvec2(0.3, -0.4) : math::dvec2(0.0);
            convention.cameras.jitterPx = jitter;
            const shader::PrepareTable table = makePrepareTable(convention, kPicture);
            for (const double metres : {0.5, 4.0, 30.0}) {
                const dvec3 point = pointAhead(projection, metres);
                const dvec3 now = project(projection.clipFromView, point);
                const dvec3 before = project(projection.clipFromView * viewBefore(), point);
                const glm::vec2 place(now.x - jitter.x, now.y - jitter.y);
                const glm::vec2 motion = shader::preparedMotion(
                    table, place, glm::vec2(0.0f), float(metres), false, 1.0f
                );
                EXPECT_NEAR(motion.x, now.x - before.x, 1.0e-3);
                EXPECT_NEAR(motion.y, now.y - before.y, 1.0e-3);
            }
        }
    }
}

TEST(HostConvention, TheSkyMovesAsTheCameraTurns) {
    const Projection projection{"", math::clipFromViewPerspective(0.9, 2.0, kNear)};
    HostConvention convention = makeConvention(projection);
    convention.cameras.viewFromWorldBefore = viewBefore();
    const shader::PrepareTable table = makePrepareTable(convention, kPicture);
    const dvec3 direction = pointAhead(projection, 1.0e7);
    const dvec3 now = project(projection.clipFromView, direction);
    const dvec3 before = project(projection.clipFromView * viewBefore(), direction);
    // Whatever the image holds there.
    const glm::vec2 motion = shader::preparedMotion(
        table, {now.x, now.y}, {77.0f, 5.0f}, shader::kSkyDepth, false, 1.0f
    );
    EXPECT_NEAR(motion.x, now.x - before.x, 1.0e-3);
    EXPECT_NEAR(motion.y, now.y - before.y, 1.0e-3);
    convention = makeConvention({"", math::clipFromViewOrthographic(6.0, 3.0, kNear, kFar)});
    convention.cameras.viewFromWorldBefore = viewBefore();
    EXPECT_EQ(
        shader::preparedMotion(
            makePrepareTable(convention, kPicture),
            {9.0f, 9.0f},
            {77.0f, 5.0f},
            shader::kSkyDepth,
            false,
            1.0f
        ),
        glm::vec2(0.0f)
    );
}

TEST(HostConvention, PointsFromBehindTheCameraHaveFiniteMotion) {
    HostConvention convention =
        makeConvention({"", math::clipFromViewPerspective(0.9, 2.0, kNear)});
    // The camera went back by 3 m: a point 2 m ahead of it now was 1 m behind it.
    convention.cameras.viewFromWorldBefore = glm::translate(dmat4(1.0), dvec3(0.0, 0.0, 3.0));
    const shader::PrepareTable table = makePrepareTable(convention, kPicture);
    const glm::vec2 motion = shader::motionOfCamera(table, {150.0f, 50.0f}, 2.0f);
    EXPECT_LT(motion.x, -1000.0f) << "towards the middle, from far outside";
    EXPECT_TRUE(std::isfinite(motion.x) && std::isfinite(motion.y));
    const glm::vec2 stored = shader::preparedMotion(table, {150.0f, 50.0f}, {}, 2.0f, false, 1.0f);
    EXPECT_LE(glm::length(stored), shader::kMaxMotionPx * 1.001f);
}

TEST(HostConvention, VectorsAreTurnedScaledAndFreedOfJitter) {
    HostConvention convention = makeConvention({"", forward()});
    convention.depth = {makeImage(VK_FORMAT_R32_SFLOAT), true, 1.0f, kNaN};
    convention.cameras.areGiven = false;
    convention.scales.exposureShare = 0.5f;
    convention.vectors.pixelsPerUnit = {-200.0f, 50.0f}; // to before; x in uv, y in NDC, up
    const auto prepare = [&](const glm::vec2& vector, float blurScale = 1.0f) {
        return shader::preparedMotion(
            makePrepareTable(convention, kPicture), {10.0f, 10.0f}, vector, 3.0f, false, blurScale
        );
    };
    EXPECT_EQ(prepare({-0.1f, 0.2f}), glm::vec2(10.0f, 5.0f));
    EXPECT_EQ(prepare({-0.1f, 0.2f}, 0.25f), glm::vec2(2.5f, 1.25f));
    convention.scales.displayedPerRendered = 2.0f;
    EXPECT_EQ(prepare({-0.1f, 0.2f}), glm::vec2(5.0f, 2.5f));
    convention.scales.displayedPerRendered = 1.0f;
    convention.scales.isCut = true;
    EXPECT_EQ(prepare({-0.1f, 0.2f}), glm::vec2(0.0f));
    convention.scales.isCut = false;
    // A still point that both frames' jitter moved.
    convention.vectors.pixelsPerUnit = {1.0f, 1.0f};
    convention.vectors.haveJitter = true;
    convention.cameras.jitterPx = {0.25, -0.5};
    convention.cameras.jitterPxBefore = {-0.25, 0.125};
    EXPECT_EQ(prepare({-0.5f, 0.625f}), glm::vec2(0.0f));
    convention.vectors.haveJitter = false;
    EXPECT_EQ(prepare({-0.5f, 0.625f}), glm::vec2(-0.25f, 0.3125f));
}

TEST(HostConvention, CameraAndObjectsHaveScalesOfTheirOwn) {
    HostConvention convention =
        makeConvention({"", math::clipFromViewPerspective(0.9, 2.0, kNear)});
    convention.cameras.viewFromWorldBefore = viewBefore();
    const glm::vec2 place(120.0f, 30.0f);
    const glm::vec2 camera =
        shader::motionOfCamera(makePrepareTable(convention, kPicture), place, 4.0f);
    ASSERT_GT(glm::length(camera), 1.0f);
    const glm::vec2 object(3.0f, -2.0f);
    const auto prepare = [&](bool haveCamera, float cameraScale, float objectScale) {
        convention.vectors.lackCamera = !haveCamera;
        convention.scales.camera = cameraScale;
        convention.scales.object = objectScale;
        const glm::vec2 vector = haveCamera ? camera + object : object;
        return shader::preparedMotion(
            makePrepareTable(convention, kPicture), place, vector, 4.0f, false, 1.0f
        );
    };
    for (const bool haveCamera : {true, false}) {
        EXPECT_LT(glm::distance(prepare(haveCamera, 1.0f, 1.0f), camera + object), 1.0e-4f);
        EXPECT_LT(glm::distance(prepare(haveCamera, 1.0f, 0.0f), camera), 1.0e-4f);
        EXPECT_LT(glm::distance(prepare(haveCamera, 0.0f, 1.0f), object), 1.0e-4f);
        EXPECT_LT(
            glm::distance(prepare(haveCamera, 0.25f, 0.5f), 0.25f * camera + 0.5f * object), 1.0e-4f
        );
    }
}

TEST(HostConvention, AnInvalidVectorIsNoMotion) {
    for (const bool hasCameras : {false, true}) {
        HostConvention convention = makeConvention({"", forward()});
        convention.cameras.areGiven = hasCameras;
        convention.depth.isLinear = true;
        const shader::PrepareTable table = makePrepareTable(convention, kPicture);
        for (const float value : {kNaN, kInfinity, -kInfinity, 3.0e38f}) {
            const glm::vec2 motion =
                shader::preparedMotion(table, {5.0f, 5.0f}, {value, 1.0f}, 2.0f, false, 1.0f);
            EXPECT_TRUE(std::isfinite(motion.x) && std::isfinite(motion.y)) << value;
            EXPECT_LE(glm::length(motion), shader::kMaxMotionPx * 1.001f) << value;
        }
    }
}

TEST(HostConvention, PartsOfImagesAreReadWhereTheyLie) {
    HostImage image = makeImage(VK_FORMAT_R32G32_SFLOAT);
    image.extent = {400, 160};
    image.area = {{30, 20}, {100, 50}}; // at half of the picture's resolution
    const shader::PrepareArea area = makeArea(image, kPicture);
    const glm::vec2 uv = shader::placeInArea(area, {0.5f, 99.5f});
    EXPECT_NEAR(uv.x * 400.0f, 30.25f, 1.0e-4f);
    EXPECT_NEAR(uv.y * 160.0f, 69.75f, 1.0e-4f);
}

void expectRefusal(const core::Status& status, const std::string& part) {
    ASSERT_FALSE(status.ok()) << "expected: " << part;
    EXPECT_NE(status.error().message.find(part), std::string::npos) << status.error().message;
}

TEST(HostImages, EachFieldOfAnImageThatIsWrongIsNamed) {
    const auto refuse = [](const char* part, const std::function<void(HostImage&)>& change) {
        HostImage image = makeImage(VK_FORMAT_R32G32B32A32_SFLOAT);
        ASSERT_TRUE(checkImage(image, kMotionRule, kPicture).ok());
        change(image);
        expectRefusal(checkImage(image, kMotionRule, kPicture), std::string("motionDepth.") + part);
    };
    refuse("image is null", [](auto& i) { i.image = VK_NULL_HANDLE; });
    refuse("before.layout is undefined", [](auto& i) {
        i.before.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    });
    refuse("format is R8G8B8A8_UNORM, it must be one of R32G32B32A32_SFLOAT", [](auto& i) {
        i.format = VK_FORMAT_R8G8B8A8_UNORM;
    });
    refuse("samples is 4", [](auto& i) { i.samples = VK_SAMPLE_COUNT_4_BIT; });
    refuse("usage lacks VK_IMAGE_USAGE_SAMPLED_BIT", [](auto& i) {
        i.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    });
    refuse("area.extent is 5 x 0, both must be 0", [](auto& i) { i.area.extent = {5, 0}; });
    refuse("area.offset is -1, 0", [](auto& i) { i.area.offset = {-1, 0}; });
    refuse("area.extent is 20 x 24, it must be the picture's 200 x 100", [](auto& i) {
        i.area.extent = {20, 24};
    });
    refuse("extent is 40 x 20, all of which is used without an area", [](auto& i) {
        i.extent = {40, 20};
    });
    refuse("area ends at 201, 100, beyond its extent of 200 x 100", [](auto& i) {
        i.extent = {200, 100};
        i.area = {{1, 0}, {200, 100}};
    });
}

TEST(HostConvention, EachFieldThatIsWrongIsNamed) {
    using C = HostConvention;
    const auto refuse = [](const std::string& part, const std::function<void(C&)>& change) {
        HostConvention convention = makeConvention({"", forward()});
        ASSERT_TRUE(checkConvention(convention, kPicture).ok());
        change(convention);
        expectRefusal(checkConvention(convention, kPicture), part);
    };
    refuse("depth.image is null", [](C& c) { c.depth.image = {}; });
    refuse("vectors.format is D32_SFLOAT, it must be one of R16G16_SFLOAT", [](C& c) {
        c.vectors.image = c.depth.image;
    });
    refuse("blurScale.format is R32_UINT", [](C& c) {
        c.scales.perPixel = makeImage(VK_FORMAT_R32_UINT);
    });
    refuse("pixelsPerUnit holds 0", [](C& c) { c.vectors.pixelsPerUnit.y = 0.0f; });
    refuse("pixelsPerUnit holds nan", [](C& c) { c.vectors.pixelsPerUnit.x = kNaN; });
    refuse("metresPerUnit is 0", [](C& c) { c.depth = {c.depth.image, true, 0.0f}; });
    refuse("exposureShare is -1", [](C& c) { c.scales.exposureShare = -1.0f; });
    refuse("cameraScale is inf", [](C& c) { c.scales.camera = kInfinity; });
    refuse("objectScale is nan", [](C& c) { c.scales.object = kNaN; });
    refuse("displayedPerRendered is 0.5", [](C& c) { c.scales.displayedPerRendered = 0.5f; });
    refuse("cameras.jitterPx is not finite", [](C& c) { c.cameras.jitterPx.x = kNaN; });
    refuse("cameras.viewFromWorld is not affine", [](C& c) { c.cameras.viewFromWorld[0].w = 1.0; });
    refuse("cameras.viewFromWorldBefore is not affine", [](C& c) {
        c.cameras.viewFromWorldBefore = dmat4(0.0);
    });
    refuse("cameras.clipFromView is not finite", [](C& c) {
        c.cameras.clipFromView[0].x = double(kNaN);
    });
    refuse("clipFromView faces +Z, cameras.aheadIsPlusZ means -Z", [](C& c) {
        c.cameras.clipFromView = aheadPlusZ();
    });
    refuse("clipFromViewBefore is orthographic, clipFromView is not", [](C& c) {
        c.cameras.clipFromViewBefore = math::clipFromViewOrthographic(6.0, 3.0, kNear, kFar);
    });
    const auto refuseWithoutCameras = [&](const std::string& part, const auto& change) {
        refuse(part + ", which needs cameras", [&](C& c) {
            c.cameras.areGiven = false;
            c.depth.isLinear = true;
            change(c);
        });
    };
    refuseWithoutCameras("depthIsLinear is false", [](C& c) { c.depth.isLinear = false; });
    refuseWithoutCameras("vectorsLackCamera is true", [](C& c) { c.vectors.lackCamera = true; });
    refuseWithoutCameras("vectors.image is null", [](C& c) { c.vectors.image = {}; });
    refuseWithoutCameras("cameraScale is not objectScale", [](C& c) { c.scales.camera = 0.5f; });
}

TEST(PrepareWay, PassesThroughBothEndsAndThePixelItself) {
    const math::vec4 ends(-20.0f, 4.0f, 12.0f, -6.0f);
    for (const float rasterTime : {0.3f, 0.5f, 0.8f, -1.0f, -0.4f, 2.5f}) {
        const shader::PixelWay way = shader::unpackWay(shader::prepareWay(ends, rasterTime));
        EXPECT_LT(glm::distance(way.open, math::vec2(-20, 4)), 0.1f);
        EXPECT_LT(glm::distance(way.close, math::vec2(12, -6)), 0.1f);
        const float exact = glm::length(shader::displacementAt(way, rasterTime));
        EXPECT_LT(exact, 0.1f * (1.0f + rasterTime * rasterTime * 4.0f)) << rasterTime;
    }
}

TEST(PrepareWay, TheMotionIsStraightIfTheRasterIsAtAnEndAndMarkedIfNotFinite) {
    for (const float rasterTime : {0.0f, 0.05f, 0.95f, 1.0f, kNaN, kInfinity, -kInfinity, 1e30f})
        EXPECT_EQ(
            shader::unpackWay(shader::prepareWay({-8, 0, 2, 1}, rasterTime)).bend, math::vec2(0.0f)
        ) << rasterTime;
    for (int channel = 0; channel < 4; ++channel)
        for (const float bad : {kNaN, kInfinity, -kInfinity}) {
            math::vec4 ends(1.0f);
            ends[channel] = bad;
            EXPECT_EQ(shader::prepareWay(ends, 0.5f).x, shader::kNoWay);
        }
    EXPECT_NE(shader::prepareWay(math::vec4(1e38f), 0.5f).x, shader::kNoWay);
}

} // namespace
} // namespace shutter::motion_blur
