// SPDX-License-Identifier: MIT
// What a host is asked for before the driver meets its images, and told when it calls at the wrong
// time: from two threads, within a callback, too early.
#include "engine/math/transform.h"
#include "tests/gpu/misuse_host.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace shutter {
namespace {

using motion_blur::HostDevice;
using motion_blur::HostInputs;
using motion_blur::MotionBlurSettings;
using test::kMisusedHeight;
using test::kMisusedWidth;
using test::kSampled;

/// What an object is told through the message while it is created, records and goes.
class Told {
  public:
    void add(std::string_view sentence) {
        sentences.emplace_back(sentence);
        if (onSentence)
            onSentence();
    }

    std::vector<std::string> sentences;
    std::function<void()> onSentence;
};

class EmbeddedCare : public test::MisuseHost {
  protected:
    /// An object whose message goes to mTold.
    void createTold(bool checksInputs) {
        HostDevice host = describeHost();
        host.checksInputs = checksInputs;
        host.message = [this](std::string_view sentence) { mTold.add(sentence); };
        mBlur = create(host);
    }

    Told mTold; ///< outlives the object, which tells more when it goes
};

TEST_F(EmbeddedCare, WhatIsUnsaidOfImagesIsAskedForOnceBeforeTheyAreUsed) {
    createTold(true);
    HostInputs inputs = makeInputs();
    inputs.color.usage = inputs.output.usage = 0;
    const auto isOfImages = [](const std::string& one) {
        return one.find("not said") != std::string::npos;
    };
    const auto record = [&] {
        size_t before = 0; // its commands are submitted
        submit([&](VkCommandBuffer commands) {
            EXPECT_TRUE(mBlur->record(commands, 0, inputs, test::gather()).ok());
            before =
                size_t(std::count_if(mTold.sentences.begin(), mTold.sentences.end(), isOfImages));
        });
        return before;
    };
    EXPECT_EQ(record(), 1u);
    ASSERT_FALSE(mTold.sentences.empty());
    EXPECT_NE(
        mTold.sentences.front().find(
            "motion blur check: the usage of color, output, and the samples "
            "of color, output, motionDepth are not said"
        ),
        std::string::npos
    ) << mTold.sentences.front();
    EXPECT_EQ(record(), 1u) << "once";
    inputs = makeInputs();
    for (motion_blur::HostImage* image : {&inputs.color, &inputs.motionDepth, &inputs.output})
        image->samples = VK_SAMPLE_COUNT_1_BIT;
    mTold.sentences.clear();
    createTold(true);
    EXPECT_EQ(record(), 0u) << "all is said";
}

TEST_F(EmbeddedCare, ALargeImageWithoutAnExtentIsAskedAbout) {
    constexpr uint32_t kSide = 160;
    createTold(true);
    const test::HostFrame large(device(), 3 * kSide, 2 * kSide);
    HostInputs inputs = large.inputs();
    inputs.width = inputs.height = kSide;
    const test::HostFrame right(device(), kSide, kSide);
    inputs.motionDepth = right.inputs().motionDepth;
    const auto countAsked = [&] {
        mFrame->begin();
        large.recordClears(mFrame->commands());
        right.recordClears(mFrame->commands());
        const core::Status done = mBlur->record(mFrame->commands(), 0, inputs, test::gather());
        EXPECT_TRUE(done.ok()) << done.error().message;
        mFrame->submit();
        mFrame->wait();
        return std::count_if(mTold.sentences.begin(), mTold.sentences.end(), [](const auto& one) {
            return one.find("the extent of color, output is not said") != std::string::npos;
        });
    };
    EXPECT_EQ(countAsked(), 1);
    EXPECT_EQ(countAsked(), 1) << "once";
    mTold.sentences.clear();
    createTold(true);
    inputs.color.extent = inputs.output.extent = {3 * kSide, 2 * kSide};
    inputs.color.area.extent = inputs.output.area.extent = {kSide, kSide};
    EXPECT_EQ(countAsked(), 0);
}

TEST_F(EmbeddedCare, CallsOfASecondThreadOrWithinACallbackAreRefused) {
    std::string within;
    std::string beside;
    const auto call = [&](std::string& message) {
        const core::Status done = mBlur->markDone(0);
        message = done ? "" : done.error().message;
    };
    createTold(true);
    mTold.onSentence = [&] {
        call(within);
        std::thread([&] { call(beside); }).join();
    };
    HostInputs inputs = makeInputs();
    submit([&](VkCommandBuffer commands) {
        const core::Status done = mBlur->record(commands, 0, inputs, test::gather());
        EXPECT_TRUE(done.ok()) << done.error().message;
    });
    EXPECT_NE(within.find("called within a callback of its own"), std::string::npos) << within;
    EXPECT_NE(beside.find("another thread is in a call"), std::string::npos) << beside;
    EXPECT_TRUE(mBlur->markDone(0).ok()) << "alone again";
}

/// What a host in C does within a callback.
struct WithinC {
    ShutterBlur* blur = nullptr;
    std::string message;

