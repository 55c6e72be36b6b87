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
        const ecs::Entity tumbler = addBox({0.5, 0.2, -8.0});
        world.registry.add(tumbler, scene::LinearVelocity{{1.0, 0.5, 1.5}});
        world.registry.add(tumbler, scene::AngularVelocity{{2.0, 3.0, 1.0}});
        return tumbler;
    }

    InstantTables compute(const RasterRecord* last = nullptr) {
        return computeInstantTables(world, request, motion(), extract(), kInstants, last);
    }

    /// With a raster of shutter open.
    InstantTables computeWithSecond() {
        ViewRequest atOpen = request;
        atOpen.instant = 0.0;
        const auto second = extractFrame(world, layout, atOpen);
        const InstantFrame frame{0.0, second.value()};
        return computeInstantTables(
            world, request, motion(), extract(), kInstants, nullptr, &frame
        );
    }

    /// The tables of the frame at 1 s, after one at 1 s - kFrameSeconds.
    InstantTables computeSecondFrame() {
        setTime(1.0 - kFrameSeconds);
        const RasterRecord last = compute().record;
        setTime(1.0);
        return compute(&last);
    }

    /// Where the request's picture of shutter time s has a point of an entity's own space.
    Seen project(ecs::Entity entity, const dvec3& point, double s) const {
        const scene::ExposureMotion motion(world, camera, request.exposure);
        const math::dmat4 view = glm::inverse(motion.worldFromCamera(s));
        const dvec4 inView = view * motion.worldFromObject(entity, s) * dvec4(point, 1.0);
        const auto& lens = world.registry.get<scene::Camera>(camera);
        const dvec4 clip = makeProjection(lens, motion.cameraYFov(s), request) * inView;
        const math::dvec2 size(request.width, request.height);
        return {(math::dvec2(clip) / clip.w * 0.5 + 0.5) * size, -inView.z};
    }

    static vec3 apply(const vec4 (&rows)[3], const Seen& seen, bool perspective) {
        const float q = perspective ? float(seen.depth) : 1.0f;
        const vec4 point(vec3(vec2Of(seen) * q, float(seen.depth)), 1.0f);
        const vec3 moved(dot(rows[0], point), dot(rows[1], point), dot(rows[2], point));
        return perspective ? vec3(moved.x / moved.z, moved.y / moved.z, moved.z) : moved;
    }

    static math::vec2 vec2Of(const Seen& seen) { return math::vec2(seen.at); }

    static float dot(const vec4& a, const vec4& b) { return glm::dot(a, b); }

    /// Both maps of a mover take what one picture shows to where the other does.
    void expectMaps(
        const LayerTables& layer,
        uint32_t row,
        const Seen& raster,
        ecs::Entity entity,
        const dvec3& point
    ) {
        const bool perspective =
            world.registry.get<scene::Camera>(camera).kind == scene::CameraKind::Perspective;
        for (uint32_t i = 0; i < kInstants; ++i) {
            const auto& motion = layer.motions.at(layer.movers.at(row) * kInstants + i);
            const Seen seen = project(entity, point, (i + 0.5) / kInstants);
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
    const dvec3 corner(0.9, -0.7, 0.3);
    auto& lens = world.registry.get<scene::Camera>(camera);
    lens.yMag = 3.0;
    for (const auto kind : {scene::CameraKind::Perspective, scene::CameraKind::Orthographic}) {
        lens.kind = kind;
        const InstantTables tables = compute();
        EXPECT_EQ(tables.isPerspective, kind == scene::CameraKind::Perspective);
        expectMaps(tables.raster, 0, project(tumbler, corner, 1.0), tumbler, corner);
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
    const dvec3 corner(0.5, 0.5, 0.5);
    expectMaps(tables.raster, 0, project(first, corner, 1.0), first, corner);
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
    const InstantTables tables = computeInstantTables(
        world, request, motion(), extract(), kInstants * shader::kLensSets, nullptr
    );
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
        const auto run = [&](const RasterRecord* last) {
            return computeInstantTables(
                world, request, motion(), extract(), kInstants * shader::kLensSets, last
            );
        };
        setTime(1.0 - kFrameSeconds);
        const RasterRecord last = run(nullptr).record;
        setTime(1.0);
        return run(&last).last.has_value();
    };
    EXPECT_FALSE(hasLast());
    world.registry.add(box, scene::LinearVelocity{{1.0, 0.0, 0.0}});
    EXPECT_TRUE(hasLast());
}

TEST_F(InstantTablesTest, TheLastRasterShowsWhereItsSurfacesAreNow) {
    moveCamera();
    const ecs::Entity tumbler = addTumbler();
    const ecs::Entity wall = addBox({0.0, 0.0, -20.0});
    const dvec3 corner(0.9, -0.7, 0.3);
    setTime(1.0 - kFrameSeconds);
    const Seen tumblerThen = project(tumbler, corner, 1.0);
    const Seen wallThen = project(wall, corner, 1.0);
    const InstantTables tables = computeSecondFrame();
    ASSERT_TRUE(tables.last.has_value());
    expectMaps(*tables.last, 0, tumblerThen, tumbler, corner);
    expectMaps(*tables.last, 1, wallThen, wall, corner);
    EXPECT_EQ(tables.last->movers.at(1), shader::kWorldMover);
}

TEST_F(InstantTablesTest, TheSecondRasterShowsWhereItsSurfacesAre) {
    moveCamera();
    const ecs::Entity tumbler = addTumbler();
    const ecs::Entity wall = addBox({0.0, 0.0, -20.0});
    const dvec3 corner(0.9, -0.7, 0.3);
    const InstantTables tables = computeWithSecond();
    ASSERT_TRUE(tables.second.has_value());
    expectMaps(*tables.second, 0, project(tumbler, corner, 0.0), tumbler, corner);
    expectMaps(*tables.second, 1, project(wall, corner, 0.0), wall, corner);
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
    setTime(1.0 - kFrameSeconds);
    const RasterRecord last = compute().record;
    scene::despawn(world, first);
    setTime(1.0);
    const InstantTables tables = compute(&last);
    ASSERT_TRUE(tables.last.has_value());
    EXPECT_EQ(tables.last->movers.at(0), shader::kNoMover);
    const dvec3 corner(0.9, -0.7, 0.3);
    setTime(1.0 - kFrameSeconds);
    const Seen then = project(second, corner, 1.0);
    setTime(1.0);
    expectMaps(*tables.last, 1, then, second, corner);
    EXPECT_EQ(tables.last->rasterRows, (std::vector<uint32_t>{shader::kNoRasterRow, 0}));
}

TEST_F(InstantTablesTest, EntitiesScaledToZeroRemainInTheLastRaster) {
    const ecs::Entity shrinking = addBox({0.5, 0.2, -8.0});
    scene::AnimationClip clip;
    clip.channels.push_back(
        {0,
         scene::AnimationPath::Scale,
         scene::Interpolation::Linear,
         {0.5f, 1.0f},
         {vec4(1.0f), vec4(0.0f)}}
    );
    world.assets.clips.push_back(std::move(clip));
    world.registry.add(shrinking, scene::Animated{{{0, 0}}});
    const dvec3 corner(0.9, -0.7, 0.3);
    setTime(1.0 - kFrameSeconds);
    const Seen then = project(shrinking, corner, 1.0);
    const InstantTables tables = computeSecondFrame();
    EXPECT_TRUE(extract().entities.empty());
    ASSERT_TRUE(tables.last.has_value());
    expectMaps(*tables.last, 0, then, shrinking, corner);
    setTime(1.0 - kFrameSeconds);
    const RasterRecord last = compute().record;
    setTime(1.0);
    scene::hide(world, shrinking);
    EXPECT_EQ(compute(&last).last->movers.at(0), shader::kNoMover) << "hidden entities are absent";
}

TEST_F(InstantTablesTest, ARasterOlderThanOneFrameIsNotUsed) {
    addTumbler();
    setTime(1.0 - kFrameSeconds);
    RasterRecord last = compute().record;
    setTime(1.0);
    EXPECT_TRUE(compute(&last).last.has_value());
    last.seconds -= kFrameSeconds;
    EXPECT_FALSE(compute(&last).last.has_value());
}

TEST_F(InstantTablesTest, TheLastRasterIsThatOfEachPartOfTheExposure) {
    moveCamera();
    const ecs::Entity tumbler = addTumbler();
    const dvec3 corner(0.9, -0.7, 0.3);
    setTime(1.0 - kFrameSeconds);
    const RasterRecord last = compute().record;
    const Seen then = project(tumbler, corner, 1.0);
    setTime(1.0);
    const scene::ExposureInterval whole = request.exposure;
    for (const auto& [from, to] : {std::pair{0.0, 0.3}, {0.3, 1.0}}) {
        request.exposure = scene::takePart(whole, whole.at(from), whole.at(to));
        const InstantTables tables = compute(&last);
        ASSERT_TRUE(tables.last.has_value());
        expectMaps(*tables.last, 0, then, tumbler, corner);
        EXPECT_EQ(tables.record.seconds, 1.0) << "the frame's own time";
    }
}

TEST_F(InstantTablesTest, TheViewBeforeDrawsTheLastRaster) {
    moveCamera();
    addTumbler();
    setTime(1.0 - kFrameSeconds);
    const RasterRecord last = compute().record;
    setTime(1.0);
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
    const scene::ExposureMotion motion(world, camera, request.exposure);
    EXPECT_TRUE(isOfFrameBefore(world, request, motion, record));
}

TEST_F(InstantTablesTest, AFrameThatIsDrawnAgainIsKnownByItsTimeAndItsCamera) {
    moveCamera();
    addTumbler();
    const RasterRecord drawn = compute().record;
    const auto isAgain = [&] {
        const scene::ExposureMotion motion(world, request.camera, request.exposure);
        return isOfSameFrame(world, request, motion, drawn);
    };
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
    ShapeWaysTest() {
        scene::Primitive box;
        box.influenceCount = 4;
        scene::MorphTarget target;
        for (int corner = 0; corner < 8; ++corner) {
            box.positions.push_back(
                {corner & 1 ? 1.0f : -1.0f, corner & 2 ? 1.0f : -1.0f, corner & 4 ? 1.0f : -1.0f}
            );
            box.joints.insert(box.joints.end(), {0, 0, 0, 0});
            box.weights.insert(box.weights.end(), {1.0f, 0.0f, 0.0f, 0.0f});
            target.positions.push_back({0.0f, 1.0f, 0.0f});
        }
        box.morphTargets.push_back(target);
        layout.geometries[0].vertexCount = 8;
        layout.reaches.push_back(scene::computePoseReach({&box, 1}));
        world.assets.skins.push_back({"", {math::dmat4(1.0)}});
    }

    /// Weights go from 0 to 1 between the times.
    ecs::Entity addMorphed(float from, float to) {
        const ecs::Entity entity = addBox({0.0, 0.0, -8.0});
        scene::WeightChannel channel;
        channel.targetCount = 1;
        channel.times = {from, to};
        channel.values = {0.0f, 1.0f};
        world.assets.clips.push_back({"", double(to), {}, {channel}});
        const auto clip = static_cast<uint32_t>(world.assets.clips.size() - 1);
        world.registry.add(entity, scene::MorphWeights{{0.0f}, {{clip, 0}}});
        return entity;
    }

    ecs::Entity addSkin(const scene::AngularVelocity& turn) {
        const ecs::Entity joint = world.registry.create();
        math::Transform transform;
        transform.translation = {0.0, 0.0, -8.0};
        world.registry.add(joint, scene::LocalTransform{transform});
        world.registry.add(joint, turn);
        const ecs::Entity entity = addBox(dvec3(0.0));
        world.registry.add(entity, scene::Skinned{0, {joint}});
        return entity;
    }

    static math::dvec2 placeBy(const vec4 (&rows)[3], const dvec3& point) {
        const vec4 p(vec3(point), 1.0f);
        return math::dvec2(dot(rows[0], p), dot(rows[1], p)) / double(dot(rows[2], p));
    }
};

TEST_F(ShapeWaysTest, DeformingEntitiesAreDrawnFromBothRasters) {
    moveCamera();
    const ecs::Entity entity = addMorphed(0.0f, 2.0f);
    setTime(1.0 - kFrameSeconds);
    const dvec3 corner(0.9, -0.7, 0.3);
    const Seen then = project(entity, corner, 1.0);
    const InstantTables tables = computeSecondFrame();
    ASSERT_EQ(tables.rasterWays.size(), 1u);
    EXPECT_EQ(tables.raster.movers.at(0), shader::kDeformedMover);
    ASSERT_TRUE(tables.last.has_value());
    EXPECT_EQ(tables.last->movers.at(0), shader::kDeformedMover);
    ASSERT_EQ(tables.lastWays.size(), 1u);
    const shader::ShapeWayRow& maps = tables.lastWays[0].maps;
    EXPECT_NEAR(
        glm::distance(placeBy({maps.raster[0], maps.raster[1], maps.raster[2]}, corner), then.at),
        0.0,
        2e-3
    );
    EXPECT_NEAR(double(dot(maps.raster[3], vec4(vec3(corner), 1.0f))), then.depth, 1e-4);
    const auto expectAt = [&](const vec4(&rows)[3], double s) {
        EXPECT_NEAR(glm::distance(placeBy(rows, corner), project(entity, corner, s).at), 0.0, 2e-3);
    };
    expectAt(maps.open, 0.0);
    expectAt(maps.middle, 0.5);
    expectAt(maps.close, 1.0);
    ASSERT_EQ(tables.middles.size(), 1u);
    EXPECT_NEAR(tables.middles[0].morphWeights.at(0), 0.5 * (1.0 - 0.5 * kExposureSeconds), 1e-7);
}

TEST_F(ShapeWaysTest, AShapeThatChangedBetweenTheExposuresAloneIsDrawnFromTheLastRaster) {
    addMorphed(0.8f, 0.85f); // this exposure opens at 0.875 s
    addTumbler();
    const InstantTables tables = computeSecondFrame();
    EXPECT_EQ(tables.raster.movers.at(0), shader::kWorldMover);
    ASSERT_TRUE(tables.last.has_value());
    EXPECT_EQ(tables.last->movers.at(0), shader::kDeformedMover);
}

TEST_F(ShapeWaysTest, AShapeThatIsTheSameIsRigidInBothRasters) {
    addMorphed(2.0f, 3.0f);
    addTumbler();
    const InstantTables tables = computeSecondFrame();
    ASSERT_TRUE(tables.last.has_value());
    EXPECT_EQ(tables.last->movers.at(0), shader::kWorldMover);
    EXPECT_TRUE(tables.lastWays.empty());
    EXPECT_TRUE(tables.middles.at(0).morphWeights.empty()) << "nobody needs it";
}

TEST_F(ShapeWaysTest, ASkinThatTurnsAsOneIsARigidMoverInAllLayers) {
    addSkin({{1.0, 2.0, 0.5}});
    setTime(1.0 - kFrameSeconds);
    const RasterRecord last = compute().record;
    setTime(1.0);
    ViewRequest atOpen = request;
    atOpen.instant = 0.0;
    const auto second = extractFrame(world, layout, atOpen);
    const InstantFrame frame{0.0, second.value()};
    const InstantTables tables =
        computeInstantTables(world, request, motion(), extract(), kInstants, &last, &frame);
    for (const LayerTables* layer : {&tables.raster, &*tables.last, &*tables.second})
        EXPECT_LT(layer->movers.at(0), shader::kDeformedMover);
    EXPECT_TRUE(tables.rasterWays.empty() && tables.lastWays.empty() && tables.secondWays.empty());
}

TEST_F(ShapeWaysTest, ASkinOneOfWhoseJointsWasTeleportedHasNoPast) {
    const ecs::Entity entity = addSkin({{1.0, 2.0, 0.5}});
    addTumbler();
    setTime(1.0 - kFrameSeconds);
    const RasterRecord last = compute().record;
    math::Transform elsewhere;
    elsewhere.translation = {1.0, 1.0, -6.0};
    const ecs::Entity joint = world.registry.get<scene::Skinned>(entity).joints[0];
    scene::teleport(world, joint, elsewhere, 0.8);
    setTime(1.0);
    const InstantTables tables = compute(&last);
    ASSERT_TRUE(tables.last.has_value());
    EXPECT_EQ(tables.last->movers.at(0), shader::kNoMover);
}

TEST_F(ShapeWaysTest, AnotherMeshHasNoPast) {
    const ecs::Entity entity = addMorphed(0.0f, 2.0f);
    layout.reaches.push_back(layout.reaches[0]);
    const uint32_t other = addMesh(scene::AlphaMode::Opaque, 1);
    addTumbler();
    setTime(1.0 - kFrameSeconds);
    const RasterRecord last = compute().record;
    world.registry.get<scene::MeshInstance>(entity).mesh = other;
    setTime(1.0);
    const InstantTables tables = compute(&last);
    ASSERT_TRUE(tables.last.has_value());
    EXPECT_EQ(tables.last->movers.at(0), shader::kNoMover);
}

} // namespace
} // namespace shutter::extract
