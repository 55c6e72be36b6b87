// SPDX-License-Identifier: MIT
#include "game/bench/bench_run.h"

#include "engine/io/file_bytes.h"
#include "game/bench/report/report_page.h"
#include "game/bench/results.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <string_view>

namespace shutter::bench {

namespace {

using core::Status;
using nlohmann::json;

/// The method at whose time all others are compared: the first of these that is measured.
constexpr const char* kReferences[] = {"resolved", "hybrid"};
/// The baseline of the headline.
constexpr const char* kBaseline = "gather";

constexpr const char* kResultsFile = "results.json";

/// A run of one suite.
class BenchRun {
  public:
    BenchRun(gpu::Device& device, const RunOptions& options, const StopQuestion& stop)
        : mDevice(device), mGiven(options.given), mSuite(options.suite), mMethods(options.methods),
          mShot(options.shot), mStop(stop),
          mSweep(
              mSuite.dial.empty() ? makeSweep(mMethods, mSuite.maxRays) : makeDialPoints(mMethods)
          ),
          mAntiAliased(makeAntiAliasedPoints(mMethods)),
          mScalingPoints(makeScalingPoints(mMethods)), mOptions(options.measure),
          mTimesOnly(mOptions), mSequence(options.sequence) {
        mTimesOnly.comparePictures = false;
    }

    Status run() {
        describeRun();
        core::Progress progress("measuring", countAllSteps());
        for (const Case& shot : mSuite.cases) {
            auto result = measureCase(mDevice, shot, sweepOf(shot), mOptions, progress, mStop);
            if (!result)
                return result.error();
            addCase(shot, result.value());
            if (mStop())
                return stopEarly();
            SHUTTER_TRY(writeResults());
        }
        for (const ScalingAxis& axis : mSuite.axes)
            SHUTTER_TRY(measureAxis(axis, progress));
        for (const SequenceCase& film : mSuite.sequences)
            SHUTTER_TRY(measureFilm(film, progress));
        mRoot["complete"] = true;
        SHUTTER_TRY(writeResults());
        return checkReportPageCanBeMade() ? writeReportPage(mRoot, mOptions.folder) : Status();
    }

  private:
    uint64_t countAllSteps() const {
        uint64_t steps = 0;
        for (const Case& shot : mSuite.cases)
            steps += countSteps(sweepOf(shot), mOptions);
        for (const ScalingAxis& axis : mSuite.axes)
            steps += axis.points.size() * countSteps(mScalingPoints, mTimesOnly);
        for (const SequenceCase& film : mSuite.sequences)
            steps += countPictures(planSequence(
                mMethods,
                mSequence.frames,
                mSequence.truth.mostInstants,
                film.shot.picture.antiAliasing
            ));
        return steps;
    }

    const std::vector<SamplePoint>& sweepOf(const Case& shot) const {
        return shot.shot.picture.antiAliasing == game::AntiAliasing::None ? mSweep : mAntiAliased;
    }

    bool isMeasured(std::string_view name) const {
        return std::any_of(mMethods.begin(), mMethods.end(), [&](const auto* method) {
            return method->name == name;
        });
    }

    const char* findReference() const {
        const auto* found =
            std::find_if(std::begin(kReferences), std::end(kReferences), [&](const char* name) {
                return isMeasured(name);
            });
        return found == std::end(kReferences) ? kReferences[0] : *found;
    }

    void describeRun() {
        mRoot = describeOrigin(mSuite.name, mDevice.info());
        mRoot["options"] = mGiven;
        mRoot["metrics"] = describeMetrics();
        mRoot["methods"] = describeMethods(mMethods);
        for (const char* name : {"cases", "equalTime", "scaling"})
            mRoot[name] = json::array();
        if (isMeasured(findReference()) && isMeasured(kBaseline))
            mRoot["headline"] = {{"method", findReference()}, {"baseline", kBaseline}};
        mRoot["settings"] = {
            {"width", mShot.width},
            {"height", mShot.height},
            {"truthSamples",
             mSuite.sequences.empty() ? mOptions.truthSamples : mSequence.truth.mostInstants},
            {"repeats", mOptions.repeats},
            {"limitSeconds", mOptions.limitSeconds},
            {"pixel", mSuite.pixel == extract::PixelModel::Box ? "box" : "centre"},
            {"tonemap",
             mShot.picture.tonemap.op == tonemap::Operator::Neutral ? "Khronos PBR Neutral, sRGB"
                                                                    : "sRGB"}};
        if (!mSuite.sequences.empty()) {
            mRoot["sequences"] = json::array();
            mRoot["temporalMetrics"] = describeTemporalMetrics();
        }
        if (mSuite.name == "paper")
            mRoot["paper"] = describePaperFigures();
    }

    void addCase(const Case& shot, const CaseResult& result) {
        json described = describeCase(shot, sweepOf(shot), result, mOptions);
        const auto imageOf = [&](const json& row) {
            return pictureFile(
                shot.name,
                row.at("method"),
                row.at("samples").is_null() ? 0u : row.at("samples").get<uint32_t>()
            );
        };
        if (json row = compareAtEqualTime(described, findReference(), imageOf); !row.is_null())
            mRoot["equalTime"].push_back(std::move(row));
        mRoot["cases"].push_back(std::move(described));
    }

    Status measureAxis(const ScalingAxis& axis, core::Progress& progress) {
        std::vector<MeasuredPoint> measured;
        for (const ScalingPoint& point : axis.points) {
            auto result =
                measureCase(mDevice, point.shot, mScalingPoints, mTimesOnly, progress, mStop);
            if (!result)
                return result.error();
            if (mStop())
                return stopEarly();
            measured.push_back({&point, std::move(result.value())});
        }
        mRoot["scaling"].push_back(describeAxis(axis, mScalingPoints, measured));
        return writeResults();
    }

    Status measureFilm(const SequenceCase& film, core::Progress& progress) {
        auto result = measureSequence(mDevice, film, mMethods, mSequence, progress, mStop);
        if (!result)
            return result.error();
        if (mStop())
            return stopEarly();
        mRoot["sequences"].push_back(describeSequence(film, result.value(), mSequence));
        return writeResults();
    }

    Status writeResults() const {
        return io::writeFileText(mOptions.folder / kResultsFile, mRoot.dump(1) + "\n");
    }

    static Status stopEarly() {
        return core::makeError("stopped; the same command goes on where it was");
    }

    gpu::Device& mDevice;
    const std::vector<std::string>& mGiven;
    const Suite& mSuite;
    const std::vector<const game::MethodInfo*>& mMethods;
    const game::ShotOptions& mShot;
    const StopQuestion& mStop;
    std::vector<SamplePoint> mSweep;
    std::vector<SamplePoint> mAntiAliased;
    std::vector<SamplePoint> mScalingPoints;
    MeasureOptions mOptions;
    MeasureOptions mTimesOnly;
    const SequenceOptions& mSequence;
    json mRoot;
};

} // namespace

Status runSuite(gpu::Device& device, const RunOptions& options, const StopQuestion& stop) {
    return BenchRun(device, options, stop).run();
}

} // namespace shutter::bench
