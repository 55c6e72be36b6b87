// SPDX-License-Identifier: MIT
// Announces pictures that take long because their shaders are compiled first: the picture before
// stays on the screen meanwhile, and says so.
#pragma once

#include "game/play/panel/play_settings.h"

#include <compare>
#include <set>
#include <string>
#include <vector>

namespace shutter::game {

class FirstUse {
  public:
    FirstUse();

    /// The settings of the next picture. Where the wanted ones take shaders that no picture had
    /// yet, one more is drawn without them, which holds notice(); at first that is a sharp picture
    /// without other effects.
    [[nodiscard]] PlaySettings choose(const PlaySettings& wanted);

    /// For the head-up display of the next picture: "compiling shaders of hybrid"; empty: none.
    [[nodiscard]] std::string notice() const { return mIsAnnounced ? std::string() : mNotice; }

  private:
    /// What decides which shaders a picture takes. Others take little time.
    struct Needs {
        std::string method;
        std::string leftMethod;           ///< empty: no split
        std::vector<std::string> effects; ///< EffectSwitch::describe() of those that take shaders

        auto operator<=>(const Needs&) const = default;
    };

    [[nodiscard]] static Needs findNeeds(const PlaySettings& settings);
    /// The wanted settings, with the last picture's method and effects, whose shaders exist.
    [[nodiscard]] PlaySettings reuse(const PlaySettings& wanted) const;

    std::set<Needs> mKnown;
    PlaySettings mLast; ///< of the last picture
    std::string mNotice = "compiling shaders";
    bool mIsAnnounced = false; ///< by the last picture
};

} // namespace shutter::game
