// SPDX-License-Identifier: MIT
// Private to engine/json: the values of a JSON file, each with its line.
#pragma once

#include "engine/core/result.h"
#include "engine/json/json_file.h"

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace shutter::json {

enum class JsonKind : uint8_t { Null, Boolean, Number, String, Array, Object };

/// The value of an object's field, of an array's element, or of the whole file.
struct JsonValue {
    JsonKind kind = JsonKind::Null;
    bool truth = false;
    uint32_t line = 1; ///< where the value begins
    uint32_t parent = 0;
    uint32_t place = 0; ///< index among the parent's children
    double number = 0.0;
    std::string key;  ///< the field's name, if the parent is an object
    std::string text; ///< the value of a string
    std::vector<uint32_t> children;
};

/// Values in the order of the file; the first is the root.
struct JsonTree {
    static constexpr uint32_t kAbsent = UINT32_MAX;

    std::string name; ///< the file's name, for errors
    std::vector<JsonValue> values;
    std::string error; ///< the first error, or empty

    /// "keys[3].time"; empty for the root.
    [[nodiscard]] std::string describePath(uint32_t index) const;
};

/// Shortens text from a file so that it fits into a message.
[[nodiscard]] std::string quoteJsonText(std::string_view text);

[[nodiscard]] core::Result<std::unique_ptr<JsonTree>>
parseJsonTree(std::string_view text, std::string name, const JsonLimits& limits);

} // namespace shutter::json
