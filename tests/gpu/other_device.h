// SPDX-License-Identifier: MIT
#pragma once

#include "tests/support/gpu_fixture.h"

#include <memory>
#include <string>
#include <utility>

namespace shutter::test {

/// Tests with a second device, of which validation reports nothing either.
class OtherDeviceTest : public GpuTest {
  protected:
    void TearDown() override {
        if (mOther) {
            mOther->waitIdle();
            EXPECT_EQ(mOther->validationMessageCount(), 0u);
        }
        mOther.reset();
        GpuTest::TearDown();
    }

    /// \param hidden what the device is said to lack, as in tests/fault_layer/README.md
    void open(gpu::DeviceOptions options, const std::string& hidden = "") {
        options.validate = true;
        options.wanted = device().info().name;
        auto opened = hidden.empty() ? gpu::Device::create(options)
                                     : openFaulty(options, "SHUTTER_FAULT_HIDE", hidden);
        ASSERT_TRUE(opened.ok()) << opened.error().message;
        mOther = std::move(opened).value();
    }

    std::unique_ptr<gpu::Device> mOther;
};

} // namespace shutter::test
