// SPDX-License-Identifier: MIT
#include "game/film/film_plan.h"

#include "engine/core/check.h"
#include "engine/json/json_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace shutter::film {

namespace {

constexpr int64_t kVersion = 1;
constexpr size_t kMaxWords = 4096;
/// As many as `shutter render` draws.
constexpr int64_t kMaxFrames = 1'000'000;

} // namespace

std::vector<FilmPart> splitIntoParts(std::span<const double> costs, uint32_t parts) {
    SHUTTER_CHECK(!costs.empty() && parts > 0, "{} frames, {} parts", costs.size(), parts);
    const auto frames = uint32_t(costs.size());
    const uint32_t count = std::min(parts, frames);
    double total = std::accumulate(costs.begin(), costs.end(), 0.0);
    const bool isFree = !(total > 0.0); // all frames count the same
    if (isFree)
        total = frames;
    std::vector<FilmPart> split;
    double sum = 0.0;
    uint32_t frame = 0;
    for (uint32_t part = 0; part < count; ++part) {
        const uint32_t first = frame;
        const double share = total * (part + 1) / count;
        const uint32_t end =
            frames - (count - part - 1); // a frame stays for each part that follows
        do {
            sum += isFree ? 1.0 : costs[frame];
            ++frame;
            // The next frame comes along where that ends nearer to the share.
        } while (frame < end &&
                 (part + 1 == count || sum + (isFree ? 1.0 : costs[frame]) / 2.0 <= share));
        split.push_back({first, frame - first});
    }
    return split;
}

std::vector<double>
interpolateCosts(std::span<const std::pair<uint32_t, double>> samples, uint32_t frameCount) {
    SHUTTER_CHECK(!samples.empty(), "no cost was measured");
    std::vector<double> costs(frameCount);
    size_t next = 0;
    for (uint32_t frame = 0; frame < frameCount; ++frame) {
        while (next < samples.size() && samples[next].first < frame)
            ++next;
        if (next == samples.size())
            costs[frame] = samples.back().second;
        else if (next == 0 || samples[next].first == frame)
            costs[frame] = samples[next].second;
        else {
            const auto& [before, costBefore] = samples[next - 1];
            const auto& [after, costAfter] = samples[next];
            costs[frame] =
                costBefore + (costAfter - costBefore) * (frame - before) / (after - before);
        }
    }
    return costs;
}

core::Status writePlan(const std::filesystem::path& file, const FilmPlan& plan) {
    nlohmann::ordered_json root;
    root["version"] = kVersion;
    root["fingerprint"] = plan.fingerprint;
    root["folder"] = plan.folder.string();
    root["options"] = plan.words;
    nlohmann::ordered_json& parts = root["parts"] = nlohmann::ordered_json::array();
    for (const FilmPart& part : plan.parts) {
        nlohmann::ordered_json& row = parts.emplace_back();
        row["first"] = part.first;
        row["count"] = part.count;
    }
    return json::writeJsonFile(file, root);
}

core::Result<FilmPlan> readPlan(const std::filesystem::path& file) {
    return json::readJsonFile(file, [](const json::JsonNode& root) {
        FilmPlan plan;
        const auto object =
            root.readObject({"version", "fingerprint", "folder", "options", "parts"});
        (void)object.require("version").readInteger(kVersion, kVersion);
        plan.fingerprint = object.require("fingerprint").readString();
        plan.folder = object.require("folder").readString();
        for (const json::JsonNode& word : object.require("options").readArray(1, kMaxWords))
            plan.words.push_back(word.readString());
        for (const json::JsonNode& node : object.require("parts").readArray(1, kMaxParts)) {
            const auto row = node.readObject({"first", "count"});
            const json::JsonNode first = row.require("first");
            const auto next = plan.frameCount();
            if (first.readInteger(0, kMaxFrames) != next)
                first.fail("must follow the part before, at {}", next);
            plan.parts.push_back({next, uint32_t(row.require("count").readInteger(1, kMaxFrames))});
        }
        return plan;
    });
}

} // namespace shutter::film
