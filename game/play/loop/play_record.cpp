// SPDX-License-Identifier: MIT
#include "game/play/loop/play_record.h"

#include "engine/json/json_file.h"
#include "engine/math/statistics.h"
#include "game/play/panel/panel_sections.h"

#include <nlohmann/json.hpp>

namespace shutter::game {

namespace {

constexpr double kRecentMilliseconds = 1000.0;

/// Adds `"name": {"median", "q1", "q3"}` unless there are no values.
void addQuartiles(
    nlohmann::ordered_json& record, const char* name, const std::vector<double>& values
) {
    if (values.empty())
        return;
    const math::Quartiles quartiles = math::computeQuartiles(values);
    nlohmann::ordered_json& described = record[name];
    described["median"] = quartiles.median;
    described["q1"] = quartiles.q1;
    described["q3"] = quartiles.q3;
}

} // namespace

void PlayRecord::addFrame(double wallSeconds) {
    const double milliseconds = wallSeconds * 1e3;
    mMilliseconds.push_back(milliseconds);
    mRecent.push_back(milliseconds);
    mRecentSum += milliseconds;
    while (mRecent.size() > 1 && mRecentSum - mRecent.front() >= kRecentMilliseconds) {
        mRecentSum -= mRecent.front();
        mRecent.pop_front();
    }
}

void PlayRecord::addStatistics(const render::FrameStatistics& statistics) {
    const auto found = statistics.measures.find("blur ms");
    mBlurMilliseconds.push_back(found == statistics.measures.end() ? 0.0 : found->second);
    mPasses.clear();
    std::map<std::string, double> times;
    for (const render::PassTime& pass : statistics.passes) {
        ++mPasses[pass.name];
        times[pass.name] += pass.gpuMilliseconds;
    }
    for (const auto& [name, milliseconds] : times)
        mPassMilliseconds[name].push_back(milliseconds);
    mReducedFrames += isReduced(statistics);
    mStandInFrames += isDrawnByStandIn(statistics);
}

double PlayRecord::meanMilliseconds() const {
    return mRecent.empty() ? 0.0 : mRecentSum / double(mRecent.size());
}

core::Status PlayRecord::write(const std::filesystem::path& path, const SessionFacts& facts) const {
    nlohmann::ordered_json record;
    record["title"] = facts.title;
    record["device"] = facts.device;
    record["method"] = facts.method;
    record["width"] = facts.size.x;
    record["height"] = facts.size.y;
    record["frames"] = mPictureCount;
    record["startSeconds"] = mStartSeconds;
    addQuartiles(record, "frameMilliseconds", mMilliseconds);
    addQuartiles(record, "blurMilliseconds", mBlurMilliseconds);
    record["passes"] = mPasses;
    nlohmann::ordered_json& passTimes = record["passMilliseconds"] =
        nlohmann::ordered_json::object();
    for (const auto& [name, milliseconds] : mPassMilliseconds)
        passTimes[name] = math::computeQuartiles(milliseconds).median;
    record["reducedFrames"] = mReducedFrames;
    record["standInFrames"] = mStandInFrames;
    if (facts.score) {
        record["score"] = *facts.score;
        record["isOver"] = facts.isOver;
    }
    if (mFirstAllocations)
        record["allocationsAfterFirstSecond"] = mLastAllocations - *mFirstAllocations;
    record["validationMessages"] = facts.validationMessages;
    return json::writeJsonFile(path, record);
}

} // namespace shutter::game
