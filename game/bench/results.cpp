// SPDX-License-Identifier: MIT
#include "game/bench/results.h"

#include "engine/math/statistics.h"
#include "engine/scene/shutter.h"
#include "game/bench/sequence/temporal_error.h"
#include "game/shot/methods.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace shutter::bench {

namespace {

using nlohmann::json;

json packQuartiles(
    const std::vector<Sample>& samples, const std::function<double(const Sample&)>& of
) {
    std::vector<double> values;
    for (const Sample& sample : samples)
        values.push_back(of(sample));
    const math::Quartiles quartiles = math::computeQuartiles(std::move(values));
    return {{"median", quartiles.median}, {"q1", quartiles.q1}, {"q3", quartiles.q3}};
}

double timeOfPass(const Sample& sample, const std::string& name) {
    for (const PassSample& pass : sample.passes)
        if (pass.name == name)
            return pass.milliseconds;
    return 0.0;
}

json describePasses(const game::MethodInfo& method, const std::vector<Sample>& samples) {
    json passes = json::array();
    for (const PassSample& pass : samples.front().passes) {
        json row = packQuartiles(samples, [&](const Sample& sample) {
            return timeOfPass(sample, pass.name);
        });
        row["name"] = pass.name;
        row["effect"] = game::groupOf(method, pass.owner) == game::PassGroup::Blur;
        passes.push_back(std::move(row));
    }
    return passes;
}

json describeMeasurement(const SamplePoint& point, const Record& record) {
    json metrics = json::object();
    for (const auto& [id, value] : record.picture.metrics)
        metrics[id] = std::isfinite(value) ? json(value) : json(); // null: equal pictures
    json row = {
        {"method", point.method->name},
        {"samples", packSampleCount(point.samples)},
        {"isDefault", point.isDefault},
        {"repeats", record.samples.size()},
        {"metrics", metrics},
        {"milliseconds", describeTimes(*point.method, record.samples)},
        {"passes", describePasses(*point.method, record.samples)},
        {"counters", record.picture.counters}};
    // Pictures go into the page, so only those of defaults do.
    if (point.isDefault) {
        row["image"] = record.picture.image;
        row["errorMap"] = record.picture.errorMap;
        if (!record.picture.linear.empty())
            row["linear"] = record.picture.linear;
    }
    return row;
}

double frameTimeOf(const json& measurement) {
    return measurement.at("milliseconds").at("frame").at("median");
}

/// How far a measurement's time is from another, as a ratio's logarithm.
double distanceFrom(double milliseconds, const json& measurement) {
    return std::abs(std::log(frameTimeOf(measurement) / milliseconds));
}

json describeFit(const std::vector<math::CurvePoint>& curve) {
    const auto fit = math::fitPower(curve);
    if (!fit)
        return {};
    return {{"exponent", fit->exponent}, {"r2", fit->r2}, {"from", fit->from}, {"to", fit->to}};
}

/// Seconds; the shot's options were checked when it was set up.
double findExposure(const game::ShotArguments& shot) {
    const auto options = game::interpret(shot);
    return options ? scene::computeExposureSeconds(
                         options.value().shutter, options.value().frameSeconds
                     )
                   : 0.0;
}

/// Errors at which methods are compared by their time, dB.
constexpr double kComparedPsnr[] = {35.0, 40.0};
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

    /// One per frame, null where there is none.
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

json describeTruth(
    const SequenceCase& film, const SequenceResult& result, const SequenceOptions& options
) {
    const std::string key(kTruthKey);
    const Frames frames(result, SequenceCamera::Own, key);
    const bool takesAll = film.shot.pixel == extract::PixelModel::Box || result.hasLens;
    json truth = {
        {"method", "accumulate"},
        {"maxStepPx", takesAll ? json() : json(options.truth.maxStepPx)},
        {"mostInstants", options.truth.mostInstants},
        {"instants", packQuartiles(frames.collectCounter("instants"))}};
    if (const auto drawn = result.films.find(key); drawn != result.films.end())
        truth["film"] = drawn->second;
    return truth;
}

} // namespace

json packSampleCount(uint32_t samples) {
    return samples > 0 ? json(samples) : json();
}

json describeTimes(const game::MethodInfo& method, const std::vector<Sample>& samples) {
    return {
        {"frame", packQuartiles(samples, computeFrameTime)},
        {"effect",
         packQuartiles(
             samples, [&](const Sample& sample) { return computeEffectTime(method, sample); }
         )},
        {"wall",
         packQuartiles(samples, [](const Sample& sample) { return sample.wallMilliseconds; })}};
}

json describeCase(
    const Case& shot,
    const std::vector<SamplePoint>& sweep,
    const CaseResult& result,
    const MeasureOptions& options
) {
    json described = {
        {"name", shot.name},
        {"title", shot.title},
        {"description", shot.description},
        {"time", shot.shot.time},
        {"exposure", findExposure(shot.shot)},
        {"phase",
         core::describeValue(
             core::getRow(scene::listShutterRows(), "phase"), shot.shot.shutter.shutter
         )},
        {"camera", shot.shot.camera},
        {"antiAliasing", nameAntiAliasing(shot.shot.picture.antiAliasing)},
        {"measurements", json::array()},
        {"skipped", json::array()},
        {"crops", json::array()}};
    described["truth"] = {
        {"method", "accumulate"},
        {"samples", options.truthSamples},
        {"image", result.truthImage},
        {"hash", result.truthHash}};
    if (!result.truthLinear.empty())
        described["truth"]["linear"] = result.truthLinear;
    for (const Crop& crop : result.crops)
        described["crops"].push_back(
            {{"x", crop.x},
             {"y", crop.y},
             {"width", crop.width},
             {"height", crop.height},
             {"label", crop.label}}
        );
    for (const SamplePoint& point : sweep) {
        const auto found = result.records.find(makeKey(point));
        if (found == result.records.end())
            continue;
        if (!found->second.skipped.empty())
            described["skipped"].push_back(
                {{"method", point.method->name},
                 {"samples", packSampleCount(point.samples)},
                 {"reason", found->second.skipped}}
            );
        else if (!found->second.samples.empty() && found->second.hasPicture)
            described["measurements"].push_back(describeMeasurement(point, found->second));
    }
    return described;
}