    static void onSentence(void* self, const char*) {
        auto& own = *static_cast<WithinC*>(self);
        std::thread([&] {
            const auto result = shutterBlurMarkDone(own.blur, 0);
            own.message = result == SHUTTER_BLUR_SUCCESS ? "" : shutterBlurGetMessage();
        }).join();
    }
};

TEST_F(EmbeddedCare, AHostInCIsAskedForItsOwnFields) {
    std::string all;
    ShutterBlurDevice described = describeDevice();
    described.checksInputs = VK_TRUE;
    described.messageUser = &all;
    described.message = [](void* user, const char* sentence) {
        *static_cast<std::string*>(user) += sentence;
    };
    ShutterBlur* blur = nullptr;
    ASSERT_EQ(shutterBlurCreate(&described, &blur), SHUTTER_BLUR_SUCCESS);
    const gpu::Image depth =
        test::makeImage(device(), "depth", VK_FORMAT_R32_SFLOAT, kMisusedWidth, kMisusedHeight);
    ShutterBlurInputs inputs = makeInputsOfC();
    inputs.vectors = inputs.depth = inputs.motionDepth;
    inputs.depth.image = depth.handle();
    inputs.depth.format = VK_FORMAT_R32_SFLOAT;
    inputs.depth.before = inputs.depth.after = test::convertUse(kSampled);
    inputs.vectors.usage = inputs.depth.usage = 0;
    inputs.motionDepth = {};
    inputs.depthIsLinear = VK_TRUE;
    submit([&](VkCommandBuffer commands) {
        test::moveOn(commands, depth.handle(), test::kNothing, kSampled);
        EXPECT_EQ(shutterBlurRecord(blur, commands, 0, &inputs, nullptr), SHUTTER_BLUR_SUCCESS)
            << shutterBlurGetMessage();
    });
    shutterBlurDestroy(blur);
    EXPECT_NE(all.find("the usage of vectors, depth, and the samples of"), std::string::npos)
        << all;
    EXPECT_NE(all.find("without cameras, vectors and depth are not compared"), std::string::npos)
        << all;
}

TEST_F(EmbeddedCare, ASecondThreadOfAHostInCIsRefused) {
    WithinC within;
    ShutterBlurDevice described = describeDevice();
    described.checksInputs = VK_TRUE;
    described.message = &WithinC::onSentence;
    described.messageUser = &within;
    ASSERT_EQ(shutterBlurCreate(&described, &within.blur), SHUTTER_BLUR_SUCCESS);
    const ShutterBlurInputs inputs = makeInputsOfC();
    submit([&](VkCommandBuffer commands) {
        EXPECT_EQ(
            shutterBlurRecord(within.blur, commands, 0, &inputs, nullptr), SHUTTER_BLUR_SUCCESS
        ) << shutterBlurGetMessage();
    });
    shutterBlurDestroy(within.blur);
    EXPECT_NE(within.message.find("another thread is in a call"), std::string::npos)
        << within.message;
}

TEST_F(EmbeddedCare, TwoThreadsThatRecordAtOnceGetPicturesOrSentences) {
    constexpr int kRounds = 60;
    const gpu::Image ids =
        test::makeImage(device(), "ids", VK_FORMAT_R32_UINT, kMisusedWidth, kMisusedHeight);
    const motion_blur::HostCameraKey key{
        1.0, glm::dmat4(1.0), math::clipFromViewPerspective(1.0, 1.5, 0.1)};
    MotionBlurSettings settings = test::gather();
    settings.method = &motion_blur::getMethod("resolved");
    std::array<std::deque<gpu::Frame>, 2> frames; // nobody submits them
    for (int round = 0; round < kRounds; ++round)
        for (auto& own : frames)
            own.emplace_back(device()).begin();
    std::atomic<int> recorded = 0;
    const auto work = [&](uint32_t number) {
        HostInputs inputs = makeInputs();
        inputs.entityId = {ids.handle(), kSampled, kSampled};
        inputs.motion.keys = {&key, 1};
        inputs.motion.rowCount = 1;
        inputs.motion.view = number;
        for (gpu::Frame& frame : frames[number]) {
            const core::Status done = mBlur->record(frame.commands(), number, inputs, settings);
            recorded += done.ok();
            const std::string message = done ? "another thread" : done.error().message;
            EXPECT_NE(message.find("another thread"), std::string::npos) << message;
            while (!mBlur->markDone(number))
                std::this_thread::yield();
        }
    };
    std::thread other(work, 1);
    work(0);
    other.join();
    EXPECT_GT(recorded, 0);
}

TEST_F(EmbeddedCare, AnObjectThatGoesTooEarlySaysSoByItsMessage) {
    createTold(false);
    mFrame->begin();
    mHost->recordClears(mFrame->commands());
    ASSERT_TRUE(mBlur->record(mFrame->commands(), 0, makeInputs(), test::gather()).ok());
    mFrame.emplace(device()); // nobody submits it
    mBlur.reset();
    ASSERT_EQ(mTold.sentences.size(), 1u);
    EXPECT_NE(
        mTold.sentences.front().find("destroyed while the GPU has frame 0"), std::string::npos
    );
}

} // namespace
} // namespace shutter
