// SPDX-License-Identifier: MIT
// A frame that is kept up to date: by hand, and in worlds that are edited at random.
#include "engine/extract/frame_extractor.h"
#include "engine/extract/world_watch.h"
#include "engine/scene/history.h"
#include "tests/unit/extract/extraction_fixture.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <optional>
#include <random>
#include <ranges>
#include <typeinfo>
#include <utility>
#include <vector>

namespace shutter::extract {
namespace {

using math::dvec3;

template <class T> [[nodiscard]] bool isIdenticalBytes(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof(T)) == 0;
}

template <class T> void expectIdentical(const std::vector<T>& a, const std::vector<T>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (size_t i = 0; i < a.size(); ++i)
        EXPECT_TRUE(isIdenticalBytes(a[i], b[i])) << i;
}

[[nodiscard]] bool isSameDraw(const DrawItem& a, const DrawItem& b) {
    return a.entity == b.entity && a.geometry == b.geometry && a.geometryRow == b.geometryRow &&
           a.alphaMode == b.alphaMode && a.doubleSided == b.doubleSided &&
           a.mirrored == b.mirrored && a.distance == b.distance;
}

/// A frame that is kept up to date, held against extractFrame(), which starts from nothing.
class KeptFrame : public Extraction {
  protected:
    /// Brings the kept frame up to date and holds it against a new one.
    const ExtractedFrame& update() {
        auto updated = extractor.update(world, layout, request);
        EXPECT_TRUE(updated.ok());
        const ExtractedFrame& kept = *updated.value();
        expectSame(kept, extract());
        follow(kept);
        return kept;
    }

    void expectSame(const ExtractedFrame& kept, const ExtractedFrame& fresh) const {
        ASSERT_EQ(kept.entityHandles, fresh.entityHandles);
        EXPECT_EQ(kept.entityMeshes, fresh.entityMeshes);
        for (size_t row = 0; row < fresh.entities.size(); ++row) {
            shader::EntityRow a = kept.entities[row];
            shader::EntityRow b = fresh.entities[row];
            ASSERT_EQ(a.motion == shader::kNoMotion, b.motion == shader::kNoMotion) << row;
            ASSERT_TRUE(isIdenticalBytes(motionOf(kept, row), motionOf(fresh, row))) << row;
            a.motion = b.motion = 0;
            ASSERT_TRUE(isIdenticalBytes(a, b)) << row;
        }
        EXPECT_TRUE(std::ranges::equal(kept.opaque.merge(), fresh.opaque.merge(), isSameDraw));
        EXPECT_TRUE(std::ranges::equal(kept.blended.merge(), fresh.blended.merge(), isSameDraw));
        ASSERT_EQ(kept.lightEntities, fresh.lightEntities);
        expectIdentical(kept.lights, fresh.lights);
        EXPECT_TRUE(isIdenticalBytes(kept.constants, fresh.constants));
        EXPECT_EQ(kept.moves, fresh.moves);
        expectSameDeformed(kept.deformed, fresh.deformed);
    }

    static void expectSameDeformed(
        const std::vector<DeformedEntity>& kept, const std::vector<DeformedEntity>& fresh
    ) {
        ASSERT_EQ(kept.size(), fresh.size());
        for (size_t i = 0; i < fresh.size(); ++i) {
            EXPECT_EQ(kept[i].row, fresh[i].row);
            EXPECT_EQ(kept[i].mesh, fresh[i].mesh);
            EXPECT_TRUE(isSame(kept[i].open, fresh[i].open));
            EXPECT_TRUE(isSame(kept[i].raster, fresh[i].raster));
            EXPECT_TRUE(isSame(kept[i].close, fresh[i].close));
            EXPECT_TRUE(isIdenticalBytes(kept[i].bounds, fresh[i].bounds));
            EXPECT_EQ(kept[i].changes, fresh[i].changes);
            EXPECT_EQ(kept[i].mirrored, fresh[i].mirrored);
        }
    }

    /// Does with a copy of the tables what EntityTable does on the device.
    void follow(const ExtractedFrame& frame) {
        const RowChanges& changes = frame.changes;
        EXPECT_EQ(changes.since, revision);
        if (changes.all)
            rows = frame.entities;
        ASSERT_EQ(rows.size(), frame.entities.size());
        for (const uint32_t row : changes.rows)
            rows.at(row) = frame.entities[row];
        expectIdentical(rows, frame.entities);
        if (frame.staticRevision != staticRevision)
            staticMotions = frame.staticMotions;
        expectIdentical(staticMotions, frame.staticMotions);
        expectStillRowsOf(frame);
        revision = changes.revision;
        staticRevision = frame.staticRevision;
    }

