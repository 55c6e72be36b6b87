// SPDX-License-Identifier: MIT
#include "game/bench/sequence/sequence_source.h"

#include "engine/app/input_script.h"
#include "engine/app/step_clock.h"
#include "engine/io/file_bytes.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/camera.h"
#include "engine/scene/lens.h"
#include "engine/scene/motion.h"
#include "engine/scene/shutter.h"
#include "game/demos/demo.h"
#include "game/options/shot_arguments.h"
#include "game/play/loop/stage.h"
#include "game/shot/shot.h"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include <string>
#include <utility>

namespace shutter::bench {

namespace {

/// Simulated motion is known up to now, so the exposure ends there; half a frame, as for film.
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
        scene::advanceAutoFocus(world, mTime.seconds);
    }

    [[nodiscard]] const scene::World& world() const override { return mStage->world(); }

    [[nodiscard]] const game::ShotOptions& options() const override { return mOptions; }

    [[nodiscard]] core::FrameRate framesPerSecond() const override {
        return 1.0 / mPlayer.frameSeconds();
    }

  protected:
    [[nodiscard]] ecs::Entity ownCamera() const override { return mStage->camera(); }

    [[nodiscard]] extract::ViewRequest ownView() const override {
        const game::DemoAppearance appearance = mStage->appearance();
        extract::ViewRequest view;
        view.camera = mStage->camera();
        view.exposure = scene::computeExposure(makeDemoShutter(), mTime.seconds, mTime.duration);
        view.width = mOptions.width;
        view.height = mOptions.height;
        view.background = appearance.background;
        view.ambient = appearance.ambient;
        view.unlit = mOptions.unlit;
        view.unseenMatters = game::unseenMatters(mOptions.picture.features);
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

class FlightSource : public SequenceSource {
  public:
    FlightSource(game::Shot shot, game::ShotOptions options)
        : mShot(std::move(shot)), mOptions(std::move(options)) {}

    void advance() override {
        ++mAdvanced;
        SHUTTER_CHECK(mAdvanced <= mOptions.frameTimes.size(), "the flight is over");
        const extract::ViewRequest view = ownView();
        scene::replayAutoFocus(mShot.world, view.camera, view.exposure);
    }

    [[nodiscard]] const scene::World& world() const override { return mShot.world; }

    [[nodiscard]] const game::ShotOptions& options() const override { return mOptions; }

    [[nodiscard]] core::FrameRate framesPerSecond() const override { return mOptions.fps; }

  protected:
    [[nodiscard]] ecs::Entity ownCamera() const override { return mShot.camera; }

    [[nodiscard]] extract::ViewRequest ownView() const override {
        SHUTTER_CHECK(mAdvanced > 0, "no frame was advanced to");
        return game::makeView(mShot, mOptions, mOptions.frameTimes[mAdvanced - 1]);
    }

    [[nodiscard]] scene::World& changeWorld() override { return mShot.world; }

  private:
    game::Shot mShot;
    game::ShotOptions mOptions;
    size_t mAdvanced = 0;
};

} // namespace

core::Result<SequenceFiles>
writeSequenceFiles(const SequenceCase& film, const std::filesystem::path& folder) {
    const std::filesystem::path scenes = folder / "scenes";
    // A demo finds its scene by its own name.
    const std::string name = film.demo.empty() ? film.name : film.demo;
    SequenceFiles files{scenes / (name + ".glb"), scenes / (film.name + ".json")};
    SHUTTER_TRY(film.writeScene(files.scene));
    SHUTTER_TRY(io::writeFileText(files.script, std::string(film.script)));
    return files;
}

core::Result<std::unique_ptr<SequenceSource>>
SequenceSource::open(const SequenceCase& film, const SequenceFiles& files, uint32_t frames) {
    return film.demo.empty() ? openFlight(film, files, frames) : openDemo(film, files);
}

extract::ViewRequest SequenceSource::view() const {
    extract::ViewRequest view = ownView();
    if (mStanding != ecs::kNullEntity)
        view.camera = mStanding;
    return view;
}

bool SequenceSource::hasLens() const {
    return scene::hasLens(world(), ownCamera());
}

StandingView SequenceSource::standingView() const {
    const extract::ViewRequest view = ownView();
    const double seconds = view.exposure.raster;
    const math::dmat4 rigid = scene::worldFromRigid(world(), view.camera, seconds);
    StandingView standing;
    standing.pose.translation = math::dvec3(rigid[3]);
    standing.pose.rotation = glm::normalize(glm::quat_cast(math::dmat3(rigid)));
    standing.lens = world().registry.get<scene::Camera>(view.camera);
    standing.lens.yFov = scene::yFovAt(world(), view.camera, seconds);
    standing.opening = scene::lensAt(world(), view.camera, seconds);
    standing.shutter = view.exposure.shutter;
    return standing;
}

void SequenceSource::stand(const StandingView& from) {
    SHUTTER_CHECK(mStanding == ecs::kNullEntity, "it has a camera at rest already");
    ecs::Registry& registry = changeWorld().registry;
    mStanding = registry.create();
    registry.add(mStanding, from.lens);
    registry.add(mStanding, scene::LocalTransform{from.pose});
    registry.add(mStanding, from.shutter);
    if (from.opening.fStop != 0.0)
        registry.add(mStanding, from.opening);
}

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

core::Result<std::unique_ptr<SequenceSource>>
openFlight(const SequenceCase& film, const SequenceFiles& files, uint32_t frames) {
    game::ShotArguments arguments = film.shot;
    arguments.scene = files.scene.string();
    arguments.flythrough = files.script.string();
    arguments.frames = fmt::format("{}:{}", film.firstFrame, film.firstFrame + frames - 1);
    auto options = game::interpret(arguments);
    if (!options)
        return options.error();
    SHUTTER_TRY(game::loadFlythrough(arguments, options.value()));
    auto shot = game::loadShot(options.value());
    if (!shot)
        return shot.error();
    return std::unique_ptr<SequenceSource>(
        std::make_unique<FlightSource>(std::move(shot).value(), std::move(options).value())
    );
}

} // namespace shutter::bench
