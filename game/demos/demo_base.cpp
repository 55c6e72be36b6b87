// SPDX-License-Identifier: MIT
#include "game/demos/demo_base.h"

#include "engine/core/check.h"
#include "engine/scene/history.h"
#include "game/demos/stage.h"

#include <utility>

namespace shutter::game {

DemoBase::DemoBase(scene::World world, ecs::Entity body) : mWorld(std::move(world)), mBody(body) {
    SHUTTER_CHECK(!mWorld.cameras.empty(), "a demo without a camera");
}

void DemoBase::recordStart() {
    recordPoses(mWorld, seconds());
}

void DemoBase::step(const DemoControls& controls) {
    const DemoControls clamped = clampControls(controls);
    ++mSteps;
    if (clamped.switchCamera)
        cutToNextCamera();
    if (clamped.toggleExclusion)
        mWorld.registry.add(mBody, scene::MotionBlur{.exclude = !isBodyExcluded()});
    simulate(clamped);
    recordPoses(mWorld, seconds());
}

void DemoBase::cutToNextCamera() {
    mCamera = (mCamera + 1) % mWorld.cameras.size();
    scene::cut(mWorld, camera(), seconds());
}

bool DemoBase::isBodyExcluded() const {
    const auto* blur = mWorld.registry.find<scene::MotionBlur>(mBody);
    return blur && blur->exclude;
}

} // namespace shutter::game