    /// Those of one revision are the same rows in the same places.
    void expectStillRowsOf(const ExtractedFrame& frame) {
        EXPECT_TRUE(std::is_sorted(frame.movingRows.begin(), frame.movingRows.end()));
        std::vector<shader::EntityRow> still = frame.entities;
        for (const uint32_t row : frame.movingRows)
            still.at(row) = {};
        if (frame.staticRevision == staticRevision)
            expectIdentical(still, stillRows);
        stillRows = std::move(still);
    }

    scene::LocalTransform& transformOf(ecs::Entity entity) {
        return world.registry.get<scene::LocalTransform>(entity);
    }

    FrameExtractor extractor;
    uint64_t revision = 0;
    uint64_t staticRevision = 0;
    std::vector<shader::EntityRow> rows;
    std::vector<shader::EntityMotion> staticMotions;
    std::vector<shader::EntityRow> stillRows;
};

TEST_F(KeptFrame, AStillFrameChangesNothing) {
    addBox({0.0, 0.0, -10.0});
    addBox({1.0, 0.0, -10.0});
    EXPECT_TRUE(update().changes.all);
    const uint64_t before = extractor.update(world, layout, request).value()->staticRevision;
    revision = 0;
    const ExtractedFrame& frame = *extractor.update(world, layout, request).value();
    EXPECT_FALSE(frame.changes.all);
    EXPECT_TRUE(frame.changes.rows.empty());
    EXPECT_TRUE(frame.movingRows.empty());
    EXPECT_TRUE(frame.staticMotions.empty());
    EXPECT_TRUE(frame.movingMotions.empty());
    EXPECT_EQ(frame.staticRevision, before);
}

TEST_F(KeptFrame, AWrittenEntityBecomesAMoverAndTheOthersStayStatic) {
    addBox({0.0, 0.0, -10.0});
    const ecs::Entity written = addBox({1.0, 0.0, -10.0});
    const uint64_t before = update().staticSet;
    transformOf(written).transform.translation.x = 1.5;
    const uint64_t joined = update().staticSet;
    EXPECT_NE(joined, before);
    transformOf(written).transform.translation.x = 2.0;
    const ExtractedFrame& frame = update();
    EXPECT_EQ(frame.staticSet, joined);
    EXPECT_EQ(frame.movingRows, std::vector<uint32_t>{1});
    EXPECT_EQ(frame.changes.rows, std::vector<uint32_t>{1});
}

TEST_F(KeptFrame, AnEntityNoLongerWrittenBecomesStaticAgainWithOthers) {
    std::vector<ecs::Entity> boxes;
    for (int i = 0; i < 100; ++i)
        boxes.push_back(addBox({double(i % 10), double(i / 10), -30.0}));
    update();
    for (const ecs::Entity box : boxes)
        transformOf(box).transform.translation.z = -31.0;
    EXPECT_EQ(update().movingRows.size(), 100u);
    update(); // no entity is written to
    EXPECT_TRUE(update().movingRows.empty());
}

TEST_F(KeptFrame, ACameraMoveUpdatesAllRowsAndRebuildsNone) {
    addBox({0.0, 0.0, -10.0});
    addMover({1.0, 0.0, -10.0}, {0.5, 0.25, 0.0});
    const ExtractedFrame first = update();
    transformOf(camera).transform.translation.x = 0.5;
    const ExtractedFrame& frame = update();
    EXPECT_TRUE(frame.changes.all);
    EXPECT_EQ(frame.staticSet, first.staticSet);
    EXPECT_NE(frame.staticRevision, first.staticRevision);
}

TEST_F(KeptFrame, OnlyEntitiesWithABlurScaleMoveUnderAMovingCamera) {
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
    const uint64_t listed = updateAt(1.0).staticSet;
    EXPECT_TRUE(updateAt(1.1).movingRows.empty());
    EXPECT_EQ(updateAt(1.2).staticSet, listed) << "nothing is listed anew";
    world.registry.get<scene::MotionBlur>(scaled).exclude = true;
    const uint64_t joined = updateAt(1.3).staticSet;
    EXPECT_NE(joined, listed);
    const ExtractedFrame& frame = updateAt(1.4);
    EXPECT_EQ(frame.staticSet, joined);
    EXPECT_EQ(frame.movingRows, (std::vector<uint32_t>{1, 2}));
    request.exposure.cap.movers.emplace_back(frame.entityHandles[0], 0.5);
    EXPECT_EQ(updateAt(1.5).movingRows, (std::vector<uint32_t>{0, 1, 2}));
}

TEST_F(KeptFrame, LogOverflowMissesNoChange) {
    const ecs::Entity first = addBox({0.0, 0.0, -10.0});
    const ecs::Entity second = addBox({1.0, 0.0, -10.0});
    update();
    transformOf(first).transform.translation.x = -1.0;
    for (size_t i = 0; i < 3 * ecs::ChangeLog::kRemembered; ++i)
        transformOf(i % 2 == 0 ? second : camera).transform.scale.x = 1.0;
    EXPECT_TRUE(update().changes.all);
}

TEST_F(KeptFrame, RowsOfAnotherWorldAreDropped) {
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
    for (const uint32_t limit : {1u, 2u, 1u}) {
        request.entityLimit = limit;
        EXPECT_EQ(extractor.update(world, layout, request).ok(), limit == 2) << limit;
    }
}

TEST_F(KeptFrame, APathAndALensThatAreNotValidAreRefusedByNameUntilTheyAreMended) {
    const ecs::Entity box = addBox({0.0, 0.0, -10.0});
    world.registry.add(box, scene::Name{"lift"});
    world.registry.add(box, scene::PathMotion{{{0.0}, {1.0}}});
    world.registry.add(camera, scene::LensMotion{{{0.0, 0.8}, {1.0, 1.0}}});
    update();
    const auto refusal = [&] {
        const auto updated = extractor.update(world, layout, request);
        return updated.ok() ? "" : updated.error().message;
    };
    world.registry.get<scene::PathMotion>(box).keys[1].seconds = 0.0;
    for (int frame = 0; frame < 2; ++frame)
        EXPECT_EQ(
            refusal(), "'lift': path: key 1 at 0 s does not come after the one before, at 0 s"
        );
    world.registry.get<scene::PathMotion>(box).keys.clear();
    EXPECT_NE(refusal(), "") << "no keys";
    world.registry.get<scene::PathMotion>(box).keys = {{0.0}, {2.0}};
    EXPECT_EQ(refusal(), "");
    world.registry.get<scene::LensMotion>(camera).keys[1].yFov = 4.0;
    EXPECT_NE(refusal().find("lens: the field of view of key 1"), std::string::npos) << refusal();
    world.registry.get<scene::LensMotion>(camera).keys[1].yFov = 1.0;
    EXPECT_EQ(refusal(), "");
}

/// A world that is edited at random.
class EditedWorld : public KeptFrame {
  protected:
    void fill(uint32_t seed) {
        reset();
        entities.clear();
        extractor = FrameExtractor();
        revision = staticRevision = 0;
        seconds = 1.0;
        random.seed(seed);
        for (const auto& [mode, primitives] :
             {std::pair{scene::AlphaMode::Opaque, 2u},
              std::pair{scene::AlphaMode::Mask, 1u},
              std::pair{scene::AlphaMode::Blend, 2u}})
            addMesh(mode, primitives);
        addMesh(scene::AlphaMode::Opaque, 0); // draws nothing
        makeDeformable(1);
        entities.push_back(addMorphed({0, 0, -8}, {0.0f, 2.0f}, {0.0f, 1.0f}));
        scene::AnimationChannel way;
        way.times = {0.0f, 2.0f, 4.0f};
        way.values = {{0, 0, -8, 0}, {1, 0, -8, 0}, {1, 0, -8, 0}};
        scene::AnimationClip& clip = world.assets.clips.back();
        clip.duration = 4.0;
        clip.channels = {way};
        for (int i = 0; i < 15; ++i)
            spawn();
    }

