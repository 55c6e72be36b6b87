// SPDX-License-Identifier: MIT
// Every hard case keeps within its bounds, under validation. What each draws and measures is in
// tests/conformance/stability; README.md beside this file says what is required.
#include "tests/conformance/stability/measured.h"
#include "tests/support/gpu_fixture.h"

#include <limits>
#include <ostream>
#include <set>

namespace shutter {
namespace {

using stability::HardCase;
using stability::Measured;

class HardCases : public test::GpuTest, public ::testing::WithParamInterface<HardCase> {};

TEST_P(HardCases, Hold) {
    const auto found = GetParam().measure(device());
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_FALSE(found.value().empty());
    for (const Measured& row : found.value()) {
        EXPECT_GT(row.samples, 0u) << row.check << ": nothing was looked at";
        EXPECT_EQ(row.notFinite, 0u) << row.check << ": NaN or infinity";
        EXPECT_LE(row.worst, row.bound) << row.check << ", " << row.unit << " (" << row.note << ")";
        RecordProperty(row.check, describe(row));
    }
}

INSTANTIATE_TEST_SUITE_P(
    Stability,
    HardCases,
    ::testing::ValuesIn(stability::listHardCases()),
    [](const ::testing::TestParamInfo<HardCase>& instance) { return instance.param.name; }
);

TEST(HardCaseList, NamesAreUniqueAndEveryCaseSaysWhatItIs) {
    std::set<std::string> names;
    for (const HardCase& hard : stability::listHardCases()) {
        EXPECT_TRUE(names.insert(hard.name).second) << hard.name;
        EXPECT_FALSE(hard.title.empty()) << hard.name;
        EXPECT_TRUE(hard.description.ends_with('.')) << hard.name;
    }
    EXPECT_GE(names.size(), 40u);
}

TEST(Measured, HoldsOnlyWhatWasLookedAtIsFiniteAndWithinItsBound) {
    const Measured good{"check", 0.5, 1.0, "px", 3};
    EXPECT_TRUE(stability::holds(good));
    Measured row = good;
    row.worst = 1.5;
    EXPECT_FALSE(stability::holds(row));
    row.worst = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(stability::holds(row));
    row = good;
    row.samples = 0;
    EXPECT_FALSE(stability::holds(row));
    row = good;
    row.notFinite = 1;
    EXPECT_FALSE(stability::holds(row));
}

} // namespace

namespace stability {

/// How googletest prints a parameter.
void PrintTo(const HardCase& hard, std::ostream* stream) {
    *stream << hard.title;
}

} // namespace stability
} // namespace shutter
