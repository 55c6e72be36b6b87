// SPDX-License-Identifier: MIT
#include "game/bench/results.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <limits>

namespace shutter::bench {

namespace {

SamplePoint pointOf(const char* method, uint32_t samples) {
    const game::MethodInfo* info = game::findMethod(method).value();
    return {info, samples, samples == info->defaultSamples};
}

Record makeRecord(double gatherMs, double psnr) {
    Record record;
    for (double factor : {1.0, 2.0, 3.0})
        record.samples.push_back(
            {{{"G-buffer", 10.0},
              {"gather and composite", gatherMs * factor, render::PassOwner::Effect},
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

std::string nameImage(const nlohmann::json& row) {
    return fmt::format("{}-{}.png", row.at("method").get<std::string>(), row.at("samples").dump());
}

nlohmann::json describeThree() {
    const std::vector<SamplePoint> sweep{
        pointOf("hybrid", 15), pointOf("gather", 4), pointOf("gather", 15), pointOf("gather", 64)};
    CaseResult result;
    result.records["hybrid/15"] = makeRecord(4.0, 30.0);
    result.records["gather/4"] = makeRecord(1.0, 25.0);
    result.records["gather/15"] = makeRecord(2.0, 28.0);
    result.records["gather/64"] = makeRecord(9.0, 31.0);
    return describeCase({}, sweep, result, {});
}

} // namespace

TEST(Cost, TheDisplayDoesNotCountAndTheSceneIsNoEffect) {
    using render::PassOwner;
    const Sample sample{
        {{"deform meshes", 4.0, PassOwner::Scene},
         {"G-buffer", 6.0, PassOwner::Scene},
         {"ray reveal", 3.0, PassOwner::Effect},
         {"tone map", 5.0, PassOwner::Display},
         {"readback display", 1.0, PassOwner::Display}},
        0.0};
    EXPECT_EQ(computeFrameTime(sample), 13.0);
    EXPECT_EQ(computeEffectTime(*game::findMethod("hybrid").value(), sample), 3.0);
    EXPECT_EQ(computeEffectTime(*game::findMethod("sharp").value(), sample), 0.0);
    // Every G-buffer of an accumulation is the method's own.
    EXPECT_EQ(computeEffectTime(*game::findMethod("accumulate").value(), sample), 13.0);
}

TEST(Results, AMeasurementHoldsMediansAndQuartiles) {
    const nlohmann::json described = describeThree();
    const nlohmann::json& hybrid = described.at("measurements").at(0);
    EXPECT_EQ(hybrid.at("method"), "hybrid");
    EXPECT_EQ(hybrid.at("milliseconds").at("frame").at("median"), 18.0);
    EXPECT_EQ(hybrid.at("milliseconds").at("effect").at("q1"), 6.0);
    EXPECT_EQ(hybrid.at("milliseconds").at("effect").at("q3"), 10.0);
    EXPECT_EQ(hybrid.at("repeats"), 3);
    EXPECT_TRUE(hybrid.at("isDefault"));
}

TEST(Results, EqualTimeTakesTheSampleCountThatIsNearestInTime) {
    // hybrid 18 ms; gather 12, 14 and 28 ms.
    const nlohmann::json equal = compareAtEqualTime(describeThree(), "hybrid", nameImage);
    ASSERT_EQ(equal.at("rows").size(), 1u);
    EXPECT_EQ(equal.at("rows").at(0).at("samples"), 15);
    EXPECT_EQ(equal.at("rows").at(0).at("image"), "gather-15.png");
    EXPECT_EQ(equal.at("reference").at("milliseconds"), 18.0);
}

TEST(Results, OnlyDefaultsCarryPictures) {
    const nlohmann::json described = describeThree();
    for (const nlohmann::json& row : described.at("measurements"))
        for (const char* picture : {"image", "errorMap", "linear"})
            EXPECT_EQ(row.contains(picture), row.at("isDefault").get<bool>()) << row.at("samples");
}

TEST(Results, AMethodWithoutSamplesHasNull) {
    CaseResult result;
    result.records["sharp/0"] = makeRecord(0.0, 20.0);
    const nlohmann::json described = describeCase({}, {pointOf("sharp", 0)}, result, {});
    EXPECT_TRUE(described.at("measurements").at(0).at("samples").is_null());
}

TEST(Results, WithoutTheReferenceThereIsNoEqualTime) {
    EXPECT_TRUE(compareAtEqualTime(describeThree(), "truth", nameImage).is_null());
}

TEST(Results, EqualPicturesHaveANullPsnrAndSkippedSampleCountsTheirReason) {
    CaseResult result;
    result.records["hybrid/15"] = makeRecord(4.0, std::numeric_limits<double>::infinity());
    result.records["gather/15"].skipped = "predicted 90 s";
    const nlohmann::json described =
        describeCase({}, {pointOf("hybrid", 15), pointOf("gather", 15)}, result, {});
    EXPECT_TRUE(described.at("measurements").at(0).at("metrics").at("psnr").is_null());
    ASSERT_EQ(described.at("skipped").size(), 1u);
    EXPECT_EQ(described.at("skipped").at(0).at("reason"), "predicted 90 s");
    EXPECT_EQ(described.at("measurements").size(), 1u);
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
    const nlohmann::json described =
        describeAxis(axis, {pointOf("sharp", 0), pointOf("hybrid", 15)}, measured);
    ASSERT_EQ(described.at("series").size(), 1u); // hybrid was not measured
    EXPECT_NEAR(described.at("series").at(0).at("fit").at("frame").at("exponent"), 1.0, 1e-12);
}

} // namespace shutter::bench