    uint32_t below(uint32_t end) {
        return std::uniform_int_distribution<uint32_t>(0, end - 1)(random);
    }

    double uniform(double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random);
    }

    dvec3 anyPlace() { return {uniform(-6.0, 6.0), uniform(-3.0, 3.0), uniform(-20.0, 2.0)}; }

    math::Transform anyTransform() {
        return {
            glm::round(anyPlace()), // few places, so that some are as far as others
            glm::angleAxis(uniform(0.0, 6.0), dvec3(0.0, 1.0, 0.0)),
            below(8) == 0 ? dvec3(0.0) : dvec3(below(4) == 0 ? -1.0 : 1.0, 1.0, 1.0)};
    }

    void spawn() {
        const ecs::Entity entity = world.registry.create();
        world.registry.add(entity, scene::LocalTransform{anyTransform()});
        if (below(4) != 0)
            world.registry.add(entity, scene::MeshInstance{below(5)});
        if (below(6) == 0)
            world.registry.add(entity, scene::Light{});
        // A child of an older one: no cycles.
        if (!entities.empty() && below(3) == 0)
            world.registry.add(entity, scene::Parent{any()});
        entities.push_back(entity);
    }

    ecs::Entity any() { return entities[below(uint32_t(entities.size()))]; }

    /// Adds the component where it is not, and removes it where it is.
    template <class T> void toggle(ecs::Entity entity, T value) {
        if (!world.registry.remove<T>(entity))
            world.registry.add(entity, std::move(value));
    }

