// SPDX-License-Identifier: MIT
// Private to engine/json: what a JSON file says, with the line of each value.
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

/// Of an object's field, of an array's element, or of the whole.
struct JsonValue {
    JsonKind kind = JsonKind::Null;
    bool truth = false;
    uint32_t line = 1; ///< where the value begins
    uint32_t parent = 0;
    uint32_t place = 0; ///< among the parent's
    double number = 0.0;
    std::string key;  ///< of an object's field
    std::string text; ///< of a string
    std::vector<uint32_t> children;
};

/// Values in the order of the file; the first is the whole.
struct JsonTree {
    static constexpr uint32_t kAbsent = UINT32_MAX;

    std::string name; ///< of the file, for errors
    std::vector<JsonValue> values;
    std::string error; ///< the first; empty: none

    /// "keys[3].time"; empty for the whole.
    [[nodiscard]] std::string describePath(uint32_t index) const;
};

/// Text from a file, as short as a line of the terminal bears.
[[nodiscard]] std::string quoteJsonText(std::string_view text);

[[nodiscard]] core::Result<std::unique_ptr<JsonTree>>
parseJsonTree(std::string_view text, std::string name, const JsonLimits& limits);

} // namespace shutter::json
