// SPDX-License-Identifier: MIT
#include "game/bench/report/shown_pictures.h"

#include <nlohmann/json.hpp>

#include <array>
#include <limits>
#include <utility>

namespace shutter::bench {

namespace {

using nlohmann::json;
using Crops = std::vector<PictureRegion>;

/// Every string under "image" or "errorMap", at any depth. Rows at equal time show less.
void collectWhole(const json& value, std::set<std::string>& paths) {
    if (value.is_object()) {
        for (const auto& [key, member] : value.items()) {
            if (member.is_string() && (key == "image" || key == "errorMap"))
                paths.insert(member.get<std::string>());
            else if (key != "equalTime")
                collectWhole(member, paths);
        }
    } else if (value.is_array()) {
        for (const json& member : value)
            collectWhole(member, paths);
    }
}

/// The text under `key`; empty where there is none.
std::string findText(const json& value, const char* key) {
    const auto found = value.is_object() ? value.find(key) : value.end();
    return found != value.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// The elements under `key`; none where that is no array.
const json& findArray(const json& value, const char* key) {
    static const json kNone = json::array();
    const auto found = value.is_object() ? value.find(key) : value.end();
    return found != value.end() && found->is_array() ? *found : kNone;
}

core::Result<PictureRegion> readCrop(const json& crop, const std::string& caseName) {
    constexpr std::array<const char*, 4> kFields = {"x", "y", "width", "height"};
    std::array<uint32_t, kFields.size()> values{};
    for (size_t i = 0; i < kFields.size(); ++i) {
        const auto found = crop.is_object() ? crop.find(kFields[i]) : crop.end();
        const double least = i < 2 ? 0.0 : 1.0;
        const bool isNumber = found != crop.end() && found->is_number_integer();
        const double value = isNumber ? found->get<double>() : -1.0;
        const bool isCount = value >= least && value <= std::numeric_limits<uint32_t>::max();
        if (!isCount)
            return core::makeError(
                "a crop of the case '{}' has no '{}' of {} or more", caseName, kFields[i], least
            );
        values[i] = uint32_t(value);
    }
    return PictureRegion{values[0], values[1], values[2], values[3]};
}

core::Result<Crops> readCrops(const json& theCase) {
    Crops crops;
    for (const json& one : findArray(theCase, "crops")) {
        const auto crop = readCrop(one, findText(theCase, "name"));
        if (!crop)
            return crop.error();
        crops.push_back(crop.value());
    }
    return crops;
}

void addCrops(const json& value, const Crops& crops, ShownPictures& shown) {
    if (const std::string path = findText(value, "image"); !path.empty() && !crops.empty())
        shown.crops[path] = crops;
}

} // namespace

core::Result<ShownPictures> findShownPictures(const json& results) {
    ShownPictures shown;
    collectWhole(results, shown.whole);
    std::map<std::string, Crops> cropsByCase;
    for (const json& theCase : findArray(results, "cases")) {
        auto crops = readCrops(theCase);
        if (!crops)
            return crops.error();
        if (theCase.is_object() && theCase.contains("truth"))
            addCrops(theCase.at("truth"), crops.value(), shown);
        for (const json& measurement : findArray(theCase, "measurements"))
            addCrops(measurement, crops.value(), shown);
        cropsByCase[findText(theCase, "name")] = std::move(crops.value());
    }
    for (const json& entry : findArray(results, "equalTime")) {
        const Crops& crops = cropsByCase[findText(entry, "case")];
        for (const json& row : findArray(entry, "rows")) {
            const std::string path = findText(row, "image");
            if (!path.empty() && !crops.empty() && !shown.whole.contains(path))
                shown.crops[path] = {crops.front()};
        }
    }
    return shown;
}

} // namespace shutter::bench
