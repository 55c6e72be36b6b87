// SPDX-License-Identifier: MIT
// Reads our own JSON files strictly: every mistake is one sentence with file, line and field, e.g.
// "film.json:12: keys[3].time: must be a number, not a string". Refuses duplicate keys, unknown
// fields, anything after the value, numbers beyond double and NUL bytes; skips a byte order mark.
#pragma once

#include "engine/core/result.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter::json {

/// Limits beyond which a file is refused.
struct JsonLimits {
    uint64_t maxBytes = uint64_t{64} << 20;
    uint32_t maxDepth = 32;         ///< nested objects and arrays
    uint32_t maxValues = 2'000'000; ///< in the whole file; 100000 keys of a flythrough fit
};

/// The range of a number.
struct JsonRange {
    double min = std::numeric_limits<double>::lowest();
    double max = std::numeric_limits<double>::max();
    bool isAboveMin = false; ///< `min` itself is refused
    bool isBelowMax = false; ///< `max` itself is refused
};

struct JsonTree;
class JsonObject;

/// One value of a document. The first read that fails becomes the document's error. That read, and
/// any later one that fails, returns a default (0 or empty), so callers need no check after each
/// field.
class JsonNode {
  public:
    [[nodiscard]] double readNumber(const JsonRange& range = {}) const;
    /// Whole numbers only; 3.0 is one.
    [[nodiscard]] int64_t
    readInteger(int64_t min = -kMaxExactInteger, int64_t max = kMaxExactInteger) const;
    [[nodiscard]] bool readBoolean() const;
    /// A UTF-8 string. \param maxBytes largest length
    [[nodiscard]] std::string readString(size_t maxBytes = 4096) const;
    [[nodiscard]] std::vector<JsonNode>
    readArray(size_t minCount = 0, size_t maxCount = SIZE_MAX) const;

    /// An object that may have these fields and no others.
    [[nodiscard]] JsonObject readObject(std::initializer_list<std::string_view> fields) const;
    [[nodiscard]] JsonObject readObject(std::span<const std::string_view> fields) const;

    /// Reads a string that must be one of the words; returns the word's index.
    [[nodiscard]] size_t readWord(std::span<const std::string_view> words) const;

    /// An array of `Count` numbers.
    template <size_t Count>
    [[nodiscard]] std::array<double, Count> readNumbers(const JsonRange& range = {}) const {
        std::array<double, Count> numbers{};
        const std::vector<JsonNode> elements = readArray(Count, Count);
        for (size_t i = 0; i < elements.size(); ++i)
            numbers[i] = elements[i].readNumber(range);
        return numbers;
    }

    /// Reads a string that must be one of the words; returns the value paired with it.
    template <class Value, size_t Count>
    [[nodiscard]] Value
    readChoice(const std::array<std::pair<std::string_view, Value>, Count>& choices) const {
        std::array<std::string_view, Count> words;
        for (size_t i = 0; i < Count; ++i)
            words[i] = choices[i].first;
        return choices[readWord(words)].second;
    }

    /// The fields of an object of any names, in the order of the file.
    [[nodiscard]] std::vector<std::pair<std::string, JsonNode>> readFields() const;

    [[nodiscard]] bool isNull() const;
    [[nodiscard]] bool isNumber() const;
    [[nodiscard]] bool isString() const;
    [[nodiscard]] bool isObject() const;
    [[nodiscard]] bool isArray() const;

    /// Reports this value as wrong, unless the document has an error already.
    /// \param what e.g. "must come after the key before, at 2 s"
    void fail(std::string_view what) const;

    template <class... Args>
    void fail(fmt::format_string<Args...> format, Args&&... args) const
        requires(sizeof...(Args) > 0) {
        fail(std::string_view(fmt::format(format, std::forward<Args>(args)...)));
    }

    /// The largest magnitude up to which every whole number is a double.
    static constexpr int64_t kMaxExactInteger = int64_t{1} << 53;

  private:
    friend class JsonDocument;
    friend class JsonObject;

    JsonNode(JsonTree& tree, uint32_t index) : mTree(&tree), mIndex(index) {}

    void failKind(std::string_view wanted) const;

    JsonTree* mTree;
    uint32_t mIndex; ///< kAbsent for a missing value, which reads as a default
};

class JsonObject {
  public:
    /// The field; a missing one is the document's error. \param field one given to readObject()
    [[nodiscard]] JsonNode require(std::string_view field) const;
    /// The field, if it is there.
    [[nodiscard]] std::optional<JsonNode> find(std::string_view field) const;

  private:
    friend class JsonNode;

    JsonObject(JsonNode node, std::vector<std::string_view> fields)
        : mNode(node), mFields(std::move(fields)) {}

    JsonNode mNode;
    std::vector<std::string_view> mFields;
};

/// A parsed file. Must outlive its nodes.
class JsonDocument {
  public:
    /// Error: it cannot be read, is not JSON, or is beyond the limits.
    [[nodiscard]] static core::Result<JsonDocument>
    load(const std::filesystem::path& path, const JsonLimits& limits = {});

    /// \param name what errors call the text
    [[nodiscard]] static core::Result<JsonDocument>
    parse(std::string_view text, std::string name, const JsonLimits& limits = {});

    JsonDocument(JsonDocument&&) noexcept;
    JsonDocument& operator=(JsonDocument&&) noexcept;
    ~JsonDocument();

    [[nodiscard]] JsonNode root() const;

    /// The first read that failed. Call it after all reads and before using any value.
    [[nodiscard]] core::Status finish() const;

  private:
    explicit JsonDocument(std::unique_ptr<JsonTree> tree);

    std::unique_ptr<JsonTree> mTree;
};

/// Parses a file and returns `read(root)`, or an error that names the file and the fault.
/// \param read takes a JsonNode and returns a value that does not refer to the document
template <class Read>
[[nodiscard]] auto readJsonFile(const std::filesystem::path& path, Read read)
    -> core::Result<decltype(read(std::declval<JsonNode>()))> {
    auto document = JsonDocument::load(path);
    if (!document)
        return document.error();
    auto value = read(document.value().root());
    SHUTTER_TRY(document.value().finish());
    return value;
}

/// The text of a JSON file: one field or element per line, two spaces per level, a line break at
/// the end. Fields keep their order, and every double reads back to the last bit. Bytes that are
/// not UTF-8 become U+FFFD. A number that is not finite, which JSON cannot hold, is a CHECK
/// failure.
[[nodiscard]] std::string formatJson(const nlohmann::ordered_json& content);

/// The same content on one line that ends in a line break, for journals.
[[nodiscard]] std::string formatJsonLine(const nlohmann::ordered_json& content);

/// Writes formatJson(content) to a temporary file and renames it, so that an interrupted write
/// never leaves half a file. Error: names the file.
[[nodiscard]] core::Status
writeJsonFile(const std::filesystem::path& path, const nlohmann::ordered_json& content);

} // namespace shutter::json
