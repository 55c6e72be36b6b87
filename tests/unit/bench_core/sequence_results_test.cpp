// SPDX-License-Identifier: MIT
#include "game/bench/measure.h"
#include "game/bench/sequence_results.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace shutter::bench {
namespace {

using nlohmann::json;

constexpr uint32_t kFrames = 8;

Record makeRecord(double milliseconds, std::map<std::string, double> metrics) {
    Record record;
    record.samples = {
        {{{"gather and composite", milliseconds, render::PassOwner::Effect}}, 2.0 * milliseconds}};
    record.hasPicture = true;
    record.picture.metrics = std::move(metrics);
    return record;
}

class SequenceResults : public testing::Test {
  protected:
    SequenceResults() {
        mResult.plan = planSequence(
            {game::findMethod("sharp").value(), game::findMethod("gather").value()}, kFrames, 64
        );
        for (uint32_t frame = 0; frame < kFrames; ++frame) {
            add("sharp/0", frame, 2.0, 20.0);
            add("gather/15", frame, 10.0, 38.0);
            Record truth = makeRecord(100.0, {});
            truth.picture.counters["instants"] = frame;
            mResult.records[makeFrameKey(SequenceCamera::Own, std::string(kTruthKey), frame)] =
                truth;
        }
        for (const SamplePoint& point : mResult.plan.sweep)
            for (const uint32_t frame : mResult.plan.sweepFrames)
                add(makeKey(point), frame, point.samples, 30.0);
    }

    Record& at(SequenceCamera camera, const std::string& key, uint32_t frame) {
        return mResult.records[makeFrameKey(camera, key, frame)];
    }

    void add(const std::string& key, uint32_t frame, double milliseconds, double psnr) {
        at(SequenceCamera::Own, key, frame) = makeRecord(milliseconds, {{"psnr", psnr}});
    }

    void setSwept(const std::string& key, double milliseconds, double psnr) {
        for (const uint32_t frame : mResult.plan.sweepFrames)
            add(key, frame, milliseconds, psnr);
    }

    [[nodiscard]] json describe() const { return describeSequence(mFilm, mResult, {}); }

    /// The row of gather for 35 dB (0) or 40 dB (1).
    [[nodiscard]] json rowOfGather(size_t error) const {
        return describe().at("equalError").at(error).at("rows").at(1);
    }

    SequenceResult mResult;

