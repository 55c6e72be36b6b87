// SPDX-License-Identifier: MIT
#include "engine/image/hdr_flip.h"
#include "engine/image/metrics.h"
#include "game/bench/frame_judge.h"
#include "game/bench/sequence/temporal_error.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace shutter::bench {
namespace {

using image::Image;
using Metrics = std::map<std::string, double>;

/// Grey of 1/2 and noise, on the steps of 8 bits.
Image makePicture(uint32_t seed) {
    Image picture(24, 16, 3);
    std::mt19937 random(seed);
    for (float& value : picture.pixels)
        value = float(112 + random() % 32) / 255.0f;
    return picture;
}

FramePicture makeFrame(const char* key, uint32_t seed, Judgement judgement = Judgement::Whole) {
    FramePicture picture;
    picture.key = key;
    picture.shown = makePicture(seed);
    picture.judgement = judgement;
    return picture;
}

std::set<std::string> listIds(const FramePicture& picture) {
    std::set<std::string> ids;
    for (const auto& [id, value] : picture.record.picture.metrics)
        ids.insert(id);
    return ids;
}

std::vector<FramePicture> judge(FrameJudge& judge, std::vector<FramePicture> pictures) {
    const core::Status judged = judge.judge(pictures);
    EXPECT_TRUE(judged) << judged.error().message;
    return pictures;
}

TEST(FrameJudge, TheFirstFrameHasNothingBeforeIt) {
    FrameJudge frames;
    const auto first = judge(
        frames,
        {makeFrame("truth", 1),
         makeFrame("gather/15", 2),
         makeFrame("gather/4", 3, Judgement::Squares),
         makeFrame("sharp/0", 4, Judgement::InTime)}
    );
    EXPECT_EQ(listIds(first[0]), std::set<std::string>()) << "nothing to compare the truth with";
    EXPECT_EQ(listIds(first[1]), (std::set<std::string>{"psnr", "ssim", "flip"}));
    EXPECT_EQ(listIds(first[2]), std::set<std::string>{"psnr"});
    EXPECT_EQ(listIds(first[3]), std::set<std::string>());
    const Metrics& metrics = first[1].record.picture.metrics;
    EXPECT_EQ(metrics.at("psnr"), image::computePsnr(makePicture(2), makePicture(1)));
    EXPECT_EQ(metrics.at("ssim"), image::computeSsim(makePicture(2), makePicture(1)));
    EXPECT_EQ(metrics.at("flip"), image::computeFlip(makePicture(2), makePicture(1)).mean);
}

TEST(FrameJudge, EachPictureIsComparedWithItsOwnOneBefore) {
    FrameJudge frames;
    judge(
        frames,
        {makeFrame("truth", 1),
         makeFrame("gather/15", 2),
         makeFrame("sharp/0", 3, Judgement::InTime),
         makeFrame("gather/4", 4, Judgement::Squares)}
    );
    // In another order, and with one that was not there.
    const auto second = judge(
        frames,
        {makeFrame("truth", 5),
         makeFrame("sharp/0", 6, Judgement::InTime),
         makeFrame("gather/15", 7),
         makeFrame("gather/4", 8, Judgement::Squares),
         makeFrame("hybrid/15", 9)}
    );
    EXPECT_EQ(listIds(second[1]), std::set<std::string>{"flicker"});
    EXPECT_EQ(
        listIds(second[2]), (std::set<std::string>{"psnr", "ssim", "flip", "flicker", "fixedPower"})
    );
    EXPECT_EQ(listIds(second[3]), std::set<std::string>{"psnr"});
    EXPECT_EQ(listIds(second[4]), (std::set<std::string>{"psnr", "ssim", "flip"}));
    const auto flickerOf = [](uint32_t before, uint32_t now) {
        const Image pictures[] = {
            makePicture(before), makePicture(1), makePicture(now), makePicture(5)};
        return computeFlicker({pictures[0], pictures[1]}, {pictures[2], pictures[3]});
    };
    EXPECT_EQ(second[1].record.picture.metrics.at("flicker"), flickerOf(3, 6));
    EXPECT_EQ(second[2].record.picture.metrics.at("flicker"), flickerOf(2, 7));
    EXPECT_EQ(
        second[2].record.picture.metrics.at("fixedPower"),
        computeFixedPower(
            computeFineError(makePicture(2), makePicture(1)),
            computeFineError(makePicture(7), makePicture(5))
        )
    );
}

TEST(FrameJudge, GoesOnFromPicturesAsFromAFrameThatItJudged) {
    FrameJudge whole;
    judge(whole, {makeFrame("truth", 1), makeFrame("gather/15", 2)});
    FrameJudge resumed;
    resumed.goOnFrom("truth", {{"truth", makePicture(1)}, {"gather/15", makePicture(2)}});
    const auto a = judge(whole, {makeFrame("truth", 3), makeFrame("gather/15", 4)});
    const auto b = judge(resumed, {makeFrame("truth", 3), makeFrame("gather/15", 4)});
    EXPECT_TRUE(a[1].record.picture.metrics.contains("fixedPower"));
    EXPECT_EQ(a[1].record.picture.metrics, b[1].record.picture.metrics);
}

TEST(FrameJudge, HdrFlipIsOfLinearPicturesWhereBothAreThere) {
    std::vector<FramePicture> pictures = {makeFrame("truth", 1), makeFrame("gather/15", 2)};
    pictures[1].linear = makePicture(4);
    FrameJudge frames;
    EXPECT_FALSE(listIds(judge(frames, pictures)[1]).contains("hdrFlip"));
    pictures[0].linear = makePicture(3);
    const auto judged = judge(frames, pictures);
    EXPECT_EQ(
        judged[1].record.picture.metrics.at("hdrFlip"),
        image::computeHdrFlip(makePicture(4), makePicture(3)).mean
    );
    EXPECT_FALSE(listIds(judged[0]).contains("hdrFlip"));
}

TEST(FrameJudge, WritesItsPicturesOrSaysWhyNot) {
    const test::TempFolder folder;
    std::vector<FramePicture> pictures = {makeFrame("truth", 1), makeFrame("gather/15", 2)};
    pictures[0].file = folder.path() / "truth.png";
    FrameJudge frames;
    judge(frames, pictures);
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "truth.png"));
    pictures[1].file = folder.path() / "none" / "gather.png";
    const core::Status judged = frames.judge(pictures);
    ASSERT_FALSE(judged);
    EXPECT_NE(judged.error().message.find("gather.png"), std::string::npos);
}

} // namespace
} // namespace shutter::bench
