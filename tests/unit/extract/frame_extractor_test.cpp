// SPDX-License-Identifier: MIT
#include "tests/unit/extract/kept_frame_fixture.h"

#include <vector>

namespace shutter::extract {

TEST_F(KeptFrame, AStillFrameChangesNothing) {
    addBox({0.0, 0.0, -10.0});
    addBox({1.0, 0.0, -10.0});
    EXPECT_TRUE(update().changes.all);
    const uint64_t before = extractor.update(world, layout, request).value()->stillRevision;
    revision = 0;
    const ExtractedFrame& frame = *extractor.update(world, layout, request).value();
    EXPECT_FALSE(frame.changes.all);
    EXPECT_TRUE(frame.changes.rows.empty());
    EXPECT_TRUE(frame.movingRows.empty());
    EXPECT_TRUE(frame.stillMotions.empty());
    EXPECT_TRUE(frame.movingMotions.empty());
    EXPECT_EQ(frame.stillRevision, before);
}

TEST_F(KeptFrame, OnlyTheRowOfAMoverChanges) {
    addBox({0.0, 0.0, -10.0});
    addMover({1.0, 0.0, -10.0});
    addBox({2.0, 0.0, -10.0});
    const uint64_t before = update().stillRevision;
    request.exposure = {1.0, 2.0, 2.0, 1.0};
    const ExtractedFrame& frame = update();
    EXPECT_FALSE(frame.changes.all);
    EXPECT_EQ(frame.changes.rows, std::vector<uint32_t>{1});
    EXPECT_EQ(frame.movingRows, std::vector<uint32_t>{1});
    EXPECT_EQ(frame.movingMotions.size(), 1u);
    EXPECT_EQ(frame.stillRevision, before);
}

TEST_F(KeptFrame, WhatIsWrittenToMovesFromThenOnAndLeavesTheOthersStill) {
    addBox({0.0, 0.0, -10.0});
    const ecs::Entity written = addBox({1.0, 0.0, -10.0});
    const uint64_t before = update().stillSet;
    transformOf(written).transform.translation.x = 1.5;
    const uint64_t joined = update().stillSet;
    EXPECT_NE(joined, before);
    transformOf(written).transform.translation.x = 2.0;
    const ExtractedFrame& frame = update();
    EXPECT_EQ(frame.stillSet, joined);
    EXPECT_EQ(frame.movingRows, std::vector<uint32_t>{1});
    EXPECT_EQ(frame.changes.rows, std::vector<uint32_t>{1});
}

TEST_F(KeptFrame, WhoeverIsNotWrittenToAnyMoreStandsStillAgainWithOthers) {
    std::vector<ecs::Entity> boxes;
    for (int i = 0; i < 100; ++i)
        boxes.push_back(addBox({double(i % 10), double(i / 10), -30.0}));
    update();
    for (const ecs::Entity box : boxes)
        transformOf(box).transform.translation.z = -31.0;
    EXPECT_EQ(update().movingRows.size(), 100u);
    update(); // nobody is written to
    EXPECT_TRUE(update().movingRows.empty());
}

TEST_F(KeptFrame, ACameraThatMovedPlacesAllRowsAnewAndListsNone) {
    addBox({0.0, 0.0, -10.0});
    addMover({1.0, 0.0, -10.0});
    const ExtractedFrame first = update();
    transformOf(camera).transform.translation.x = 0.5;
    const ExtractedFrame& frame = update();
    EXPECT_TRUE(frame.changes.all);
    EXPECT_EQ(frame.stillSet, first.stillSet);
    EXPECT_NE(frame.stillRevision, first.stillRevision);
}

TEST_F(KeptFrame, UnderAMovingCameraOnlyWhatHasAScaleOfItsOwnMoves) {
    addBox({0.0, 0.0, -10.0});
    const ecs::Entity scaled = addBox({1.0, 0.0, -10.0});
    const ecs::Entity child = addBox({2.0, 0.0, -10.0});
    world.registry.add(child, scene::Parent{scaled});
    world.registry.add(camera, scene::LinearVelocity{{0.3, 0.0, 0.0}});
    world.registry.add(scaled, scene::MotionBlur{}); // of scale 1
    const auto updateAt = [&](double seconds) -> const ExtractedFrame& {
        request.exposure.open = seconds - 0.02;
        request.exposure.raster = request.exposure.close = seconds;
        return update();
    };
    const uint64_t listed = updateAt(1.0).stillSet;
    EXPECT_TRUE(updateAt(1.1).movingRows.empty());
    EXPECT_EQ(updateAt(1.2).stillSet, listed) << "nothing is listed anew";
    world.registry.get<scene::MotionBlur>(scaled).exclude = true;
    const uint64_t joined = updateAt(1.3).stillSet;
    EXPECT_NE(joined, listed);
    const ExtractedFrame& frame = updateAt(1.4);
    EXPECT_EQ(frame.stillSet, joined);
    EXPECT_EQ(frame.movingRows, (std::vector<uint32_t>{1, 2}));
    request.exposure.cap.movers.emplace_back(frame.entityHandles[0], 0.5);
    EXPECT_EQ(updateAt(1.5).movingRows, (std::vector<uint32_t>{0, 1, 2}));
}

TEST_F(KeptFrame, ThingsFollowAnAncestorThatIsWrittenTo) {
    const ecs::Entity root = world.registry.create();
    world.registry.add(root, scene::LocalTransform{});
    const ecs::Entity middle = world.registry.create(); // has no transform of its own
    world.registry.add(middle, scene::Parent{root});
    const ecs::Entity leaf = addBox({0.0, 0.0, -10.0});
    world.registry.add(leaf, scene::Parent{middle});
    update();
    transformOf(root).transform.translation.x = 1.0;
    EXPECT_EQ(update().changes.rows, std::vector<uint32_t>{0});
    world.registry.add(
        middle, scene::LocalTransform{{{0.0, 1.0, 0.0}, {1, 0, 0, 0}, math::dvec3(1.0)}}
    );
    EXPECT_EQ(update().changes.rows, std::vector<uint32_t>{0});
}

TEST_F(KeptFrame, WhatBecomesDrawableGetsItsRow) {
    const ecs::Entity root = world.registry.create();
    world.registry.add(
        root, scene::LocalTransform{{math::dvec3(0.0), {1, 0, 0, 0}, math::dvec3(0.0)}}
    );
    const ecs::Entity leaf = addBox({0.0, 0.0, -10.0});
    world.registry.add(leaf, scene::Parent{root});
    addBox({2.0, 0.0, -10.0});
    EXPECT_EQ(update().entities.size(), 1u);
    EXPECT_FALSE(update().changes.all);
    transformOf(root).transform.translation.x = 1.0; // still scaled to nothing
    EXPECT_FALSE(update().changes.all);
    transformOf(root).transform.scale = math::dvec3(1.0);
    EXPECT_EQ(update().entities.size(), 2u);
    transformOf(root).transform.scale = math::dvec3(0.0);
    EXPECT_EQ(update().entities.size(), 1u);
}

TEST_F(KeptFrame, WhatComesAndGoesInTimeHasARowWhileItIsThere) {
    addBox({-2.0, 0.0, -10.0});
    const ecs::Entity parent = addBox({0.0, 0.0, -10.0});
    const ecs::Entity box = addBox({2.0, 0.0, 0.0});
    world.registry.add(box, scene::Parent{parent});
    const auto countAt = [&](double open, double close, bool isPart) {
        request.exposure = {0.0, 4.0, 4.0, 1.0, 4.0};
        request.exposure = isPart ? scene::takePart(request.exposure, open, close)
                                  : scene::ExposureInterval{open, close, close, 1.0, close - open};
        return update().entities.size();
    };
    EXPECT_EQ(countAt(0.0, 1.0, false), 3u);
    scene::appear(world, parent, 1.0);
    scene::hide(world, parent, 3.0);
    // In any order of time, also once nothing is written to any more.
    for (int round = 0; round < 2; ++round) {
        EXPECT_EQ(countAt(0.0, 0.9, true), 1u);
        EXPECT_EQ(countAt(1.1, 2.9, true), 3u);
        EXPECT_EQ(countAt(3.1, 4.0, true), 1u);
        EXPECT_EQ(countAt(1.1, 2.9, true), 3u);
        EXPECT_EQ(countAt(4.0, 5.0, false), 1u) << "hidden all the time";
        EXPECT_EQ(countAt(2.0, 2.5, false), 3u);
        EXPECT_EQ(countAt(0.5, 1.5, false), 3u) << "as at the raster instant";
        EXPECT_EQ(countAt(2.5, 3.5, false), 1u) << "likewise";
    }
}

TEST_F(KeptFrame, MoreChangesThanAreRememberedAreNotMissed) {
    const ecs::Entity first = addBox({0.0, 0.0, -10.0});
    const ecs::Entity second = addBox({1.0, 0.0, -10.0});
    update();
    transformOf(first).transform.translation.x = -1.0;
    for (size_t i = 0; i < 3 * ecs::ChangeLog::kRemembered; ++i)
        transformOf(i % 2 == 0 ? second : camera).transform.scale.x = 1.0;
    EXPECT_TRUE(update().changes.all);
}

TEST_F(KeptFrame, AnotherWorldIsListedAnew) {
    addBox({0.0, 0.0, -10.0});
    update();
    world = scene::World{};
    request.camera = camera = addCamera({});
    addBox({1.0, 0.0, -10.0});
    addBox({2.0, 0.0, -10.0});
    EXPECT_EQ(update().entities.size(), 2u);
}

TEST_F(KeptFrame, AFullTableIsAnErrorUntilThereIsRoom) {
    addBox({0.0, 0.0, -10.0});
    addBox({1.0, 0.0, -10.0});
    request.entityLimit = 1;
    EXPECT_FALSE(extractor.update(world, layout, request).ok());
    request.entityLimit = 2;
    revision = extractor.update(world, layout, request).value()->changes.revision;
    request.entityLimit = 1;
    EXPECT_FALSE(extractor.update(world, layout, request).ok());
}

TEST_F(KeptFrame, RowsThatOthersAppendedAreDropped) {
    addBox({0.0, 0.0, -10.0});
    update();
    ExtractedFrame& frame = *extractor.update(world, layout, request).value();
    revision = frame.changes.revision;
    frame.entities.emplace_back();
    frame.entityMeshes.push_back(0);
    frame.entityHandles.push_back(camera);
    EXPECT_EQ(update().entities.size(), 1u);
}

TEST_F(KeptFrame, APathThatIsNotValidIsRefusedByNameUntilItIsMended) {
    const ecs::Entity box = addBox({0.0, 0.0, -10.0});
    world.registry.add(box, scene::Name{"lift"});
    world.registry.add(box, scene::PathMotion{{{0.0}, {1.0}}});
    update();
    world.registry.get<scene::PathMotion>(box).keys[1].seconds = 0.0;
    for (int frame = 0; frame < 2; ++frame) {
        const auto refused = extractor.update(world, layout, request);
        ASSERT_FALSE(refused.ok());
        EXPECT_EQ(
            refused.error().message,
            "'lift': path: key 1 at 0 s does not come after the one before, at 0 s"
        );
    }
    world.registry.get<scene::PathMotion>(box).keys.clear();
    EXPECT_FALSE(extractor.update(world, layout, request).ok()) << "no keys";
    world.registry.get<scene::PathMotion>(box).keys = {{0.0}, {2.0}};
    EXPECT_TRUE(extractor.update(world, layout, request).ok());
}

TEST_F(KeptFrame, ALensThatIsNotValidIsRefused) {
    world.registry.add(camera, scene::LensMotion{{{0.0, 0.8}, {1.0, 4.0}}});
    const auto refused = extractor.update(world, layout, request);
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message.find("lens: the field of view of key 1"), std::string::npos)
        << refused.error().message;
    world.registry.get<scene::LensMotion>(camera).keys[1].yFov = 1.0;
    EXPECT_TRUE(extractor.update(world, layout, request).ok());
}

} // namespace shutter::extract