    void choose(const std::vector<std::function<void()>>& edits) {
        edits[below(uint32_t(edits.size()))]();
    }

    void editPlace(ecs::Entity entity) {
        const auto place = [&] {
            if (auto* local = world.registry.find<scene::LocalTransform>(entity))
                local->transform = anyTransform();
        };
        choose({
            place,
            place,
            [&] { scene::teleport(world, entity, anyTransform(), seconds); },
            [&] { editVelocity(entity); },
            [&] {
                toggle(entity, scene::AngularVelocity{{0.0, uniform(-1.0, 1.0), 0.0}});
            },
            [&] { toggle(entity, scene::LocalMatrix{math::computeMatrix(anyTransform())}); },
            [&] { editPath(entity); },
        });
    }

    void editVelocity(ecs::Entity entity) {
        if (below(3) == 0)
            toggle(entity, scene::LinearVelocity{{0.5, 0.0, 0.0}});
        else if (auto* velocity = world.registry.find<scene::LinearVelocity>(entity))
            velocity->metresPerSecond = below(2) == 0 ? dvec3(0.0) : anyPlace() * 0.1;
    }

    void editPath(ecs::Entity entity) {
        auto* path = world.registry.find<scene::PathMotion>(entity);
        if (!path) {
            world.registry.add(entity, scene::PathMotion{{{0.0, anyPlace()}}});
        } else if (path->keys.size() == 1) {
            path->keys.push_back({4.0, anyPlace(), {}, {}, below(2) == 0});
        } else {
            world.registry.remove<scene::PathMotion>(entity);
        }
    }

    void editPresence(ecs::Entity entity) {
        choose({
            [&] { scene::hide(world, entity); },
            [&] { scene::hide(world, entity, seconds + uniform(-1.0, 0.5)); },
            [&] { scene::show(world, entity, seconds); },
            [&] { scene::show(world, entity, seconds + uniform(-0.5, 0.5)); },
            [&] {
                if (entities.size() > 8)
                    scene::despawn(world, entity);
            },
            [&] { spawn(); },
            [&] {
                if (auto* instance = world.registry.find<scene::MeshInstance>(entity))
                    instance->mesh = below(5);
            },
            [&] { toggle(entity, scene::MeshInstance{below(5)}); },
            [&] { reparent(entity); },
            [&] { editShape(entity); },
        });
        std::erase_if(entities, [&](ecs::Entity one) { return !world.registry.isAlive(one); });
    }

    void reparent(ecs::Entity entity) {
        const ecs::Entity parent = any();
        const auto at = [&](ecs::Entity one) {
            return std::find(entities.begin(), entities.end(), one);
        };
        if (at(parent) < at(entity))
            world.registry.add(entity, scene::Parent{parent});
        else
            world.registry.remove<scene::Parent>(entity);
    }

    void editShape(ecs::Entity entity) {
        const auto* instance = std::as_const(world.registry).find<scene::MeshInstance>(entity);
        if (!instance || instance->mesh != 0)
            return;
        if (below(2) == 0)
            toggle(entity, scene::MorphWeights{{0.25f}, {{0, 0}}});
        else if (!world.registry.remove<scene::Skinned>(entity))
            world.registry.add(entity, scene::Skinned{0, {any()}});
    }

