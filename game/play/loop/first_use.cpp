// SPDX-License-Identifier: MIT
#include "game/play/loop/first_use.h"

#include "game/play/panel/effect_switches.h"

namespace shutter::game {

FirstUse::FirstUse() {
    mLast.method = "sharp";
    for (const EffectSwitch& effect : listEffectSwitches())
        effect.turnOff(mLast);
}

FirstUse::Needs FirstUse::findNeeds(const PlaySettings& settings) {
    Needs needs{settings.method, settings.split ? settings.leftMethod : std::string(), {}};
    for (const EffectSwitch& effect : listEffectSwitches())
        if (effect.takesShaders)
            needs.effects.push_back(effect.describe(settings));
    return needs;
}

PlaySettings FirstUse::reuse(const PlaySettings& wanted) const {
    PlaySettings settings = wanted;
    settings.method = mLast.method;
    settings.split = mLast.split;
    settings.leftMethod = mLast.split ? mLast.leftMethod : wanted.leftMethod;
    for (const EffectSwitch& effect : listEffectSwitches())
        if (effect.takesShaders)
            effect.copy(mLast, settings);
    return settings;
}

PlaySettings FirstUse::choose(const PlaySettings& wanted) {
    const Needs needs = findNeeds(wanted);
    if (mIsAnnounced || mKnown.contains(needs)) {
        mKnown.insert(needs);
        mLast = wanted;
        mNotice.clear();
        mIsAnnounced = false;
        return wanted;
    }
    mIsAnnounced = !mNotice.empty(); // the picture that is drawn now holds it
    mNotice = "compiling shaders of " + wanted.method;
    return reuse(wanted);
}

} // namespace shutter::game
