// SPDX-License-Identifier: MIT
#include "tests/stability/storm_stage.h"

#include "engine/scene/history.h"
#include "engine/scene/motion.h"
#include "game/demos/random.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace shutter::stability {

namespace {

using math::dvec3;

constexpr double kMostMetres = 1.5; ///< longest side of a mesh that is copied
constexpr double kMostSpeed = 4.0;  ///< m/s
constexpr double kMostTurn = 20.0;  ///< rad/s

/// Something that a storm copies.
struct Model {
    scene::MeshInstance mesh;
    dvec3 scale{1.0};
};

/// Undeformed meshes, the small ones where there are any.
std::vector<Model> listModels(const scene::World& world) {
    std::vector<Model> small;
    std::vector<Model> all;
    for (auto [entity, mesh, local] :
         world.registry.view<scene::MeshInstance, scene::LocalTransform>()) {
        if (mesh.mesh == scene::kNone || world.registry.has<scene::Skinned>(entity) ||
            world.registry.has<scene::MorphWeights>(entity))
            continue;
        const Model model{mesh, local.transform.scale};
        const dvec3 size = world.assets.meshes[mesh.mesh].bounds.size() * model.scale;
        all.push_back(model);
        if (std::max({size.x, size.y, size.z}) <= kMostMetres)
            small.push_back(model);
    }
    return small.empty() ? all : small;
}

dvec3 chooseVector(game::Random& random, const dvec3& most) {
    // One after another: the order in which arguments are evaluated is the compiler's.
    dvec3 chosen;
    for (int axis = 0; axis < 3; ++axis)
        chosen[axis] = random.between(-most[axis], most[axis]);
    return chosen;
}

class StormStage : public game::Stage {
  public:
    StormStage(std::unique_ptr<game::Stage> stage, uint32_t count)
        : mStage(std::move(stage)), mModels(listModels(mStage->world())),
          mCount(mModels.empty() ? 0 : count) {}

    [[nodiscard]] std::string title() const override { return mStage->title(); }

    [[nodiscard]] scene::World& world() override { return mStage->world(); }

    [[nodiscard]] ecs::Entity camera() const override { return mStage->camera(); }

    [[nodiscard]] game::DemoLook look() const override { return mStage->look(); }

    void advance(const app::InputState& input, const game::StageFrame& frame) override {
        mStage->advance(input, frame);
        if (frame.paused)
            return;
        const uint32_t inStorm = mFrame++ % kStormFrames;
        if (inStorm == 0)
            spawn(frame.time.seconds + startSeconds());
        else if (inStorm == kStormFrames / 2)
            despawn();
    }

    void adjustShutter(double seconds, scene::CameraShutter& shutter) const override {
        mStage->adjustShutter(seconds, shutter);
    }

    [[nodiscard]] double startSeconds() const override { return mStage->startSeconds(); }

    [[nodiscard]] std::vector<game::HudLine> hud() const override { return mStage->hud(); }

    [[nodiscard]] bool isOver() const override { return mStage->isOver(); }

    [[nodiscard]] std::optional<int> score() const override { return mStage->score(); }

  private:
    void spawn(double seconds) {
        scene::World& into = mStage->world();
        const math::dmat4 worldFromCamera = scene::worldFromEntity(into, mStage->camera(), seconds);
        game::Random random(mFrame);
        for (uint32_t i = 0; i < mCount; ++i) {
            const Model& model =
                mModels[static_cast<size_t>(random.next() * double(mModels.size()))];
            const dvec3 place = chooseVector(random, {3.0, 1.5, 5.0}) - dvec3(0.0, 0.0, 7.0);
            math::Transform at;
            at.translation = dvec3(worldFromCamera * math::dvec4(place, 1.0));
            at.scale = model.scale;
            const ecs::Entity entity = into.registry.create();
            if (i % 2 == 0) {
                const dvec3 velocity = chooseVector(random, dvec3(kMostSpeed));
                at.translation -= velocity * seconds; // it counts from time 0
                into.registry.add(entity, scene::LinearVelocity{velocity});
                into.registry.add(
                    entity, scene::AngularVelocity{chooseVector(random, dvec3(kMostTurn))}
                );
            }
            into.registry.add(entity, scene::LocalTransform{at});
            into.registry.add(entity, model.mesh);
            scene::appear(into, entity, seconds);
            mSpawned.push_back(entity);
        }
    }

    void despawn() {
        for (const ecs::Entity entity : std::exchange(mSpawned, {}))
            scene::despawn(mStage->world(), entity);
    }

    std::unique_ptr<game::Stage> mStage;
    std::vector<Model> mModels;
    uint32_t mCount;
    uint32_t mFrame = 0; ///< that were not paused
    std::vector<ecs::Entity> mSpawned;
};

} // namespace

std::unique_ptr<game::Stage> makeStormStage(std::unique_ptr<game::Stage> stage, uint32_t count) {
    return std::make_unique<StormStage>(std::move(stage), count);
}

} // namespace shutter::stability
