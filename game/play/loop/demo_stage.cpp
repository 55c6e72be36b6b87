// SPDX-License-Identifier: MIT
#include "engine/core/check.h"
#include "game/play/loop/stage.h"
#include "game/shot/shot.h"
#include "game/shot/surroundings.h"

#include <algorithm>
#include <string_view>

namespace shutter::game {

namespace {

using app::InputState;
using app::Key;
using app::PadButton;

DemoControls readControls(const InputState& input) {
    const app::Gamepad& pad = input.pad;
    DemoControls controls;
    controls.turn = std::clamp(
        axisOf(input, Key::A, Key::D) + axisOf(input, Key::Left, Key::Right) + pad.leftStick.x,
        -1.0,
        1.0
    );
    controls.drive = std::clamp(
        axisOf(input, Key::S, Key::W) + axisOf(input, Key::Down, Key::Up) + pad.rightTrigger -
            pad.leftTrigger + pad.rightStick.y,
        -1.0,
        1.0
    );
    controls.action = input.isDown(Key::Space) || input.isDown(app::MouseButton::Left) ||
                      pad.down[static_cast<size_t>(PadButton::A)];
    controls.switchCamera = input.wasPressed(Key::C) || input.wasPressed(PadButton::Y);
    controls.toggleExclusion = input.wasPressed(Key::E) || input.wasPressed(PadButton::X);
    return controls;
}

class DemoStage : public Stage {
  public:
    explicit DemoStage(std::unique_ptr<Demo> demo) : mDemo(std::move(demo)) {}

    [[nodiscard]] std::string title() const override { return mDemo->name(); }

    [[nodiscard]] scene::World& world() override { return mDemo->world(); }

    [[nodiscard]] ecs::Entity camera() const override { return mDemo->camera(); }

    [[nodiscard]] DemoAppearance appearance() const override { return mDemo->appearance(); }

    void advance(const InputState& input, const StageFrame& frame) override {
        const DemoControls read = readControls(input);
        mPressed.switchCamera = mPressed.switchCamera || read.switchCamera;
        mPressed.toggleExclusion = mPressed.toggleExclusion || read.toggleExclusion;
        mPressed.action = mPressed.action || input.wasPressed(Key::Space) ||
                          input.wasClicked(app::MouseButton::Left) ||
                          input.wasPressed(PadButton::A);
        for (uint32_t i = 0; i < frame.time.steps; ++i) {
            // A tap belongs to exactly one step, even if its frame has none.
            DemoControls controls = read;
            controls.switchCamera = mPressed.switchCamera;
            controls.toggleExclusion = mPressed.toggleExclusion;
            controls.action = controls.action || mPressed.action;
            mPressed = {};
            mDemo->step(controls);
        }
    }

    [[nodiscard]] std::vector<HudLine> hud() const override {
        std::vector<HudLine> lines = mDemo->hud();
        if (mDemo->isBodyExcluded())
            lines.push_back({fmt::format("{}: not blurred", findWords().body)});
        return lines;
    }

    [[nodiscard]] std::vector<KeyHelp> keys() const override { return listDemoKeys(findWords()); }

    [[nodiscard]] bool readsKeysInSteps() const override { return true; }

    [[nodiscard]] bool isOver() const override { return mDemo->isOver(); }

    [[nodiscard]] std::optional<int> score() const override { return mDemo->score(); }

  private:
    [[nodiscard]] const DemoControlWords& findWords() const {
        const auto demos = listDemos();
        const auto found = std::find_if(demos.begin(), demos.end(), [&](const DemoInfo& info) {
            return std::string_view(info.name) == mDemo->name();
        });
        SHUTTER_CHECK(found != demos.end(), "there is no demo {}", mDemo->name());
        return found->controls;
    }

    std::unique_ptr<Demo> mDemo;
    DemoControls mPressed; ///< since the last step
};

} // namespace

std::vector<KeyHelp> listDemoKeys(const DemoControlWords& words) {
    std::vector<KeyHelp> keys{
        {"A D", words.turn},
        {"W S", words.drive},
        {"Space", words.action},
        {"C", "next camera"},
        {"E", *words.body ? fmt::format("{} in or out of the blur", words.body) : ""}};
    std::erase_if(keys, [](const KeyHelp& key) { return key.what.empty(); });
    return keys;
}

core::Result<std::unique_ptr<Stage>>
makeDemoStage(std::unique_ptr<Demo> demo, const ShotOptions& options) {
    SHUTTER_TRY(focusOnEntity(demo->world(), demo->camera(), options, demo->name()));
    SHUTTER_TRY(addSurroundings(demo->world(), options));
    const DemoAppearance appearance = demo->appearance();
    if (!demo->world().assets.environment && appearance.turbidity > 0.0)
        addSky(demo->world(), appearance.turbidity, appearance.skyIntensity, demo->seconds());
    return std::unique_ptr<Stage>(std::make_unique<DemoStage>(std::move(demo)));
}

} // namespace shutter::game
