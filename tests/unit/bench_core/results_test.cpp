// SPDX-License-Identifier: MIT
// What the benchmark writes: results, those of sequences, and its journal.
#include "engine/io/file_bytes.h"
#include "game/bench/journal.h"
#include "game/bench/measure.h"
#include "game/bench/results.h"
#include "tests/support/outcomes.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace shutter::bench {
namespace {

using nlohmann::json;

SamplePoint pointOf(const char* method, uint32_t samples) {
    const game::MethodInfo* info = game::findMethod(method).value();
    return {info, samples, samples == info->defaultSamples};
}

Record makeRecord(double gatherMs, double psnr) {
    Record record;
    for (double factor : {1.0, 2.0, 3.0})
        record.samples.push_back(
            {{{"G-buffer", 10.0},
              {"gather and composite", gatherMs * factor, render::PassOwner::Blur},
              {"tone map", 5.0, render::PassOwner::Display}},
             40.0}
        );
    record.hasPicture = true;
    record.picture.metrics = {{"psnr", psnr}, {"ssim", 0.5}, {"flip", 0.1}};
    record.picture.image = "images/a.png";
    record.picture.errorMap = "images/a.flip.png";
    record.picture.linear = "images/a.exr";
    return record;
}

std::string nameImage(const json& row) {
    return fmt::format("{}-{}.png", row.at("method").get<std::string>(), row.at("samples").dump());
}

/// Of hybrid at 18 ms, and of gather at 12, 14 and 28 ms.
json describeThree() {
    const std::vector<SamplePoint> sweep{
        pointOf("hybrid", 15), pointOf("gather", 4), pointOf("gather", 15), pointOf("gather", 64)};
    CaseResult result;
    result.records["hybrid/15"] = makeRecord(4.0, 30.0);
    result.records["gather/4"] = makeRecord(1.0, 25.0);
    result.records["gather/15"] = makeRecord(2.0, 28.0);
    result.records["gather/64"] = makeRecord(9.0, 31.0);
    return describeCase({}, sweep, result, {});
}

TEST(Cost, TheDisplayDoesNotCountAndTheSceneIsNoEffect) {
    using render::PassOwner;
    const Sample sample{
        {{"deform meshes", 4.0, PassOwner::Scene},
         {"G-buffer", 6.0, PassOwner::Scene},
         {"ray reveal", 3.0, PassOwner::Blur},
         {"tone map", 5.0, PassOwner::Display},
         {"readback display", 1.0, PassOwner::Display}},
        0.0};
    EXPECT_EQ(computeFrameTime(sample), 13.0);
    EXPECT_EQ(computeEffectTime(*game::findMethod("hybrid").value(), sample), 3.0);
    EXPECT_EQ(computeEffectTime(*game::findMethod("sharp").value(), sample), 0.0);
    // Every G-buffer of an accumulation is the method's own.
    EXPECT_EQ(computeEffectTime(*game::findMethod("accumulate").value(), sample), 13.0);
}

TEST(Results, AMeasurementHoldsMediansAndQuartilesAndOnlyDefaultsCarryPictures) {
    const json described = describeThree();
    const json& hybrid = described.at("measurements").at(0);
    EXPECT_EQ(hybrid.at("method"), "hybrid");
    EXPECT_EQ(hybrid.at("milliseconds").at("frame").at("median"), 18.0);
    EXPECT_EQ(hybrid.at("milliseconds").at("effect").at("q1"), 6.0);
    EXPECT_EQ(hybrid.at("milliseconds").at("effect").at("q3"), 10.0);
    EXPECT_EQ(hybrid.at("repeats"), 3);
    EXPECT_TRUE(hybrid.at("isDefault"));
    for (const json& row : described.at("measurements"))
        for (const char* picture : {"image", "errorMap", "linear"})
            EXPECT_EQ(row.contains(picture), row.at("isDefault").get<bool>()) << row.at("samples");
}

TEST(Results, EqualTimeTakesTheSampleCountThatIsNearestInTimeToTheReference) {
    const json equal = compareAtEqualTime(describeThree(), "hybrid", nameImage);
    ASSERT_EQ(equal.at("rows").size(), 1u);
    EXPECT_EQ(equal.at("rows").at(0).at("samples"), 15);
    EXPECT_EQ(equal.at("rows").at(0).at("image"), "gather-15.png");
    EXPECT_EQ(equal.at("reference").at("milliseconds"), 18.0);
    EXPECT_TRUE(compareAtEqualTime(describeThree(), "truth", nameImage).is_null());
}

TEST(Results, EqualPicturesHaveANullPsnrAndSkippedSampleCountsTheirReason) {
    CaseResult result;
    result.records["hybrid/15"] = makeRecord(4.0, std::numeric_limits<double>::infinity());
    result.records["gather/15"].skipped = "predicted 90 s";
    const json described =
        describeCase({}, {pointOf("hybrid", 15), pointOf("gather", 15)}, result, {});
    EXPECT_TRUE(described.at("measurements").at(0).at("metrics").at("psnr").is_null());
    ASSERT_EQ(described.at("skipped").size(), 1u);
    EXPECT_EQ(described.at("skipped").at(0).at("reason"), "predicted 90 s");
    EXPECT_EQ(described.at("measurements").size(), 1u);
    CaseResult without;
    without.records["sharp/0"] = makeRecord(0.0, 20.0);
    const json sharp = describeCase({}, {pointOf("sharp", 0)}, without, {});
    EXPECT_TRUE(sharp.at("measurements").at(0).at("samples").is_null());
}

TEST(Results, AnAxisIsFittedPerMethod) {
    ScalingAxis axis{"resolution", "Resolution", "pixels", {}};
    axis.points = {{100.0, "a", {}}, {400.0, "b", {}}};
    std::vector<MeasuredPoint> measured;
    for (const ScalingPoint& point : axis.points) {
        MeasuredPoint one{&point, {}};
        Record record;
        record.samples.push_back({{{"G-buffer", point.value * 0.5}}, 1.0});
        one.result.records["sharp/0"] = record;
        measured.push_back(std::move(one));
    }
    const json described =
        describeAxis(axis, {pointOf("sharp", 0), pointOf("hybrid", 15)}, measured);
    ASSERT_EQ(described.at("series").size(), 1u); // hybrid was not measured
    EXPECT_NEAR(described.at("series").at(0).at("fit").at("frame").at("exponent"), 1.0, 1e-12);
}

constexpr uint32_t kFrames = 8;

Record makeRecord(double milliseconds, std::map<std::string, double> metrics) {
    Record record;
    record.samples = {
        {{{"gather and composite", milliseconds, render::PassOwner::Blur}}, 2.0 * milliseconds}};
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

TEST_F(SequenceResults, EqualErrorUsesOnlyFramesWithEverySampleCount) {
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

TEST_F(SequenceResults, TheMeanOverThePixelTakesAllInstantsAndEveryMeasureIsDescribed) {
    EXPECT_EQ(describe().at("truth").at("maxStepPx"), 0.5);
    mFilm.shot.pixel = extract::PixelModel::Box;
    mFilm.shot.picture.antiAliasing = game::AntiAliasing::Taa;
    EXPECT_TRUE(describe().at("truth").at("maxStepPx").is_null());
    EXPECT_EQ(describe().at("antiAliasing"), "taa");
    const json metrics = describe().at("measurements").at(0).at("metrics");
    EXPECT_EQ(describeTemporalMetrics().size(), metrics.size());
    for (const json& metric : describeTemporalMetrics())
        EXPECT_TRUE(metrics.contains(metric.at("id"))) << metric;
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

class JournalFile : public testing::Test {
  protected:
    JournalFile() { std::filesystem::create_directories(mFile.parent_path()); }

    const test::TempFolder mFolder;
    const std::filesystem::path mFile = mFolder.path() / "journal" / "case.json";
};

TEST_F(JournalFile, MeasurementsAreReadBack) {
    {
        Journal journal(mFile, "a");
        ASSERT_TRUE(journal.addSample("hybrid/15", {{{"gather", 1.5}}, 3.0}).ok());
        ASSERT_TRUE(journal.addSample("hybrid/15", {{{"gather", 2.5}}, 4.0}).ok());
        PictureFacts facts;
        facts.metrics = {{"psnr", std::numeric_limits<double>::infinity()}, {"flip", 0.25}};
        facts.image = "images/x.png";
        facts.linear = "images/x.exr";
        facts.counters = {{"rays traced", 7}};
        ASSERT_TRUE(journal.setPicture("hybrid/15", facts).ok());
        ASSERT_TRUE(journal.skip("truth/256", "too long").ok());
    }
    const Journal again(mFile, "a");
    const Record& record = again.find("hybrid/15");
    ASSERT_EQ(record.samples.size(), 2u);
    EXPECT_EQ(record.samples[1].passes[0].name, "gather");
    EXPECT_EQ(record.samples[1].passes[0].milliseconds, 2.5);
    EXPECT_EQ(record.samples[1].wallMilliseconds, 4.0);
    ASSERT_TRUE(record.hasPicture);
    EXPECT_TRUE(std::isinf(record.picture.metrics.at("psnr")));
    EXPECT_EQ(record.picture.metrics.at("flip"), 0.25);
    EXPECT_EQ(record.picture.linear, "images/x.exr");
    EXPECT_EQ(record.picture.counters.at("rays traced"), 7u);
    EXPECT_EQ(again.find("truth/256").skipped, "too long");
    EXPECT_FALSE(again.find("truth/256").hasPicture);
    EXPECT_TRUE(again.find("never").samples.empty());
}

TEST_F(JournalFile, ALaterMeasurementReplacesASkip) {
    Journal journal(mFile, "a");
    ASSERT_TRUE(journal.skip("truth/256", "too long").ok());
    ASSERT_TRUE(journal.addSample("truth/256", {}).ok());
    EXPECT_TRUE(Journal(mFile, "a").find("truth/256").skipped.empty());
}

TEST_F(JournalFile, AnotherFingerprintOrAnInvalidFileStartsANewJournal) {
    ASSERT_TRUE(Journal(mFile, "a").addSample("x/1", {}).ok());
    EXPECT_TRUE(Journal(mFile, "b").records().empty());
    EXPECT_EQ(Journal(mFile, "a").records().size(), 1u);
    for (const char* text : {"", "{", "[]", "{\"fingerprint\":\"a\",\"records\":{\"x\":{}}}"}) {
        ASSERT_TRUE(io::writeFileText(mFile, text).ok());
        EXPECT_TRUE(Journal(mFile, "a").records().empty()) << text;
    }
}

TEST_F(JournalFile, AWrongFieldStartsANewJournalAndIsNamed) {
    PictureFacts facts;
    facts.image = "images/x.png";
    facts.errorMap = "images/x.flip.png";
    facts.linear = "images/x.exr";
    facts.counters = {{"rays traced", 7}};
    {
        Journal journal(mFile, "a");
        ASSERT_TRUE(journal.addSample("x/1", {{{"gather", 1.5}}, 3.0}).ok());
        ASSERT_TRUE(journal.setPicture("x/1", facts).ok());
    }
    const auto bytes = test::valueOf(io::readFileBytes(mFile, 1 << 20));
    const std::string whole(bytes.begin(), bytes.end());
    const auto expectNewJournal = [&](const char* mention) {
        testing::internal::CaptureStderr();
        EXPECT_TRUE(Journal(mFile, "a").records().empty()) << mention;
        const std::string reported = testing::internal::GetCapturedStderr();
        EXPECT_NE(reported.find(mention), std::string::npos) << reported;
        EXPECT_NE(reported.find(mFile.string()), std::string::npos) << reported;
    };

    struct Change {
        std::string from;
        const char* to;
        const char* mention;
    };

    for (const Change& change :
         {Change{"\"rays traced\": 7", "\"rays traced\": 1e300", "counters.rays traced"},
          Change{"\"rays traced\": 7", "\"rays traced\": -1", "counters.rays traced"},
          Change{"images/x.png", "/etc/hostname", "leaves the report's folder"},
          Change{"images/x.flip.png", "../../../../x.png", "leaves the report's folder"},
          Change{"images/x.exr", "../../../x.exr", "leaves the report's folder"},
          Change{"\"gather\"", "\"gather\", 2", "must have 3 elements"},
          Change{"\"samples\"", "\"more\": 1, \"samples\"", "is not a field"},
          Change{"\"wall\": 3.0", "\"wall\": []", "wall"}}) {
        std::string text = whole;
        const size_t place = text.find(change.from);
        ASSERT_NE(place, std::string::npos) << change.from;
        ASSERT_TRUE(
            io::writeFileText(mFile, text.replace(place, change.from.size(), change.to)).ok()
        );
        expectNewJournal(change.mention);
    }
    std::filesystem::remove(mFile);
    std::filesystem::create_directory(mFile);
    expectNewJournal("it is a folder");
    Journal nowhere("no/such/folder/x.json", "a");
    test::expectRefused(nowhere.addSample("x/1", {}), "no/such/folder/x.json");
}

} // namespace
} // namespace shutter::bench
