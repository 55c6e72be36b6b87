// SPDX-License-Identifier: MIT
#include "tests/unit/extract/extraction_fixture.h"

#include <cmath>
#include <limits>

namespace shutter::extract {

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<uint32_t> entitiesOf(const std::vector<DrawItem>& items) {
    std::vector<uint32_t> entities;
    for (const DrawItem& item : items)
        entities.push_back(item.entity);
    return entities;
}

} // namespace

TEST_F(Extraction, AnEmptyWorldHasNoRowsAndDoesNotMove) {
    const ExtractedFrame frame = extract();
    EXPECT_TRUE(frame.entities.empty());
    EXPECT_TRUE(frame.opaque.empty());
    EXPECT_TRUE(frame.blended.empty());
    EXPECT_TRUE(frame.lights.empty());
    EXPECT_EQ(frame.constants.lightCount, 0u);
    EXPECT_FALSE(frame.moves);
}

TEST_F(Extraction, RowsFollowTheEntitiesThatDrawWithoutGaps) {
    const uint32_t second = addMesh(scene::AlphaMode::Opaque, 2);
    addBox({0.0, 0.0, -5.0}, second);
    [[maybe_unused]] const ecs::Entity drawsNothing = world.registry.create();
    addBox({0.0, 0.0, -9.0}, 0);
    const ExtractedFrame frame = extract();
    EXPECT_EQ(frame.entityMeshes, (std::vector<uint32_t>{second, 0}));
    ASSERT_EQ(frame.entities.size(), 2u);
    EXPECT_EQ(frame.entities[0].firstGeometry, layout.firstGeometry[second]);
    EXPECT_EQ(frame.entities[1].firstGeometry, layout.firstGeometry[0]);
}

TEST_F(Extraction, EveryGeometryOfAMeshIsDrawnOnce) {
    const uint32_t mesh = addMesh(scene::AlphaMode::Opaque, 3);
    addBox({0.0, 0.0, -5.0}, mesh);
    const ExtractedFrame frame = extract();
    ASSERT_EQ(frame.opaque.size(), 3u);
    for (uint32_t i = 0; i < 3; ++i)
        EXPECT_EQ(frame.opaque.merge()[i].geometry, layout.firstGeometry[mesh] + i);
}

TEST_F(Extraction, OpaqueComesNearToFarAndBlendedFarToNear) {
    const uint32_t glass = addMesh(scene::AlphaMode::Blend, 1);
    const uint32_t leaf = addMesh(scene::AlphaMode::Mask, 1);
    addBox({0.0, 0.0, -30.0}, 0);
    addBox({0.0, 0.0, -10.0}, leaf);
    addBox({0.0, 0.0, -20.0}, 0);
    addBox({0.0, 0.0, -11.0}, glass);
    addBox({0.0, 0.0, -33.0}, glass);
    const ExtractedFrame frame = extract();
    EXPECT_EQ(entitiesOf(frame.opaque.merge()), (std::vector<uint32_t>{1, 2, 0}));
    EXPECT_EQ(entitiesOf(frame.blended.merge()), (std::vector<uint32_t>{4, 3}));
    EXPECT_NEAR(frame.opaque.merge()[0].distance, 10.0f, 1e-4f);
    EXPECT_EQ(frame.opaque.merge()[0].alphaMode, scene::AlphaMode::Mask);
}

TEST_F(Extraction, AMeshWithoutTrianglesGetsNoRow) {
    const uint32_t points = addMesh(scene::AlphaMode::Opaque, 0);
    const uint32_t empty = addMesh(scene::AlphaMode::Opaque, 1);
    layout.bounds[empty] = math::Bounds{};
    addBox({0.0, 0.0, -5.0}, points);
    addBox({0.0, 0.0, -5.0}, empty);
    addBox({0.0, 0.0, -5.0}, 0);
    EXPECT_EQ(extract().entityMeshes, (std::vector<uint32_t>{0}));
}

TEST_F(Extraction, ASingularTransformGetsNoRow) {
    math::Transform flat;
    flat.translation = {0.0, 0.0, -5.0};
    flat.scale = {1.0, 0.0, 1.0};
    addBox(flat);
    flat.scale = math::dvec3(0.0);
    addBox(flat);
    EXPECT_TRUE(extract().entities.empty());
}

TEST_F(Extraction, ATransformThatIsNotFiniteGetsNoRow) {
    addBox({kNan, 0.0, -5.0});
    addBox({0.0, kInfinity, -5.0});
    const ecs::Entity fast = addBox({0.0, 0.0, -5.0});
    // Fine at open (time 0), out of range at the close.
    world.registry.add(fast, scene::LinearVelocity{{1e308, 0.0, 0.0}});
    request.exposure = {0.0, 0.0, 1e10, 0.0};
    EXPECT_TRUE(extract().entities.empty());
}

TEST_F(Extraction, AMirroringTransformIsMarked) {
    math::Transform mirrored;
    mirrored.translation = {0.0, 0.0, -5.0};
    mirrored.scale = {-1.0, 1.0, 1.0};
    addBox(mirrored);
    addBox({0.0, 0.0, -9.0});
    const ExtractedFrame frame = extract();
    ASSERT_EQ(frame.opaque.size(), 2u);
    EXPECT_TRUE(frame.opaque.merge()[0].mirrored);
    EXPECT_EQ(frame.entities[0].handedness, -1.0f);
    EXPECT_FALSE(frame.opaque.merge()[1].mirrored);
    EXPECT_EQ(frame.entities[1].handedness, 1.0f);
}

