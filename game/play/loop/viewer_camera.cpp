// SPDX-License-Identifier: MIT
#include "game/play/loop/viewer_camera.h"

#include "engine/scene/auto_focus.h"
#include "engine/scene/lens.h"
#include "engine/scene/motion.h"
#include "engine/scene/path.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>

namespace shutter::game {

namespace {

/// Longest time that an exposure reaches back.
constexpr double kWaySeconds = 0.5;
/// Speed at which flying starts, metres per second for each metre of distance.
constexpr double kFlyShare = 0.5;

math::Transform placementAt(const scene::World& world, ecs::Entity entity, double seconds) {
    const math::dmat4 rigid = worldFromRigid(world, entity, seconds);
    math::Transform placement;
    placement.translation = math::dvec3(rigid[3]);
    placement.rotation = glm::normalize(glm::quat_cast(math::dmat3(rigid)));
    return placement;
}

/// As the lens is at `seconds`: keys are another camera's, only autofocus goes on.
void copyLens(scene::World& world, ecs::Entity from, ecs::Entity to, double seconds) {
    const ecs::Registry& registry = world.registry;
    const auto* keys = registry.find<scene::FocusMotion>(from);
    if (!keys && !registry.has<scene::CameraLens>(from) && !registry.has<scene::AutoFocus>(from))
        return;
    const bool isKeyed = keys && !keys->keys.empty() && keys->keys.front().focusDistance;
    world.registry.add(to, scene::lensAt(world, from, seconds));
    if (const auto* found = registry.find<scene::AutoFocus>(from); found && !isKeyed) {
        const scene::AutoFocus focus = *found;
        world.registry.add(to, focus);
    }
}

bool sameWay(const math::Transform& a, const math::Transform& b) {
    return a.translation == b.translation && a.rotation == b.rotation;
}

} // namespace

ViewerCamera::ViewerCamera(scene::World& world, ecs::Entity like, double distance, double seconds) {
    const math::Transform placement = placementAt(world, like, seconds);
    const scene::Camera camera = world.registry.get<scene::Camera>(like);
    mEntity = world.registry.create();
    world.registry.add(mEntity, camera);
    world.registry.get<scene::Camera>(mEntity).name = "viewer";
    copyLens(world, like, mEntity, seconds);
    world.registry.add(mEntity, scene::LocalTransform{placement});
    mOrbit = app::makeOrbit(placement, distance);
    mFly = app::makeFly(placement, kFlyShare * distance);
}

void ViewerCamera::setMode(ViewerMode mode) {
    if (mode == mMode)
        return;
    const math::Transform here = placement();
    if (mode == ViewerMode::Orbit)
        mOrbit = app::makeOrbit(here, mOrbit.distance);
    else
        mFly = app::makeFly(here, mFly.speed);
    mMode = mode;
}

void ViewerCamera::jumpTo(const math::Transform& placement) {
    mOrbit = app::makeOrbit(placement, mOrbit.distance);
    mFly = app::makeFly(placement, mFly.speed);
    mWay.clear();
}

math::Transform ViewerCamera::placement() const {
    return mMode == ViewerMode::Orbit ? placementOf(mOrbit) : placementOf(mFly);
}

void ViewerCamera::advance(
    scene::World& world,
    const app::InputState& input,
    double seconds,
    double duration,
    double wallSeconds,
    double heightPx,
    bool paused
) {
    if (mMode == ViewerMode::Orbit)
        steer(mOrbit, input, wallSeconds, heightPx);
    else
        steer(mFly, input, wallSeconds, heightPx);
    const math::Transform here = placement();
    const bool rests = !mWay.empty() && sameWay(mWay.front().placement, here);
    if (!(paused && rests)) {
        for (Stop& stop : mWay)
            stop.age += std::max(duration, 1e-6);
        mWay.push_front({here, 0.0});
    }
    while (mWay.size() > 2 && mWay[mWay.size() - 2].age > kWaySeconds)
        mWay.pop_back();

    scene::PathMotion path;
    path.interpolation = scene::PathInterpolation::Linear;
    for (auto stop = mWay.rbegin(); stop != mWay.rend(); ++stop)
        path.keys.push_back(
            {seconds - stop->age, stop->placement.translation, stop->placement.rotation}
        );
    world.registry.add(mEntity, std::move(path));
}

} // namespace shutter::game
