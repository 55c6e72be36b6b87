// SPDX-License-Identifier: MIT
#include "engine/core/result.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace shutter::core {
namespace {

TEST(Result, HoldsTheValueItWasMadeOf) {
    const Result<std::string> result = std::string("value");
    EXPECT_TRUE(result.ok());
    EXPECT_TRUE(static_cast<bool>(result));
    EXPECT_EQ(result.value(), "value");
}

TEST(Result, HoldsTheErrorItWasMadeOf) {
    const Result<int> result = makeError("{}: field '{}' is missing", "a.gltf", "asset");
    EXPECT_FALSE(result.ok());
    EXPECT_FALSE(static_cast<bool>(result));
    EXPECT_EQ(result.error().message, "a.gltf: field 'asset' is missing");
}

TEST(Result, AValueThatIsFalseIsStillAValue) {
    const Result<bool> result = false;
    EXPECT_TRUE(result.ok());
    EXPECT_FALSE(result.value());
}

TEST(Result, AMoveOnlyValueCanBeTakenOut) {
    Result<std::unique_ptr<int>> result = std::make_unique<int>(5);
    const std::unique_ptr<int> taken = std::move(result).value();
    EXPECT_EQ(*taken, 5);
}

TEST(Result, TheValueCanBeChangedInPlace) {
    Result<int> result = 1;
    result.value() += 1;
    EXPECT_EQ(result.value(), 2);
}

TEST(Status, IsASuccessUnlessMadeOfAnError) {
    EXPECT_TRUE(Status().ok());
    const Status failed = makeError("--size: '{}' is no size", "axb");
    EXPECT_FALSE(failed.ok());
    EXPECT_FALSE(static_cast<bool>(failed));
    EXPECT_EQ(failed.error().message, "--size: 'axb' is no size");
}

TEST(ResultDeathTest, AskingForWhatIsNotThereIsAProgrammersMistake) {
    Result<int> failed = makeError("no such file");
    EXPECT_DEATH((void)failed.value(), "value\\(\\) of an error: no such file");
    EXPECT_DEATH((void)std::as_const(failed).value(), "no such file");
    EXPECT_DEATH((void)std::move(failed).value(), "no such file");
    EXPECT_DEATH((void)Result<int>(3).error(), "error\\(\\) of a result");
    EXPECT_DEATH((void)Status().error(), "error\\(\\) of a success");
}

} // namespace
} // namespace shutter::core
