// SPDX-License-Identifier: MIT
#include "game/play/loop/first_use.h"

namespace shutter::game {

FirstUse::Needs FirstUse::findNeeds(const PlaySettings& settings) {
    return {
        settings.method,
        settings.split ? settings.leftMethod : std::string(),
        settings.picture.antiAliasing,
        settings.picture.features.shadows.mode,
        settings.picture.bloom.share > 0.0f};
}

PlaySettings FirstUse::reuse(const PlaySettings& wanted) const {
    PlaySettings settings = wanted;
    settings.method = mLast.method;
    settings.split = !mLast.leftMethod.empty();
    if (settings.split)
        settings.leftMethod = mLast.leftMethod;
    settings.picture.antiAliasing = mLast.antiAliasing;
    settings.picture.features.shadows.mode = mLast.shadows;
    if (!mLast.bloom)
        settings.picture.bloom.share = 0.0f;
    return settings;
}

PlaySettings FirstUse::choose(const PlaySettings& wanted) {
    const Needs needs = findNeeds(wanted);
    if (mIsAnnounced || mKnown.contains(needs)) {
        mKnown.insert(needs);
        mLast = needs;
        mNotice.clear();
        mIsAnnounced = false;
        return wanted;
    }
    mIsAnnounced = !mNotice.empty(); // the picture that is drawn now holds it
    mNotice = "compiling shaders of " + wanted.method;
    return reuse(wanted);
}

} // namespace shutter::game
