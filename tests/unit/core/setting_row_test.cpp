// SPDX-License-Identifier: MIT
#include "engine/core/setting_row.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace shutter::core {

namespace {

enum class Colour : uint8_t { Red, Green };

struct Paint {
    bool isWet = false;
    uint32_t coats = 3;
    float thickness = 0.03f;
    double seconds = 2.0;
    Colour colour = Colour::Red;

    bool operator==(const Paint&) const = default;
};

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::string_view kColours[] = {"red", "green"};

const SettingRow<Paint> kRows[] = {
    {"isWet", &Paint::isWet, "", {}, "Whether it is wet."},
    {"coats", &Paint::coats, "", {.lowest = 1, .highest = 15, .step = 2}, "Number of coats."},
    {"thickness", &Paint::thickness, "mm", {.lowest = 1e-6, .highest = 10}, "Thickness."},
    {"seconds",
     &Paint::seconds,
     "s",
     {.lowest = 0, .highest = 1e6, .isLowestValid = false, .isUnlimited = true},
     "Time to dry."},
    {"colour", makeWordField<&Paint::colour>(kColours), "", {}, "Colour."},
};
const SettingRows<Paint> kPaint(kRows);

const SettingRow<Paint>& rowOf(std::string_view name) {
    return *findRow(kPaint, name);
}

} // namespace

TEST(SettingRow, WhatIsWrittenIsReadBackTheSame) {
    const Paint paint{true, 7, 0.1f, kInfinity, Colour::Green};
    Paint read;
    for (const SettingRow<Paint>& row : kPaint)
        ASSERT_TRUE(parseValue(row, describeValue(row, paint), read).ok()) << row.name;
    EXPECT_EQ(read, paint);
    EXPECT_TRUE(areEqual(kPaint, read, paint));
    EXPECT_FALSE(areEqual(kPaint, read, Paint{}));
    EXPECT_EQ(
        describeValues(kPaint, paint),
        "isWet=true coats=7 thickness=0.1 seconds=unlimited colour=green"
    );
}

TEST(SettingRow, TextThatIsNoValueIsRefusedAndChangesNothing) {
    const std::array<std::array<const char*, 3>, 9> cases{
        {{"isWet", "yes", "'yes' is not true or false"},
         {"coats", "2", "2 must be 1 to 15 in steps of 2"},
         {"coats", "2.5", "2.5 must be 1 to 15 in steps of 2"},
         {"coats", "17", "17 must be 1 to 15 in steps of 2"},
         {"thickness", "nan", "'nan' is not a number"},
         {"thickness", "unlimited", "'unlimited' is not a number"},
         {"thickness", "11", "11 must be 1e-06 to 10 mm"},
         {"seconds", "0", "0 must be above 0 up to 1e+06 s or unlimited"},
         {"colour", "blue", "'blue' is not red or green"}}};
    for (const auto& [name, text, message] : cases) {
        Paint paint;
        const Status parsed = parseValue(rowOf(name), text, paint);
        ASSERT_FALSE(parsed.ok()) << name << " " << text;
        EXPECT_EQ(parsed.error().message, message);
        EXPECT_EQ(paint, Paint{});
    }
}

TEST(SettingRow, ANumberOutsideItsRangeChangesNothing) {
    Paint paint;
    for (const SettingRow<Paint>& row : kPaint) {
        if (!isNumber(row))
            continue;
        for (const double bad : {row.range.lowest - 1.0, 2.0 * row.range.highest, double(NAN)})
            EXPECT_FALSE(setNumber(row, paint, bad)) << row.name << " " << bad;
        EXPECT_EQ(setNumber(row, paint, kInfinity), row.range.isUnlimited) << row.name;
    }
    paint.seconds = 2.0;
    EXPECT_EQ(paint, Paint{});
}

TEST(SettingRow, ValidationNamesTheFieldThatIsOutOfItsRange) {
    EXPECT_TRUE(validateRows(kPaint, Paint{}, "paint.").ok());
    const Status valid = validateRows(kPaint, Paint{.thickness = 11.0f}, "paint.");
    ASSERT_FALSE(valid.ok());
    EXPECT_EQ(valid.error().message, "paint.thickness is 11, it must be 1e-06 to 10 mm");
    EXPECT_FALSE(validateRows(kPaint, Paint{.thickness = NAN}, "").ok());
}

TEST(SettingRow, AFloatIsTheNumberThatPeopleWrote) {
    EXPECT_EQ(shortestOf(0.03f), 0.03);
    EXPECT_EQ(static_cast<float>(shortestOf(1e-6f)), 1e-6f);
}

TEST(SettingRow, ARowIsFoundByItsNameOnly) {
    EXPECT_EQ(findRow(kPaint, "coats"), &kRows[1]);
    EXPECT_EQ(findRow(kPaint, "coat"), nullptr);
}

} // namespace shutter::core
