// SPDX-License-Identifier: MIT
// Places of a raster's surfaces at other instants and in the last raster, compared with a
// projection of the same point; and when the last raster is not used.
#include "engine/extract/frame_view.h"
#include "engine/extract/instant_tables.h"
#include "engine/math/transform.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/history.h"
#include "engine/scene/motion.h"
#include "tests/unit/extract/extraction_fixture.h"

#include <utility>

namespace shutter::extract {
namespace {

using math::dvec2;
using math::dvec3;
using math::dvec4;
using math::LayerTables;
using math::vec3;
using math::vec4;

constexpr uint32_t kInstants = 5;
constexpr double kFrameSeconds = 0.25;
constexpr double kExposureSeconds = 0.125;
const dvec3 kCorner(0.9, -0.7, 0.3); // of a box

/// What a pixel shows: its place and its depth.
struct Seen {
    math::dvec2 at{0.0};
    double depth = 0.0;
};

class InstantTablesTest : public Extraction {
  protected:
    InstantTablesTest() { setTime(1.0); }

    void setTime(double seconds) {
        scene::CameraShutter shutter;
        shutter.exposureSeconds = kExposureSeconds;
        request.exposure = scene::computeExposure(shutter, seconds, kFrameSeconds);
    }

    /// A camera that goes and turns.
    void moveCamera() {
        world.registry.add(camera, scene::LinearVelocity{{0.3, -0.1, 0.4}});
        world.registry.add(camera, scene::AngularVelocity{{0.1, 0.2, 0.3}});
    }

    ecs::Entity addTumbler() {
        const ecs::Entity tumbler = addMover({0.5, 0.2, -8.0}, {1.0, 0.5, 1.5});
        world.registry.add(tumbler, scene::AngularVelocity{{2.0, 3.0, 1.0}});
        return tumbler;
    }

    InstantTables compute(const RasterRecord* last = nullptr) {
        return computeInstantTables(world, request, motion(), extract(), kInstants, last);
    }

    /// With a raster of shutter open.
    InstantTables computeWithSecond(const RasterRecord* last = nullptr) {
        ViewRequest atOpen = request;
        atOpen.instant = 0.0;
        const auto second = extractFrame(world, layout, atOpen);
        const InstantFrame frame{0.0, second.value()};
        return computeInstantTables(world, request, motion(), extract(), kInstants, last, &frame);
    }

    InstantTables computeThroughLens(const RasterRecord* last = nullptr) {
        const uint32_t instants = kInstants * shader::kLensSets;
        return computeInstantTables(world, request, motion(), extract(), instants, last);
    }

    /// The raster of the frame before.
    RasterRecord drawLast() {
        setTime(1.0 - kFrameSeconds);
        const RasterRecord last = compute().record;
        setTime(1.0);
        return last;
    }

    /// The tables of the frame at 1 s, after one at 1 s - kFrameSeconds.
    InstantTables computeSecondFrame() {
        const RasterRecord last = drawLast();
        return compute(&last);
    }

    /// Where the raster of the frame before has the corner of an entity.
    Seen projectLast(ecs::Entity entity) {
        setTime(1.0 - kFrameSeconds);
        const Seen seen = project(entity, 1.0);
        setTime(1.0);
        return seen;
    }

    /// Where the request's picture of shutter time s has the corner of an entity.
    Seen project(ecs::Entity entity, double s) const {
        const scene::ExposureMotion motion(world, camera, request.exposure);
        const math::dmat4 view = glm::inverse(motion.worldFromCamera(s));
        const dvec4 inView = view * motion.worldFromObject(entity, s) * dvec4(kCorner, 1.0);
        const auto& lens = world.registry.get<scene::Camera>(camera);
        const dvec4 clip = makeProjection(lens, motion.cameraYFov(s), request) * inView;
        const math::dvec2 size(request.width, request.height);
        return {(math::dvec2(clip) / clip.w * 0.5 + 0.5) * size, -inView.z};
    }

    static vec3 apply(const vec4 (&rows)[3], const Seen& seen, bool perspective) {
        const float q = perspective ? float(seen.depth) : 1.0f;
        const vec4 point(vec3(math::vec2(seen.at) * q, float(seen.depth)), 1.0f);
        const vec3 moved(
            glm::dot(rows[0], point), glm::dot(rows[1], point), glm::dot(rows[2], point)
        );
        return perspective ? vec3(moved.x / moved.z, moved.y / moved.z, moved.z) : moved;
    }

