// SPDX-License-Identifier: MIT
#include "game/bench/sequence_results.h"

#include "engine/math/statistics.h"
#include "game/bench/results.h"
#include "game/bench/sequence/temporal_error.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace shutter::bench {

namespace {

using nlohmann::json;

/// Errors at which methods are compared by their time, dB.
constexpr double kAskedPsnr[] = {35.0, 40.0};
/// Measures of a frame that are curves over time.
constexpr const char* kCurves[] = {"psnr", "ssim", "flip", "hdrFlip", "flicker"};

/// JSON has no infinity, which equal pictures have: null is written instead.
json packNumber(double value) {
    return std::isfinite(value) ? json(value) : json();
}

/// The records of one point, frame by frame.
class Frames {
  public:
    Frames(const SequenceResult& result, SequenceCamera camera, const std::string& key) {
        const uint32_t count =
            camera == SequenceCamera::Own ? result.plan.frames : result.plan.standingFrames;
        for (uint32_t frame = 0; frame < count; ++frame) {
            const auto found = result.records.find(makeFrameKey(camera, key, frame));
            mRecords.push_back(found == result.records.end() ? nullptr : &found->second);
        }
    }

    /// One a frame, null where there is none.
    [[nodiscard]] json listMetric(const std::string& id) const {
        json values = json::array();
        for (const Record* record : mRecords) {
            const auto value = find(record, id);
            values.push_back(value ? packNumber(*value) : json());
        }
        return values;
    }

    /// The frames that lack it are left out.
    [[nodiscard]] std::vector<double> collectMetric(const std::string& id) const {
        std::vector<double> values;
        for (const Record* record : mRecords)
            if (const auto value = find(record, id))
                values.push_back(*value);
        return values;
    }

    [[nodiscard]] std::vector<Sample> collectSamples() const {
        std::vector<Sample> samples;
        for (const Record* record : mRecords)
            if (record != nullptr)
                samples.insert(samples.end(), record->samples.begin(), record->samples.end());
        return samples;
    }

    [[nodiscard]] std::vector<double> collectCounter(const std::string& name) const {
        std::vector<double> counts;
        for (const Record* record : mRecords)
            if (record != nullptr && record->picture.counters.contains(name))
                counts.push_back(double(record->picture.counters.at(name)));
        return counts;
    }

    /// The records of these frames alone.
    [[nodiscard]] Frames select(const std::vector<uint32_t>& frames) const {
        Frames some = *this;
        some.mRecords.clear();
        for (const uint32_t frame : frames)
            some.mRecords.push_back(mRecords.at(frame));
        return some;
    }

  private:
    static std::optional<double> find(const Record* record, const std::string& id) {
        if (record == nullptr || !record->picture.metrics.contains(id))
            return std::nullopt;
        return record->picture.metrics.at(id);
    }

    std::vector<const Record*> mRecords; ///< null: not measured
};

/// Null where there are none.
json packQuartiles(std::vector<double> values) {
    if (values.empty())
        return {};
    const math::Quartiles quartiles = math::computeQuartiles(std::move(values));
    return {{"median", quartiles.median}, {"q1", quartiles.q1}, {"q3", quartiles.q3}};
}

double computeMean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values)
        sum += value;
    return values.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / double(values.size());
}

json describeMeasurement(const SamplePoint& point, const SequenceResult& result) {
    const std::string key = makeKey(point);
    const Frames own(result, SequenceCamera::Own, key);
    const Frames standing(result, SequenceCamera::Standing, key);
    const std::vector<double> psnr = own.collectMetric("psnr");
    json row = {
        {"method", point.method->name},
        {"samples", packSampleCount(point.samples)},
        {"metrics",
         {{"psnr", packNumber(computeFilmPsnr(psnr))},
          {"ssim", packNumber(computeMean(own.collectMetric("ssim")))},
          {"flip", packNumber(computeMean(own.collectMetric("flip")))},
          {"hdrFlip", packNumber(computeMean(own.collectMetric("hdrFlip")))},
          {"flicker", packNumber(computeMean(own.collectMetric("flicker")))},
          {"standingFlicker", packNumber(computeMean(standing.collectMetric("flicker")))},
          {"fixedNoise", computeFixedNoise(own.collectMetric("fixedPower"))}}},
        {"milliseconds", describeTimes(*point.method, own.collectSamples())},
        {"curves", json::object()}};
    for (const char* id : kCurves)
        row["curves"][id] = own.listMetric(id);
    if (const auto film = result.films.find(key); film != result.films.end())
        row["film"] = film->second;
    return row;
}

