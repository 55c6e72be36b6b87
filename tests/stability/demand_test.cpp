// SPDX-License-Identifier: MIT
// A frame costs what its scene demands. What frames are made of is held in every run; their times,
// which other programs disturb, are held where SHUTTER_MEASURE is set (README.md beside this file).
#include "tests/conformance/demand/claim.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/temp_folder.h"

#include <cstdlib>
#include <memory>
#include <ostream>
#include <set>
#include <utility>

namespace shutter {
namespace {

using demand::Claim;
using stability::Measured;

bool isMeasuring() {
    return std::getenv("SHUTTER_MEASURE") != nullptr; // NOLINT(concurrency-mt-unsafe)
}

class Claims : public test::GpuTest, public ::testing::WithParamInterface<Claim> {};

/// --gtest_output=json:FILE writes the figures.
void hold(const stability::Measurements& rows) {
    for (const Measured& row : rows) {
        EXPECT_TRUE(stability::holds(row)) << row.check << ": " << describe(row);
        ::testing::Test::RecordProperty(row.check, describe(row));
    }
}

TEST_P(Claims, Hold) {
    const test::TempFolder folder;
    demand::DemandOptions options;
    options.folder = folder.path();
    if (!isMeasuring()) {
        options.width = 160;
        options.height = 90;
        options.rounds = 1;
    }
    std::unique_ptr<gpu::Device> unvalidated;
    if (isMeasuring()) { // validation takes time of its own
        gpu::DeviceOptions same;
        same.wanted = device().info().name;
        auto made = gpu::Device::create(same);
        ASSERT_TRUE(made) << made.error().message;
        unvalidated = std::move(made).value();
    }
    const auto found = GetParam().measure(unvalidated ? *unvalidated : device(), options);
    ASSERT_TRUE(found) << found.error().message;
    hold(found.value().counts);
    if (isMeasuring())
        hold(found.value().times);
    for (const Measured& row : found.value().times)
        EXPECT_GT(row.samples, 0u) << row.check << " was not measured";
}

INSTANTIATE_TEST_SUITE_P(
    Demand,
    Claims,
    ::testing::ValuesIn(demand::listClaims()),
    [](const ::testing::TestParamInfo<Claim>& instance) { return instance.param.name; }
);

TEST(ClaimList, NamesAreUniqueAndEveryClaimSaysWhatItCompares) {
    std::set<std::string> names;
    for (const Claim& claim : demand::listClaims()) {
        EXPECT_TRUE(names.insert(claim.name).second) << claim.name;
        EXPECT_FALSE(claim.title.empty()) << claim.name;
        EXPECT_TRUE(claim.description.ends_with('.')) << claim.name;
    }
    EXPECT_EQ(names.size(), 5u);
}

} // namespace

namespace demand {

/// How googletest prints a parameter.
void PrintTo(const Claim& claim, std::ostream* stream) {
    *stream << claim.title;
}

} // namespace demand
} // namespace shutter