    /// Both maps of a mover take what one picture shows to where the other does.
    void
    expectMaps(const LayerTables& layer, uint32_t row, const Seen& raster, ecs::Entity entity) {
        const bool perspective =
            world.registry.get<scene::Camera>(camera).kind == scene::CameraKind::Perspective;
        for (uint32_t i = 0; i < kInstants; ++i) {
            const auto& motion = layer.motions.at(layer.movers.at(row) * kInstants + i);
            const Seen seen = project(entity, (i + 0.5) / kInstants);
            const vec3 there = apply(motion.instantFromRaster, raster, perspective);
            EXPECT_NEAR(there.x, seen.at.x, 2e-3) << i;
            EXPECT_NEAR(there.y, seen.at.y, 2e-3) << i;
            EXPECT_NEAR(there.z, seen.depth, 1e-4) << i;
            const vec3 back = apply(motion.rasterFromInstant, seen, perspective);
            EXPECT_NEAR(back.x, raster.at.x, 2e-3) << i;
            EXPECT_NEAR(back.y, raster.at.y, 2e-3) << i;
        }
    }
};

TEST_F(InstantTablesTest, ATumblingMoverMatchesItsProjectionByEitherCamera) {
    moveCamera();
    const ecs::Entity tumbler = addTumbler();
    auto& lens = world.registry.get<scene::Camera>(camera);
    lens.yMag = 3.0;
    for (const auto kind : {scene::CameraKind::Perspective, scene::CameraKind::Orthographic}) {
        lens.kind = kind;
        const InstantTables tables = compute();
        EXPECT_EQ(tables.isPerspective, kind == scene::CameraKind::Perspective);
        expectMaps(tables.raster, 0, project(tumbler, 1.0), tumbler);
    }
}

TEST_F(InstantTablesTest, StaticEntitiesUnderAMovingCameraAreOneMover) {
    moveCamera();
    const ecs::Entity first = addBox({0.0, 0.0, -8.0});
    addBox({2.0, 0.0, -9.0});
    const InstantTables tables = compute();
    EXPECT_EQ(tables.raster.movers.at(0), shader::kWorldMover);
    EXPECT_EQ(tables.raster.movers.at(1), shader::kWorldMover);
    EXPECT_EQ(tables.raster.movers.at(2), shader::kSkyMover);
    EXPECT_FALSE(tables.raster.isStatic);
    expectMaps(tables.raster, 0, project(first, 1.0), first);
}

TEST_F(InstantTablesTest, BothLayersAreStaticUnderAStaticCamera) {
    addTumbler();
    const InstantTables tables = computeSecondFrame();
    EXPECT_TRUE(tables.raster.isStatic);
    ASSERT_TRUE(tables.last.has_value());
    EXPECT_TRUE(tables.last->isStatic);
}

TEST_F(InstantTablesTest, ALensAddsPlacesButNoMotions) {
    addTumbler();
    world.registry.add(camera, scene::CameraLens{.fStop = 1.0, .focusDistance = 3.0});
    const InstantTables pinhole = compute();
    request.usesLens = true;
    const InstantTables tables = computeThroughLens();
    EXPECT_EQ(tables.raster.motions.size(), pinhole.raster.motions.size());
    EXPECT_EQ(tables.lens.size(), size_t(kInstants) * shader::kLensSets);
    EXPECT_EQ(tables.times.size(), tables.lens.size());
    ASSERT_EQ(tables.lensReaches.size(), size_t(kInstants) + 1);
    EXPECT_FALSE(tables.raster.isStatic);
    for (size_t i = 0; i < tables.lens.size(); ++i) {
        const shader::LensReach& reach = tables.lensReaches[i / shader::kLensSets];
        EXPECT_NEAR(reach.inverseFocus, 1.0 / 3.0, 1e-6);
        for (int axis = 0; axis < 2; ++axis) {
            EXPECT_GE(tables.lens[i][axis + 2], reach.low[axis]);
            EXPECT_LE(tables.lens[i][axis + 2], reach.high[axis]);
            EXPECT_NEAR(tables.lens[i][axis], -tables.lens[i][axis + 2] / 3.0, 1e-4);
        }
    }
}

TEST_F(InstantTablesTest, WithALensALastRasterOfTheSameAddsNothing) {
    world.registry.add(camera, scene::CameraLens{.fStop = 1.0, .focusDistance = 3.0});
    const ecs::Entity box = addBox({0.0, 0.0, -8.0});
    request.usesLens = true;
    const auto hasLast = [&] {
        setTime(1.0 - kFrameSeconds);
        const RasterRecord last = computeThroughLens().record;
        setTime(1.0);
        return computeThroughLens(&last).last.has_value();
    };
    EXPECT_FALSE(hasLast());
    world.registry.add(box, scene::LinearVelocity{{1.0, 0.0, 0.0}});
    EXPECT_TRUE(hasLast());
}

TEST_F(InstantTablesTest, TheLastAndTheSecondRasterShowWhereTheirSurfacesAreNow) {
    moveCamera();
    const ecs::Entity tumbler = addTumbler();
    const ecs::Entity wall = addBox({0.0, 0.0, -20.0});
    const RasterRecord last = drawLast();
    const InstantTables tables = computeWithSecond(&last);
    ASSERT_TRUE(tables.last.has_value() && tables.second.has_value());
    expectMaps(*tables.last, 0, projectLast(tumbler), tumbler);
    expectMaps(*tables.last, 1, projectLast(wall), wall);
    expectMaps(*tables.second, 0, project(tumbler, 0.0), tumbler);
    expectMaps(*tables.second, 1, project(wall, 0.0), wall);
    EXPECT_EQ(tables.last->movers.at(1), shader::kWorldMover);
    EXPECT_EQ(tables.second->movers.at(1), shader::kWorldMover);
    EXPECT_EQ(tables.record.seconds, 1.0) << "the next frame reads the frame's own raster";
}

TEST_F(InstantTablesTest, EntitiesAppearingDuringTheExposureAreInBothRasters) {
    const ecs::Entity tumbler = addTumbler();
    scene::appear(world, tumbler, 1.0 - 0.5 * kExposureSeconds);
    const InstantTables tables = computeWithSecond();
    ASSERT_TRUE(tables.second.has_value());
    EXPECT_EQ(tables.second->movers.at(0), shader::kWorldMover) << "without a past it is static";
}

TEST_F(InstantTablesTest, RowsThatMoveUpAreFoundByTheirEntity) {
    const ecs::Entity first = addTumbler();
    const ecs::Entity second = addTumbler();
    const RasterRecord last = drawLast();
    scene::despawn(world, first);
    const InstantTables tables = compute(&last);
    ASSERT_TRUE(tables.last.has_value());
    EXPECT_EQ(tables.last->movers.at(0), shader::kNoMover);
    expectMaps(*tables.last, 1, projectLast(second), second);
    EXPECT_EQ(tables.last->rasterRows, (std::vector<uint32_t>{shader::kNoRasterRow, 0}));
}

TEST_F(InstantTablesTest, EntitiesScaledToZeroRemainInTheLastRaster) {
    const ecs::Entity shrinking = addBox({0.5, 0.2, -8.0});
    animateScale(shrinking, {0.5f, 1.0f}, {1.0f, 0.0f});
    const RasterRecord last = drawLast();
    const InstantTables tables = compute(&last);
    EXPECT_TRUE(extract().entities.empty());
    ASSERT_TRUE(tables.last.has_value());
    expectMaps(*tables.last, 0, projectLast(shrinking), shrinking);
    scene::hide(world, shrinking);
    EXPECT_EQ(compute(&last).last->movers.at(0), shader::kNoMover) << "hidden entities are absent";
}

TEST_F(InstantTablesTest, ARasterOlderThanOneFrameIsNotUsed) {
    addTumbler();
    RasterRecord last = drawLast();
    EXPECT_TRUE(compute(&last).last.has_value());
    last.seconds -= kFrameSeconds;
    EXPECT_FALSE(compute(&last).last.has_value());
}

TEST_F(InstantTablesTest, TheLastRasterIsThatOfEachPartOfTheExposure) {
    moveCamera();
    const ecs::Entity tumbler = addTumbler();
    const RasterRecord last = drawLast();
    const Seen then = projectLast(tumbler);
    const scene::ExposureInterval whole = request.exposure;
    for (const auto& [from, to] : {std::pair{0.0, 0.3}, {0.3, 1.0}}) {
        request.exposure = scene::takePart(whole, whole.at(from), whole.at(to));
        const InstantTables tables = compute(&last);
        ASSERT_TRUE(tables.last.has_value());
        expectMaps(*tables.last, 0, then, tumbler);
        EXPECT_EQ(tables.record.seconds, 1.0) << "the frame's own time";
    }
}

TEST_F(InstantTablesTest, TheViewBeforeDrawsTheLastRaster) {
    moveCamera();
    addTumbler();
    const RasterRecord last = drawLast();
    const auto before = makeViewBefore(world, request, motion());
    ASSERT_TRUE(before.has_value());
    const auto frame = extractFrame(world, layout, *before);
    const scene::ExposureMotion motionBefore(world, camera, before->exposure);
    const RasterRecord record =
        makeRasterRecord(world, *before, motionBefore, frame.value(), before->exposure.rasterTime);
    EXPECT_EQ(record.seconds, last.seconds);
    EXPECT_EQ(record.pictureFromWorld, last.pictureFromWorld);
    EXPECT_EQ(record.entities, last.entities);
    EXPECT_EQ(record.worldFromObject, last.worldFromObject);
    EXPECT_TRUE(isOfFrameBefore(world, request, motion(), record));
}

TEST_F(InstantTablesTest, AFrameThatIsDrawnAgainIsKnownByItsTimeAndItsCamera) {
    moveCamera();
    addTumbler();
    const RasterRecord drawn = compute().record;
    const auto isAgain = [&] { return isOfSameFrame(world, request, motion(), drawn); };
    EXPECT_TRUE(isAgain());
    request.jitterPx = {0.3, -0.2};
    EXPECT_TRUE(isAgain()) << "wherever in the pixel";
    setTime(1.0 + kFrameSeconds);
    EXPECT_FALSE(isAgain());
    setTime(1.0);
    world.registry.get<scene::LocalTransform>(camera).transform.translation.x += 0.1;
    EXPECT_FALSE(isAgain());
}

TEST_F(InstantTablesTest, NoLastRasterIsUsedAfterACutAPauseOrTheBeginning) {
    moveCamera();
    ASSERT_TRUE(makeViewBefore(world, request, motion()).has_value());
    request.exposure.frameSeconds = 0.0;
    EXPECT_FALSE(makeViewBefore(world, request, motion()).has_value());
    setTime(1.0);
    scene::cut(world, camera, 0.8);
    EXPECT_FALSE(makeViewBefore(world, request, motion()).has_value());
    scene::cut(world, camera, 0.7);
    EXPECT_TRUE(makeViewBefore(world, request, motion()).has_value()) << "before the frame before";
    world.startSeconds = 0.9;
    EXPECT_FALSE(makeViewBefore(world, request, motion()).has_value());
}

TEST_F(InstantTablesTest, InstantsFollowTheResponse) {
    addTumbler();
    request.exposure.shutter.response.shape = scene::ResponseShape::Triangle;
    const InstantTables tables = compute();
    ASSERT_EQ(tables.times.size(), kInstants);
    for (uint32_t i = 0; i < kInstants; ++i)
        EXPECT_FLOAT_EQ(
            tables.times[i],
            float(scene::invertResponse(request.exposure.shutter.response, (i + 0.5) / kInstants))
        );
}

/// The fixture's box with a morph target that lifts all of it by 1 m, or a skin of one joint.
class ShapeWaysTest : public InstantTablesTest {
  protected:
    ShapeWaysTest() { makeDeformable(1, 1.0f); }

