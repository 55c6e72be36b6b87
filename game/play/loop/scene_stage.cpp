// SPDX-License-Identifier: MIT
#include "engine/flythrough/flythrough.h"
#include "engine/scene/camera.h"
#include "engine/scene/history.h"
#include "engine/scene/motion.h"
#include "game/play/loop/stage.h"
#include "game/play/loop/viewer_camera.h"
#include "game/shot/shot.h"

#include <algorithm>

namespace shutter::game {

namespace {

using app::InputState;
using app::Key;

/// Metres from the camera to the centre of the drawn geometry.
double findDistance(const scene::World& world, ecs::Entity camera, double seconds) {
    const math::Bounds bounds = scene::computeWorldBounds(world, seconds);
    const math::dvec3 eye(worldFromEntity(world, camera, seconds)[3]);
    const double distance = bounds.isEmpty() ? 1.0 : glm::distance(eye, bounds.centre());
    return std::isfinite(distance) ? std::max(distance, 1e-2) : 1.0;
}

class SceneStage : public Stage {
  public:
    SceneStage(const ShotOptions& options, Shot shot)
        : mTitle(options.scene.filename().string()),
          mAppearance{options.background, options.ambient}, mWorld(std::move(shot.world)),
          mSceneCameras(mWorld.cameras),
          mViewer(
              mWorld,
              shot.camera,
              findDistance(mWorld, shot.camera, options.frameTimes.front()),
              options.frameTimes.front()
          ),
          mStartSeconds(options.frameTimes.front()) {
        mWorld.cameras.push_back(mViewer.entity());
        if (options.flythrough && options.isFlythroughShutter) {
            mFlythrough = options.flythrough;
            mFlythroughCamera = shot.camera;
        }
        // The session begins at the camera that an option names.
        if (!options.camera.empty() || options.flythrough || !options.flythroughClip.empty())
            mChosen = static_cast<size_t>(
                std::find(mSceneCameras.begin(), mSceneCameras.end(), shot.camera) -
                mSceneCameras.begin()
            );
        else
            mChosen = mSceneCameras.size();
    }

    [[nodiscard]] std::string title() const override { return mTitle; }

    [[nodiscard]] scene::World& world() override { return mWorld; }

    [[nodiscard]] ecs::Entity camera() const override {
        return mChosen < mSceneCameras.size() ? mSceneCameras[mChosen] : mViewer.entity();
    }

    [[nodiscard]] DemoAppearance appearance() const override { return mAppearance; }

    void advance(const InputState& input, const StageFrame& frame) override {
        const double seconds = mStartSeconds + frame.time.seconds;
        if (input.wasPressed(Key::C))
            switchCamera(seconds);
        mViewer.advance(
            mWorld,
            mChosen < mSceneCameras.size() ? InputState() : input,
            seconds,
            frame.time.duration,
            frame.wallSeconds,
            frame.heightPx,
            frame.paused
        );
    }

    [[nodiscard]] bool holdsCamera() const override { return mChosen >= mSceneCameras.size(); }

    [[nodiscard]] double startSeconds() const override { return mStartSeconds; }

    void adjustShutter(double seconds, scene::CameraShutter& shutter) const override {
        if (mFlythrough && camera() == mFlythroughCamera)
            flythrough::applyShutter(*mFlythrough, seconds, shutter);
    }

    [[nodiscard]] std::vector<HudLine> hud() const override {
        if (mChosen < mSceneCameras.size()) {
            const auto& lens = mWorld.registry.get<scene::Camera>(camera());
            return {{"camera " + (lens.name.empty() ? fmt::format("{}", mChosen) : lens.name)}};
        }
        return {{mViewer.mode() == ViewerMode::Orbit ? "orbit" : "fly"}};
    }

    [[nodiscard]] std::vector<KeyHelp> keys() const override {
        const KeyHelp next{"C", "next camera"};
        if (mChosen < mSceneCameras.size())
            return {next};
        if (mViewer.mode() == ViewerMode::Orbit)
            return {
                {"drag", "turn"}, {"right drag", "move"}, {"wheel", "nearer and farther"}, next};
        return {{"W A S D Q E", "fly"}, {"right drag", "turn the view"}, {"wheel", "speed"}, next};
    }

  private:
    /// The scene's cameras, then round it, then in flight.
    void switchCamera(double seconds) {
        if (mChosen == mSceneCameras.size() && mViewer.mode() == ViewerMode::Orbit) {
            mViewer.setMode(ViewerMode::Fly);
            return;
        }
        if (mChosen == mSceneCameras.size()) {
            mViewer.setMode(ViewerMode::Orbit);
            mChosen = 0;
        } else {
            ++mChosen;
        }
        if (mSceneCameras.empty())
            mChosen = 0;
        scene::cut(mWorld, camera(), seconds);
    }

    std::string mTitle;
    DemoAppearance mAppearance;
    scene::World mWorld;
    std::vector<ecs::Entity> mSceneCameras;
    ViewerCamera mViewer;
    double mStartSeconds;
    std::optional<flythrough::Flythrough> mFlythrough; ///< whose shutters count
    ecs::Entity mFlythroughCamera;
    size_t mChosen = 0; ///< of mSceneCameras; as many as there are: the viewer's
};

} // namespace

core::Result<std::unique_ptr<Stage>> loadSceneStage(const ShotOptions& options) {
    auto shot = loadShot(options);
    if (!shot)
        return shot.error();
    return std::unique_ptr<Stage>(std::make_unique<SceneStage>(options, std::move(shot).value()));
}

} // namespace shutter::game
