// SPDX-License-Identifier: MIT
// `gallery`: throw balls at targets that cross on rails; the faster, the more they are worth.
#pragma once

#include "game/demos/demo_base.h"
#include "game/demos/gallery_aim.h"
#include "game/demos/random.h"

#include <memory>

namespace shutter::game {

class GalleryDemo final : public DemoBase {
  public:
    /// \param file names the scene in messages
    [[nodiscard]] static core::Result<std::unique_ptr<Demo>>
    create(scene::World world, std::string_view file);

    [[nodiscard]] const char* name() const override { return "gallery"; }

    [[nodiscard]] DemoAppearance appearance() const override;
    [[nodiscard]] std::vector<HudLine> hud() const override;
    [[nodiscard]] bool isOver() const override;

    [[nodiscard]] int score() const override { return mScore; }

    [[nodiscard]] int hitCount() const { return mHits; }

    [[nodiscard]] int throwCount() const { return mThrows; }

  protected:
    void simulate(const DemoControls& controls) override;

  private:
    struct Nodes {
        ecs::Entity shooter;
        ecs::Entity launcher;
        ecs::Entity ball;
    };

    GalleryDemo(scene::World world, const Nodes& nodes);
    void throwOne();
    void countHits();
    void placeShooter();

    Nodes mNodes;
    math::Transform mShooterRest;
    math::Transform mLauncherRest;
    Aim mAim;
    Random mRandom{7};
    double mReadySeconds = 0.0; ///< when the next ball may be thrown
    double mCutSeconds = 0.0;   ///< after the end: when the picture cuts next
    int mScore = 0;
    int mHits = 0;
    int mThrows = 0;
};

} // namespace shutter::game
