// SPDX-License-Identifier: MIT
// Settings that are valid and otherwise anything.
#pragma once

#include "engine/scene/lens.h"
#include "engine/scene/shutter.h"
#include "game/play/panel/play_settings.h"
#include "modules/motion_blur/settings.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace shutter::test {

class RandomSettings {
  public:
    explicit RandomSettings(uint32_t seed) : mRandom(seed) {}

    game::PlaySettings make() {
        game::PlaySettings settings;
        settings.method = pickMethod();
        settings.leftMethod = pickMethod();
        settings.view = index(2) == 0 ? "" : "tiles \"\\ \xc3\xa9";
        fill(game::listPlayRows(), settings);
        game::visitPictureRows([&](auto rows, const auto& part) {
            fill(rows, part(settings.picture));
        });
        fill(motion_blur::listBudgetRows(), settings.budget);
        fill(motion_blur::listSettingRows(), settings.blur);
        fill(scene::listShutterRows(), settings.shutter);
        scene::ShutterResponse& response = settings.shutter.response;
        fill(scene::listResponseRows(), response);
        response.closeShare = std::min(response.closeShare, 1.0 - response.openShare);
        for (size_t count = 2 + index(63); count > 0; --count)
            response.samples.push_back(share());
        response.samples.back() = 0.5;
        fill(scene::listCutRows(), settings.shutter.cuts);
        fill(scene::listOverrideRows(), settings.lens);
        return settings;
    }

    /// [0, 1)
    double share() { return std::uniform_real_distribution<double>(0.0, 1.0)(mRandom); }

    size_t index(size_t count) {
        return std::uniform_int_distribution<size_t>(0, count - 1)(mRandom);
    }

  private:
    std::string pickMethod() {
        const auto methods = game::listMethods();
        return methods[index(methods.size())].name;
    }

    /// An end of the range, infinity, or anything between.
    double pick(const core::NumberRange& range) {
        switch (index(range.isUnlimited ? 4 : 3)) {
        case 0:
            return range.lowest;
        case 1:
            return range.highest;
        case 2: {
            const double value = range.lowest + share() * (range.highest - range.lowest);
            return range.step == 0.0
                       ? value
                       : range.lowest +
                             range.step * std::floor((value - range.lowest) / range.step);
        }
        default:
            return std::numeric_limits<double>::infinity();
        }
    }

    template <class Owner> void fill(std::span<const core::SettingRow<Owner>> rows, Owner& owner) {
        for (const auto& row : rows)
            if (const auto* yes = std::get_if<bool Owner::*>(&row.field))
                owner.** yes = index(2) == 0;
            else if (const auto* words = std::get_if<core::WordField<Owner>>(&row.field))
                words->set(owner, index(words->words.size()));
            else
                core::setNumber(row, owner, pick(row.range));
    }

    std::mt19937 mRandom;
};

} // namespace shutter::test
