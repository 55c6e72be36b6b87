// SPDX-License-Identifier: MIT
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/settings.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string_view>

namespace shutter::motion_blur {

namespace {

using Row = core::SettingRow<MotionBlurSettings>;

/// Sets the field without a look at the row's range.
void force(const Row& row, MotionBlurSettings& settings, double value) {
    if (const auto* whole = std::get_if<uint32_t MotionBlurSettings::*>(&row.field))
        settings.** whole = static_cast<uint32_t>(value);
    else
        settings.**std::get_if<float MotionBlurSettings::*>(&row.field) = static_cast<float>(value);
}

core::Status validateWith(const Row& row, double value) {
    MotionBlurSettings settings;
    force(row, settings, value);
    return validate(settings);
}

/// Converts to any field's type.
struct Anything {
    template <class T> operator T() const; // NOLINT: never defined, used in requires alone
};

/// Number of fields of an aggregate: as many initializers as it takes.
template <class T, class... Initializers> constexpr size_t countFields() {
    if constexpr (requires { T{Initializers{}..., Anything{}}; })
        return countFields<T, Initializers..., Anything>();
    else
        return sizeof...(Initializers);
}

} // namespace

TEST(SettingRows, BothEndsOfEveryRangeAreValid) {
    for (const Row& row : listSettingRows()) {
        if (!core::isNumber(row))
            continue;
        EXPECT_TRUE(validateWith(row, row.range.lowest).ok()) << row.name;
        EXPECT_TRUE(validateWith(row, row.range.highest).ok()) << row.name;
        EXPECT_EQ(row.range.step == 0.0 && validateWith(row, INFINITY).ok(), row.range.isUnlimited)
            << row.name;
    }
}

TEST(SettingRows, ANumberOutsideItsRangeIsRefusedByName) {
    for (const Row& row : listSettingRows()) {
        if (!core::isNumber(row))
            continue;
        const bool isWhole = std::holds_alternative<uint32_t MotionBlurSettings::*>(row.field);
        std::vector<double> bad = {row.range.highest + (isWhole ? 1.0 : 0.001 * row.range.highest)};
        if (!isWhole)
            bad.insert(bad.end(), {row.range.lowest - 1e-4, NAN, -INFINITY, -1e7});
        else if (row.range.lowest > 0.0)
            bad.push_back(row.range.lowest - 1.0);
        for (const double value : bad) {
            const core::Status valid = validateWith(row, value);
            ASSERT_FALSE(valid.ok()) << row.name << " " << value;
            EXPECT_NE(valid.error().message.find(row.name), std::string::npos)
                << valid.error().message;
        }
    }
}

TEST(SettingRows, EveryNameLabelAndMeaningIsThereOnce) {
    std::set<std::string_view> names;
    std::set<std::string_view> labels;
    for (const Row& row : listSettingRows()) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name;
        EXPECT_TRUE(labels.insert(row.label).second) << row.name;
        EXPECT_FALSE(std::string_view(row.label).empty()) << row.name;
        EXPECT_TRUE(std::string_view(row.meaning).ends_with('.')) << row.name;
    }
    EXPECT_EQ(names.size(), listSettingRows().size());
}

/// A field without a row would be validated, saved and shown by nobody.
TEST(SettingRows, EveryFieldHasARow) {
    EXPECT_EQ(countFields<MotionBlurSettings>(), listSettingRows().size() + 1) << "and `method`";
}

TEST(SettingRows, EverySettingIsReadByAMethodAndEachNameReadHasARow) {
    std::set<std::string_view> rows;
    for (const Row& row : listSettingRows())
        rows.insert(row.name);
    std::set<std::string_view> read = {"sampleCount"};
    for (const Method* method : listMethods())
        for (const std::string_view name : method->settings)
            read.insert(name);
    EXPECT_EQ(rows, read);
}

} // namespace shutter::motion_blur
