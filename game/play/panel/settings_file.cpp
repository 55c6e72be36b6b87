// SPDX-License-Identifier: MIT
// Settings as JSON, read and written row by row.
#include "engine/json/json_rows.h"
#include "engine/scene/lens.h"
#include "engine/scene/shutter.h"
#include "game/play/panel/play_settings.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/settings.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter::game {

namespace {

using core::Status;
using nlohmann::ordered_json;
using scene::ShutterResponse;

constexpr int64_t kVersion = 1;

void readResponse(const json::JsonNode& node, ShutterResponse& response) {
    const json::JsonObject object =
        json::readRows(node, scene::listResponseRows(), response, {"samples"});
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
        json::readRows(node, scene::listShutterRows(), shutter, {"response", "cuts"});
    if (const auto response = object.find("response"))
        readResponse(*response, shutter.response);
    if (const auto cuts = object.find("cuts"))
        json::readRows(*cuts, scene::listCutRows(), shutter.cuts);
}

void readLens(const json::JsonNode& node, scene::LensOverride& lens) {
    json::readRows(node, scene::listOverrideRows(), lens);
    // Ranges begin at 0, which is the camera's own; the least value is above it.
    if (Status valid = scene::validate(lens); !valid)
        node.fail(valid.error().message);
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
    std::vector<std::string_view> fields = {
        "version", "method", "leftMethod", "view", "budget", "blur", "shutter", "lens"};
    visitPictureRows([&](auto rows, const auto&) {
        for (const auto& row : rows)
            fields.push_back(row.name);
    });
    const json::JsonObject object =
        json::readRows(root, listPlayRows(), settings, std::move(fields));
    visitPictureRows([&](auto rows, const auto& part) {
        json::readRows(object, rows, part(settings.picture));
    });
    (void)object.require("version").readInteger(kVersion, kVersion);
    readMethod(object, "method", settings.method);
    readMethod(object, "leftMethod", settings.leftMethod);
    if (const auto view = object.find("view"))
        settings.view = view->readString(kMaxViewBytes);
    if (const auto budget = object.find("budget"))
        json::readRows(*budget, motion_blur::listBudgetRows(), settings.budget);
    if (const auto blur = object.find("blur"))
        json::readRows(*blur, motion_blur::listSettingRows(), settings.blur);
    if (const auto shutter = object.find("shutter"))
        readShutter(*shutter, settings.shutter);
    if (const auto lens = object.find("lens"))
        readLens(*lens, settings.lens);
    return settings;
}

/// Adds a field for every row. Infinity, which JSON cannot hold, is a word.
template <class Owner>
void addRows(ordered_json& object, core::SettingRows<Owner> rows, const Owner& owner) {
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
    visitPictureRows([&](auto rows, const auto& part) {
        addRows(described, rows, part(settings.picture));
    });
    addRows(described["budget"], motion_blur::listBudgetRows(), settings.budget);
    addRows(described["blur"], motion_blur::listSettingRows(), settings.blur);
    ordered_json& shutterObject = described["shutter"];
    addRows(shutterObject, scene::listShutterRows(), shutter);
    ordered_json& response = shutterObject["response"];
    addRows(response, scene::listResponseRows(), shutter.response);
    response["samples"] = shutter.response.samples;
    addRows(shutterObject["cuts"], scene::listCutRows(), shutter.cuts);
    addRows(described["lens"], scene::listOverrideRows(), settings.lens);
    return described;
}

} // namespace

core::Result<PlaySettings> loadPlaySettings(const std::filesystem::path& path) {
    return json::readJsonFile(path, readSettings);
}

std::string formatPlaySettings(const PlaySettings& settings) {
    return describe(settings).dump();
}

core::Status savePlaySettings(const std::filesystem::path& path, const PlaySettings& settings) {
    if (Status valid = validate(settings); !valid)
        return core::makeError("{} is not written: {}", path.string(), valid.error().message);
    return json::writeJsonFile(path, describe(settings));
}

} // namespace shutter::game
