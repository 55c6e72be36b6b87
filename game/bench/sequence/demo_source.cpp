// SPDX-License-Identifier: MIT
#include "engine/app/input_script.h"
#include "engine/app/step_clock.h"
#include "engine/scene/shutter.h"
#include "game/bench/sequence/sequence_source.h"
#include "game/demos/demo.h"
#include "game/options/shot_arguments.h"
#include "game/play/loop/stage.h"

#include <utility>

namespace shutter::bench {

namespace {

/// What is simulated is known up to now, so the exposure ends there; half a frame, as a film's.
scene::CameraShutter makeDemoShutter() {
    scene::CameraShutter shutter;
    shutter.mode = scene::ShutterMode::Angle;
    shutter.angleDegrees = 180.0;
    shutter.phase = scene::ShutterPhase::End;
    return shutter;
}

class DemoSource : public SequenceSource {
  public:
    DemoSource(
        std::unique_ptr<game::Stage> stage, app::InputScript script, game::ShotOptions options
    )
        : mStage(std::move(stage)), mPlayer(std::move(script)), mOptions(std::move(options)) {}

    void advance() override {
        // Screenshots, sizes and the end are the window's affair.
        (void)mPlayer.takeFrame(mCollector, {mOptions.width, mOptions.height});
        const double seconds = mPlayer.frameSeconds();
        mTime = mClock.advance(seconds);
        mStage->advance(mCollector.take(), {mTime, seconds, double(mOptions.height), false});
        scene::World& world = mStage->world();
        const ecs::Entity camera = mStage->camera();
        if (world.registry.find<scene::CameraShutter>(camera) == nullptr)
            world.registry.add(camera, makeDemoShutter());
    }

    [[nodiscard]] const scene::World& world() const override { return mStage->world(); }

    [[nodiscard]] const game::ShotOptions& options() const override { return mOptions; }

    [[nodiscard]] core::FrameRate framesPerSecond() const override {
        return 1.0 / mPlayer.frameSeconds();
    }

  protected:
    [[nodiscard]] extract::ViewRequest ownView() const override {
        const game::DemoLook look = mStage->look();
        extract::ViewRequest view;
        view.camera = mStage->camera();
        view.exposure = scene::computeExposure(makeDemoShutter(), mTime.seconds, mTime.duration);
        view.width = mOptions.width;
        view.height = mOptions.height;
        view.background = look.background;
        view.ambient = look.ambient;
        view.unlit = mOptions.unlit;
        view.shadows = mOptions.picture.shadows;
        return view;
    }

    [[nodiscard]] scene::World& changeWorld() override { return mStage->world(); }

  private:
    std::unique_ptr<game::Stage> mStage;
    app::ScriptPlayer mPlayer;
    game::ShotOptions mOptions;
    app::InputCollector mCollector;
    app::StepClock mClock{game::kDemoStepSeconds};
    app::FrameTime mTime;
};

} // namespace

core::Result<std::unique_ptr<SequenceSource>>
openDemo(const SequenceCase& film, const SequenceFiles& files) {
    game::ShotArguments arguments = film.shot;
    arguments.scene = files.scene.string();
    auto options = game::interpret(arguments);
    if (!options)
        return options.error();
    auto script = app::readInputScript(files.script);
    if (!script)
        return script.error();
    auto demo = game::makeDemo(film.demo, files.scene.parent_path());
    if (!demo)
        return demo.error();
    auto stage = game::makeDemoStage(std::move(demo).value(), options.value());
    if (!stage)
        return stage.error();
    auto source = std::make_unique<DemoSource>(
        std::move(stage).value(), std::move(script).value(), std::move(options).value()
    );
    for (uint32_t i = 0; i < film.firstFrame; ++i)
        source->advance();
    return std::unique_ptr<SequenceSource>(std::move(source));
}

} // namespace shutter::bench
