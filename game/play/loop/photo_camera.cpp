// SPDX-License-Identifier: MIT
#include "game/play/loop/photo_camera.h"

#include "engine/core/check.h"
#include "engine/scene/history.h"
#include "engine/scene/motion.h"

#include <glm/gtc/quaternion.hpp>

namespace shutter::game {

namespace {

constexpr double kMetresPerSecond = 4.0; ///< until the wheel says otherwise

math::Transform makeRigid(const math::dmat4& matrix) {
    const math::dmat4 rigid = math::removeScale(matrix);
    math::Transform transform;
    transform.translation = math::dvec3(rigid[3]);
    transform.rotation = glm::normalize(glm::quat_cast(math::dmat3(rigid)));
    return transform;
}

bool isSameView(const app::FlyView& a, const app::FlyView& b) {
    return a.position == b.position && a.yaw == b.yaw && a.pitch == b.pitch;
}

} // namespace

void PhotoCamera::take(scene::World& world, ecs::Entity stageCamera, double seconds) {
    if (mOut)
        return;
    const math::dmat4 worldFromStage =
        math::removeScale(worldFromEntity(world, stageCamera, seconds));
    const scene::Camera lens = world.registry.get<scene::Camera>(stageCamera);
    Out out;
    out.entity = world.registry.create();
    world.registry.add(out.entity, lens);
    world.registry.add(out.entity, scene::Parent{stageCamera});
    world.registry.add(out.entity, scene::LocalTransform{});
    out.stageFromWorld = glm::inverse(worldFromStage);
    out.start = app::makeFly(makeRigid(worldFromStage), kMetresPerSecond);
    out.view = out.start;
    mOut = out;
}

void PhotoCamera::putBack(scene::World& world) {
    if (mOut)
        scene::despawn(world, mOut->entity);
    mOut.reset();
}

ecs::Entity PhotoCamera::entity() const {
    SHUTTER_CHECK(mOut, "the photo camera is not out");
    return mOut->entity;
}

void PhotoCamera::advance(
    scene::World& world, const app::InputState& input, double wallSeconds, double heightPx
) {
    if (!mOut)
        return;
    steer(mOut->view, input, wallSeconds, heightPx);
    // A view has no roll: one that nobody moved is the stage's camera itself.
    math::Transform local;
    if (!isSameView(mOut->view, mOut->start))
        local = makeRigid(mOut->stageFromWorld * computeMatrix(placementOf(mOut->view)));
    world.registry.get<scene::LocalTransform>(mOut->entity).transform = local;
}

} // namespace shutter::game
