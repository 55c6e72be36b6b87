// SPDX-License-Identifier: MIT
#include "game/play/panel/effect_switches.h"

#include "modules/particles/particle_emitter.h"

#include <array>
#include <iterator>

namespace shutter::game {

namespace {

using S = PlaySettings;

void stepShadows(S& settings) {
    using shadows::ShadowMode;
    ShadowMode& mode = settings.picture.features.shadows.mode;
    mode = mode == ShadowMode::None    ? ShadowMode::Sharp
           : mode == ShadowMode::Sharp ? ShadowMode::Blurred
                                       : ShadowMode::None;
}

std::string describeShadows(const S& settings) {
    const shadows::ShadowSettings& shadows = settings.picture.features.shadows;
    if (shadows.mode == shadows::ShadowMode::None)
        return {};
    return core::describeValue(core::getRow(shadows::listShadowRows(), "shadows"), shadows) +
           " shadows";
}

std::string describeAntiAliasing(const S& settings) {
    if (settings.picture.antiAliasing == AntiAliasing::None)
        return {};
    return core::describeValue(core::getRow(listPictureRows(), "antiAliasing"), settings.picture);
}

constexpr std::array kSwitches = {
    EffectSwitch{
        "smooth edges",
        describeAntiAliasing,
        [](const S& from, S& to) { to.picture.antiAliasing = from.picture.antiAliasing; },
        [](S& settings) { settings.picture.antiAliasing = AntiAliasing::None; },
        nullptr,
        true},
    EffectSwitch{
        "shadows",
        describeShadows,
        [](const S& from, S& to) {
            to.picture.features.shadows.mode = from.picture.features.shadows.mode;
        },
        [](S& settings) { settings.picture.features.shadows.mode = shadows::ShadowMode::None; },
        stepShadows,
        true},
    EffectSwitch{
        "sky",
        [](const S& settings) { return std::string(settings.environment ? "sky" : ""); },
        [](const S& from, S& to) { to.environment = from.environment; },
        [](S& settings) { settings.environment = false; },
        nullptr,
        false,
        [](const scene::World& world) {
            return std::string(
                world.assets.environment ? "" : "the scene has no sky; --sky adds one"
            );
        }},
    EffectSwitch{
        "bloom",
        [](const S& settings) {
            return std::string(settings.picture.bloom.share > 0.0f ? "bloom" : "");
        },
        [](const S& from, S& to) { to.picture.bloom.share = from.picture.bloom.share; },
        [](S& settings) { settings.picture.bloom.share = 0.0f; },
        nullptr,
        true},
    EffectSwitch{
        "particles",
        [](const S& settings) {
            return std::string(settings.picture.features.particles.areShown ? "particles" : "");
        },
        [](const S& from, S& to) {
            to.picture.features.particles = from.picture.features.particles;
        },
        [](S& settings) { settings.picture.features.particles.areShown = false; },
        nullptr,
        false,
        [](const scene::World& world) {
            const auto emitters = world.registry.view<particles::ParticleEmitter>();
            const bool isEmpty = emitters.begin() == std::default_sentinel;
            return std::string(isEmpty ? "the scene has no particles" : "");
        }},
};

} // namespace

std::span<const EffectSwitch> listEffectSwitches() {
    return kSwitches;
}

void pressKey(const EffectSwitch& effect, PlaySettings& settings) {
    static const PlaySettings kFresh;
    if (effect.step)
        effect.step(settings);
    else if (effect.describe(settings).empty())
        effect.copy(kFresh, settings);
    else
        effect.turnOff(settings);
}

} // namespace shutter::game
