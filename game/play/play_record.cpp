// SPDX-License-Identifier: MIT
#include "game/play/play_record.h"

#include "engine/json/json_file.h"
#include "game/quartiles.h"

namespace shutter::game {

namespace {

constexpr double kRecentMilliseconds = 1000.0;

/// `"name": {"median", "q1", "q3"}`, where there are values.
void writeQuartiles(json::JsonWriter& json, const char* name, const std::vector<double>& values) {
    if (values.empty())
        return;
    const Quartiles quartiles = computeQuartiles(values);
    json.key(name).beginObject();
    json.key("median").value(quartiles.median);
    json.key("q1").value(quartiles.q1);
    json.key("q3").value(quartiles.q3);
    json.endObject();
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
}

double PlayRecord::meanMilliseconds() const {
    return mRecent.empty() ? 0.0 : mRecentSum / double(mRecent.size());
}

core::Status PlayRecord::write(const std::filesystem::path& path, const SessionFacts& facts) const {
    json::JsonWriter json;
    json.beginObject();
    json.key("title").value(facts.title);
    json.key("device").value(facts.device);
    json.key("method").value(facts.method);
    json.key("width").integer(facts.size.x);
    json.key("height").integer(facts.size.y);
    json.key("frames").integer(mPictureCount);
    json.key("startSeconds").value(mStartSeconds);
    writeQuartiles(json, "frameMilliseconds", mMilliseconds);
    writeQuartiles(json, "blurMilliseconds", mBlurMilliseconds);
    if (facts.score) {
        json.key("score").integer(*facts.score);
        json.key("isOver").value(facts.isOver);
    }
    json.key("validationMessages").integer(facts.validationMessages);
    json.endObject();
    return json::writeJsonFile(path, json);
}

} // namespace shutter::game
