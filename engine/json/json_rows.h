// SPDX-License-Identifier: MIT
// Settings that are described by rows, read from JSON.
#pragma once

#include "engine/core/frame_rate.h"
#include "engine/core/setting_row.h"
#include "engine/json/json_file.h"

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace shutter::json {

/// Frames a second: a number of the range, or a string that is a fraction in it.
inline core::FrameRate readRate(const JsonNode& node, const JsonRange& range) {
    if (!node.isString())
        return node.readNumber(range);
    const std::string text = node.readString();
    const auto rate = core::parseFrameRate(text);
    if (rate && rate.value().perSecond() <= range.max && text.find('/') != std::string::npos)
        return rate.value();
    node.fail(
        "'{}' must be a number or a fraction such as 24000/1001, at most {}", text, range.max
    );
    return {};
}

template <class Owner>
void readNumber(JsonNode node, const core::SettingRow<Owner>& row, Owner& owner) {
    const core::NumberRange& range = row.range;
    if (range.isUnlimited && node.isString()) {
        (void)node.readWord(std::span(&core::kUnlimited, 1));
        setNumber(row, owner, std::numeric_limits<double>::infinity());
        return;
    }
    const JsonRange values{range.lowest, range.highest, !range.isLowestValid};
    const double number =
        range.step != 0.0 ? double(node.readInteger(int64_t(range.lowest), int64_t(range.highest)))
        : range.isRate    ? readRate(node, values).perSecond()
                          : node.readNumber(values);
    if (!setNumber(row, owner, number))
        node.fail("must be {}, not {}", describeRange(range, row.unit), number);
}

/// Sets the row's field. Fails (JsonNode::fail) unless the value is one that the row allows.
template <class Owner>
void readRow(const JsonNode& node, const core::SettingRow<Owner>& row, Owner& owner) {
    if (const auto* yes = std::get_if<bool Owner::*>(&row.field))
        owner.** yes = node.readBoolean();
    else if (const auto* words = std::get_if<core::WordField<Owner>>(&row.field))
        words->set(owner, node.readWord(words->words));
    else
        readNumber(node, row, owner);
}

/// Reads the rows' fields that the object has. \param object of a readObject() with their names
template <class Owner>
void readRows(const JsonObject& object, core::SettingRows<Owner> rows, Owner& owner) {
    for (const core::SettingRow<Owner>& row : rows)
        if (const auto value = object.find(row.name))
            readRow(*value, row, owner);
}

/// Reads the rows' fields that the object has. Returns the object, which may also have the fields
/// named `more`; these are not read.
template <class Owner>
JsonObject readRows(
    const JsonNode& node,
    core::SettingRows<Owner> rows,
    Owner& owner,
    std::vector<std::string_view> more = {}
) {
    std::vector<std::string_view> names = std::move(more);
    for (const core::SettingRow<Owner>& row : rows)
        names.push_back(row.name);
    const JsonObject object = node.readObject(std::span<const std::string_view>(names));
    readRows(object, rows, owner);
    return object;
}

} // namespace shutter::json
