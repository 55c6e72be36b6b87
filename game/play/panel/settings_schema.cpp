// SPDX-License-Identifier: MIT
// The JSON schema of the settings file, made of the rows that read and write it.
#include "engine/core/setting_row.h"
#include "engine/scene/lens.h"
#include "engine/scene/shutter.h"
#include "game/play/panel/play_settings.h"
#include "modules/motion_blur/budget.h"
#include "modules/motion_blur/settings.h"
#include "shaders/common/shutter_response_shared.h"

#include <nlohmann/json.hpp>

#include <string>

namespace shutter::game {

namespace {

using nlohmann::ordered_json;

ordered_json describeNumber(const core::NumberRange& range) {
    // Whole numbers in steps are listed: a schema's multipleOf counts from 0, not from the lowest.
    if (range.step > 1.0) {
        ordered_json values = ordered_json::array();
        for (double value = range.lowest; value <= range.highest; value += range.step)
            values.push_back(int64_t(value));
        return {{"enum", values}};
    }
    ordered_json number;
    number["type"] = range.step == 1.0 ? "integer" : "number";
    number[range.isLowestValid ? "minimum" : "exclusiveMinimum"] = range.lowest;
    number["maximum"] = range.highest;
    if (range.isRate)
        return {
            {"anyOf", {{{"type", "string"}, {"pattern", "^[0-9]{1,10}/[0-9]{1,10}$"}}, number}}};
    if (!range.isUnlimited)
        return number;
    return {{"anyOf", {{{"const", core::kUnlimited}}, number}}};
}

template <class Owner> ordered_json describeRow(const core::SettingRow<Owner>& row) {
    ordered_json field;
    if (std::holds_alternative<bool Owner::*>(row.field))
        field["type"] = "boolean";
    else if (const auto* words = std::get_if<core::WordField<Owner>>(&row.field))
        field["enum"] = words->words;
    else
        field = describeNumber(row.range);
    field["description"] = row.meaning;
    return field;
}

template <class Owner> void addRows(ordered_json& object, core::SettingRows<Owner> rows) {
    for (const core::SettingRow<Owner>& row : rows)
        object["properties"][row.name] = describeRow(row);
}

template <class Owner> ordered_json describeObject(core::SettingRows<Owner> rows) {
    ordered_json object;
    object["type"] = "object";
    object["additionalProperties"] = false;
    addRows(object, rows);
    return object;
}

ordered_json describeShutter() {
    ordered_json shutter = describeObject(scene::listShutterRows());
    ordered_json response = describeObject(scene::listResponseRows());
    response["properties"]["samples"] = {
        {"type", "array"},
        {"maxItems", shader::kMaxResponseKnots},
        {"items", {{"type", "number"}, {"minimum", 0}}},
        {"description", "Shape samples: sensitivity at equal distances from open to close."}};
    shutter["properties"]["response"] = response;
    shutter["properties"]["cuts"] = describeObject(scene::listCutRows());
    return shutter;
}

} // namespace

std::string makeSettingsSchema() {
    ordered_json methods = ordered_json::array();
    for (const MethodInfo& method : listMethods())
        methods.push_back(method.name);
    ordered_json schema;
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema";
    schema["title"] = "Settings of shutter play, version 1";
    schema["description"] = "Fields that are left out keep their defaults.";
    schema["type"] = "object";
    schema["required"] = {"version"};
    schema["additionalProperties"] = false;
    ordered_json& properties = schema["properties"];
    properties["version"]["const"] = 1;
    for (const char* field : {"method", "leftMethod"})
        properties[field]["enum"] = methods;
    properties["view"] = {{"type", "string"}, {"maxLength", kMaxViewBytes}};
    addRows(schema, listPlayRows());
    visitPictureRows([&](auto rows, const auto&) { addRows(schema, rows); });
    properties["budget"] = describeObject(motion_blur::listBudgetRows());
    properties["blur"] = describeObject(motion_blur::listSettingRows());
    properties["shutter"] = describeShutter();
    properties["lens"] = describeObject(scene::listOverrideRows());
    return schema.dump(2);
}

} // namespace shutter::game
