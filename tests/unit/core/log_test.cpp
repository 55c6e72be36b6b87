// SPDX-License-Identifier: MIT
#include "engine/core/log.h"

#include <gtest/gtest.h>

namespace shutter::core {
namespace {

class Log : public testing::Test {
  protected:
    void TearDown() override { setLogLevel(LogLevel::Warning); }
};

TEST_F(Log, WarningsArePrintedByDefaultAndInfoIsNot) {
    testing::internal::CaptureStderr();
    logInfo("device {}", 1);
    logWarning("mip {} is missing", 2);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "shutter: warning: mip 2 is missing\n");
}

TEST_F(Log, InfoIsPrintedWhenAskedFor) {
    setLogLevel(LogLevel::Info);
    testing::internal::CaptureStderr();
    logInfo("device {}", 1);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "shutter: device 1\n");
}

TEST_F(Log, TextWithBracesIsPrintedAsItIs) {
    testing::internal::CaptureStderr();
    writeLog(LogLevel::Warning, "{\"json\": {}}");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "shutter: warning: {\"json\": {}}\n");
}

} // namespace
} // namespace shutter::core
