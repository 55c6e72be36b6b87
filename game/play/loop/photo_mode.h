// SPDX-License-Identifier: MIT
// Photo mode: a paused picture is traced, more rays in every frame, until it is the truth; its
// camera hangs on the one that the picture was seen through, so that it blurs as that does
// wherever the player takes it.
#pragma once

#include "engine/app/camera_control.h"
#include "engine/extract/extracted_frame.h"
#include "engine/scene/world.h"
#include "game/play/panel/play_settings.h"

#include <cstdint>
#include <optional>

namespace shutter::game {

class PhotoMode {
  public:
    static constexpr uint32_t kMaxRays = 256; ///< per pixel: then nothing is added any more
    /// Pictures of `accumulate`, at least: with fewer a lens shows bright points many times.
    static constexpr uint32_t kLensPictures = 64;

    [[nodiscard]] bool isOn() const { return mIsOn; }

    /// \param traces rays are there to trace; without them the picture stays the method's
    void turn(bool on, bool traces = true);

    /// The picture is traced.
    [[nodiscard]] bool isTracing() const { return mIsOn && mTraces; }

    /// The settings with which the next frame is drawn: over the whole window, by `truth` where
    /// rays can be traced, else by `accumulate` where there is depth of field.
    /// \param hasLens of the camera (scene::hasLens())
    [[nodiscard]] PlaySettings choose(const PlaySettings& settings, bool hasLens = false) const;

    /// Rays per pixel that the picture has had so far: 0 where it is another one than in the call
    /// before, because the camera, the shutter, the size or a feature is.
    [[nodiscard]] uint32_t begin(
        const scene::World& world, const extract::ViewRequest& view, const FeatureSettings& features
    );

    /// Rays per pixel that the frame after begin() adds, 0 or 1.
    [[nodiscard]] uint32_t raysToAdd() const { return mRays < kMaxRays ? 1 : 0; }

    void end() { mRays += raysToAdd(); }

    /// Rays per pixel of the last frame; nothing while it traces none.
    [[nodiscard]] std::optional<uint32_t> rays() const;

  private:
    struct Picture {
        extract::ViewRequest view;
        FeatureSettings features;
        math::dmat4 cameraAtOpen{1.0};
        math::dmat4 cameraAtClose{1.0};
        scene::CameraLens lensAtOpen;
        scene::CameraLens lensAtClose;
    };

    [[nodiscard]] static bool areSame(const Picture& a, const Picture& b);

    bool mIsOn = false;
    bool mTraces = true;
    uint32_t mRays = 0;
    std::optional<Picture> mPicture;
};

class PhotoCamera {
  public:
    /// Creates its entity where `stageCamera` is; a camera that is out already stays as it is.
    /// \param seconds of the picture, at which the world is static
    void take(scene::World& world, ecs::Entity stageCamera, double seconds);

    /// Destroys its entity, if there is one.
    void putBack(scene::World& world);

    [[nodiscard]] bool isOut() const { return mOut.has_value(); }

    /// It must be out (CHECKed).
    [[nodiscard]] ecs::Entity entity() const;

    /// Flies as the player wants, out or not. \param heightPx of the window, above 0
    void
    advance(scene::World& world, const app::InputState& input, double wallSeconds, double heightPx);

  private:
    struct Out {
        ecs::Entity entity;
        math::dmat4 stageFromWorld{1.0};
        math::dmat4 rest{1.0}; ///< where it is until it is moved, from the stage's camera
        app::FlyView start;
        app::FlyView view;
    };

    std::optional<Out> mOut;
};

} // namespace shutter::game
