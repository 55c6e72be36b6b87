// SPDX-License-Identifier: MIT
// The history of a host's frame: the last raster of its own view, and only if the host declares it
// as the previous frame.
#include "engine/math/transform.h"
#include "tests/gpu/embedding_host.h"
#include "tests/support/picture.h"

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using motion_blur::HostCameraKey;
using motion_blur::HostInputs;
using motion_blur::MotionBlurSettings;
using test::HostFrame;
using test::kSampled;
using test::Picture;

/// Rasters of one wall in one colour each, under a camera that pans: surfaces that enter the
/// picture during the exposure are only in the last raster, so their colour shows whether it was
/// used.
struct PannedFrame : HostFrame {
    PannedFrame(gpu::Device& device, uint32_t w, uint32_t h)
        : HostFrame(device, w, h), picture(device, {w, h}) {}

    [[nodiscard]] HostInputs inputs() const {
        HostInputs in = HostFrame::inputs();
        in.entityId = ids();
        in.output = picture.output();
        return in;
    }

    /// \param id of all pixels
    void recordClears(VkCommandBuffer commands, float brightness, uint32_t id) const {
        test::clear(commands, color, {{brightness, brightness, brightness, 1.0f}});
        test::clear(commands, motionDepth, {{8.0f, 0.0f, 5.0f, 0.0f}});
        test::clear(commands, entityId, {.uint32 = {id, 0, 0, 0}});
    }

    Picture picture;
};

class EmbeddedHistory : public test::EmbeddedTest {
  protected:
    static constexpr uint32_t kFramesInFlight = 5;

    struct Frame {
        float brightness = 1.0f;
        uint32_t view = 0;
        bool followsLast = true;
        uint32_t width = 64;
        const char* method = "resolved";
        bool history = true;
        uint32_t id = 0;       ///< of all its pixels; there is one row
        int index = 1;         ///< of the frame: the pictures of each show another part of the wall
        bool isStatic = false; ///< the camera is static at the frame's end
    };

    [[nodiscard]] motion_blur::HostDevice hostOfSuite() const override {
        motion_blur::HostDevice host = describeHost();
        host.framesInFlight = kFramesInFlight;
        return host;
    }

    void TearDown() override {
        mFrames.clear();
        EmbeddedTest::TearDown();
    }

    /// A wall 5 m away, and a camera that has panned by a third of the picture in each frame.
    static std::array<HostCameraKey, 2> makeKeys(int index, bool isStatic) {
        const auto key = [&](double time) {
            const double angle = 0.4 * (index - 1.0 + (isStatic ? 1.0 : time));
            const glm::dvec3 up(0.0, 1.0, 0.0);
            return HostCameraKey{
                time,
                glm::rotate(glm::dmat4(1.0), angle, up),
                math::clipFromViewPerspective(1.0, 2.0, 0.1)};
        };
        return {key(0.0), key(1.0)};
    }

    core::Status
    record(VkCommandBuffer commands, uint32_t slot, const Frame& frame, HostInputs in) {
        const std::array<HostCameraKey, 2> keys = makeKeys(frame.index, frame.isStatic);
        in.motion.keys = keys;
        in.motion.movers = mMovers;
        in.motion.rowCount = 1;
        in.motion.view = frame.view;
        in.motion.followsLast = frame.followsLast;
        if (mLent)
            in.last = {
                {mLent->color.handle(), kSampled, kSampled},
                {mLent->motionDepth.handle(), kSampled, kSampled},
                {mLent->entityId.handle(), kSampled, kSampled}};
        MotionBlurSettings settings = test::settingsOf(frame.method);
        settings.history = frame.history;
        return mBlur->record(commands, slot, in, settings);
    }

    /// Records and submits; read() waits for it.
    void submit(const Frame& frame, uint32_t slot) {
        InFlight& made = *mFrames.emplace_back(std::make_unique<InFlight>(device(), frame.width));
        made.frame.begin();
        const VkCommandBuffer commands = made.frame.commands();
        made.host.recordClears(commands, frame.brightness, frame.id);
        const core::Status done = record(commands, slot, frame, made.host.inputs());
        ASSERT_TRUE(done.ok()) << done.error().message;
        made.host.picture.recordReadback(commands);
        made.frame.submit();
    }

    /// Brightest, darkest and mean of the frames that were submitted since the last call.
    struct Range {
        float low = std::numeric_limits<float>::infinity();
        float high = -low;
        double mean = 0.0;
    };

