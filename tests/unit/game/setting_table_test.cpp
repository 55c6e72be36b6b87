// SPDX-License-Identifier: MIT
// The rows against what the effect itself takes and reads.
#include "game/methods.h"
#include "game/setting_table.h"

#include <gtest/gtest.h>

#include <set>

namespace shutter {
namespace {

using motion_blur::MotionBlurSettings;

bool isTaken(const game::SettingRow<MotionBlurSettings>& row, double value) {
    MotionBlurSettings settings;
    if (const auto* whole = std::get_if<uint32_t MotionBlurSettings::*>(&row.field))
        settings.** whole = static_cast<uint32_t>(value);
    else
        settings.**std::get_if<float MotionBlurSettings::*>(&row.field) = static_cast<float>(value);
    const core::Status valid = motion_blur::validate(settings);
    if (!valid) {
        EXPECT_NE(valid.error().message.find(row.name), std::string::npos);
    }
    return valid.ok();
}

TEST(SettingTable, RangesAreTheEffects) {
    for (const auto& row : game::listBlurRows()) {
        if (!game::isNumber(row))
            continue;
        const game::NumberRange& range = row.range;
        SCOPED_TRACE(row.name);
        EXPECT_TRUE(isTaken(row, range.lowest));
        EXPECT_TRUE(isTaken(row, range.highest));
        const bool isWhole = range.step != 0.0;
        if (!isWhole) {
            EXPECT_EQ(isTaken(row, INFINITY), range.isUnlimited);
        }
        if (!isWhole || range.lowest > 0.0) {
            EXPECT_FALSE(isTaken(row, isWhole ? range.lowest - 1.0 : range.lowest - 1e-4));
        }
        if (!range.isUnlimited) {
            EXPECT_FALSE(isTaken(row, isWhole ? range.highest + 1.0 : range.highest * 1.001));
        }
        if (range.step == 2.0) {
            EXPECT_FALSE(isTaken(row, range.lowest + 1.0));
        }
    }
}

TEST(SettingTable, EverySettingThatAMethodReadsHasOneRowAndNoOtherHas) {
    std::multiset<std::string_view> rows;
    for (const auto& row : game::listBlurRows())
        rows.insert(row.name);
    std::set<std::string_view> read = {"sampleCount"};
    for (const game::MethodInfo& method : game::listMethods())
        if (method.family == game::MethodFamily::MotionBlur)
            for (const std::string_view name : motion_blur::listSettings(method.blur))
                read.insert(name);
    EXPECT_EQ(rows, (std::multiset<std::string_view>(read.begin(), read.end())));
}

TEST(SettingTable, ANumberOutsideOfItsRangeChangesNothing) {
    MotionBlurSettings settings;
    for (const auto& row : game::listBlurRows()) {
        if (!game::isNumber(row))
            continue;
        const double before = game::getNumber(row, settings);
        for (const double bad :
             {row.range.lowest - 1.0,
              2.0 * row.range.highest + 1.0,
              double(NAN),
              -double(INFINITY)})
            EXPECT_FALSE(game::setNumber(row, settings, bad)) << row.name << " " << bad;
        EXPECT_EQ(game::setNumber(row, settings, INFINITY), row.range.isUnlimited) << row.name;
        EXPECT_TRUE(game::setNumber(row, settings, before)) << row.name;
    }
    EXPECT_TRUE(game::areEqual(game::listBlurRows(), settings, MotionBlurSettings{}));
}

TEST(SettingTable, AFloatIsTheNumberThatPeopleWrote) {
    EXPECT_EQ(game::shortestOf(0.03f), 0.03);
    EXPECT_EQ(static_cast<float>(game::shortestOf(1e-6f)), 1e-6f);
}

} // namespace
} // namespace shutter
