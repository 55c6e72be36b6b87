// SPDX-License-Identifier: MIT
#pragma once

#include "engine/gpu/device.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string>

namespace shutter::test {

/// A separate device with a simulated fault. \param variable of tests/fault_layer/README.md
[[nodiscard]] core::Result<std::unique_ptr<gpu::Device>>
openFaulty(const gpu::DeviceOptions& options, const char* variable, const std::string& value);

/// Base of every test that draws: one validated device for the whole process, and a test fails when
/// validation (core or synchronization) reports anything during it. Skipped with the reason where
/// there is no device or no validation layer; with SHUTTER_REQUIRE_DEVICE set that is a failure.
class GpuTest : public ::testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;

    [[nodiscard]] static gpu::Device& device();

  private:
    uint32_t mMessagesBefore = 0;
};

/// Skipped, with the reason, on a device that traces no rays in shaders.
class RayTest : public GpuTest {
  protected:
    void SetUp() override;
};

} // namespace shutter::test