json compareAtEqualTime(
    const json& described, const std::string& reference, const ImageOf& imageOf
) {
    const json* own = nullptr;
    std::map<std::string, const json*> nearest;
    const json& measurements = described.at("measurements");
    for (const json& row : measurements)
        if (row.at("method") == reference && row.at("isDefault"))
            own = &row;
    if (own == nullptr)
        return {};
    const double time = frameTimeOf(*own);
    std::vector<std::string> order;
    for (const json& row : measurements) {
        const std::string method = row.at("method");
        const json*& best = nearest[method];
        if (best == nullptr)
            order.push_back(method);
        if (best == nullptr || distanceFrom(time, row) < distanceFrom(time, *best))
            best = &row;
    }
    json rows = json::array();
    for (const std::string& method : order) {
        if (method == reference)
            continue;
        const json& row = *nearest.at(method);
        rows.push_back(
            {{"method", method},
             {"samples", row.at("samples")},
             {"milliseconds", frameTimeOf(row)},
             {"metrics", row.at("metrics")},
             {"image", imageOf(row)}}
        );
    }
    return {
        {"case", described.at("name")},
        {"reference",
         {{"method", reference}, {"samples", own->at("samples")}, {"milliseconds", time}}},
        {"rows", rows}};
}

json describeAxis(
    const ScalingAxis& axis,
    const std::vector<SamplePoint>& sweep,
    const std::vector<MeasuredPoint>& points
) {
    json series = json::array();
    for (const SamplePoint& point : sweep) {
        json rows = json::array();
        std::vector<math::CurvePoint> frames;
        std::vector<math::CurvePoint> effects;
        for (const MeasuredPoint& measured : points) {
            const auto found = measured.result.records.find(makeKey(point));
            if (found == measured.result.records.end() || found->second.samples.empty())
                continue;
            json times = describeTimes(*point.method, found->second.samples);
            frames.push_back({measured.point->value, times.at("frame").at("median")});
            effects.push_back({measured.point->value, times.at("effect").at("median")});
            rows.push_back(
                {{"value", measured.point->value},
                 {"label", measured.point->label},
                 {"milliseconds", times}}
            );
        }
        if (rows.empty())
            continue;
        series.push_back(
            {{"method", point.method->name},
             {"points", rows},
             {"fit", {{"frame", describeFit(frames)}, {"effect", describeFit(effects)}}}}
        );
    }
    return {{"axis", axis.name}, {"title", axis.title}, {"unit", axis.unit}, {"series", series}};
}

json describeMethods(const std::vector<const game::MethodInfo*>& methods) {
    const auto nameUnit = [](const game::MethodInfo& method) {
        if (!method.sampleUnit)
            return "none";
        switch (*method.sampleUnit) {
        case game::SampleUnit::Taps:
            return "samples";
        case game::SampleUnit::Instants:
            return "instants";
        case game::SampleUnit::Rays:
            break;
        }
        return "rays";
    };
    json rows = json::array();
    for (const game::MethodInfo* method : methods)
        rows.push_back(
            {{"name", method->name},
             {"title", method->description},
             {"publication", method->publication},
             {"sampleUnit", nameUnit(*method)},
             {"default", packSampleCount(method->defaultSamples)},
             {"usesRays", method->rays != game::RayNeed::None}}
        );
    return rows;
}

json describeMetrics() {
    return json::array(
        {{{"id", "psnr"}, {"name", "PSNR"}, {"unit", "dB"}, {"better", "higher"}},
         {{"id", "ssim"}, {"name", "SSIM"}, {"unit", ""}, {"better", "higher"}},
         {{"id", "flip"}, {"name", "FLIP"}, {"unit", ""}, {"better", "lower"}},
         {{"id", "linearPsnr"}, {"name", "Linear PSNR"}, {"unit", "dB"}, {"better", "higher"}}}
    );
}

double computeFrameTime(const Sample& sample) {
    double sum = 0.0;
    for (const PassSample& pass : sample.passes)
        if (pass.owner != render::PassOwner::Display)
            sum += pass.milliseconds;
    return sum;
}

double computeEffectTime(const game::MethodInfo& method, const Sample& sample) {
    double sum = 0.0;
    for (const PassSample& pass : sample.passes)
        if (game::groupOf(method, pass.owner) == game::PassGroup::Blur)
            sum += pass.milliseconds;
    return sum;
}

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
        {"antiAliasing", nameAntiAliasing(film.shot.picture.antiAliasing)},
        {"frames", result.plan.frames},
        {"framesPerSecond", result.framesPerSecond},
        {"standingFrames", result.plan.standingFrames},
        {"truth", describeTruth(film, result, options)},
        {"measurements", json::array()},
        {"equalError", json::array()},
        {"skipped", json::array()}};
    for (const SamplePoint& point : result.plan.points)
        described["measurements"].push_back(describeMeasurement(point, result));
    for (const double psnr : kComparedPsnr)
        described["equalError"].push_back(describeEqualError(psnr, result));
    for (const SkippedMethod& skipped : result.skipped)
        described["skipped"].push_back(
            {{"method", skipped.method->name}, {"samples", nullptr}, {"reason", skipped.reason}}
        );
    return described;
}

} // namespace shutter::bench
