// SPDX-License-Identifier: MIT
#include "game/bench/sequence/sequence_source.h"
#include "game/options/shot_arguments.h"
#include "game/shot/shot.h"

#include <fmt/format.h>

#include <utility>

namespace shutter::bench {

namespace {

class FlightSource : public SequenceSource {
  public:
    FlightSource(game::Shot shot, game::ShotOptions options)
        : mShot(std::move(shot)), mOptions(std::move(options)) {}

    void advance() override {
        ++mAdvanced;
        SHUTTER_CHECK(mAdvanced <= mOptions.frameTimes.size(), "the flight is over");
    }

    [[nodiscard]] const scene::World& world() const override { return mShot.world; }

    [[nodiscard]] const game::ShotOptions& options() const override { return mOptions; }

    [[nodiscard]] core::FrameRate framesPerSecond() const override { return mOptions.fps; }

  protected:
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
