// SPDX-License-Identifier: MIT
// Worlds that are edited at random, and the frame that is kept of them.
#include "engine/scene/history.h"
#include "tests/unit/extract/kept_frame_fixture.h"

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace shutter::extract {
namespace {

using math::dvec3;

/// A world that is edited at random.
class EditedWorld : public KeptFrame {
  protected:
    void fill(uint32_t seed) {
        random.seed(seed);
        for (const auto& [mode, primitives] :
             {std::pair{scene::AlphaMode::Opaque, 2u},
              std::pair{scene::AlphaMode::Mask, 1u},
              std::pair{scene::AlphaMode::Blend, 2u}})
            addMesh(mode, primitives);
        addMesh(scene::AlphaMode::Opaque, 0); // draws nothing
        makeDeformable();
        for (int i = 0; i < 16; ++i)
            spawn();
    }

    /// Gives mesh 0 vertices, a morph target and a joint.
    void makeDeformable() {
        scene::Primitive box;
        box.influenceCount = 4;
        scene::MorphTarget target;
        for (int corner = 0; corner < 8; ++corner) {
            box.positions.push_back(
                {corner & 1 ? 1.0f : -1.0f, corner & 2 ? 1.0f : -1.0f, corner & 4 ? 1.0f : -1.0f}
            );
            box.joints.insert(box.joints.end(), {0, 0, 0, 0});
            box.weights.insert(box.weights.end(), {1.0f, 0.0f, 0.0f, 0.0f});
            target.positions.push_back({0.0f, corner & 2 ? 1.0f : 0.0f, 0.0f});
        }
        box.morphTargets.push_back(target);
        layout.geometries[0].vertexCount = 8;
        layout.reaches.assign(layout.bounds.size(), scene::computePoseReach({&box, 1}));
        world.assets.skins.push_back({"", {math::dmat4(1.0)}});
        scene::WeightChannel weights;
        weights.targetCount = 1;
        weights.times = {0.0f, 2.0f};
        weights.values = {0.0f, 1.0f};
        scene::AnimationChannel way;
        way.times = {0.0f, 2.0f, 4.0f};
        way.values = {{0, 0, -8, 0}, {1, 0, -8, 0}, {1, 0, -8, 0}};
        scene::AnimationClip clip;
        clip.duration = 4.0;
        clip.channels = {way};
        clip.weightChannels = {weights};
        world.assets.clips.push_back(clip);
    }

    uint32_t below(uint32_t end) {
        return std::uniform_int_distribution<uint32_t>(0, end - 1)(random);
    }

    double uniform(double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random);
    }

    dvec3 anyPlace() { return {uniform(-6.0, 6.0), uniform(-3.0, 3.0), uniform(-20.0, 2.0)}; }

    math::Transform anyTransform() {
        math::Transform transform;
        // Few places, so that some are as far as others.
        transform.translation = glm::round(anyPlace());
        transform.rotation = glm::angleAxis(uniform(0.0, 6.0), dvec3(0.0, 1.0, 0.0));
        transform.scale = below(8) == 0 ? dvec3(0.0) : dvec3(below(4) == 0 ? -1.0 : 1.0, 1.0, 1.0);
        return transform;
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

    void editPlace(ecs::Entity entity) {
        switch (below(7)) {
        case 0:
        case 1:
            if (auto* local = world.registry.find<scene::LocalTransform>(entity))
                local->transform = anyTransform();
            break;
        case 2:
            scene::teleport(world, entity, anyTransform(), seconds);
            break;
        case 3:
            if (below(3) == 0)
                toggle(entity, scene::LinearVelocity{{0.5, 0.0, 0.0}});
            else if (auto* velocity = world.registry.find<scene::LinearVelocity>(entity))
                velocity->metresPerSecond = below(2) == 0 ? dvec3(0.0) : anyPlace() * 0.1;
            break;
        case 4:
            toggle(entity, scene::AngularVelocity{{0.0, uniform(-1.0, 1.0), 0.0}});
            break;
        case 5:
            toggle(entity, scene::LocalMatrix{math::computeMatrix(anyTransform())});
            break;
        default:
            editPath(entity);
        }
    }

    void editPath(ecs::Entity entity) {
        auto* path = world.registry.find<scene::PathMotion>(entity);
        if (!path) {
            scene::PathMotion fresh;
            fresh.keys.push_back({0.0, anyPlace(), {}, {}, false});
            world.registry.add(entity, fresh);
        } else if (path->keys.size() == 1) {
            path->keys.push_back({4.0, anyPlace(), {}, {}, below(2) == 0});
        } else {
            world.registry.remove<scene::PathMotion>(entity);
        }
    }

    void editPresence(ecs::Entity entity) {
        switch (below(8)) {
        case 0:
            if (below(2) == 0)
                scene::hide(world, entity);
            else
                scene::hide(world, entity, seconds + uniform(-1.0, 0.5));
            break;
        case 1:
            scene::show(world, entity, seconds + (below(2) == 0 ? 0.0 : uniform(-0.5, 0.5)));
            break;
        case 2:
            if (entities.size() > 8)
                scene::despawn(world, entity);
            break;
        case 3:
            spawn();
            break;
        case 4:
            if (auto* instance = world.registry.find<scene::MeshInstance>(entity))
                instance->mesh = below(5);
            break;
        case 5:
            toggle(entity, scene::MeshInstance{below(5)});
            break;
        case 6:
            reparent(entity);
            break;
        default:
            editShape(entity);
        }
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
        switch (below(9)) {
        case 0:
            transformOf(camera).transform.translation.x = uniform(-1.0, 1.0);
            break;
        case 1:
            toggle(camera, scene::LinearVelocity{{uniform(-1.0, 1.0), 0.0, 0.25}});
            break;
        case 2:
            request.width = 100 + 50 * below(3);
            break;
        case 3:
            request.jitterPx = below(2) == 0 ? math::dvec2(0.0) : math::dvec2(0.25, -0.25);
            break;
        case 4:
            request.instant = below(2) == 0 ? std::optional<double>() : uniform(0.0, 1.0);
            break;
        case 5:
            exposureSeconds = below(3) * 0.25;
            break;
        case 6:
            world.registry.get<scene::Camera>(camera).yFov = below(2) == 0 ? 0.8 : 0.6;
            break;
        case 7:
            scene::cut(world, camera, seconds);
            break;
        default:
            request.exposure.cap.movers.clear();
            if (below(2) == 0)
                request.exposure.cap.movers.emplace_back(any(), 0.5);
        }
    }

    void edit() {
        const ecs::Entity entity = any();
        switch (below(8)) {
        case 0:
        case 1:
        case 2:
            editPlace(entity);
            break;
        case 3:
            editPresence(entity);
            break;
        case 4:
            editView();
            break;
        case 5:
            seconds += below(8) == 0 ? -0.25 : 0.125;
            break;
        case 6:
            if (auto* blur = world.registry.find<scene::MotionBlur>(entity); blur && below(2) == 0)
                blur->exclude = !blur->exclude;
            else if (below(6) == 0)
                toggle(entity, scene::MotionBlur{below(2) == 0 ? 0.5 : 1.0, false});
            else
                toggle(entity, scene::Animated{{{0, 0}}});
            break;
        default:
            if (auto* light = world.registry.find<scene::Light>(entity))
                light->intensity = float(uniform(0.0, 2.0));
            world.playback.activeClips = {below(2) == 0};
        }
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
    uint64_t stillSet = 0;
};

} // namespace

TEST_F(EditedWorld, TheKeptFrameEqualsANewOneBitByBit) {
    size_t refreshed = 0;
    size_t placedAnew = 0;
    for (uint32_t seed = 1; seed <= 48; ++seed) {
        world = scene::World{};
        layout = {};
        request = {};
        entities.clear();
        extractor = FrameExtractor();
        revision = stillRevision = 0;
        seconds = 1.0;
        addMesh(scene::AlphaMode::Opaque, 1);
        camera = request.camera = addCamera({});
        request.width = 200;
        request.height = 100;
        fill(seed);
        for (int frame = 0; frame < 100; ++frame) {
            SCOPED_TRACE(fmt::format("seed {}, frame {}", seed, frame));
            for (uint32_t edits = below(3); edits > 0; --edits)
                edit();
            const uint64_t setBefore = stillSet;
            const ExtractedFrame& kept = update();
            stillSet = kept.stillSet;
            refreshed += !kept.changes.all;
            placedAnew += kept.changes.all && stillSet == setBefore;
            if (HasFailure())
                return;
        }
    }
    EXPECT_GT(refreshed, 500u) << "or it was not tried";
    EXPECT_GT(placedAnew, 100u);
}

} // namespace shutter::extract
