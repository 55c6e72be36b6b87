// SPDX-License-Identifier: MIT
// Settings as JSON. settings.schema.json describes the same.
#include "engine/json/json_file.h"
#include "engine/scene/shutter.h"
#include "game/play/play_rows.h"
#include "game/play/play_settings.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::game {

namespace {

using core::Status;
using nlohmann::ordered_json;
using scene::ShutterResponse;

constexpr int64_t kVersion = 1;

template <class Owner> using Rows = std::span<const core::SettingRow<Owner>>;

template <class Owner>
void readNumber(json::JsonNode node, const core::SettingRow<Owner>& row, Owner& owner) {
    const core::NumberRange& range = row.range;
    if (range.isUnlimited && node.isString()) {
        (void)node.readWord(std::span(&core::kUnlimited, 1));
        setNumber(row, owner, std::numeric_limits<double>::infinity());
        return;
    }
    const double number =
        range.step != 0.0 ? double(node.readInteger(int64_t(range.lowest), int64_t(range.highest)))
                          : node.readNumber({range.lowest, range.highest});
    if (!setNumber(row, owner, number))
        node.fail("must be {}, not {}", describeRange(range, row.unit), number);
}

template <class Owner>
void readRow(const json::JsonNode& node, const core::SettingRow<Owner>& row, Owner& owner) {
    if (const auto* yes = std::get_if<bool Owner::*>(&row.field))
        owner.** yes = node.readBoolean();
    else if (const auto* words = std::get_if<core::WordField<Owner>>(&row.field))
        words->set(owner, node.readWord(words->words));
    else
        readNumber(node, row, owner);
}

/// The object with the rows' fields, which are read, and those named `more`, which are not.
template <class Owner>
json::JsonObject readRows(
    const json::JsonNode& node,
    Rows<Owner> rows,
    Owner& owner,
    std::vector<std::string_view> more = {}
) {
    std::vector<std::string_view> names = std::move(more);
    for (const core::SettingRow<Owner>& row : rows)
        names.push_back(row.name);
    const json::JsonObject object = node.readObject(std::span<const std::string_view>(names));
    for (const core::SettingRow<Owner>& row : rows)
        if (const auto value = object.find(row.name))
            readRow(*value, row, owner);
    return object;
}

void readResponse(const json::JsonNode& node, ShutterResponse& response) {
    const json::JsonObject object = readRows(node, listResponseRows(), response, {"samples"});
    if (const auto samples = object.find("samples")) {
        response.samples.clear();
        for (const json::JsonNode& sample : samples->readArray(0, shader::kMaxResponseKnots))
            response.samples.push_back(sample.readNumber({.min = 0.0}));
    }
    if (Status valid = scene::validateResponse(response); !valid)
        node.fail(valid.error().message);
}

void readShutter(const json::JsonNode& node, scene::CameraShutter& shutter) {
    const json::JsonObject object =
        readRows(node, listShutterRows(), shutter, {"response", "cuts"});
    if (const auto response = object.find("response"))
        readResponse(*response, shutter.response);
    if (const auto cuts = object.find("cuts"))
        readRows(*cuts, listCutRows(), shutter.cuts);
}

void readMethod(const json::JsonObject& object, std::string_view field, std::string& method) {
    const auto node = object.find(field);
    if (!node)
        return;
    std::vector<std::string_view> names;
    for (const MethodInfo& info : listMethods())
        names.push_back(info.name);
    method = names[node->readWord(names)];
}

PlaySettings readSettings(const json::JsonNode& root) {
    PlaySettings settings;
    const json::JsonObject object = readRows(
        root,
        listPlayRows(),
        settings,
        {"version", "method", "leftMethod", "view", "budget", "blur", "shutter"}
    );
    (void)object.require("version").readInteger(kVersion, kVersion);
    readMethod(object, "method", settings.method);
    readMethod(object, "leftMethod", settings.leftMethod);
    if (const auto view = object.find("view"))
        settings.view = view->readString(kMaxViewBytes);
    if (const auto budget = object.find("budget"))
        readRows(*budget, listBudgetRows(), settings.budget);
    if (const auto blur = object.find("blur"))
        readRows(*blur, motion_blur::listSettingRows(), settings.blur);
    if (const auto shutter = object.find("shutter"))
        readShutter(*shutter, settings.shutter);
    return settings;
}

/// Adds a field for every row. Infinity, which JSON cannot hold, is a word.
template <class Owner> void addRows(ordered_json& object, Rows<Owner> rows, const Owner& owner) {
    for (const core::SettingRow<Owner>& row : rows) {
        ordered_json& field = object[std::string(row.name)];
        if (const auto* yes = std::get_if<bool Owner::*>(&row.field))
            field = owner.**yes;
        else if (std::holds_alternative<core::WordField<Owner>>(row.field))
            field = describeValue(row, owner);
        else if (const double number = getNumber(row, owner); std::isinf(number))
            field = core::kUnlimited;
        else if (row.range.step != 0.0)
            field = int64_t(number); // 16, not 16.0
        else
            field = number;
    }
}

ordered_json describe(const PlaySettings& settings) {
    const scene::CameraShutter& shutter = settings.shutter;
    ordered_json described;
    described["version"] = kVersion;
    described["method"] = settings.method;
    described["leftMethod"] = settings.leftMethod;
    described["view"] = settings.view;
    addRows(described, listPlayRows(), settings);
    addRows(described["budget"], listBudgetRows(), settings.budget);
    addRows(described["blur"], motion_blur::listSettingRows(), settings.blur);
    ordered_json& shutterObject = described["shutter"];
    addRows(shutterObject, listShutterRows(), shutter);
    ordered_json& response = shutterObject["response"];
    addRows(response, listResponseRows(), shutter.response);
    response["samples"] = shutter.response.samples;
    addRows(shutterObject["cuts"], listCutRows(), shutter.cuts);
    return described;
}

} // namespace

core::Result<PlaySettings> loadPlaySettings(const std::filesystem::path& path) {
    return json::readJsonFile(path, readSettings);
}

core::Status savePlaySettings(const std::filesystem::path& path, const PlaySettings& settings) {
    if (Status valid = validate(settings); !valid)
        return core::makeError("{} is not written: {}", path.string(), valid.error().message);
    return json::writeJsonFile(path, describe(settings));
}

} // namespace shutter::game
