// SPDX-License-Identifier: MIT
// Frame rates, rows of settings, and words.
#include "engine/core/frame_rate.h"
#include "engine/core/setting_row.h"
#include "engine/core/words.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace shutter::core {
namespace {

TEST(Words, ACountOfOneIsSingularAndOthersPlural) {
    EXPECT_EQ(countOf(0, "frame"), "0 frames");
    EXPECT_EQ(countOf(1, "frame"), "1 frame");
    EXPECT_EQ(countOf(2, "frame"), "2 frames");
    EXPECT_EQ(countOf(1, "vertex", "vertices"), "1 vertex");
    EXPECT_EQ(countOf(3, "vertex", "vertices"), "3 vertices");
    EXPECT_EQ(thereAre(0, "light"), "there are 0 lights");
    EXPECT_EQ(thereAre(1, "light"), "there is 1 light");
    EXPECT_EQ(thereAre(2, "mesh", "meshes"), "there are 2 meshes");
}

TEST(Words, AMisspeltNameIsNearestToTheOneThatFewestErrorsLeadTo) {
    const std::vector<std::string> names = {"method", "out", "samples", "sky", "set", "seed"};
    EXPECT_EQ(findNearest("methd", names), "method");
    EXPECT_EQ(findNearest("otu", names), "out") << "two letters exchanged are one error";
    EXPECT_EQ(findNearest("sampels", names), "samples");
    EXPECT_EQ(findNearest("smpls", names), "") << "more than a third is wrong";
    EXPECT_EQ(findNearest("skye", names), "sky");
    EXPECT_EQ(findNearest("sed", names), "set") << "the first of equally near ones";
    for (const char* far : {"", "x", "resolution"})
        EXPECT_EQ(findNearest(far, names), "") << far;
    EXPECT_EQ(findNearest(std::string(100, 'm'), names), "");
}

FrameRate parse(const std::string& text) {
    const auto rate = parseFrameRate(text);
    EXPECT_TRUE(rate) << text;
    return rate ? rate.value() : FrameRate(1.0);
}

RationalRate rationalOf(const std::string& text) {
    const auto found = findRational(parse(text));
    EXPECT_TRUE(found) << text;
    return found.value_or(RationalRate{});
}

TEST(FrameRate, AFractionIsKeptAndItsTimesAreRoundedOnce) {
    EXPECT_EQ(parse("24000/1001"), FrameRate(24000.0, 1001.0));
    EXPECT_EQ(parse("24000/1001").perSecond(), 24000.0 / 1001.0);
    EXPECT_EQ(parse("29.97"), FrameRate(29.97));
    EXPECT_EQ(parse("25"), FrameRate(25.0));
    EXPECT_EQ(parse("24/1"), FrameRate(24.0));
    for (const char* text :
         {"24000/1001", "23.976", "29.97", "25", "1e-05", "2147483647/2147483647"})
        EXPECT_EQ(parse(describe(parse(text))), parse(text)) << text;
    EXPECT_EQ(describe(parse("30000/1001")), "30000/1001");
    EXPECT_EQ(describe(parse("29.97")), "29.97");
    const FrameRate rate = parse("24000/1001");
    EXPECT_EQ(rate.secondsOf(24000.0), 1001.0);
    EXPECT_EQ(rate.secondsOf(240000000.0), 10010000.0);
    // Of a number it has the bits that a division gives.
    for (int frame = 0; frame < 1000; ++frame)
        ASSERT_EQ(FrameRate(29.97).secondsOf(frame), frame / 29.97) << frame;
}

TEST(FrameRate, InvalidRatesAreRefusedInASentence) {
    for (const char* text :
         {"",
          "0",
          "-24",
          "nan",
          "inf",
          "x",
          "0/1",
          "1/0",
          "-24000/1001",
          "24000/-1",
          "24000 / 1001",
          "24000/",
          "/1001",
          "24000/1001/1",
          "24.0/1.001",
          "24000/1001 ",
          "99999999999/1",
          "2147483648/1",
          "1/2147483648",
          "1e3/1"}) {
        const auto rate = parseFrameRate(text);
        ASSERT_FALSE(rate) << text;
        EXPECT_NE(rate.error().message.find("24000/1001"), std::string::npos) << text;
    }
}

TEST(FrameRate, ARateIsStoredAsTheSimplestEqualFraction) {
    EXPECT_EQ(rationalOf("24000/1001"), (RationalRate{24000, 1001}));
    EXPECT_EQ(rationalOf("24"), (RationalRate{24, 1}));
    EXPECT_EQ(rationalOf("23.976"), (RationalRate{2997, 125}));
    EXPECT_EQ(rationalOf("29.97"), (RationalRate{2997, 100}));
    EXPECT_EQ(rationalOf("12.5"), (RationalRate{25, 2}));
    EXPECT_EQ(rationalOf("0.1"), (RationalRate{1, 10}));
    EXPECT_EQ(*findRational(24000.0 / 1001.0), (RationalRate{24000, 1001}));
    // A number that is no such fraction gets the nearest one.
    const RationalRate near = *findRational(3.141592653589793);
    EXPECT_NEAR(double(near.numerator) / near.denominator, 3.141592653589793, 1e-15);
    EXPECT_FALSE(findRational(1e-300));
    EXPECT_FALSE(findRational(1e12));
    EXPECT_EQ(*findRational(2147483647.0), (RationalRate{2147483647, 1}));
}

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

TEST(SettingRow, WrittenValuesAreReadBackUnchanged) {
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
    EXPECT_EQ(shortestOf(0.03f), 0.03) << "a float is the number that people wrote";
    EXPECT_EQ(static_cast<float>(shortestOf(1e-6f)), 1e-6f);
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

TEST(SettingRow, ANumberOutsideItsRangeIsRefusedAndItsFieldNamed) {
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
    EXPECT_TRUE(validateRows(kPaint, Paint{}, "paint.").ok());
    const Status valid = validateRows(kPaint, Paint{.thickness = 11.0f}, "paint.");
    ASSERT_FALSE(valid.ok());
    EXPECT_EQ(valid.error().message, "paint.thickness is 11, it must be 1e-06 to 10 mm");
    EXPECT_FALSE(validateRows(kPaint, Paint{.thickness = NAN}, "").ok());
}

} // namespace
} // namespace shutter::core
