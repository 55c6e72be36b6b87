// SPDX-License-Identifier: MIT
// Rows, draws and deformed meshes on their way from the world to the tables of a frame.
#include "tests/unit/extract/extraction_fixture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shutter::extract {
namespace {

using math::dmat4;
using math::dvec3;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<uint32_t> entitiesOf(const std::vector<DrawItem>& items) {
    std::vector<uint32_t> entities;
    for (const DrawItem& item : items)
        entities.push_back(item.entity);
    return entities;
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

TEST_F(Extraction, EntitiesWithoutTrianglesVolumeOrPlaceGetNoRow) {
    const uint32_t points = addMesh(scene::AlphaMode::Opaque, 0);
    const uint32_t empty = addMesh(scene::AlphaMode::Opaque, 1);
    layout.bounds[empty] = math::Bounds{};
    addBox({0.0, 0.0, -5.0}, points);
    addBox({0.0, 0.0, -5.0}, empty);
    for (const math::dvec3& scale : {math::dvec3(1.0, 0.0, 1.0), math::dvec3(0.0)})
        addBox(math::Transform{.translation = {0.0, 0.0, -5.0}, .scale = scale});
    addBox({kNan, 0.0, -5.0});
    addBox({0.0, kInfinity, -5.0});
    const ecs::Entity fast = addBox({0.0, 0.0, -5.0});
    // Fine at open (time 0), out of range at the close.
    world.registry.add(fast, scene::LinearVelocity{{1e308, 0.0, 0.0}});
    request.exposure = {0.0, 0.0, 1e10, 0.0};
    const ecs::Entity drawn = addBox({0.0, 0.0, -5.0});
    EXPECT_EQ(extract().entityHandles, std::vector<ecs::Entity>{drawn});
}

TEST_F(Extraction, AMirroringTransformIsMarked) {
    addBox(math::Transform{.translation = {0.0, 0.0, -5.0}, .scale = {-1.0, 1.0, 1.0}});
    addBox({0.0, 0.0, -9.0});
    const ExtractedFrame frame = extract();
    ASSERT_EQ(frame.opaque.size(), 2u);
    EXPECT_TRUE(frame.opaque.merge()[0].mirrored);
    EXPECT_EQ(frame.entities[0].handedness, -1.0f);
    EXPECT_FALSE(frame.opaque.merge()[1].mirrored);
    EXPECT_EQ(frame.entities[1].handedness, 1.0f);
}

TEST_F(Extraction, EntitiesOutsideThePictureHaveRowsForRaysButAreNotDrawn) {
    for (const dvec3& outside :
         {dvec3(0, 0, 5), dvec3(-100, 0, -5), dvec3(100, 0, -5), dvec3(0, 100, -5)})
        addBox(outside);
    addBox({0.0, -100.0, -5.0});
    addBox({0.0, 0.0, -0.9});                      // across the near plane
    addBox({3.0, 0.0, -3.0});                      // across the right edge
    addBox({0.0, 0.0, -5.0});                      // in view
    addBox(math::Transform{.scale = dvec3(50.0)}); // the camera is inside
    const ExtractedFrame frame = extract();
    EXPECT_EQ(frame.entities.size(), 9u);
    std::vector<uint32_t> drawn = entitiesOf(frame.opaque.merge());
    std::sort(drawn.begin(), drawn.end());
    EXPECT_EQ(drawn, (std::vector<uint32_t>{5, 6, 7, 8}));
}

TEST_F(Extraction, RowsTakePointsToEyeSpaceWhichHasTheWorldsAxesAndTheCamerasOrigin) {
    const math::Transform pose{{1.0, 2.0, 3.0}, glm::angleAxis(0.7, dvec3(0.0, 1.0, 0.0))};
    request.camera = addCamera(pose);
    addBox({1.0, 2.0, -7.0});
    const math::Transform slanted{
        {1.0, -2.0, -8.0}, glm::angleAxis(1.1, glm::normalize(dvec3(1, 2, 3))), {1.0, 2.0, 0.5}};
    addBox(slanted);
    const ExtractedFrame frame = extract();
    const math::vec4(&rows)[3] = frame.entities.at(0).relWorldFromObject;
    EXPECT_EQ(rows[0], math::vec4(1.0f, 0.0f, 0.0f, 0.0f));
    EXPECT_EQ(rows[1], math::vec4(0.0f, 1.0f, 0.0f, 0.0f));
    EXPECT_EQ(rows[2], math::vec4(0.0f, 0.0f, 1.0f, -10.0f));
    const math::dvec4 point(0.3, -0.4, 0.5, 1.0);
    const math::dvec4 expected =
        math::computeMatrix(slanted) * point - math::dvec4(pose.translation, 0.0);
    const math::vec4(&slantedRows)[3] = frame.entities.at(1).relWorldFromObject;
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(glm::dot(math::dvec4(slantedRows[i]), point), expected[i], 1e-6);
}

TEST_F(Extraction, EachInstantHasTheEntityWhereItIsThen) {
    addMover({0.0, 0.0, -10.0}, {0.5, 0.0, 0.0});
    request.exposure = {2.0, 3.0, 4.0, 0.5};
    const ExtractedFrame frame = extract();
    const shader::EntityRow& row = frame.entities.at(0);
    const shader::EntityMotion motion = motionOf(frame, 0);
    const double focal = 1.0 / std::tan(scene::Camera{}.yFov / 2.0) / 2.0; // aspect 2
    const math::vec3 centre(0.0f);
    EXPECT_NEAR(project(motion.clipFromObjectOpen, centre).x, 0.1 * focal, 1e-6);
    EXPECT_NEAR(project(row.clipFromObjectRaster, centre).x, 0.15 * focal, 1e-6);
    EXPECT_NEAR(project(motion.clipFromObjectClose, centre).x, 0.2 * focal, 1e-6);
    EXPECT_NEAR(row.relWorldFromObject[0].w, 1.5f, 1e-6f);
}

TEST_F(Extraction, AMoverInViewMovesThePictureEvenIfItEndsWhereItBegan) {
    addBox({0.0, 0.0, -10.0});
    addMover({0.0, 0.0, 20.0}, {1.0, 0.0, 0.0});
    EXPECT_FALSE(extract().moves) << "out of view";
    // There and back by a clip, with the raster instant between the two.
    const auto linear = scene::Interpolation::Linear;
    animateX(addBox(dvec3(0.0)), {0.0f, 1.0f, 2.0f}, {0.0f, 1.0f, 0.0f}, linear, 20.0f);
    request.exposure = {0.0, 1.0, 2.0, 0.5};
    EXPECT_TRUE(extract().moves);
}

/// Mesh 0 is deformed by joints 0 (below) and 1 (above), or by a morph target.
class DeformedEntities : public Extraction {
  protected:
    DeformedEntities() { makeDeformable(2); }

    ecs::Entity addJoint(const math::Transform& transform) {
        const ecs::Entity joint = world.registry.create();
        world.registry.add(joint, scene::LocalTransform{transform});
        return joint;
    }

    ecs::Entity addChild(ecs::Entity parent, const math::Transform& transform) {
        const ecs::Entity joint = addJoint(transform);
        world.registry.add(joint, scene::Parent{parent});
        return joint;
    }

    ecs::Entity addTurning(const math::Transform& transform) {
        const ecs::Entity joint = addJoint(transform);
        world.registry.add(joint, scene::AngularVelocity{{0.0, 2.0, 0.5}});
        return joint;
    }

    ecs::Entity addSkinned(ecs::Entity below, ecs::Entity above) {
        const ecs::Entity entity = addBox(dvec3(0.0));
        world.registry.add(entity, scene::Skinned{0, {below, above}});
        return entity;
    }

    ecs::Entity addSkinned(const dvec3& below, const dvec3& above) {
        return addSkinned(addJoint({below}), addJoint({above}));
    }

    /// The weight goes from one to the other in the exposure.
    ecs::Entity addMorphed(float from, float to) {
        return Extraction::addMorphed({0, 0, -5}, {0.0f, 1.0f}, {from, to});
    }
};

TEST_F(DeformedEntities, GeometriesOfDeformedEntitiesFollowTheScenesOwn) {
    const uint32_t two = addMesh(scene::AlphaMode::Opaque, 2);
    layout.reaches.push_back(layout.reaches[0]);
    addBox(dvec3(0, 0, -5), two);
    addSkinned({0, 0, -5}, {0, 0, -5});
    const ecs::Entity both = addMorphed(0.0f, 1.0f);
    world.registry.get<scene::MeshInstance>(both).mesh = two;
    addSkinned({0, 0, -5}, {0, 0, -5});

    const ExtractedFrame frame = extract();
    ASSERT_EQ(frame.entities.size(), 4u);
    ASSERT_EQ(frame.deformed.size(), 3u);
    EXPECT_EQ(frame.entities[0].firstGeometry, 1u);
    EXPECT_EQ(frame.entities[1].firstGeometry, 3u);
    EXPECT_EQ(frame.entities[2].firstGeometry, 4u);
    EXPECT_EQ(frame.entities[3].firstGeometry, 6u);
    for (const DrawItem& item : frame.opaque.merge()) {
        const uint32_t mesh = frame.entityMeshes[item.entity];
        EXPECT_EQ(
            item.geometryRow - frame.entities[item.entity].firstGeometry,
            item.geometry - layout.firstGeometry[mesh]
        );
    }
    EXPECT_EQ(frame.opaque.size(), 6u);
}

TEST_F(DeformedEntities, DeformedEntitiesAreCulledByTheirDeformedBounds) {
    // The box at rest is in the picture, its pose is not; and the other way round.
    addSkinned({100, 0, -5}, {100, 0, -5});
    EXPECT_TRUE(extract().opaque.empty());
    addSkinned({100, 0, -5}, {0, 0, -5});
    EXPECT_EQ(extract().opaque.size(), 1u);
}

TEST_F(DeformedEntities, AChangeOfShapeIsMotion) {
    addMorphed(0.5f, 0.5f);
    EXPECT_FALSE(extract().moves);
    EXPECT_FALSE(extract().deformed.at(0).changes);
    addMorphed(0.5f, 0.75f);
    const ExtractedFrame frame = extract();
    EXPECT_TRUE(frame.moves);
    EXPECT_TRUE(frame.deformed.at(1).changes);
    EXPECT_EQ(frame.deformed[1].open.morphWeights.at(0), 0.5);
    EXPECT_EQ(frame.deformed[1].close.morphWeights.at(0), 0.75);
    EXPECT_EQ(frame.deformed[1].raster.morphWeights.at(0), 0.75);
}

TEST_F(DeformedEntities, AHeldSkeletonThatIsCarriedIsOneShape) {
    for (const double away : {0.0, 0.3, 1.0e4, 1.0e6}) {
        const ecs::Entity root = addJoint({{away, -3.0 * away, -5.0}});
        world.registry.add(root, scene::LinearVelocity{{0.7, 0.3, 0.1}});
        addSkinned(
            root, addChild(root, {{0.1, 0.2, 0.3}, glm::angleAxis(0.7, dvec3(0.6, 0, 0.8))})
        );
        const ExtractedFrame frame = extract();
        EXPECT_FALSE(frame.deformed.back().changes) << away;
        EXPECT_TRUE(frame.moves);
    }
}

TEST_F(DeformedEntities, ASmallBendIsAChangeOfShape) {
    const ecs::Entity above = addJoint({{0, 0, -5}});
    world.registry.add(above, scene::AngularVelocity{{0.0, 0.0, 1.0e-6}});
    addSkinned(addJoint({{0, 0, -5}}), above);
    const ExtractedFrame frame = extract();
    EXPECT_TRUE(frame.deformed.at(0).changes);
    EXPECT_FALSE(frame.deformed[0].carrier) << "a body in two pieces";
}

TEST_F(DeformedEntities, AHeldSkeletonThatTurnsIsCarriedByAJointUnlessItsScaleIsZero) {
    const ecs::Entity root = addTurning({{1.0e4, 0, -5}});
    world.registry.add(root, scene::LinearVelocity{{0.7, 0.3, 0.1}});
    addSkinned(root, addChild(root, {.translation = {0.1, 0.2, 0.3}, .scale = {1.0, 0.5, -2.0}}));
    const ecs::Entity stands = addJoint({{0, 0, -5}});
    addSkinned(addTurning({.translation = {0, 0, -5}, .scale = dvec3(0.0)}), stands);
    const ExtractedFrame frame = extract();
    EXPECT_TRUE(frame.deformed.at(0).changes) << "in the world's axes";
    EXPECT_TRUE(frame.deformed[0].carrier);
    EXPECT_FALSE(frame.deformed.at(1).carrier) << "one joint stands, the other is a point";
    world.registry.get<scene::LocalTransform>(stands).transform.scale = dvec3(0.0);
    EXPECT_FALSE(extract().deformed.at(1).carrier) << "all is a point";
}

TEST_F(DeformedEntities, AHeldSkeletonWhoseWeightsChangeDeforms) {
    const ecs::Entity root = addTurning({{0, 0, -5}});
    const ecs::Entity entity = addSkinned(root, root);
    EXPECT_TRUE(extract().deformed.at(0).carrier);
    const ecs::Entity other = addMorphed(0.0f, 1.0f);
    world.registry.add(entity, scene::MorphWeights(world.registry.get<scene::MorphWeights>(other)));
    EXPECT_FALSE(extract().deformed.at(0).carrier);
}

TEST_F(DeformedEntities, AMirroredSkeletonTurnsTheWindingRound) {
    const ecs::Entity root = addJoint({.translation = {0, 0, -5}, .scale = {-1, 1, 1}});
    addSkinned(root, root);
    const ExtractedFrame frame = extract();
    ASSERT_EQ(frame.opaque.size(), 1u);
    EXPECT_TRUE(frame.opaque.merge()[0].mirrored);
    EXPECT_EQ(frame.entities[0].handedness, -1.0f);
    EXPECT_TRUE(frame.deformed.at(0).mirrored);
}

TEST_F(DeformedEntities, MostJointsDecideWhetherASkeletonMirrors) {
    const dmat4 mirror = glm::scale(dmat4(1.0), dvec3(-1, 1, 1));
    const dmat4 flat = glm::scale(dmat4(1.0), dvec3(-1, 0, 1));
    const math::Bounds deformed{dvec3(-1.0), dvec3(1.0)};
    scene::PoseReach all;
    all.joints = {deformed, deformed, deformed};
    EXPECT_FALSE(isMirrored({{}, {1.0}}, all));
    EXPECT_FALSE(isMirrored({{mirror, dmat4(1.0)}, {}}, all));
    EXPECT_TRUE(isMirrored({{mirror, dmat4(1.0), mirror}, {}}, all));
    EXPECT_TRUE(isMirrored({{flat, mirror, flat}, {}}, all));
    // Only this mesh's joints of a shared skeleton count.
    scene::PoseReach first;
    first.joints = {deformed, {}, {}};
    EXPECT_TRUE(isMirrored({{mirror, dmat4(1.0), dmat4(1.0)}, {}}, first));
}

TEST_F(DeformedEntities, AShapeThatIsNotFiniteIsNotDrawn) {
    const math::Transform bad{.translation = {0, 0, -5}, .scale = {1.0, kNan, 1.0}};
    addSkinned(addJoint({{0, 0, -5}}), addJoint(bad));
    EXPECT_TRUE(extract().entities.empty());
    addMorphed(float(kNan), float(kNan));
    EXPECT_TRUE(extract().entities.empty());
    addSkinned({0, 0, -5}, {1e19, 0, -5});
    EXPECT_TRUE(extract().entities.empty()) << "too far away for acceleration structures";
    // A joint that bends nothing may be anywhere, and a skeleton may be scaled to nothing.
    const ecs::Entity joint = addJoint({.translation = {0, 0, -5}, .scale = dvec3(0.0)});
    const ecs::Entity entity = addBox(dvec3(0.0));
    world.registry.add(entity, scene::Skinned{1, {joint, joint, addJoint(bad)}});
    world.assets.skins.push_back({"", std::vector<dmat4>(3, dmat4(1.0))});
    const ExtractedFrame frame = extract();
    ASSERT_EQ(frame.entityHandles, std::vector<ecs::Entity>{entity});
    EXPECT_FALSE(frame.deformed.at(0).bounds.isEmpty());
}

TEST_F(DeformedEntities, AShapeThatChangesOnTheSpotIsABoxForRaysAndAStaticOneAnOrdinaryMesh) {
    addSkinned({0, 0, -5}, {0, 1, -5});
    addBox(dvec3(0, 0, -7));
    addMorphed(0.0f, 1.0f);
    ExtractedFrame frame = extract();
    const TimedTables tables = computeTables(frame);
    EXPECT_EQ(tables.rows.size(), 3u);
    EXPECT_EQ(tables.moving, std::vector<uint32_t>{2});
    ASSERT_EQ(tables.shapes.size(), 2u);
    EXPECT_EQ(tables.shapes[0].row, 0u);
    EXPECT_FALSE(tables.shapes[0].changes());
    EXPECT_EQ(tables.shapes[1].keys.size(), 2u);
    ASSERT_EQ(tables.boxes.size(), 1u);
    EXPECT_LE(tables.boxes[0].min.y, -1.0f);
    EXPECT_GE(tables.boxes[0].max.y, 2.0f) << "the upper vertices are lifted";
}

TEST_F(DeformedEntities, EntitiesScaledToZeroAtTheRasterInstantMayBeHitBefore) {
    animateScale(addMorphed(0.0f, 1.0f), {0.0f, 1.0f}, {1.0f, 0.0f});
    ExtractedFrame frame = extract();
    EXPECT_TRUE(frame.entities.empty());
    const TimedTables tables = computeTables(frame);
    ASSERT_EQ(tables.extra.size(), 1u);
    ASSERT_EQ(tables.shapes.size(), 1u);
    EXPECT_EQ(tables.shapes[0].row, 0u);
    EXPECT_EQ(tables.moving, std::vector<uint32_t>{0});
}

TEST_F(DeformedEntities, ShapesThatNeedTooMuchMemoryAreRefused) {
    layout.geometries[0].vertexCount = 20'000'000;
    addMorphed(0.0f, 1.0f);
    ExtractedFrame frame = extract();
    const auto tables = computeTimedTables(world, layout, request, frame);
    ASSERT_FALSE(tables.ok());
    EXPECT_EQ(
        tables.error().message,
        "rays that each have their own time need 2441 MiB for 1 skinned or morphed entity with up "
        "to 2 shapes each, more than the 1024 MiB there may be: shorten the exposure"
    );
}

TEST_F(Extraction, WavesThatNoVertexCanFollowAreRefusedByTheEntitysName) {
    const ecs::Entity flag = addBox(math::dvec3(0, 0, -5));
    world.registry.add(flag, scene::Name{"flag"});
    world.registry.add(flag, scene::VertexWaves{.exponent = 0.0});
    const auto frame = extractFrame(world, layout, request);
    ASSERT_FALSE(frame.ok());
    EXPECT_EQ(frame.error().message, "'flag': the waves' exponent is 0, not in [1, 16]");
}

} // namespace
} // namespace shutter::extract