    /// Weights go from 0 to 1 between the times.
    ecs::Entity addMorphed(float from, float to) {
        return Extraction::addMorphed({0.0, 0.0, -8.0}, {from, to}, {0.0f, 1.0f});
    }

    ecs::Entity addSkin(const scene::AngularVelocity& turn) {
        const ecs::Entity joint = world.registry.create();
        world.registry.add(joint, scene::LocalTransform{{.translation = {0.0, 0.0, -8.0}}});
        world.registry.add(joint, turn);
        const ecs::Entity entity = addBox(dvec3(0.0));
        world.registry.add(entity, scene::Skinned{0, {joint}});
        return entity;
    }

    /// The corner by a shape's map. \param rows three
    static dvec2 placeBy(const vec4* rows) {
        const vec4 p(vec3(kCorner), 1.0f);
        return dvec2(glm::dot(rows[0], p), glm::dot(rows[1], p)) / double(glm::dot(rows[2], p));
    }
};

TEST_F(ShapeWaysTest, DeformingEntitiesAreDrawnFromBothRasters) {
    moveCamera();
    const ecs::Entity entity = addMorphed(0.0f, 2.0f);
    const Seen then = projectLast(entity);
    const InstantTables tables = computeSecondFrame();
    ASSERT_EQ(tables.rasterWays.size(), 1u);
    EXPECT_EQ(tables.raster.movers.at(0), shader::kDeformedMover);
    ASSERT_TRUE(tables.last.has_value());
    EXPECT_EQ(tables.last->movers.at(0), shader::kDeformedMover);
    ASSERT_EQ(tables.lastWays.size(), 1u);
    const shader::ShapeWayRow& maps = tables.lastWays[0].maps;
    EXPECT_NEAR(double(glm::dot(maps.raster[3], vec4(vec3(kCorner), 1.0f))), then.depth, 1e-4);
    EXPECT_LT(glm::distance(placeBy(maps.raster), then.at), 2e-3);
    EXPECT_LT(glm::distance(placeBy(maps.open), project(entity, 0.0).at), 2e-3);
    EXPECT_LT(glm::distance(placeBy(maps.middle), project(entity, 0.5).at), 2e-3);
    EXPECT_LT(glm::distance(placeBy(maps.close), project(entity, 1.0).at), 2e-3);
    ASSERT_EQ(tables.middles.size(), 1u);
    EXPECT_NEAR(tables.middles[0].morphWeights.at(0), 0.5 * (1.0 - 0.5 * kExposureSeconds), 1e-7);
}

TEST_F(ShapeWaysTest, ShapesAreRigidInARasterUnlessTheyChangedSinceThen) {
    addMorphed(0.8f, 0.85f); // between the exposures: this one opens at 0.875 s
    addMorphed(2.0f, 3.0f);
    addTumbler();
    const InstantTables tables = computeSecondFrame();
    ASSERT_TRUE(tables.last.has_value());
    EXPECT_EQ(tables.raster.movers.at(0), shader::kWorldMover);
    EXPECT_EQ(tables.last->movers.at(0), shader::kDeformedMover);
    EXPECT_EQ(tables.last->movers.at(1), shader::kWorldMover);
    EXPECT_EQ(tables.lastWays.size(), 1u);
    EXPECT_TRUE(tables.middles.at(1).morphWeights.empty()) << "nobody needs it";
}

TEST_F(ShapeWaysTest, ASkinThatTurnsAsOneIsARigidMoverInAllLayers) {
    addSkin({{1.0, 2.0, 0.5}});
    const RasterRecord last = drawLast();
    const InstantTables tables = computeWithSecond(&last);
    for (const LayerTables* layer : {&tables.raster, &*tables.last, &*tables.second})
        EXPECT_LT(layer->movers.at(0), shader::kDeformedMover);
    EXPECT_TRUE(tables.rasterWays.empty() && tables.lastWays.empty() && tables.secondWays.empty());
}

TEST_F(ShapeWaysTest, ShapesOfAnotherMeshOrATeleportedJointHaveNoPast) {
    const ecs::Entity entity = addMorphed(0.0f, 2.0f);
    const ecs::Entity skinned = addSkin({{1.0, 2.0, 0.5}});
    layout.reaches.push_back(layout.reaches[0]);
    const uint32_t other = addMesh(scene::AlphaMode::Opaque, 1);
    addTumbler();
    const RasterRecord last = drawLast();
    world.registry.get<scene::MeshInstance>(entity).mesh = other;
    const ecs::Entity joint = world.registry.get<scene::Skinned>(skinned).joints[0];
    scene::teleport(world, joint, {.translation = {1.0, 1.0, -6.0}}, 0.8);
    const InstantTables tables = compute(&last);
    ASSERT_TRUE(tables.last.has_value());
    EXPECT_EQ(tables.last->movers.at(0), shader::kNoMover);
    EXPECT_EQ(tables.last->movers.at(1), shader::kNoMover);
}

} // namespace
} // namespace shutter::extract
