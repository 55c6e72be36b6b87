// SPDX-License-Identifier: MIT
// Effects that are switched every frame leave nothing behind; a message of the validation layers
// fails the test as everywhere.
#include "tests/conformance/demand/toggle_law.h"
#include "tests/support/gpu_fixture.h"

namespace shutter {
namespace {

class ToggleLaw : public test::GpuTest {};

TEST_F(ToggleLaw, TwoThousandFramesLeaveNothingBehind) {
    const auto found = demand::measureToggles(device());
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found.value().size(), 8u);
    for (const stability::Measured& row : found.value()) {
        EXPECT_TRUE(stability::holds(row)) << row.check << ": " << describe(row);
        RecordProperty(row.check, describe(row));
    }
}

} // namespace
} // namespace shutter