TEST_F(Extraction, WhatLiesOutsideThePictureKeepsItsRowForRaysButIsNotDrawn) {
    addBox({0.0, 0.0, 5.0});     // behind
    addBox({-100.0, 0.0, -5.0}); // left
    addBox({100.0, 0.0, -5.0});
    addBox({0.0, 100.0, -5.0});
    addBox({0.0, -100.0, -5.0});
    addBox({0.0, 0.0, -5.0}); // in view
    const ExtractedFrame frame = extract();
    EXPECT_EQ(frame.entities.size(), 6u);
    EXPECT_EQ(entitiesOf(frame.opaque.merge()), (std::vector<uint32_t>{5}));
}

TEST_F(Extraction, WhatReachesIntoThePictureOrAroundTheCameraIsDrawn) {
    math::Transform large;
    large.scale = math::dvec3(50.0); // the camera is inside
    addBox(large);
    addBox({3.0, 0.0, -3.0}); // across the right edge
    addBox({0.0, 0.0, -0.9}); // across the near plane
    EXPECT_EQ(extract().opaque.size(), 3u);
}

TEST_F(Extraction, EyeSpaceHasTheWorldsAxesAndTheCamerasOrigin) {
    math::Transform pose;
    pose.translation = {1.0, 2.0, 3.0};
    pose.rotation = glm::angleAxis(0.7, math::dvec3(0.0, 1.0, 0.0));
    world.registry.get<scene::LocalTransform>(camera).transform = pose;
    addBox({1.0, 2.0, -7.0});
    const shader::EntityRow row = extract().entities.at(0);
    EXPECT_EQ(row.eyeFromObject[0], math::vec4(1.0f, 0.0f, 0.0f, 0.0f));
    EXPECT_EQ(row.eyeFromObject[1], math::vec4(0.0f, 1.0f, 0.0f, 0.0f));
    EXPECT_EQ(row.eyeFromObject[2], math::vec4(0.0f, 0.0f, 1.0f, -10.0f));
}

TEST_F(Extraction, TheRowsOfASlantedTransformTakePointsToEyeSpace) {
    math::Transform pose;
    pose.translation = {1.0, -2.0, -8.0};
    pose.rotation = glm::angleAxis(1.1, glm::normalize(math::dvec3(1.0, 2.0, 3.0)));
    pose.scale = {1.0, 2.0, 0.5};
    addBox(pose);
    const shader::EntityRow row = extract().entities.at(0);
    const math::dvec4 point(0.3, -0.4, 0.5, 1.0);
    const math::dvec4 expected = math::computeMatrix(pose) * point;
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(glm::dot(math::dvec4(row.eyeFromObject[i]), point), expected[i], 1e-6);
}

TEST_F(Extraction, EachInstantHasTheEntityWhereItIsThen) {
    const ecs::Entity box = addBox({0.0, 0.0, -10.0});
    world.registry.add(box, scene::LinearVelocity{{0.5, 0.0, 0.0}});
    request.exposure = {2.0, 3.0, 4.0, 0.5};
    const ExtractedFrame frame = extract();
    const shader::EntityRow& row = frame.entities.at(0);
    const shader::EntityMotion motion = motionOf(frame, 0);
    const double focal = 1.0 / std::tan(scene::Camera{}.yFov / 2.0) / 2.0; // aspect 2
    const math::vec3 centre(0.0f);
    EXPECT_NEAR(project(motion.clipFromObjectOpen, centre).x, 0.1 * focal, 1e-6);
    EXPECT_NEAR(project(row.clipFromObjectRaster, centre).x, 0.15 * focal, 1e-6);
    EXPECT_NEAR(project(motion.clipFromObjectClose, centre).x, 0.2 * focal, 1e-6);
    EXPECT_NEAR(row.eyeFromObject[0].w, 1.5f, 1e-6f);
}

TEST_F(Extraction, AStillSceneDoesNotMove) {
    addBox({0.0, 0.0, -10.0});
    EXPECT_FALSE(extract().moves);
}

TEST_F(Extraction, ASceneWithAMoverInViewMoves) {
    addBox({0.0, 0.0, -10.0});
    const ecs::Entity box = addBox({0.0, 0.0, -20.0});
    world.registry.add(box, scene::AngularVelocity{{0.0, 0.1, 0.0}});
    EXPECT_TRUE(extract().moves);
    request.exposure = {1.0, 1.0, 1.0, 1.0}; // no exposure, no motion
    EXPECT_FALSE(extract().moves);
}

TEST_F(Extraction, AMoverThatEndsWhereItBeganMoves) {
    // There and back by a clip, with the raster instant between the two.
    const ecs::Entity box = addBox({0.0, 0.0, -20.0});
    scene::AnimationChannel channel;
    channel.times = {0.0f, 1.0f, 2.0f};
    channel.values = {{0, 0, -20, 0}, {1, 0, -20, 0}, {0, 0, -20, 0}};
    scene::AnimationClip clip;
    clip.duration = 2.0;
    clip.channels = {channel};
    world.assets.clips.push_back(clip);
    world.registry.add(box, scene::Animated{{{0, 0}}});
    request.exposure = {0.0, 1.0, 2.0, 0.5};
    EXPECT_TRUE(extract().moves);
}

TEST_F(Extraction, AMoverOutOfViewDoesNotMakeThePictureMove) {
    addBox({0.0, 0.0, -10.0});
    const ecs::Entity box = addBox({0.0, 0.0, 20.0});
    world.registry.add(box, scene::LinearVelocity{{1.0, 0.0, 0.0}});
    EXPECT_FALSE(extract().moves);
}

} // namespace shutter::extract
