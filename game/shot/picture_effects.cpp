// SPDX-License-Identifier: MIT
#include "game/shot/picture_effects.h"

#include <utility>

namespace shutter::game {

template <class Module, class Settings>
void PictureEffects::add(gpu::Device& device, Settings PictureSettings::*settings) {
    auto effect = std::make_unique<Module>(device, PictureSettings().*settings);
    mConfigure.push_back([&one = *effect, settings](const PictureSettings& wanted) {
        one.configure(wanted.*settings);
    });
    mEffects.push_back(std::move(effect));
}

PictureEffects::PictureEffects(gpu::Device& device) {
    add<bloom::Bloom>(device, &PictureSettings::bloom);
    add<tonemap::Tonemap>(device, &PictureSettings::tonemap);
}

void PictureEffects::configure(const PictureSettings& settings) {
    for (const auto& configure : mConfigure)
        configure(settings);
    mNeedsBrightest = settings.bloom.share > 0.0f;
}

std::vector<render::Effect*> PictureEffects::listWith(std::initializer_list<render::Effect*> last
) const {
    std::vector<render::Effect*> effects;
    for (const auto& effect : mEffects)
        effects.push_back(effect.get());
    effects.insert(effects.end(), last.begin(), last.end());
    return effects;
}

} // namespace shutter::game
