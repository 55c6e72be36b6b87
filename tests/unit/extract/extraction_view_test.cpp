// SPDX-License-Identifier: MIT
// A frame's view from its camera, lights, entities without a past or hidden, and the lens of rays.
#include "engine/extract/frame_view.h"
#include "engine/math/transform.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/history.h"
#include "engine/scene/lens.h"
#include "engine/scene/path.h"
#include "tests/unit/extract/extraction_fixture.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

namespace shutter::extract {
namespace {

void expectNear(const math::mat4& a, const math::mat4& b) {
    constexpr float kRounding = 6e-7f; // five units in the last place
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) {
            const float size = std::max(1.0f, std::abs(a[column][row]));
            EXPECT_NEAR(a[column][row], b[column][row], kRounding * size) << column << " " << row;
        }
}

TEST_F(Extraction, APlaceOfTheLensSeesWhatIsInFocusWhereItWasAndTheRestShifted) {
    constexpr double kFocus = 4.0;
    world.registry.add(camera, scene::CameraLens{.fStop = 0.1, .focusDistance = kFocus});
    const auto& lens = world.registry.get<scene::Camera>(camera);
    const double radius = scene::computeLensRadius({.fStop = 0.1}, lens.yFov);
    const double scale = 1.0 / std::tan(lens.yFov / 2.0); // heights of half the picture
    request.lensPlace = math::dvec2(0.5, 0.875);          // up
    const CameraPose pose = placeCamera(motion(), lens, request, 0.5);
    for (const double depth : {1.0, 4.0, 50.0}) {
        const math::dvec4 clip = pose.clipFromView * glm::inverse(pose.worldFromView) *
                                 math::dvec4(0.3, 0.2, -depth, 1.0);
        const math::dvec2 seen(clip.x / clip.w, -clip.y / clip.w); // y points down in clip space
        const double shift = scale * 0.75 * radius * (1.0 / kFocus - 1.0 / depth);
        EXPECT_NEAR(seen.x, 0.5 * scale * 0.3 / depth, 1e-7) << depth;
        EXPECT_NEAR(seen.y, scale * 0.2 / depth + shift, 1e-6) << depth;
    }
}

TEST_F(Extraction, AMovingCameraSeesTheSkyAndStillPointsFromWhereItIsAtOpenAndClose) {
    request.exposure = {0.0, 0.0, 1.0, 0.0};
    const double focal = 1.0 / std::tan(scene::Camera{}.yFov / 2.0) / 2.0;
    const auto expectSeen = [&](const math::vec4& ahead, double atClose) {
        const ExtractedFrame frame = extract();
        EXPECT_TRUE(frame.moves);
        const math::vec4 open = frame.constants.clipFromRelWorldOpen * ahead;
        const math::vec4 close = frame.constants.clipFromRelWorldClose * ahead;
        EXPECT_NEAR(open.x / open.w, 0.0f, 1e-6f);
        EXPECT_NEAR(close.x / close.w, atClose * focal, 1e-5);
    };
    world.registry.add(camera, scene::AngularVelocity{{0.0, 0.1, 0.0}});
    // Turned to the left by 0.1 rad: the former centre is now at the right.
    expectSeen({0.0f, 0.0f, -1.0f, 0.0f}, std::tan(0.1));
    // Far from the origin, where single precision would lose the displacement.
    request.camera = addCamera({.translation = {4e6, 0.0, 0.0}});
    world.registry.add(request.camera, scene::LinearVelocity{{1.0, 0.0, 0.0}});
    expectSeen({0.0f, 0.0f, -2.0f, 1.0f}, -0.5); // from the eye
}

TEST_F(Extraction, APhaseOnlyChoosesTheRasterInstant) {
    addMover({0.0, 0.0, -10.0}, {1.0, 0.0, 0.0});
    using scene::ShutterPhase;
    for (const auto& [phase, open, close] :
         {std::tuple{ShutterPhase::Start, 5.0, 5.5},
          std::tuple{ShutterPhase::Centre, 4.75, 5.25},
          std::tuple{ShutterPhase::End, 4.5, 5.0}}) {
        request.exposure = scene::computeExposure({0.5, phase}, 5.0);
        const ExtractedFrame frame = extract();
        const shader::EntityRow& row = frame.entities.at(0);
        const shader::EntityMotion motion = motionOf(frame, 0);
        EXPECT_NEAR(row.relWorldFromObject[0].w, 5.0f, 1e-6f); // the frame's own time in all three
        const auto x = [&](const math::mat4& matrix) { return double(matrix[3].x); };
        const double perMetre = x(row.clipFromObjectRaster) / 5.0;
        EXPECT_NEAR(x(motion.clipFromObjectOpen), open * perMetre, 1e-5);
        EXPECT_NEAR(x(motion.clipFromObjectClose), close * perMetre, 1e-5);
    }
}

TEST_F(Extraction, TheScaleOfACamerasNodeDoesNotCount) {
    addBox({0.5, 0.25, -10.0});
    auto& transform = world.registry.get<scene::LocalTransform>(camera).transform;
    transform = {{0.1, 0.2, 0.3}, glm::angleAxis(0.2, math::dvec3(0.0, 1.0, 0.0))};
    const ExtractedFrame plain = extract();
    transform.scale = {3.0, 0.5, 20.0};
    const ExtractedFrame scaled = extract();
    expectNear(scaled.constants.clipFromRelWorld, plain.constants.clipFromRelWorld);
    expectNear(scaled.entities[0].clipFromObjectRaster, plain.entities[0].clipFromObjectRaster);
    EXPECT_NEAR(glm::length(math::vec3(scaled.constants.forward)), 1.0f, 1e-6f);
}

TEST_F(Extraction, EyeSpaceGoesToClipSpaceAndBackAndPixelsGrowWithDistance) {
    addBox({0.5, 0.25, -10.0});
    const ExtractedFrame frame = extract();
    const shader::FrameConstants& constants = frame.constants;
    const math::vec4 centre(0.5f, 0.25f, -10.0f, 1.0f);
    const math::vec4 clip = constants.clipFromRelWorld * centre;
    EXPECT_NEAR(clip.x, (frame.entities[0].clipFromObjectRaster * math::vec4(0, 0, 0, 1)).x, 1e-6f);
    EXPECT_NEAR(clip.w, 10.0f, 1e-5f); // the distance
    const math::vec4 back = constants.relWorldFromClip * clip;
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(back[i] / back.w, centre[i], 1e-4f);
    EXPECT_EQ(constants.sizePx, math::vec2(200.0f, 100.0f));
    EXPECT_NEAR(constants.pixelFootprint.x, 2.0 * std::tan(0.4) / 100.0, 1e-7);
    EXPECT_EQ(constants.pixelFootprint.y, 0.0f);
    EXPECT_FLOAT_EQ(constants.forward.w, 0.05f); // the near plane
}

TEST_F(Extraction, ACamerasFrameIsSeenWholeInAPictureOfAnotherShape) {
    auto& lens = world.registry.get<scene::Camera>(camera);
    const ExtractedFrame plain = extract(); // 200 x 100, without a separate frame
    const auto clip = [](const ExtractedFrame& frame) { return frame.constants.clipFromRelWorld; };
    for (const double narrower : {0.5, 1.0, 2.0, 2.0 + 1e-7}) {
        lens.aspectRatio = narrower;
        EXPECT_EQ(clip(extract()), clip(plain)) << narrower;
    }
    lens.aspectRatio = 5.0;
    const ExtractedFrame whole = extract();
    const math::vec2 corner(5.0 * std::tan(0.4), std::tan(0.4));
    const math::vec3 seen = project(clip(whole), math::vec3(corner, -1.0f));
    EXPECT_NEAR(seen.x, 1.0f, 1e-6f);
    EXPECT_NEAR(seen.y, -0.4f, 1e-6f) << "pixels stay square";
    EXPECT_NEAR(whole.constants.pixelFootprint.x, 2.5 * plain.constants.pixelFootprint.x, 1e-7);
    request.frameFit = FrameFit::Height;
    EXPECT_EQ(clip(extract()), clip(plain));
}

TEST_F(Extraction, AnOrthographicFrameIsSeenWholeInAPictureOfAnotherShape) {
    auto& lens = world.registry.get<scene::Camera>(camera);
    lens.kind = scene::CameraKind::Orthographic;
    lens.xMag = 12.0;
    lens.yMag = 4.0;
    const auto seen = [&](const math::vec3& place) {
        return math::vec2(project(extract().constants.clipFromRelWorld, place));
    };
    const math::vec3 corner(12.0f, 4.0f, -10.0f);
    EXPECT_LT(glm::distance(seen(corner), math::vec2(1.0f, -2.0f / 3.0f)), 1e-6f);
    EXPECT_NEAR(extract().constants.pixelFootprint.y, 0.12f, 1e-7f);
    request.frameFit = FrameFit::Height;
    EXPECT_LT(glm::distance(seen(corner), math::vec2(1.5f, -1.0f)), 1e-6f);
    request.frameFit = FrameFit::Whole;
    lens.xMag = 3.0; // narrower than the picture: margins are visible
    EXPECT_LT(glm::distance(seen({3, 4, -10}), math::vec2(0.375f, -1.0f)), 1e-6f);
}

TEST_F(Extraction, ANegativeMagnificationMirrorsThePictureAndTurnsWindingsRound) {
    auto& lens = world.registry.get<scene::Camera>(camera);
    lens.kind = scene::CameraKind::Orthographic;
    lens.yMag = 4.0;
    addBox({2.0, 2.0, -10.0});
    addBox({{1.0, 1.0, -20.0}, {1, 0, 0, 0}, {-1.0, 1.0, 1.0}});
    for (const double x : {1.0, -1.0})
        for (const double y : {4.0, -4.0}) {
            lens.xMag = x;
            lens.yMag = y;
            const ExtractedFrame frame = extract();
            const math::vec3 at = project(frame.entities[0].clipFromObjectRaster, math::vec3());
            EXPECT_NEAR(at.x, 0.25 * x, 1e-6f);
            EXPECT_NEAR(at.y, -0.5 * y / 4.0, 1e-6f);
            EXPECT_FLOAT_EQ(frame.constants.pixelFootprint.y, 0.08f);
            const std::vector<DrawItem> draws = frame.opaque.merge();
            ASSERT_EQ(draws.size(), 2u);
            EXPECT_EQ(draws[0].mirrored, x * y < 0.0);
            EXPECT_EQ(draws[1].mirrored, x * y > 0.0);
            EXPECT_EQ(frame.entities[0].handedness, 1.0f) << "in the world nothing is mirrored";
        }
}

TEST_F(Extraction, ACameraBelowAShearedOrMirroredParentStaysRigid) {
    addBox({0.5, 0.25, -10.0});
    const ecs::Entity parent = world.registry.create();
    world.registry.add(camera, scene::Parent{parent});
    world.registry.get<scene::LocalTransform>(camera).transform.rotation =
        glm::angleAxis(0.5, glm::normalize(math::dvec3(1.0, 2.0, 3.0)));
    for (const math::dvec3& scale :
         {math::dvec3(1, 3, 0.5), math::dvec3(-1, 1, 1), math::dvec3(2, -1, 1), math::dvec3(0)}) {
        world.registry.add(
            parent,
            scene::LocalTransform{{{0, 0, 0}, glm::angleAxis(0.3, math::dvec3(0, 1, 0)), scale}}
        );
        const ExtractedFrame frame = extract();
        // Back into the view's own space: a rotation is left.
        const math::dmat4 projection = math::clipFromViewPerspective(0.8, 2.0, 0.05);
        const math::dmat3 turn(
            glm::inverse(projection) * math::dmat4(frame.constants.clipFromRelWorld)
        );
        for (int column = 0; column < 3; ++column)
            EXPECT_NEAR(glm::length(turn[column]), 1.0, 1e-5);
        EXPECT_NEAR(glm::determinant(turn), 1.0, 1e-5);
        EXPECT_FALSE(frame.opaque.size() > 0 && frame.opaque.merge()[0].mirrored);
    }
}

TEST_F(Extraction, JitterMovesTheSampleByThatPartOfAPixelAndLeavesMotionAlone) {
    addBox({0.5, 0.25, -10.0});
    const ExtractedFrame straight = extract();
    request.jitterPx = {0.25, -0.5};
    const ExtractedFrame jittered = extract();
    // The sample moves right and up, so the picture moves left and down.
    const math::vec3 moved = project(jittered.entities[0].clipFromObjectRaster, math::vec3()) -
                             project(straight.entities[0].clipFromObjectRaster, math::vec3());
    EXPECT_NEAR(moved.x * 100.0f, -0.25f, 1e-4f); // half of the width: NDC to pixels
    EXPECT_NEAR(moved.y * 50.0f, 0.5f, 1e-4f);
    EXPECT_EQ(jittered.entities[0].motion, shader::kNoMotion);
    EXPECT_FALSE(jittered.moves);
    addMover({0.5, 0.25, -10.0}, {1.0, 0.0, 0.0});
    const shader::EntityMotion motion = motionOf(extract(), 1);
    request.jitterPx = math::dvec2(0.0);
    const shader::EntityMotion expected = motionOf(extract(), 1);
    EXPECT_EQ(motion.clipFromObjectOpen, expected.clipFromObjectOpen);
    EXPECT_EQ(motion.clipFromObjectClose, expected.clipFromObjectClose);
    EXPECT_NE(motion.clipFromObjectOpen, motion.clipFromObjectClose);
}

/// Where a box's centre is drawn, pixels from where it is without jitter.
class JitterOfStatic : public Extraction {
  protected:
    JitterOfStatic() {
        request.jittered = Jittered::Static;
        request.lodBias = -1.0f;
        request.staticLodBias = -2.0f;
        setExposure(0.25);
    }