/// The fastest sample count of each method whose film is within the error; those without one are
/// named with their best.
json describeEqualError(double psnr, const SequenceResult& result) {
    std::vector<SamplePoint> points = result.plan.points;
    points.insert(points.end(), result.plan.sweep.begin(), result.plan.sweep.end());
    json rows = json::array();
    for (const SamplePoint& drawn : result.plan.points) {
        const game::MethodInfo& method = *drawn.method;
        json fastest;
        double best = -std::numeric_limits<double>::infinity();
        for (const SamplePoint& point : points) {
            if (point.method != &method)
                continue;
            const Frames frames =
                Frames(result, SequenceCamera::Own, makeKey(point)).select(result.plan.sweepFrames);
            const double reached = computeFilmPsnr(frames.collectMetric("psnr"));
            const double time = describeTimes(method, frames.collectSamples())["frame"]["median"];
            best = std::max(best, reached);
            if (reached < psnr || (!fastest.is_null() && fastest.at("milliseconds") <= time))
                continue;
            fastest = {
                {"method", method.name},
                {"samples", packSampleCount(point.samples)},
                {"milliseconds", time},
                {"psnr", packNumber(reached)}};
        }
        if (fastest.is_null())
            fastest = {
                {"method", method.name},
                {"samples", nullptr},
                {"milliseconds", nullptr},
                {"psnr", packNumber(best)}};
        rows.push_back(std::move(fastest));
    }
    return {{"psnr", psnr}, {"frames", result.plan.sweepFrames}, {"rows", rows}};
}

json describeTruth(const SequenceResult& result, const SequenceOptions& options) {
    const std::string key(kTruthKey);
    const Frames frames(result, SequenceCamera::Own, key);
    json truth = {
        {"method", "accumulate"},
        {"maxStepPx", options.truth.maxStepPx},
        {"mostInstants", options.truth.mostInstants},
        {"instants", packQuartiles(frames.collectCounter("instants"))}};
    if (const auto film = result.films.find(key); film != result.films.end())
        truth["film"] = film->second;
    return truth;
}

} // namespace

json describeTemporalMetrics() {
    return json::array(
        {{{"id", "psnr"}, {"name", "PSNR"}, {"unit", "dB"}, {"better", "higher"}},
         {{"id", "ssim"}, {"name", "SSIM"}, {"unit", ""}, {"better", "higher"}},
         {{"id", "flip"}, {"name", "FLIP"}, {"unit", ""}, {"better", "lower"}},
         {{"id", "hdrFlip"}, {"name", "HDR-FLIP"}, {"unit", ""}, {"better", "lower"}},
         {{"id", "flicker"}, {"name", "Flicker"}, {"unit", ""}, {"better", "lower"}},
         {{"id", "standingFlicker"},
          {"name", "Flicker, camera at rest"},
          {"unit", ""},
          {"better", "lower"}},
         {{"id", "fixedNoise"}, {"name", "Fixed noise"}, {"unit", ""}, {"better", "lower"}}}
    );
}

json describeSequence(
    const SequenceCase& film, const SequenceResult& result, const SequenceOptions& options
) {
    json described = {
        {"name", film.name},
        {"title", film.title},
        {"description", film.description},
        {"kind", film.demo.empty() ? "flight" : "demo"},
        {"frames", result.plan.frames},
        {"framesPerSecond", result.framesPerSecond},
        {"standingFrames", result.plan.standingFrames},
        {"truth", describeTruth(result, options)},
        {"measurements", json::array()},
        {"equalError", json::array()},
        {"skipped", json::array()}};
    for (const SamplePoint& point : result.plan.points)
        described["measurements"].push_back(describeMeasurement(point, result));
    for (const double psnr : kAskedPsnr)
        described["equalError"].push_back(describeEqualError(psnr, result));
    for (const game::MethodInfo* method : result.skipped)
        described["skipped"].push_back(
            {{"method", method->name},
             {"samples", nullptr},
             {"reason", "the device does not trace the rays that it needs"}}
        );
    return described;
}

} // namespace shutter::bench
