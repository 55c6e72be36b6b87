// SPDX-License-Identifier: MIT
// Settings as JSON. settings.schema.json describes the same.
#include "engine/io/json_rows.h"
#include "engine/scene/shutter.h"
#include "engine/scene/shutter_rows.h"
#include "game/play/panel/play_rows.h"
#include "game/play/panel/play_settings.h"
#include "modules/motion_blur/setting_rows.h"

#include <string_view>
#include <vector>

namespace shutter::game {

namespace {

using core::Status;
using scene::ShutterResponse;

constexpr int64_t kVersion = 1;

void readResponse(const io::JsonNode& node, ShutterResponse& response) {
    const io::JsonObject object =
        io::readRows(node, scene::listResponseRows(), response, {"samples"});
    if (const auto samples = object.find("samples")) {
        response.samples.clear();
        for (const io::JsonNode& sample : samples->readArray(0, shader::kMaxResponseKnots))
            response.samples.push_back(sample.readNumber({.min = 0.0}));
    }
    if (Status valid = scene::validateResponse(response); !valid)
        node.fail(valid.error().message);
}

void readShutter(const io::JsonNode& node, scene::CameraShutter& shutter) {
    const io::JsonObject object =
        io::readRows(node, scene::listShutterRows(), shutter, {"response", "cuts"});
    if (const auto response = object.find("response"))
        readResponse(*response, shutter.response);
    if (const auto cuts = object.find("cuts"))
        io::readRows(*cuts, scene::listCutRows(), shutter.cuts);
}

void readMethod(const io::JsonObject& object, std::string_view field, std::string& method) {
    const auto node = object.find(field);
    if (!node)
        return;
    std::vector<std::string_view> names;
    for (const MethodInfo& info : listMethods())
        names.push_back(info.name);
    method = names[node->readWord(names)];
}

PlaySettings readSettings(const io::JsonNode& root) {
    PlaySettings settings;
    const io::JsonObject object = io::readRows(
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
        io::readRows(*budget, motion_blur::listBudgetRows(), settings.budget);
    if (const auto blur = object.find("blur"))
        io::readRows(*blur, motion_blur::listSettingRows(), settings.blur);
    if (const auto shutter = object.find("shutter"))
        readShutter(*shutter, settings.shutter);
    return settings;
}

template <class Owner>
void writeRows(io::JsonWriter& json, core::SettingRows<Owner> rows, const Owner& owner) {
    for (const core::SettingRow<Owner>& row : rows) {
        json.key(row.name);
        if (const auto* yes = std::get_if<bool Owner::*>(&row.field))
            json.value(owner.**yes);
        else if (std::holds_alternative<core::WordField<Owner>>(row.field))
            json.value(describeValue(row, owner));
        else if (const double number = getNumber(row, owner); std::isinf(number))
            json.value(core::kUnlimited);
        else
            json.value(number);
    }
}

io::JsonWriter describe(const PlaySettings& settings) {
    const scene::CameraShutter& shutter = settings.shutter;
    io::JsonWriter json;
    json.beginObject().key("version").integer(kVersion);
    json.key("method").value(settings.method);
    json.key("leftMethod").value(settings.leftMethod);
    json.key("view").value(settings.view);
    writeRows(json, listPlayRows(), settings);
    json.key("budget").beginObject();
    writeRows(json, motion_blur::listBudgetRows(), settings.budget);
    json.endObject().key("blur").beginObject();
    writeRows(json, motion_blur::listSettingRows(), settings.blur);
    json.endObject().key("shutter").beginObject();
    writeRows(json, scene::listShutterRows(), shutter);
    json.key("response").beginObject();
    writeRows(json, scene::listResponseRows(), shutter.response);
    json.key("samples").numbers(shutter.response.samples);
    json.endObject().key("cuts").beginObject();
    writeRows(json, scene::listCutRows(), shutter.cuts);
    json.endObject().endObject().endObject();
    return json;
}

} // namespace

core::Result<PlaySettings> loadPlaySettings(const std::filesystem::path& path) {
    return io::readJsonFile(path, readSettings);
}

core::Status savePlaySettings(const std::filesystem::path& path, const PlaySettings& settings) {
    if (Status valid = validate(settings); !valid)
        return core::makeError("{} is not written: {}", path.string(), valid.error().message);
    return io::writeJsonFile(path, describe(settings));
}

} // namespace shutter::game
