// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/device.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace shutter::test {

/// Base of every test that draws: one validated device for the whole process, and a test fails when
/// validation (core or synchronization) says anything during it. Skipped with the reason where
/// there is no device or no validation layer; with SHUTTER_REQUIRE_DEVICE set that is a failure.
class GpuTest : public ::testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;

    [[nodiscard]] static gpu::Device& device();

  private:
    uint32_t mMessagesBefore = 0;
};

} // namespace shutter::test