    void setExposure(double seconds) {
        scene::CameraShutter shutter;
        shutter.exposureSeconds = seconds;
        request.exposure = scene::computeExposure(shutter, 2.0, 0.5);
    }

    /// For each row.
    std::vector<math::dvec2> findShiftsPx() {
        std::vector<math::dvec2> shifts;
        request.jitterPx = {0.0, 0.0};
        const ExtractedFrame plain = extract();
        request.jitterPx = {0.25, -0.5};
        const ExtractedFrame jittered = extract();
        for (size_t row = 0; row < plain.entities.size(); ++row) {
            const auto at = [&](const ExtractedFrame& frame) {
                return math::dvec2(project(frame.entities[row].clipFromObjectRaster, {0, 0, 0})) *
                       0.5 * math::dvec2(request.width, request.height);
            };
            shifts.push_back(at(jittered) - at(plain));
        }
        return shifts;
    }
};

TEST_F(JitterOfStatic, OnlyWhatMovesOrDeformsIsSampledAtTheCentre) {
    addBox({0.0, 0.0, -8.0});
    addMover({2.0, 0.0, -8.0}, {1.0, 0.0, 0.0});
    // At rest during the exposure, and not at the last frame's raster, half a second before.
    const ecs::Entity parked = addBox({-2.0, 0.0, -8.0});
    world.registry.add(
        parked, scene::PathMotion{.keys = {{1.5, {-2.0, 0.0, -8.0}}, {1.7, {-2.0, 1.0, -8.0}}}}
    );
    const ecs::Entity waving = addBox({0.0, 2.0, -8.0});
    world.registry.add(
        waving, scene::VertexWaves{.waves = {{.displacement = {1, 0, 0}, .hertz = 0.7}}}
    );
    makeDeformable(1);
    addMover({0.0, -2.0, -8.0}, {0.0, 0.0, 0.0}); // could move and does not
    for (const double exposure : {0.25, 0.0}) {
        setExposure(exposure);
        const std::vector<math::dvec2> shifts = findShiftsPx();
        ASSERT_EQ(shifts.size(), 5u);
        for (const size_t row : {1u, 2u, 3u})
            EXPECT_EQ(shifts[row], math::dvec2(0.0)) << exposure << ", row " << row;
        for (const size_t row : {0u, 4u}) {
            EXPECT_NEAR(shifts[row].x, -0.25, 1e-4);
            EXPECT_NEAR(shifts[row].y, 0.5, 1e-4);
        }
    }
    EXPECT_EQ(extract().constants.staticLodBias, -3.0f);
    EXPECT_EQ(extract().constants.lodBias, -1.0f);
}

TEST_F(JitterOfStatic, NothingIsJitteredUnderAMovingCamera) {
    addBox({0.0, 0.0, -8.0});
    world.registry.add(camera, scene::LinearVelocity{{0.1, 0.0, 0.0}});
    for (const double exposure : {0.25, 0.0}) {
        setExposure(exposure);
        EXPECT_EQ(findShiftsPx().at(0), math::dvec2(0.0)) << exposure;
        EXPECT_EQ(extract().constants.staticLodBias, -1.0f) << exposure;
    }
}

TEST_F(Extraction, AThousandKilometresFromTheOriginAllIsAsAtTheOrigin) {
    const auto build = [&](const math::dvec3& origin) {
        world = scene::World{};
        request.camera = addCamera({origin, glm::angleAxis(0.3, math::dvec3(0.0, 1.0, 0.0))});
        world.registry.add(request.camera, scene::LinearVelocity{{0.25, 0.0, 0.5}});
        addMover(origin + math::dvec3(-3.0, 0.25, -10.0), {0.5, 0.125, 0.0});
        return extract();
    };
    const ExtractedFrame near = build(math::dvec3(0.0));
    const ExtractedFrame far = build({1.0e6, -1.0e6, 1.0e6});
    ASSERT_EQ(far.opaque.size(), 1u);
    const shader::EntityRow& a = near.entities[0];
    const shader::EntityRow& b = far.entities[0];
    const shader::EntityMotion nearMotion = motionOf(near, 0);
    const shader::EntityMotion farMotion = motionOf(far, 0);
    expectNear(farMotion.clipFromObjectOpen, nearMotion.clipFromObjectOpen);
    expectNear(b.clipFromObjectRaster, a.clipFromObjectRaster);
    expectNear(farMotion.clipFromObjectClose, nearMotion.clipFromObjectClose);
    expectNear(far.constants.clipFromRelWorld, near.constants.clipFromRelWorld);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(b.relWorldFromObject[i].w, a.relWorldFromObject[i].w, 2e-6f);
    world = scene::World{};
    request.camera = addCamera({.translation = {1.0e6, 2.0e6, -3.0e6}});
    addBox({1.0e6, 2.0e6, -3.0e6 - 10.0});
    EXPECT_FALSE(extract().moves) << "a static scene";
}

TEST_F(Extraction, ALightIsWhereItsEntityIsSeenFromTheCamera) {
    request.camera = addCamera({.translation = {0.0, 0.0, 7.0}});
    const ecs::Entity lamp = world.registry.create();
    const math::Transform place{
        {1.0, 2.0, 3.0},
        glm::angleAxis(glm::radians(90.0), math::dvec3(0.0, 1.0, 0.0)),
        math::dvec3(4.0)};
    world.registry.add(lamp, scene::LocalTransform{place});
    scene::Light light;
    light.kind = scene::LightKind::Spot;
    light.color = {1.0f, 0.5f, 0.25f};
    light.intensity = 8.0f;
    light.range = 20.0f;
    light.innerConeAngle = 0.2f;
    light.outerConeAngle = 0.6f;
    world.registry.add(lamp, light);
    const ExtractedFrame frame = extract();
    EXPECT_EQ(frame.constants.lightCount, 1u);
    const shader::LightRow& row = frame.lights.at(0);
    EXPECT_EQ(row.positionRange, math::vec4(1.0f, 2.0f, -4.0f, 20.0f));
    EXPECT_EQ(row.kind, shader::kLightSpot);
    EXPECT_NEAR(row.direction.x, -1.0f, 1e-6f); // -Z turned a quarter to the left
    EXPECT_NEAR(row.direction.z, 0.0f, 1e-6f);
    EXPECT_EQ(row.radiance, math::vec4(8.0f, 4.0f, 2.0f, 0.0f));
    // Full inside the inner cone, dark from the outer one on.
    EXPECT_NEAR(std::cos(0.2f) * row.spotScale + row.spotOffset, 1.0f, 1e-5f);
    EXPECT_NEAR(std::cos(0.6f) * row.spotScale + row.spotOffset, 0.0f, 1e-5f);
    world.registry.get<scene::Light>(lamp
    ) = {.kind = scene::LightKind::Spot, .innerConeAngle = 0.5f, .outerConeAngle = 0.5f};
    const shader::LightRow sharp = extract().lights.at(0);
    EXPECT_EQ(sharp.positionRange.w, 0.0f) << "without limits";
    EXPECT_TRUE(std::isfinite(sharp.spotScale) && std::isfinite(sharp.spotOffset));
}

TEST_F(Extraction, RequestedSettingsAreInTheConstants) {
    request.background = {0.1f, 0.2f, 0.3f};
    request.ambient = {0.4f, 0.5f, 0.6f};
    request.lodBias = -1.5f;
    EXPECT_EQ(extract().constants.flags, 0u);
    request.unlit = true;
    const shader::FrameConstants constants = extract().constants;
    EXPECT_EQ(math::vec3(constants.background), request.background);
    EXPECT_EQ(math::vec3(constants.ambient), request.ambient);
    EXPECT_EQ(constants.lodBias, -1.5f);
    EXPECT_EQ(constants.flags, shader::kFrameUnlit);
}

class ExtractionHistory : public Extraction {
  protected:
    ExtractionHistory() {
        scene::CameraShutter shutter;
        shutter.exposureSeconds = 1.0;
        request.exposure = scene::computeExposure(shutter, 1.0, 1.0);
    }

