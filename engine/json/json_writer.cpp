// SPDX-License-Identifier: MIT
#include "engine/io/file_bytes.h"
#include "engine/json/json_file.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace shutter::json {

namespace {

/// fmt's shortest that reads back the same.
std::string formatNumber(double number) {
    SHUTTER_CHECK(std::isfinite(number), "JSON has no {}", number);
    if (number == 0.0 && std::signbit(number))
        return "-0.0"; // parsers take -0 for a whole number, which has no sign
    return fmt::format("{}", number);
}

/// With quotes; bytes that are no UTF-8 become U+FFFD.
std::string quote(std::string_view text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace

void JsonWriter::breakLine() {
    mText += '\n';
    mText.append(2 * mLevels.size(), ' ');
}

void JsonWriter::startValue() {
    if (mLevels.empty()) {
        SHUTTER_CHECK(mText.empty(), "a second value after the whole");
        return;
    }
    Level& level = mLevels.back();
    SHUTTER_CHECK(level.isObject == mHasKey, "a value and its key must come together");
    if (!mHasKey) {
        if (!level.isEmpty)
            mText += ',';
        breakLine();
    }
    level.isEmpty = false;
    mHasKey = false;
}

JsonWriter& JsonWriter::write(std::string_view text) {
    startValue();
    mText += text;
    return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
    SHUTTER_CHECK(
        !mLevels.empty() && mLevels.back().isObject && !mHasKey, "no place for the key {}", name
    );
    if (!mLevels.back().isEmpty)
        mText += ',';
    breakLine();
    mText += quote(name) + ": ";
    mHasKey = true;
    return *this;
}

JsonWriter& JsonWriter::beginObject() {
    write("{");
    mLevels.push_back({.isObject = true});
    return *this;
}

JsonWriter& JsonWriter::beginArray() {
    write("[");
    mLevels.push_back({.isObject = false});
    return *this;
}

JsonWriter& JsonWriter::end(bool isObject, char bracket) {
    SHUTTER_CHECK(
        !mLevels.empty() && mLevels.back().isObject == isObject && !mHasKey, "nothing to end"
    );
    const bool isEmpty = mLevels.back().isEmpty;
    mLevels.pop_back();
    if (!isEmpty)
        breakLine();
    mText += bracket;
    return *this;
}

JsonWriter& JsonWriter::endObject() {
    return end(true, '}');
}

JsonWriter& JsonWriter::endArray() {
    return end(false, ']');
}

JsonWriter& JsonWriter::value(double number) {
    return write(formatNumber(number));
}

JsonWriter& JsonWriter::value(bool truth) {
    return write(truth ? "true" : "false");
}

JsonWriter& JsonWriter::value(std::string_view text) {
    return write(quote(text));
}

JsonWriter& JsonWriter::integer(int64_t number) {
    return write(fmt::format("{}", number));
}

JsonWriter& JsonWriter::numbers(std::span<const double> values) {
    std::string line = "[";
    for (const double number : values)
        line += (line.size() > 1 ? ", " : "") + formatNumber(number);
    return write(line + "]");
}

std::string JsonWriter::text() const {
    SHUTTER_CHECK(mLevels.empty() && !mText.empty(), "the JSON is not complete");
    return mText + "\n";
}

core::Status writeJsonFile(const std::filesystem::path& path, const JsonWriter& content) {
    return io::writeFileText(path, content.text());
}

} // namespace shutter::json
