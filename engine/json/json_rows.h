// SPDX-License-Identifier: MIT
// Settings that are described by rows, read from JSON.
#pragma once

#include "engine/core/setting_row.h"
#include "engine/json/json_file.h"

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace shutter::json {

template <class Owner>
void readNumber(JsonNode node, const core::SettingRow<Owner>& row, Owner& owner) {
    const core::NumberRange& range = row.range;
    if (range.isUnlimited && node.isString()) {
        (void)node.readWord(std::span(&core::kUnlimited, 1));
        setNumber(row, owner, std::numeric_limits<double>::infinity());
        return;
    }
    const double number =
        range.step != 0.0 ? double(node.readInteger(int64_t(range.lowest), int64_t(range.highest)))
                          : node.readNumber({range.lowest, range.highest, !range.isLowestValid});
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
    for (const core::SettingRow<Owner>& row : rows)
        if (const auto value = object.find(row.name))
            readRow(*value, row, owner);
    return object;
}

} // namespace shutter::json