  private:
    SequenceCase mFilm;
};

TEST_F(SequenceResults, TheFastestSampleCountWithinTheErrorIsNamed) {
    EXPECT_EQ(
        rowOfGather(0),
        json({{"method", "gather"}, {"samples", 15}, {"milliseconds", 10.0}, {"psnr", 38.0}})
    );
    setSwept("gather/8", 9.0, 35.0); // the limit is within
    EXPECT_EQ(rowOfGather(0).at("samples"), 8);
    setSwept("gather/64", 8.0, 36.0); // fewer samples need not be faster
    EXPECT_EQ(rowOfGather(0).at("samples"), 64);
    setSwept("gather/4", 7.0, 34.9);
    EXPECT_EQ(rowOfGather(0).at("samples"), 64);
}

TEST_F(SequenceResults, AMethodThatMissesTheErrorIsNamedWithItsBest) {
    setSwept("gather/64", 99.0, 39.5);
    const json best = {
        {"method", "gather"}, {"samples", nullptr}, {"milliseconds", nullptr}, {"psnr", 39.5}};
    EXPECT_EQ(rowOfGather(1), best);
    const json sharp = describe().at("equalError").at(0).at("rows").at(0);
    EXPECT_EQ(sharp.at("method"), "sharp");
    EXPECT_EQ(sharp.at("psnr"), 20.0);
}

TEST_F(SequenceResults, OnlyFramesWithEverySampleCountAreAtEqualError) {
    ASSERT_FALSE(mResult.plan.isSwept(0));
    add("gather/15", 0, 1.0, 0.0);
    EXPECT_EQ(rowOfGather(0).at("psnr"), 38.0);
    EXPECT_EQ(describe().at("equalError").at(0).at("frames"), json(mResult.plan.sweepFrames));
    // Squares are averaged, not decibels: 38 dB thrice and 20 dB.
    add("gather/15", mResult.plan.sweepFrames[0], 10.0, 20.0);
    const double meanSquare = (3.0 * std::pow(10.0, -3.8) + 0.01) / 4.0;
    setSwept("gather/64", 1.0, 0.0);
    EXPECT_NEAR(rowOfGather(1).at("psnr"), 30.0, 1e-9) << "the others' best";
    for (const uint32_t count : {4, 8, 16, 32})
        setSwept("gather/" + std::to_string(count), 1.0, 0.0);
    EXPECT_NEAR(rowOfGather(1).at("psnr"), -10.0 * std::log10(meanSquare), 1e-9);
}

TEST_F(SequenceResults, MeasuresAreMeansOverTheFramesThatHaveThem) {
    for (uint32_t frame = 0; frame < kFrames; ++frame) {
        auto& metrics = at(SequenceCamera::Own, "gather/15", frame).picture.metrics;
        metrics["ssim"] = frame < 4 ? 0.5 : 1.0;
        metrics["flip"] = 0.25;
        if (frame % 4 == 0)
            metrics["hdrFlip"] = frame == 0 ? 0.5 : 0.25;
        if (frame > 0) {
            metrics["flicker"] = 0.125;
            metrics["fixedPower"] = frame == 1 ? 0.07 : 0.0;
        }
    }
    for (uint32_t frame = 0; frame < mResult.plan.standingFrames; ++frame)
        at(SequenceCamera::Standing, "gather/15", frame) = makeRecord(
            1.0e6,
            frame == 0 ? std::map<std::string, double>{}
                       : std::map<std::string, double>{{"flicker", 0.0625}}
        );
    const json row = describe().at("measurements").at(1);
    const json& metrics = row.at("metrics");
    EXPECT_EQ(metrics.at("ssim"), 0.75);
    EXPECT_EQ(metrics.at("flip"), 0.25);
    EXPECT_EQ(metrics.at("hdrFlip"), 0.375);
    EXPECT_EQ(metrics.at("flicker"), 0.125);
    EXPECT_EQ(metrics.at("standingFlicker"), 0.0625);
    EXPECT_NEAR(metrics.at("fixedNoise"), 0.1, 1e-12);
    EXPECT_EQ(
        row.at("curves").at("hdrFlip"),
        json({0.5, nullptr, nullptr, nullptr, 0.25, nullptr, nullptr, nullptr})
    );
    EXPECT_EQ(row.at("milliseconds").at("frame").at("median"), 10.0) << "of its own camera";
    EXPECT_EQ(row.at("milliseconds").at("wall").at("median"), 20.0);
    EXPECT_EQ(describe().at("truth").at("instants").at("median"), 3.5);
}

TEST_F(SequenceResults, AFilmThatEqualsItsTruthHasNoFinitePsnr) {
    for (uint32_t frame = 0; frame < kFrames; ++frame)
        add("gather/15", frame, 10.0, std::numeric_limits<double>::infinity());
    const json row = describe().at("measurements").at(1);
    EXPECT_TRUE(row.at("metrics").at("psnr").is_null());
    EXPECT_TRUE(row.at("curves").at("psnr").at(0).is_null());
    EXPECT_EQ(rowOfGather(1).at("milliseconds"), 10.0);
    EXPECT_TRUE(rowOfGather(1).at("psnr").is_null());
}

TEST_F(SequenceResults, EveryMeasureOfAMethodIsDescribed) {
    const json metrics = describe().at("measurements").at(0).at("metrics");
    EXPECT_EQ(describeTemporalMetrics().size(), metrics.size());
    for (const json& metric : describeTemporalMetrics())
        EXPECT_TRUE(metrics.contains(metric.at("id"))) << metric;
}

} // namespace
} // namespace shutter::bench
