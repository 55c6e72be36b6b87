// SPDX-License-Identifier: MIT
#include "engine/json/json_file.h"

#include "engine/core/words.h"
#include "engine/io/file_bytes.h"
#include "engine/json/json_tree.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace shutter::json {

namespace {

std::string_view describeKind(JsonKind kind) {
    constexpr std::array<std::string_view, 6> kNames = {
        "null", "a boolean", "a number", "a string", "an array", "an object"};
    return kNames[size_t(kind)];
}

std::string describeRange(const JsonRange& range) {
    const bool hasMin = range.min > std::numeric_limits<double>::lowest();
    const bool hasMax = range.max < std::numeric_limits<double>::max();
    if (hasMin && hasMax)
        return fmt::format(
            "must lie in {}{}, {}{}",
            range.isAboveMin ? '(' : '[',
            range.min,
            range.max,
            range.isBelowMax ? ')' : ']'
        );
    if (hasMin)
        return fmt::format("must be {} {}", range.isAboveMin ? "above" : "at least", range.min);
    return fmt::format("must be {} {}", range.isBelowMax ? "below" : "at most", range.max);
}

bool isWithin(double number, const JsonRange& range) {
    return (range.isAboveMin ? number > range.min : number >= range.min) &&
           (range.isBelowMax ? number < range.max : number <= range.max);
}

/// nlohmann would write null instead.
void checkFinite(const nlohmann::ordered_json& content) {
    if (content.is_number_float()) {
        const auto number = content.get<double>();
        SHUTTER_CHECK(std::isfinite(number), "JSON has no {}", number);
    }
    if (content.is_structured())
        for (const nlohmann::ordered_json& element : content)
            checkFinite(element);
}

/// \param indent spaces per level; -1: everything on one line
std::string format(const nlohmann::ordered_json& content, int indent) {
    checkFinite(content);
    return content.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
           "\n";
}

} // namespace

void JsonNode::fail(std::string_view what) const {
    if (!mTree->error.empty() || mIndex == JsonTree::kAbsent)
        return;
    const std::string path = mTree->describePath(mIndex);
    mTree->error = fmt::format(
        "{}:{}: {}{}{}",
        mTree->name,
        mTree->values[mIndex].line,
        path,
        path.empty() ? "" : ": ",
        what
    );
}

void JsonNode::failKind(std::string_view wanted) const {
    fail("must be {}, not {}", wanted, describeKind(mTree->values[mIndex].kind));
}

bool JsonNode::isNull() const {
    return mIndex != JsonTree::kAbsent && mTree->values[mIndex].kind == JsonKind::Null;
}

bool JsonNode::isNumber() const {
    return mIndex != JsonTree::kAbsent && mTree->values[mIndex].kind == JsonKind::Number;
}

bool JsonNode::isString() const {
    return mIndex != JsonTree::kAbsent && mTree->values[mIndex].kind == JsonKind::String;
}

bool JsonNode::isObject() const {
    return mIndex != JsonTree::kAbsent && mTree->values[mIndex].kind == JsonKind::Object;
}

bool JsonNode::isArray() const {
    return mIndex != JsonTree::kAbsent && mTree->values[mIndex].kind == JsonKind::Array;
}

double JsonNode::readNumber(const JsonRange& range) const {
    if (mIndex == JsonTree::kAbsent)
        return 0.0;
    const JsonValue& value = mTree->values[mIndex];
    if (value.kind != JsonKind::Number) {
        failKind("a number");
        return 0.0;
    }
    if (isWithin(value.number, range))
        return value.number;
    fail("{}, not {}", describeRange(range), value.number);
    return 0.0;
}

int64_t JsonNode::readInteger(int64_t min, int64_t max) const {
    if (mIndex == JsonTree::kAbsent)
        return 0;
    const JsonValue& value = mTree->values[mIndex];
    if (value.kind != JsonKind::Number) {
        failKind("a whole number");
        return 0;
    }
    if (value.number != std::floor(value.number)) {
        fail("must be a whole number, not {}", value.number);
        return 0;
    }
    const double number = readNumber(
        {.min = double(std::max(min, -kMaxExactInteger)),
         .max = double(std::min(max, kMaxExactInteger))}
    );
    return int64_t(number);
}

bool JsonNode::readBoolean() const {
    if (mIndex == JsonTree::kAbsent)
        return false;
    const JsonValue& value = mTree->values[mIndex];
    if (value.kind != JsonKind::Boolean)
        failKind("true or false");
    return value.truth;
}

std::string JsonNode::readString(size_t maxBytes) const {
    if (mIndex == JsonTree::kAbsent)
        return {};
    const JsonValue& value = mTree->values[mIndex];
    if (value.kind != JsonKind::String)
        failKind("a string");
    if (value.text.size() <= maxBytes)
        return value.text;
    fail("is longer than {} bytes", maxBytes);
    return {};
}

