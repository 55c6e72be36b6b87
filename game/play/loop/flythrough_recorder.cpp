// SPDX-License-Identifier: MIT
#include "game/play/loop/flythrough_recorder.h"

#include "engine/extract/frame_view.h"
#include "engine/scene/camera.h"
#include "engine/scene/lens.h"
#include "engine/scene/motion.h"
#include "game/play/loop/numbered_file.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <numbers>

namespace shutter::game {

namespace {

// That a file may hold.
constexpr double kWidestDegrees = 179.0;
constexpr double kWidestFStop = 0.01;
constexpr double kClosedFStop = 1.0e9;

/// That gives the camera which plays the flight, a copy of the world's first one, a lens of this
/// radius. \param yFov of the key, radians
double findFStop(const scene::World& world, double radius, double yFov) {
    scene::CameraLens played;
    if (!world.cameras.empty())
        if (const auto* found = world.registry.find<scene::CameraLens>(world.cameras.front()))
            played = *found;
    played.fStop = 1.0;
    const double widest = scene::computeLensRadius(played, yFov);
    if (radius == 0.0 || widest == 0.0)
        return kClosedFStop;
    return std::clamp(widest / radius, kWidestFStop, kClosedFStop);
}

flythrough::FlythroughKey
makeKey(const scene::World& world, const extract::ViewRequest& view, bool hasLens) {
    const double seconds = view.exposure.raster;
    const math::dmat4 rigid = worldFromRigid(world, view.camera, seconds);
    flythrough::FlythroughKey key;
    key.position = math::dvec3(rigid[3]);
    key.rotation = glm::normalize(glm::quat_cast(math::dmat3(rigid)));
    const double yFov = scene::yFovAt(world, view.camera, seconds);
    const double pictureYFov =
        extract::computePictureYFov(world.registry.get<scene::Camera>(view.camera), yFov, view);
    key.fieldOfView = std::min(pictureYFov * 180.0 / std::numbers::pi, kWidestDegrees);
    if (hasLens) {
        const scene::CameraLens lens = scene::lensAt(world, view.camera, seconds);
        key.focusDistance = lens.focusDistance;
        key.fStop = findFStop(
            world, scene::computeLensRadius(lens, yFov), *key.fieldOfView * std::numbers::pi / 180.0
        );
    }
    return key;
}

} // namespace

void FlythroughRecorder::start() {
    mFlight.emplace();
    mFlight->name = "recorded";
    mLast.reset();
}

void FlythroughRecorder::addFrame(const scene::World& world, const extract::ViewRequest& view) {
    if (!mFlight)
        return;
    const double seconds = view.exposure.raster;
    auto& keys = mFlight->keys;
    if (keys.empty()) {
        mStartSeconds = seconds;
        mCamera = view.camera;
        mHasLens = scene::hasLens(world, view.camera);
    }
    flythrough::FlythroughKey key = makeKey(world, view, mHasLens);
    key.seconds = seconds - mStartSeconds;
    if (!keys.empty() && key.seconds <= keys.back().seconds)
        return; // paused
    key.cut = view.camera != mCamera;
    const bool isDue =
        keys.empty() || key.cut || key.seconds >= keys.back().seconds + kRecordedKeySeconds - 1e-9;
    mCamera = view.camera;
    if (!isDue) {
        mLast = key;
        return;
    }
    // The key just before a cut is the end of its shot.
    if (key.cut && mLast && mLast->seconds > keys.back().seconds)
        keys.push_back(*mLast);
    keys.push_back(key);
    mLast.reset();
}

core::Result<std::filesystem::path> FlythroughRecorder::finish(const std::filesystem::path& folder
) {
    flythrough::Flythrough flight = std::move(mFlight).value_or(flythrough::Flythrough());
    mFlight.reset();
    if (mLast)
        flight.keys.push_back(*mLast);
    mLast.reset();
    if (flight.keys.empty())
        return core::makeError("nothing was recorded: no game time passed");
    auto file = findFreeFile(folder, "flythrough", ".json");
    if (file)
        SHUTTER_TRY(flythrough::writeFlythrough(file.value(), flight));
    return file;
}

} // namespace shutter::game
