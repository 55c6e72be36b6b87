// SPDX-License-Identifier: MIT
// A host that goes wrong through both interfaces of the motion blur, in small pictures.
#pragma once

#include "engine/gpu/frame.h"
#include "modules/motion_blur/c_interface/shutter_motion_blur.h"
#include "tests/gpu/embedding_host.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace shutter::test {

inline constexpr uint32_t kMisusedWidth = 40;
inline constexpr uint32_t kMisusedHeight = 24;
inline constexpr VkImageUsageFlags kAllUsage =
    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
    VK_IMAGE_USAGE_TRANSFER_DST_BIT;

inline void expectNamed(bool isRefused, const std::string& message, const std::string& part) {
    EXPECT_TRUE(isRefused) << "expected: " << part;
    EXPECT_NE(message.find(part), std::string::npos)
        << "expected: " << part << "\n got: " << message;
    EXPECT_EQ(message.find("CHECK"), std::string::npos) << message;
    EXPECT_EQ(message.find(".cpp"), std::string::npos) << message;
}

/// The same part, of the sentence that C gets.
inline void expectNamedInC(ShutterBlurResult result, const std::string& part) {
    expectNamed(result == SHUTTER_BLUR_ERROR_REFUSED, shutterBlurGetMessage(), part);
}

inline ShutterBlurUse convertUse(const graph::OutsideUse& use) {
    return {use.layout, use.stages, use.access};
}

/// A recording that goes wrong, as both interfaces say it.
struct Misuse {
    const char* part; ///< of the sentence
    std::function<void(motion_blur::HostInputs&, motion_blur::MotionBlurSettings&)> inCpp;
    std::function<void(ShutterBlurInputs&, ShutterBlurSettings&)> inC;
};

class MisuseHost : public EmbeddedTest {
  protected:
    void SetUp() override {
        EmbeddedTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        mBlur = create(describeHost());
        const ShutterBlurDevice described = describeDevice();
        ASSERT_EQ(shutterBlurCreate(&described, &mC), SHUTTER_BLUR_SUCCESS)
            << shutterBlurGetMessage();
        mHost.emplace(device(), kMisusedWidth, kMisusedHeight);
        mFrame.emplace(device());
    }

    void TearDown() override {
        shutterBlurDestroy(mC);
        mFrame.reset();
        mHost.reset();
        mBlur.reset();
        EmbeddedTest::TearDown();
    }

    static ShutterBlurDevice describeDevice() {
        ShutterBlurDevice described = shutterBlurDefaultDevice();
        described.physical = device().physical();
        described.device = device().handle();
        described.queueFamily = device().queueFamily();
        return described;
    }

    [[nodiscard]] motion_blur::HostInputs makeInputs() const {
        motion_blur::HostInputs inputs = mHost->inputs();
        for (motion_blur::HostImage* image : {&inputs.color, &inputs.motionDepth, &inputs.output})
            image->usage = kAllUsage;
        inputs.color.format = inputs.output.format = VK_FORMAT_R16G16B16A16_SFLOAT;
        inputs.motionDepth.format = VK_FORMAT_R32G32B32A32_SFLOAT;
        return inputs;
    }

    static ShutterBlurImage convertImage(const motion_blur::HostImage& image) {
        ShutterBlurImage made{};
        made.image = image.image;
        made.format = image.format;
        made.usage = image.usage;
        made.before = convertUse(image.before);
        made.after = convertUse(image.after);
        return made;
    }

    [[nodiscard]] ShutterBlurInputs makeInputsOfC() const {
        const motion_blur::HostInputs given = makeInputs();
        ShutterBlurInputs inputs = shutterBlurDefaultInputs();
        inputs.width = kMisusedWidth;
        inputs.height = kMisusedHeight;
        inputs.color = convertImage(given.color);
        inputs.motionDepth = convertImage(given.motionDepth);
        inputs.output = convertImage(given.output);
        return inputs;
    }

    void submit(const std::function<void(VkCommandBuffer)>& record) {
        mFrame->begin();
        mHost->recordClears(mFrame->commands());
        record(mFrame->commands());
        mFrame->submit();
        mFrame->wait();
    }

    void expectRefused(const Misuse& misuse) {
        submit([&](VkCommandBuffer commands) {
            if (misuse.inCpp) {
                motion_blur::HostInputs inputs = makeInputs();
                motion_blur::MotionBlurSettings settings = gather();
                misuse.inCpp(inputs, settings);
                const core::Status done = mBlur->record(commands, 0, inputs, settings);
                expectNamed(!done, done ? "" : done.error().message, misuse.part);
            }
            if (misuse.inC) {
                ShutterBlurInputs inputs = makeInputsOfC();
                ShutterBlurSettings settings = shutterBlurDefaultSettings();
                misuse.inC(inputs, settings);
                const auto done = shutterBlurRecord(mC, commands, 0, &inputs, &settings);
                expectNamedInC(done, misuse.part);
            }
        });
    }

    std::unique_ptr<motion_blur::EmbeddedMotionBlur> mBlur;
    ShutterBlur* mC = nullptr;
    std::optional<HostFrame> mHost;
    std::optional<gpu::Frame> mFrame;
};

} // namespace shutter::test
