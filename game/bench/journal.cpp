// SPDX-License-Identifier: MIT
#include "game/bench/journal.h"

#include "engine/core/log.h"
#include "engine/io/file_bytes.h"
#include "engine/io/uri.h"
#include "engine/json/json_file.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

namespace shutter::bench {

namespace {

/// JSON has no infinity: null is written instead.
nlohmann::json packMetric(double value) {
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json();
}

nlohmann::json packRecord(const Record& record) {
    auto samples = nlohmann::json::array();
    for (const Sample& sample : record.samples) {
        auto passes = nlohmann::json::array();
        for (const PassSample& pass : sample.passes)
            passes.push_back({pass.name, pass.milliseconds, render::describe(pass.owner)});
        samples.push_back({{"passes", passes}, {"wall", sample.wallMilliseconds}});
    }
    nlohmann::json packed = {{"samples", samples}, {"skipped", record.skipped}};
    if (record.hasPicture) {
        auto metrics = nlohmann::json::object();
        for (const auto& [id, value] : record.picture.metrics)
            metrics[id] = packMetric(value);
        packed["picture"] = {
            {"metrics", metrics},
            {"image", record.picture.image},
            {"errorMap", record.picture.errorMap},
            {"counters", record.picture.counters}};
        if (!record.picture.linear.empty())
            packed["picture"]["linear"] = record.picture.linear;
    }
    return packed;
}

double readMetric(const json::JsonNode& node) {
    return node.isNull() ? std::numeric_limits<double>::infinity() : node.readNumber();
}

render::PassOwner readOwner(const json::JsonNode& node) {
    using Owner = render::PassOwner;
    constexpr std::array kOwners = {
        Owner::Scene, Owner::Rays, Owner::Blur, Owner::Other, Owner::Display};
    std::array<std::string_view, kOwners.size()> words;
    for (size_t i = 0; i < kOwners.size(); ++i)
        words[i] = render::describe(kOwners[i]);
    return kOwners[node.readWord(words)];
}

Sample readSample(const json::JsonNode& node) {
    const json::JsonObject object = node.readObject({"passes", "wall"});
    Sample sample;
    sample.wallMilliseconds = object.require("wall").readNumber();
    for (const json::JsonNode& pass : object.require("passes").readArray()) {
        const std::vector<json::JsonNode> parts = pass.readArray(3, 3);
        if (parts.size() == 3)
            sample.passes.push_back(
                {parts[0].readString(), parts[1].readNumber(), readOwner(parts[2])}
            );
    }
    return sample;
}

/// A picture that the journal names, which is read again: in the report's folder or below.
std::string readPicturePath(const json::JsonNode& node, const std::filesystem::path& folder) {
    std::string path = node.readString();
    if (!io::liesInside(folder, path))
        node.fail("'{}' leaves the report's folder", path);
    return path;
}

PictureFacts readPicture(const json::JsonNode& node, const std::filesystem::path& folder) {
    const json::JsonObject object =
        node.readObject({"metrics", "image", "errorMap", "linear", "counters"});
    PictureFacts picture;
    for (const auto& [id, value] : object.require("metrics").readFields())
        picture.metrics[id] = readMetric(value);
    picture.image = readPicturePath(object.require("image"), folder);
    picture.errorMap = readPicturePath(object.require("errorMap"), folder);
    if (const auto linear = object.find("linear"))
        picture.linear = readPicturePath(*linear, folder);
    for (const auto& [name, value] : object.require("counters").readFields())
        picture.counters[name] = uint64_t(value.readInteger(0));
    return picture;
}

Record readRecord(const json::JsonNode& node, const std::filesystem::path& folder) {
    const json::JsonObject object = node.readObject({"samples", "skipped", "picture"});
    Record record;
    for (const json::JsonNode& sample : object.require("samples").readArray())
        record.samples.push_back(readSample(sample));
    record.skipped = object.require("skipped").readString();
    if (const auto picture = object.find("picture")) {
        record.hasPicture = true;
        record.picture = readPicture(*picture, folder);
    }
    return record;
}

/// The records of the journal; nothing where it has another fingerprint. Error: it is no journal.
core::Result<std::optional<std::map<std::string, Record>>>
readRecords(const std::filesystem::path& file, const std::string& fingerprint) {
    using Records = std::map<std::string, Record>;
    constexpr json::JsonLimits kLimits{.maxDepth = 8, .maxValues = 5'000'000};
    const auto document = json::JsonDocument::load(file, kLimits);
    if (!document)
        return document.error();
    const json::JsonObject root = document.value().root().readObject({"fingerprint", "records"});
    const std::string found = root.require("fingerprint").readString();
    // In a subfolder of the report's folder.
    const std::filesystem::path folder = file.parent_path() / "..";
    Records records;
    if (found == fingerprint)
        for (const auto& [key, record] : root.require("records").readFields())
            records[key] = readRecord(record, folder);
    SHUTTER_TRY(document.value().finish());
    return found == fingerprint ? std::optional(std::move(records)) : std::nullopt;
}

} // namespace

Journal::Journal(std::filesystem::path file, std::string fingerprint)
    : mFile(std::move(file)), mFingerprint(std::move(fingerprint)) {
    std::error_code ignored;
    if (!std::filesystem::exists(mFile, ignored))
        return;
    auto records = readRecords(mFile, mFingerprint);
    if (!records)
        core::logWarning("{}; measured again", records.error().message);
    else if (!records.value())
        core::logInfo("{}: measured with other settings, measured again", mFile.string());
    else
        mRecords = std::move(*records.value());
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

core::Status Journal::setRecords(std::map<std::string, Record> records) {
    for (auto& [key, record] : records)
        mRecords[key] = std::move(record);
    return save();
}

core::Status Journal::save() const {
    auto records = nlohmann::json::object();
    for (const auto& [key, record] : mRecords)
        records[key] = packRecord(record);
    const nlohmann::json root = {{"fingerprint", mFingerprint}, {"records", records}};
    return io::writeFileText(mFile, root.dump(1) + "\n");
}

} // namespace shutter::bench