    std::vector<Range> read() {
        std::vector<Range> ranges;
        for (const auto& one : mFrames) {
            one->frame.wait();
            const image::Image picture = one->host.picture.read();
            Range range;
            for (size_t i = 0; i < picture.pixels.size(); i += 4) {
                range.low = std::min(range.low, picture.pixels[i]);
                range.high = std::max(range.high, picture.pixels[i]);
                range.mean += 4.0 * picture.pixels[i] / double(picture.pixels.size());
            }
            ranges.push_back(range);
        }
        mFrames.clear();
        return ranges;
    }

    Range draw(const Frame& frame) {
        submit(frame, 0);
        return read().back();
    }

    /// \return whether a frame of brightness 4 shows anything of the one before, of brightness 1
    bool looksBack(const Frame& frame) {
        const Range range = draw(frame);
        EXPECT_FLOAT_EQ(range.high, 4.0f);
        return range.low < 3.9f;
    }

    void drawFirst() { (void)draw({.brightness = 1.0f, .followsLast = false, .index = 0}); }

    struct InFlight {
        InFlight(gpu::Device& device, uint32_t width) : frame(device), host(device, width, 32) {}

        gpu::Frame frame;
        PannedFrame host;
    };

    std::vector<std::unique_ptr<InFlight>> mFrames;
    std::vector<motion_blur::HostMover> mMovers; ///< of all frames
    const PannedFrame* mLent = nullptr;          ///< the previous frame, whose images are lent
};

TEST_F(EmbeddedHistory, ThePreviousFrameIsLookedUpWhereThereIsOneAndTheHostDeclaresIt) {
    EXPECT_FALSE(looksBack({.brightness = 4.0f})) << "the first frame";
    drawFirst();
    EXPECT_TRUE(looksBack({.brightness = 4.0f}));
    drawFirst();
    EXPECT_FALSE(looksBack({.brightness = 4.0f, .followsLast = false})) << "a cut";
    drawFirst();
    EXPECT_FALSE(looksBack({.brightness = 4.0f, .history = false}));
}

TEST_F(EmbeddedHistory, HostHistoryImagesGiveTheBitsOfStoredHistory) {
    const auto drawSecond = [&](bool lends) {
        useOwn(hostOfSuite()); // which holds nothing yet
        submit({.brightness = 1.0f, .followsLast = false, .index = 0}, 0);
        mFrames.back()->frame.wait();
        mLent = lends ? &mFrames.back()->host : nullptr;
        submit({.brightness = 4.0f}, 1);
        mFrames.back()->frame.wait();
        image::Image picture = mFrames.back()->host.picture.read();
        mLent = nullptr;
        mFrames.clear();
        EXPECT_TRUE(mBlur->markDone(0).ok() && mBlur->markDone(1).ok());
        return std::pair(std::move(picture), mBlur->living());
    };
    const auto [kept, living] = drawSecond(false);
    const auto [lent, livingWithout] = drawSecond(true);
    EXPECT_TRUE(test::sameBits(lent, kept));
    EXPECT_NE(*std::min_element(kept.pixels.begin(), kept.pixels.end()), 4.0f) << "it is looked up";
    EXPECT_LT(livingWithout.images, living.images) << "what the first frame kept is gone";
}

TEST_F(EmbeddedHistory, AFrameInWhichNothingMovedNeedsNoRecording) {
    const auto drawLast = [&](int stillFrames) {
        drawFirst();
        for (int i = 0; i < stillFrames; ++i)
            (void)draw({.brightness = 1.0f, .index = 0, .isStatic = true});
        return draw({.brightness = 4.0f});
    };
    const Range without = drawLast(0);
    const Range with = drawLast(3);
    EXPECT_LT(without.low, 3.9f) << "it is looked up";
    EXPECT_EQ(without.low, with.low);
    EXPECT_EQ(without.mean, with.mean);
}

TEST_F(EmbeddedHistory, AChangedSizeHasNoHistory) {
    drawFirst();
    EXPECT_FALSE(looksBack({.brightness = 4.0f, .width = 80}));
    (void)draw({.brightness = 1.0f, .width = 80, .index = 0});
    EXPECT_TRUE(looksBack({.brightness = 4.0f, .width = 80}));
}

TEST_F(EmbeddedHistory, AnotherMethodInBetweenLeavesNoHistory) {
    drawFirst();
    (void)draw({.brightness = 1.0f, .method = "gather"});
    EXPECT_FALSE(looksBack({.brightness = 4.0f}));
    drawFirst();
    (void)draw({.brightness = 1.0f, .history = false});
    EXPECT_FALSE(looksBack({.brightness = 4.0f}));
}