size_t JsonNode::readWord(std::span<const std::string_view> words) const {
    const std::string word = readString(SIZE_MAX);
    const auto found = std::find(words.begin(), words.end(), word);
    if (found != words.end())
        return size_t(found - words.begin());
    if (isString())
        fail("'{}' is not one of {}", quoteJsonText(word), fmt::join(words, ", "));
    return 0;
}

std::vector<JsonNode> JsonNode::readArray(size_t minCount, size_t maxCount) const {
    std::vector<JsonNode> elements;
    if (mIndex == JsonTree::kAbsent)
        return elements;
    const JsonValue& value = mTree->values[mIndex];
    if (value.kind != JsonKind::Array) {
        failKind("an array");
        return elements;
    }
    const size_t count = value.children.size();
    if (count < minCount || count > maxCount) {
        if (minCount == maxCount)
            fail("must have {}, not {}", core::countOf(minCount, "element"), count);
        else if (count < minCount)
            fail("must have at least {}, not {}", core::countOf(minCount, "element"), count);
        else
            fail("must have at most {}, not {}", core::countOf(maxCount, "element"), count);
        return elements;
    }
    elements.reserve(count);
    for (const uint32_t child : value.children)
        elements.push_back(JsonNode(*mTree, child));
    return elements;
}

JsonObject JsonNode::readObject(std::initializer_list<std::string_view> fields) const {
    return readObject(std::span(fields.begin(), fields.size()));
}

JsonObject JsonNode::readObject(std::span<const std::string_view> fields) const {
    JsonObject object(JsonNode(*mTree, JsonTree::kAbsent), {fields.begin(), fields.end()});
    if (mIndex == JsonTree::kAbsent)
        return object;
    const JsonValue& value = mTree->values[mIndex];
    if (value.kind != JsonKind::Object) {
        failKind("an object");
        return object;
    }
    for (const uint32_t child : value.children) {
        const std::string& key = mTree->values[child].key;
        if (std::find(fields.begin(), fields.end(), key) == fields.end()) {
            JsonNode(*mTree, child)
                .fail("is not a field here; the fields are {}", fmt::join(fields, ", "));
            return object;
        }
    }
    object.mNode = *this;
    return object;
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::readFields() const {
    std::vector<std::pair<std::string, JsonNode>> fields;
    if (mIndex == JsonTree::kAbsent)
        return fields;
    const JsonValue& value = mTree->values[mIndex];
    if (value.kind != JsonKind::Object)
        failKind("an object");
    else
        for (const uint32_t child : value.children)
            fields.emplace_back(mTree->values[child].key, JsonNode(*mTree, child));
    return fields;
}

std::optional<JsonNode> JsonObject::find(std::string_view field) const {
    SHUTTER_CHECK(
        std::find(mFields.begin(), mFields.end(), field) != mFields.end(),
        "the field '{}' was not announced",
        field
    );
    if (mNode.mIndex == JsonTree::kAbsent)
        return std::nullopt;
    JsonTree& tree = *mNode.mTree;
    for (const uint32_t child : tree.values[mNode.mIndex].children)
        if (tree.values[child].key == field)
            return JsonNode(tree, child);
    return std::nullopt;
}

JsonNode JsonObject::require(std::string_view field) const {
    if (const std::optional<JsonNode> found = find(field))
        return *found;
    mNode.fail("the field '{}' is missing", field);
    return JsonNode(*mNode.mTree, JsonTree::kAbsent);
}

JsonDocument::JsonDocument(std::unique_ptr<JsonTree> tree) : mTree(std::move(tree)) {}

JsonDocument::JsonDocument(JsonDocument&&) noexcept = default;
JsonDocument& JsonDocument::operator=(JsonDocument&&) noexcept = default;
JsonDocument::~JsonDocument() = default;

core::Result<JsonDocument>
JsonDocument::load(const std::filesystem::path& path, const JsonLimits& limits) {
    const auto bytes = io::readFileBytes(path, limits.maxBytes + 1);
    if (!bytes)
        return bytes.error();
    if (bytes.value().size() > limits.maxBytes)
        return core::makeError("{}: the file is over {} bytes", path.string(), limits.maxBytes);
    return parse(
        {reinterpret_cast<const char*>(bytes.value().data()), bytes.value().size()},
        path.string(),
        limits
    );
}

core::Result<JsonDocument>
JsonDocument::parse(std::string_view text, std::string name, const JsonLimits& limits) {
    auto tree = parseJsonTree(text, std::move(name), limits);
    if (!tree)
        return tree.error();
    return JsonDocument(std::move(tree).value());
}

JsonNode JsonDocument::root() const {
    return {*mTree, 0};
}

core::Status JsonDocument::finish() const {
    if (mTree->error.empty())
        return {};
    return core::Error{mTree->error};
}

std::string formatJson(const nlohmann::ordered_json& content) {
    return format(content, 2);
}

std::string formatJsonLine(const nlohmann::ordered_json& content) {
    return format(content, -1);
}

core::Status
writeJsonFile(const std::filesystem::path& path, const nlohmann::ordered_json& content) {
    return io::writeFileText(path, formatJson(content));
}

} // namespace shutter::json
