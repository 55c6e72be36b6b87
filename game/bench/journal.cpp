// SPDX-License-Identifier: MIT
#include "game/bench/journal.h"

#include "engine/core/log.h"
#include "engine/io/file_bytes.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <limits>

namespace shutter::bench {

namespace {

using nlohmann::json;

/// JSON has no infinity: null is written instead.
json packMetric(double value) {
    return std::isfinite(value) ? json(value) : json();
}

double unpackMetric(const json& value) {
    return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

json packRecord(const Record& record) {
    json samples = json::array();
    for (const Sample& sample : record.samples) {
        json passes = json::array();
        for (const PassSample& pass : sample.passes)
            passes.push_back({pass.name, pass.milliseconds, render::describe(pass.owner)});
        samples.push_back({{"passes", passes}, {"wall", sample.wallMilliseconds}});
    }
    json packed = {{"samples", samples}, {"skipped", record.skipped}};
    if (record.hasPicture) {
        json metrics = json::object();
        for (const auto& [id, value] : record.picture.metrics)
            metrics[id] = packMetric(value);
        packed["picture"] = {
            {"metrics", metrics},
            {"image", record.picture.image},
            {"errorMap", record.picture.errorMap},
            {"counters", record.picture.counters}};
    }
    return packed;
}

render::PassOwner unpackOwner(const json& word) {
    using Owner = render::PassOwner;
    for (const Owner owner : {Owner::Scene, Owner::Rays, Owner::Effect})
        if (word == render::describe(owner))
            return owner;
    return Owner::Display;
}

Record unpackRecord(const json& packed) {
    Record record;
    for (const json& from : packed.at("samples")) {
        Sample sample;
        sample.wallMilliseconds = from.at("wall");
        for (const json& pass : from.at("passes"))
            sample.passes.push_back({pass.at(0), pass.at(1), unpackOwner(pass.at(2))});
        record.samples.push_back(std::move(sample));
    }
    record.skipped = packed.at("skipped");
    if (!packed.contains("picture"))
        return record;
    const json& picture = packed.at("picture");
    record.hasPicture = true;
    for (const auto& [id, value] : picture.at("metrics").items())
        record.picture.metrics[id] = unpackMetric(value);
    record.picture.image = picture.at("image");
    record.picture.errorMap = picture.at("errorMap");
    record.picture.counters = picture.at("counters");
    return record;
}

} // namespace

Journal::Journal(std::filesystem::path file, std::string fingerprint)
    : mFile(std::move(file)), mFingerprint(std::move(fingerprint)) {
    std::ifstream stream(mFile);
    if (!stream)
        return;
    try {
        const json root = json::parse(stream);
        if (root.at("fingerprint") != mFingerprint) {
            core::logInfo("{}: measured with other settings, measured anew", mFile.string());
            return;
        }
        for (const auto& [key, record] : root.at("records").items())
            mRecords[key] = unpackRecord(record);
    } catch (const json::exception&) {
        core::logWarning("{}: not a journal of this version, measured anew", mFile.string());
        mRecords.clear();
    }
}

const Record& Journal::find(const std::string& key) const {
    static const Record kNone;
    const auto found = mRecords.find(key);
    return found == mRecords.end() ? kNone : found->second;
}

core::Status Journal::addSample(const std::string& key, Sample sample) {
    Record& record = mRecords[key];
    record.skipped.clear(); // a limit that refused it once was raised
    record.samples.push_back(std::move(sample));
    return save();
}

core::Status Journal::setPicture(const std::string& key, PictureFacts picture) {
    Record& record = mRecords[key];
    record.skipped.clear();
    record.hasPicture = true;
    record.picture = std::move(picture);
    return save();
}

core::Status Journal::skip(const std::string& key, const std::string& reason) {
    mRecords[key].skipped = reason;
    return save();
}

core::Status Journal::save() const {
    json records = json::object();
    for (const auto& [key, record] : mRecords)
        records[key] = packRecord(record);
    const json root = {{"fingerprint", mFingerprint}, {"records", records}};
    return io::writeFileText(mFile, root.dump(1) + "\n");
}

} // namespace shutter::bench