TEST_F(EmbeddedHistory, ARefusedFrameLeavesNoHistoryAndADroppedFrameIsAllowed) {
    for (const bool isRefused : {true, false}) {
        drawFirst();
        InFlight one(device(), 64);
        one.frame.begin();
        one.host.recordClears(one.frame.commands(), 1.0f, 0);
        HostInputs in = one.host.inputs();
        if (isRefused)
            in.color = {};
        EXPECT_EQ(record(one.frame.commands(), 1, {}, in).ok(), !isRefused);
        EXPECT_TRUE(mBlur->markDone(1).ok()); // it is never submitted
        EXPECT_FALSE(looksBack({.brightness = 4.0f, .followsLast = isRefused}));
    }
    drawFirst();
    EXPECT_TRUE(looksBack({.brightness = 4.0f}));
}

TEST_F(EmbeddedHistory, AlternatingViewsHaveSeparateHistoriesWithFramesInFlight) {
    // Without waiting: five recordings are in flight at once, each under its own number.
    submit({.brightness = 1.0f, .view = 0, .followsLast = false, .index = 0}, 0);
    submit({.brightness = 16.0f, .view = 3, .index = 0}, 1);
    submit({.brightness = 4.0f, .view = 0}, 2);
    submit({.brightness = 64.0f, .view = 3}, 3);
    submit({.brightness = 8.0f, .view = 0, .index = 2}, 4);
    const std::vector<Range> ranges = read();
    EXPECT_FLOAT_EQ(ranges[0].low, 1.0f);
    EXPECT_FLOAT_EQ(ranges[1].low, 16.0f) << "the first frame of its view";
    EXPECT_LT(ranges[2].low, 3.9f);
    EXPECT_GE(ranges[2].low, 1.0f);
    EXPECT_FLOAT_EQ(ranges[2].high, 4.0f) << "nothing of the other view";
    EXPECT_LT(ranges[3].low, 63.0f);
    EXPECT_GE(ranges[3].low, 16.0f) << "nothing of the other view";
    EXPECT_LT(ranges[4].low, 7.9f);
    EXPECT_GE(ranges[4].low, 4.0f) << "nothing of the frame before the last";
}

TEST_F(EmbeddedHistory, IdsThatAreNoRowsAndTransformsBeyondAllRangeAreDrawn) {
    drawFirst();
    const Range unknown = draw({.brightness = 4.0f, .id = 1});
    drawFirst();
    const Range row = draw({.brightness = 4.0f, .id = 0});
    ASSERT_LT(unknown.mean, row.mean - 0.1)
        << "the row is found in this frame, an invalid one is not";
    // 0x1000000 has the low bits of row 0, and must not be taken for it.
    for (const uint32_t id : {0xFFFFFEu, 0xFFFFFFu, 0x1000000u, 0x80000000u, 0xFFFFFFFEu}) {
        drawFirst();
        const Range range = draw({.brightness = 4.0f, .id = id});
        EXPECT_EQ(range.low, unknown.low) << id;
        EXPECT_EQ(range.mean, unknown.mean) << id;
    }
    drawFirst();
    const Range sky = draw({.brightness = 4.0f, .id = 0xFFFFFFFFu});
    EXPECT_GE(sky.low, 1.0f);
    EXPECT_LE(sky.high, 4.0f);
    const glm::dmat4 huge(glm::dmat3(1.0e300));
    const glm::dmat4 tiny(glm::dmat3(1.0e-300));
    const glm::dmat4 flat(glm::dmat3(0.0));
    for (const glm::dmat4& open : {huge, tiny, flat})
        for (const glm::dmat4& close : {tiny, huge, flat}) {
            const std::array matrices{open, close};
            mMovers = {{0, matrices}};
            drawFirst();
            const Range range = draw({.brightness = 4.0f});
            EXPECT_GE(range.low, 1.0f);
            EXPECT_LE(range.high, 4.0f);
        }
}

TEST_F(EmbeddedHistory, AClosedViewLeavesNothingBehind) {
    useOwn(hostOfSuite()); // which holds nothing else
    drawFirst();
    const gpu::LivingObjects before = mBlur->living();
    (void)draw({.brightness = 1.0f, .view = 2});
    EXPECT_EQ(mBlur->living().images, before.images + 2);
    EXPECT_TRUE(mBlur->closeView(2).ok());
    drawFirst();
    drawFirst(); // once the frames before are done
    EXPECT_LE(mBlur->living().images, before.images + 2) << "view 0 has two rasters by now";
    EXPECT_FALSE(looksBack({.brightness = 4.0f, .view = 2}));
}

} // namespace
} // namespace shutter