    void editView() {
        choose({
            [&] { transformOf(camera).transform.translation.x = uniform(-1.0, 1.0); },
            [&] {
                toggle(camera, scene::LinearVelocity{{uniform(-1.0, 1.0), 0.0, 0.25}});
            },
            [&] { request.width = 100 + 50 * below(3); },
            [&] { request.jitterPx = double(below(2)) * math::dvec2(0.25, -0.25); },
            [&] { request.instant = below(2) == 0 ? std::optional<double>() : uniform(0.0, 1.0); },
            [&] { exposureSeconds = below(3) * 0.25; },
            [&] { world.registry.get<scene::Camera>(camera).yFov = below(2) == 0 ? 0.8 : 0.6; },
            [&] { scene::cut(world, camera, seconds); },
            [&] {
                request.exposure.cap.movers.clear();
                if (below(2) == 0)
                    request.exposure.cap.movers.emplace_back(any(), 0.5);
            },
        });
    }

    void editBlur(ecs::Entity entity) {
        if (auto* blur = world.registry.find<scene::MotionBlur>(entity); blur && below(2) == 0)
            blur->exclude = !blur->exclude;
        else if (below(6) == 0)
            toggle(entity, scene::MotionBlur{below(2) == 0 ? 0.5 : 1.0, false});
        else
            toggle(entity, scene::Animated{{{0, 0}}});
    }

    void edit() {
        const ecs::Entity entity = any();
        const auto move = [&] { editPlace(entity); };
        choose({
            move,
            move,
            move,
            [&] { editPresence(entity); },
            [&] { editView(); },
            [&] { seconds += below(8) == 0 ? -0.25 : 0.125; },
            [&] { editBlur(entity); },
            [&] {
                if (auto* light = world.registry.find<scene::Light>(entity))
                    light->intensity = float(uniform(0.0, 2.0));
                world.playback.activeClips = {below(2) == 0};
            },
        });
        const scene::MotionCap cap = request.exposure.cap;
        request.exposure = {seconds - exposureSeconds, seconds, seconds, 1.0, 0.125, {}, cap};
        if (exposureSeconds > 0.0 && below(3) == 0) {
            const double open = seconds - exposureSeconds * uniform(0.2, 1.0);
            request.exposure = scene::takePart(
                request.exposure, open, std::lerp(open, seconds, uniform(0.1, 1.0))
            );
        }
    }

    std::mt19937 random;
    std::vector<ecs::Entity> entities;
    double seconds = 1.0;
    double exposureSeconds = 0.5;
    uint64_t staticSet = 0;
};

TEST_F(EditedWorld, TheKeptFrameEqualsANewOneBitByBit) {
    size_t refreshed = 0;
    size_t recomputed = 0;
    for (uint32_t seed = 1; seed <= 48; ++seed) {
        fill(seed);
        for (int frame = 0; frame < 100; ++frame) {
            SCOPED_TRACE(fmt::format("seed {}, frame {}", seed, frame));
            for (uint32_t edits = below(3); edits > 0; --edits)
                edit();
            const uint64_t setBefore = staticSet;
            const ExtractedFrame& kept = update();
            staticSet = kept.staticSet;
            refreshed += !kept.changes.all;
            recomputed += kept.changes.all && staticSet == setBefore;
            if (HasFailure())
                return;
        }
    }
    EXPECT_GT(refreshed, 500u) << "or it was not tried";
    EXPECT_GT(recomputed, 100u);
}

template <class T> void expectWatched() {
    ecs::Registry registry;
    const ecs::Entity entity = registry.create();
    WorldWatch watch;
    (void)watch.update(registry);
    registry.add(entity, T{});
    const WorldChanges changes = watch.update(registry);
    EXPECT_TRUE(changes.structure || !changes.placed.empty()) << typeid(T).name();
}

template <class... Components> void expectAllWatched(scene::ComponentList<Components...>) {
    (expectWatched<Components>(), ...);
}

TEST(WorldWatch, EachPlacingComponentIsWatched) {
    expectAllWatched(scene::PlacingComponents());
}

} // namespace
} // namespace shutter::extract
