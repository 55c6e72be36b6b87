// SPDX-License-Identifier: MIT
#include "game/play/loop/hotkeys.h"

#include "engine/core/check.h"
#include "game/play/panel/effect_switches.h"
#include "game/shot/picture_drawer.h"

#include <algorithm>
#include <array>
#include <initializer_list>

namespace shutter::game {

namespace {

using app::Key;
using app::PadButton;

constexpr std::array kSpeeds = {0.05, 0.1, 0.25, 0.5, 1.0};

constexpr std::array kPresetKeys = {
    Key::Digit1, Key::Digit2, Key::Digit3, Key::Digit4, Key::Digit5};
/// Of listEffectSwitches().
constexpr std::array kEffectKeys = {
    Key::Digit6, Key::Digit7, Key::Digit8, Key::Digit9, Key::Digit0};
/// They move the player's own cameras.
constexpr std::array kFlyKeys = {Key::W, Key::A, Key::S, Key::D, Key::Q, Key::E};

/// The picture itself comes before the first and after the last view.
void cycleView(std::span<const std::string> views, int step, std::string& view) {
    const auto found = std::find(views.begin(), views.end(), view);
    const auto count = static_cast<int>(views.size());
    const int place = found == views.end() ? 0 : static_cast<int>(found - views.begin()) + 1;
    const int next = (place + step + count + 1) % (count + 1);
    view = next == 0 ? std::string() : views[static_cast<size_t>(next - 1)];
}

} // namespace

const std::string&
cycle(std::span<const std::string> choices, const std::string& current, int step) {
    SHUTTER_CHECK(!choices.empty(), "there is nothing to go through");
    const auto found = std::find(choices.begin(), choices.end(), current);
    if (found == choices.end())
        return choices.front();
    const auto count = static_cast<int>(choices.size());
    const int next = (static_cast<int>(found - choices.begin()) + step + count) % count;
    return choices[static_cast<size_t>(next)];
}

double nextSpeed(double speed, int step) {
    const auto nearest = std::min_element(kSpeeds.begin(), kSpeeds.end(), [&](double a, double b) {
        return std::abs(a - speed) < std::abs(b - speed);
    });
    const auto place = static_cast<int>(nearest - kSpeeds.begin()) + step;
    return kSpeeds[static_cast<size_t>(std::clamp(place, 0, int(kSpeeds.size()) - 1))];
}

PanelRequests applyHotkeys(
    const app::InputState& input, const Choices& choices, double speed, PlaySettings& settings
) {
    const int step = input.isDown(Key::Shift) ? -1 : 1;
    if (input.wasPressed(Key::M) || input.wasPressed(PadButton::RightBumper))
        settings.method = cycle(choices.methods, settings.method, step);
    if (input.wasPressed(PadButton::LeftBumper))
        settings.method = cycle(choices.methods, settings.method, -1);
    if (input.wasPressed(Key::N))
        settings.leftMethod = cycle(choices.methods, settings.leftMethod, step);
    if (input.wasPressed(Key::X))
        settings.split = !settings.split;
    if (input.wasPressed(Key::V))
        cycleView(choices.views, step, settings.view);
    if (input.wasPressed(Key::B))
        settings.cameraBlurScale = settings.cameraBlurScale > 0.0 ? 0.0 : 1.0;
    if (input.wasPressed(Key::F1) || input.wasPressed(PadButton::Back))
        settings.showPanel = !settings.showPanel;
    for (size_t i = 0; i < kPresetKeys.size() && i < listPresets().size(); ++i)
        if (input.wasPressed(kPresetKeys[i]))
            applyPreset(listPresets()[i], settings);
    for (size_t i = 0; i < kEffectKeys.size() && i < listEffectSwitches().size(); ++i)
        if (input.wasPressed(kEffectKeys[i]))
            pressKey(listEffectSwitches()[i], settings);
    PanelRequests requests;
    requests.togglePause = input.wasPressed(Key::P) || input.wasPressed(PadButton::Start);
    requests.togglePhoto = input.wasPressed(Key::T);
    const bool focuses = input.wasPressed(Key::F);
    requests.focusMiddle = focuses && !input.isDown(Key::Shift);
    requests.focusOwn = focuses && input.isDown(Key::Shift);
    requests.savePicture = input.wasPressed(Key::F2);
    requests.singleStep = input.wasPressed(Key::Period);
    requests.toggleRecording = input.wasPressed(Key::R);
    requests.toggleFullScreen = input.wasPressed(Key::F11);
    requests.save = input.wasPressed(Key::F5);
    requests.load = input.wasPressed(Key::F9);
    requests.quit = input.wasPressed(Key::Escape);
    if (input.wasPressed(Key::Comma))
        requests.speed = nextSpeed(speed, -1);
    if (input.wasPressed(Key::Slash))
        requests.speed = nextSpeed(speed, 1);
    return requests;
}

std::string
explainIdleKeys(const app::InputState& input, const KeyFacts& facts, const PlaySettings& settings) {
    const auto isAnyPressed = [&](const auto& keys) {
        return std::any_of(keys.begin(), keys.end(), [&](Key key) {
            return input.wasPressed(key);
        });
    };
    const auto pressed = [&](std::initializer_list<Key> keys) { return isAnyPressed(keys); };
    if (!facts.photoMethod.empty()) {
        if (pressed({Key::M, Key::N, Key::X, Key::V, Key::C}) || isAnyPressed(kPresetKeys))
            return fmt::format("photo mode draws one picture by {}; T ends it", facts.photoMethod);
    } else if (facts.stageRests && (pressed({Key::C, Key::E}) || input.wasPressed(PadButton::Y))) {
        return "C and E act when the game goes on: P, or . for one frame";
    } else if (facts.isCameraFixed && isAnyPressed(kFlyKeys)) {
        return "this camera is the scene's; C goes on to one that you move";
    } else if (pressed({Key::N}) && !settings.split) {
        return fmt::format("left of a split: {}; X shows it", settings.leftMethod);
    }
    const auto method = findMethod(facts.photoMethod.empty() ? settings.method : facts.photoMethod);
    if (pressed({Key::B}) && method && method.value()->family == MethodFamily::Sharp)
        return "sharp blurs nothing, the camera's motion neither";
    if (pressed({Key::Digit6}) && method && isSampledAnyway(*method.value()))
        return fmt::format("{} has smooth edges without help", method.value()->name);
    for (size_t i = 0; i < kEffectKeys.size() && i < facts.idleEffects.size(); ++i)
        if (pressed({kEffectKeys[i]}) && !facts.idleEffects[i].empty())
            return facts.idleEffects[i];
    if (pressed({Key::Comma}) && facts.speed <= kSpeeds.front())
        return fmt::format("speed {:g} is the slowest", kSpeeds.front());
    if (pressed({Key::Slash}) && facts.speed >= kSpeeds.back())
        return fmt::format("speed {:g} is the fastest", kSpeeds.back());
    return {};
}

double countHintDown(double seconds, double wallSeconds, bool hasPicture) {
    constexpr double kMaxSecondsPerTurn = 0.25;
    return hasPicture ? std::max(seconds - std::min(wallSeconds, kMaxSecondsPerTurn), 0.0)
                      : seconds;
}

} // namespace shutter::game