    ecs::Entity addMover() { return Extraction::addMover({0.0, 0.0, -10.0}, {1.0, 0.0, 0.0}); }
};

TEST_F(ExtractionHistory, RaysMeetWhatAppearsFromThenOnAndWhatIsHiddenUntilThen) {
    const ecs::Entity mover = addMover();
    scene::appear(world, mover, 0.7);
    ExtractedFrame frame = extract();
    EXPECT_FALSE(frame.moves) << "a raster shows it all the time or never";
    auto keys = computeTables(frame).rows.at(0).keys;
    EXPECT_FALSE(isDrawable(interpolateKeys(keys, 0.69)));
    EXPECT_EQ(interpolateKeys(keys, 0.71), interpolateKeys(keys, 1.0)) << "it is static";
    EXPECT_TRUE(isDrawable(interpolateKeys(keys, 1.0)));
    world.registry.remove<scene::Appeared>(mover);
    scene::hide(world, mover, 0.4);
    frame = extract();
    EXPECT_TRUE(frame.entities.empty()) << "at the raster instant it is hidden";
    keys = computeTables(frame).rows.at(0).keys;
    EXPECT_TRUE(isDrawable(interpolateKeys(keys, 0.39)));
    EXPECT_NEAR(interpolateKeys(keys, 0.39)[3].x, 0.39, 1e-3) << "it moves until then";
    EXPECT_FALSE(isDrawable(interpolateKeys(keys, 0.41)));
}

TEST_F(ExtractionHistory, HiddenEntitiesHaveNoRowAndNoLight) {
    const ecs::Entity mover = addMover();
    const ecs::Entity other = addMover();
    const ecs::Entity lamp = world.registry.create();
    world.registry.add(lamp, scene::Light{});
    world.registry.add(lamp, scene::Parent{mover});
    scene::hide(world, mover);
    ExtractedFrame frame = extract();
    ASSERT_EQ(frame.entityHandles, std::vector<ecs::Entity>{other});
    EXPECT_TRUE(frame.lights.empty());
    EXPECT_EQ(computeTables(frame).rows.size(), 1u) << "rays meet it no more than the picture";
    scene::show(world, mover, 0.7);
    EXPECT_EQ(extract().entities.size(), 2u);
    EXPECT_EQ(extract().lights.size(), 1u);
}

TEST_F(Extraction, RaysSeeAPullOfTheAutofocusOverTheExposure) {
    request.usesLens = true;
    world.registry.add(camera, scene::CameraLens{.fStop = 2.0, .focusDistance = 5.0});
    const auto computeLens = [&] {
        ExtractedFrame frame = extract();
        return computeTables(frame).lens;
    };
    const auto unfocused = computeLens();
    ASSERT_EQ(unfocused.size(), 1u) << "nothing focuses it";
    EXPECT_FLOAT_EQ(unfocused[0].focus, 0.2f);
    constexpr size_t kIntervals = 64;
    const ecs::Entity target = world.registry.create();
    scene::PathMotion way{{{0.0, {0, 0, -2}}, {1.0, {0, 0, -8}}}, scene::PathInterpolation::Linear};
    for (scene::PathKey& key : way.keys)
        key.rotation = math::dquat(1.0, 0.0, 0.0, 0.0);
    world.registry.add(target, std::move(way));
    world.registry.add(camera, scene::AutoFocus{target, 0.0});
    scene::advanceAutoFocus(world, 0.0);
    scene::advanceAutoFocus(world, 1.0);
    const auto lens = computeLens();
    ASSERT_EQ(lens.size(), kIntervals + 1);
    EXPECT_FLOAT_EQ(lens.front().focus, 1.0f / 2.0f);
    EXPECT_NEAR(lens[kIntervals / 2].focus, 1.0f / 5.0f, 1e-4f);
    EXPECT_FLOAT_EQ(lens.back().focus, 1.0f / 8.0f);
}

} // namespace
} // namespace shutter::extract
