// SPDX-License-Identifier: MIT
#include "game/bench/bench_run.h"

#include "engine/io/file_bytes.h"
#include "game/bench/report/report_page.h"
#include "game/bench/results.h"
#include "game/bench/sequence_results.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <string_view>

namespace shutter::bench {

namespace {

using core::Status;
using nlohmann::json;

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// The method at whose time all others are compared: the first of these that is measured.
constexpr const char* kReferences[] = {"resolved", "hybrid"};
/// What the headline compares it with.
constexpr const char* kBaseline = "gather";

constexpr const char* kResultsFile = "results.json";

Status writeJson(const json& results, const std::filesystem::path& file) {
    return io::writeFileText(file, results.dump(1) + "\n");
}

/// A run of one suite.
class BenchRun {
  public:
    BenchRun(gpu::Device& device, const RunOptions& options, const StopQuestion& stop)
        : mDevice(device), mSuite(options.suite), mMethods(options.methods), mShot(options.shot),
          mStop(stop), mSweep(makeSweep(mMethods, mSuite.maxRays)),
          mScalingPoints(makeScalingPoints(mMethods)), mOptions(options.measure),
          mTimesOnly(mOptions), mSequence(options.sequence), mPartFile(options.partFile) {
        mTimesOnly.comparePictures = false;
    }

    Status run() {
        describeRun();
        core::Progress progress("measuring", countAllSteps());
        for (const Case& shot : mSuite.cases) {
            auto result = measureCase(mDevice, shot, mSweep, mOptions, progress, mStop);
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
        for (const stability::HardCase& hard : mSuite.hardCases) {
            SHUTTER_TRY(measureHardCase(hard));
            progress.advance();
        }
        for (const demand::Claim& claim : mSuite.claims) {
            SHUTTER_TRY(measureClaim(claim));
            progress.advance();
        }
        mRoot["complete"] = true;
        if (!mPartFile.empty())
            return writeJson(mRoot, mPartFile);
        SHUTTER_TRY(writeReport(mRoot, mOptions.folder));
        return judgeResults(mRoot);
    }

  private:
    uint64_t countAllSteps() const {
        uint64_t steps = mSuite.cases.size() * countSteps(mSweep, mOptions);
        for (const ScalingAxis& axis : mSuite.axes)
            steps += axis.points.size() * countSteps(mScalingPoints, mTimesOnly);
        if (!mSuite.sequences.empty())
            steps +=
                mSuite.sequences.size() *
                countPictures(planSequence(mMethods, mSequence.frames, mSequence.truth.mostInstants)
                );
        return steps + mSuite.hardCases.size() + mSuite.claims.size();
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
            {"pixel", mShot.pixel == extract::PixelModel::Box ? "box" : "centre"},
            {"tonemap",
             mShot.tonemap.op == tonemap::Operator::Neutral ? "Khronos PBR Neutral, sRGB"
                                                            : "sRGB"}};
        if (!mSuite.hardCases.empty())
            mRoot["stability"] = json::array();
        if (!mSuite.claims.empty())
            mRoot["demand"] = json::array();
        if (!mSuite.sequences.empty()) {
            mRoot["sequences"] = json::array();
            mRoot["temporalMetrics"] = describeTemporalMetrics();
        }
        if (mSuite.name == "paper")
            mRoot["paper"] = describePaperFigures();
    }

    void addCase(const Case& shot, const CaseResult& result) {
        json described = describeCase(shot, mSweep, result, mOptions);
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

    Status measureHardCase(const stability::HardCase& hard) {
        const Clock::time_point start = Clock::now();
        HeldCase held{&hard, hard.measure(mDevice)};
        held.seconds = secondsSince(start);
        mRoot["stability"].push_back(describeHardCase(held));
        return mStop() ? stopEarly() : writeResults();
    }

    Status measureClaim(const demand::Claim& claim) {
        demand::DemandOptions options;
        options.width = mShot.width;
        options.height = mShot.height;
        options.rounds = mOptions.repeats;
        options.folder = mOptions.folder / "scenes";
        const Clock::time_point start = Clock::now();
        MeasuredClaim measured{&claim, claim.measure(mDevice, options)};
        measured.seconds = secondsSince(start);
        mRoot["demand"].push_back(describeClaim(measured));
        return mStop() ? stopEarly() : writeResults();
    }

    /// A part's file is there once all of it is measured.
    Status writeResults() const {
        return mPartFile.empty() ? writeJson(mRoot, mOptions.folder / kResultsFile) : Status();
    }

    /// Measurements are kept for the next run, except those of hard cases and claims: of these only
    /// whole parts are.
    Status stopEarly() const {
        if (mPartFile.empty() && (!mSuite.hardCases.empty() || !mSuite.claims.empty()))
            return core::makeError("stopped; the suite {} starts anew each time", mSuite.name);
        return core::makeError("stopped; the same command goes on where it was");
    }

    gpu::Device& mDevice;
    const Suite& mSuite;
    const std::vector<const game::MethodInfo*>& mMethods;
    const game::ShotOptions& mShot;
    const StopQuestion& mStop;
    std::vector<SamplePoint> mSweep;
    std::vector<SamplePoint> mScalingPoints;
    MeasureOptions mOptions;
    MeasureOptions mTimesOnly;
    const SequenceOptions& mSequence;
    std::filesystem::path mPartFile;
    json mRoot;
};

} // namespace

Status judgeResults(const json& results) {
    for (const auto& [list, noun] :
         {std::pair("stability", "hard cases"), std::pair("demand", "claims")}) {
        if (!results.contains(list))
            continue;
        std::vector<std::string> broken;
        for (const json& entry : results.at(list))
            if (!entry.at("held").get<bool>())
                broken.push_back(entry.at("name"));
        if (!broken.empty())
            return core::makeError(
                "{} of {} {} left their bounds: {}",
                broken.size(),
                results.at(list).size(),
                noun,
                fmt::join(broken, ", ")
            );
    }
    return {};
}

Status writeReport(const json& results, const std::filesystem::path& folder) {
    SHUTTER_TRY(writeJson(results, folder / kResultsFile));
    return checkReportPageCanBeMade() ? writeReportPage(results, folder) : Status();
}

Status runSuite(gpu::Device& device, const RunOptions& options, const StopQuestion& stop) {
    return BenchRun(device, options, stop).run();
}

} // namespace shutter::bench
