// SPDX-License-Identifier: MIT
#include "engine/json/json_tree.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <unordered_set>

namespace shutter::json {

namespace {

using nlohmann::json;

constexpr size_t kMaxQuotedBytes = 64;

/// How far the parser has read, which nlohmann does not report itself.
struct Progress {
    const char* at = nullptr;
};

/// Iterates over the text and records its position.
class CountingIterator {
  public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    CountingIterator(const char* at, Progress* progress) : mAt(at), mProgress(progress) {}

    reference operator*() const { return *mAt; }

    CountingIterator& operator++() {
        mProgress->at = ++mAt;
        return *this;
    }

    CountingIterator operator++(int) {
        const CountingIterator before = *this;
        ++*this;
        return before;
    }

    bool operator==(const CountingIterator& other) const { return mAt == other.mAt; }

    bool operator!=(const CountingIterator& other) const { return mAt != other.mAt; }

  private:
    const char* mAt;
    Progress* mProgress;
};

/// Counts lines up to a position that only moves forward.
class LineCounter {
  public:
    explicit LineCounter(const char* begin) : mAt(begin) {}

    uint32_t countTo(const char* end) {
        if (end > mAt) {
            mLine += uint32_t(std::count(mAt, end, '\n'));
            mAt = end;
        }
        return mLine;
    }

  private:
    const char* mAt;
    uint32_t mLine = 1;
};

/// The parser's message without the exception's number, the position, and the characters last read,
/// which may be a megabyte of a string.
std::string shortenSyntaxError(std::string_view what) {
    if (const size_t number = what.find("] "); number != std::string_view::npos)
        what.remove_prefix(number + 2);
    if (const size_t place = what.find(": "); what.starts_with("parse error at line"))
        what.remove_prefix(place == std::string_view::npos ? 0 : place + 2);
    constexpr std::string_view kLast = "; last read: '";
    const size_t last = what.find(kLast);
    if (last == std::string_view::npos)
        return std::string(what);
    const size_t expected = what.rfind("'; expected");
    std::string shortened(what.substr(0, last));
    if (expected != std::string_view::npos && expected > last)
        shortened += what.substr(expected + 1);
    return shortened;
}

/// Builds the tree from the parser's events.
class TreeBuilder : public nlohmann::json_sax<json> {
  public:
    TreeBuilder(std::string_view text, const JsonLimits& limits, JsonTree& tree)
        : mBegin(text.data()), mProgress{text.data()}, mLines(text.data()), mLimits(limits),
          mTree(tree) {}

    Progress& progress() { return mProgress; }

    bool null() override { return add({.kind = JsonKind::Null}); }

    bool boolean(bool truth) override { return add({.kind = JsonKind::Boolean, .truth = truth}); }

    bool number_integer(number_integer_t number) override { return addNumber(double(number)); }

    bool number_unsigned(number_unsigned_t number) override { return addNumber(double(number)); }

    bool number_float(number_float_t number, const string_t&) override { return addNumber(number); }

    bool string(string_t& text) override {
        return add({.kind = JsonKind::String, .text = std::move(text)});
    }

    bool binary(binary_t&) override { return fail("binary values are not JSON"); }

    bool start_object(size_t) override { return open(JsonKind::Object); }

    bool end_object() override { return close(); }

    bool start_array(size_t) override { return open(JsonKind::Array); }

    bool end_array() override { return close(); }

    bool key(string_t& name) override {
        if (!mOpen.back().keys.insert(name).second) {
            const std::string path = mTree.describePath(mOpen.back().value);
            return fail(fmt::format(
                "{}{}the field '{}' stands here twice",
                path,
                path.empty() ? "" : ": ",
                quoteJsonText(name)
            ));
        }
        mKey = std::move(name);
        return true;
    }

    bool
    parse_error(size_t, const std::string&, const nlohmann::detail::exception& error) override {
        return fail(shortenSyntaxError(error.what()));
    }

  private:
    struct OpenValue {
        uint32_t value = 0;
        std::unordered_set<std::string> keys;
    };

    /// The line of the token that was just read. The parser has read one character past a number,
    /// possibly a line break; no token ends in one.
    uint32_t findLine() {
        return mLines.countTo(mProgress.at > mBegin ? mProgress.at - 1 : mBegin);
    }

    bool fail(std::string what) {
        mTree.error = fmt::format("{}:{}: {}", mTree.name, findLine(), what);
        return false;
    }

    bool addNumber(double number) { return add({.kind = JsonKind::Number, .number = number}); }

    bool add(JsonValue value) {
        if (mTree.values.size() >= mLimits.maxValues)
            return fail(fmt::format("the file holds more than {} values", mLimits.maxValues));
        value.line = findLine();
        const auto index = uint32_t(mTree.values.size());
        if (!mOpen.empty()) {
            value.parent = mOpen.back().value;
            JsonValue& parent = mTree.values[value.parent];
            value.place = uint32_t(parent.children.size());
            if (parent.kind == JsonKind::Object)
                value.key = std::move(mKey);
            parent.children.push_back(index);
        }
        mTree.values.push_back(std::move(value));
        return true;
    }

    bool open(JsonKind kind) {
        if (mOpen.size() >= mLimits.maxDepth)
            return fail(fmt::format("the values nest deeper than {} levels", mLimits.maxDepth));
        if (!add({.kind = kind}))
            return false;
        mOpen.push_back({.value = uint32_t(mTree.values.size() - 1), .keys = {}});
        return true;
    }

    bool close() {
        mOpen.pop_back();
        return true;
    }

    const char* mBegin;
    Progress mProgress;
    LineCounter mLines;
    JsonLimits mLimits;
    JsonTree& mTree;
    std::vector<OpenValue> mOpen;
    std::string mKey;
};

} // namespace

std::string quoteJsonText(std::string_view text) {
    if (text.size() <= kMaxQuotedBytes)
        return std::string(text);
    size_t end = kMaxQuotedBytes;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80)
        --end; // never cuts a character
    return std::string(text.substr(0, end)) + "...";
}

std::string JsonTree::describePath(uint32_t index) const {
    std::string path;
    for (; index != 0; index = values[index].parent) {
        const JsonValue& value = values[index];
        std::string step = values[value.parent].kind == JsonKind::Array
                               ? fmt::format("[{}]", value.place)
                               : quoteJsonText(value.key);
        if (!path.empty() && path.front() != '[')
            step += '.';
        path = step + path;
    }
    return path;
}

core::Result<std::unique_ptr<JsonTree>>
parseJsonTree(std::string_view text, std::string name, const JsonLimits& limits) {
    auto tree = std::make_unique<JsonTree>();
    tree->name = std::move(name);
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
        return core::makeError("{}: the file is empty", tree->name);
    // The parser would take it for the end and ignore what follows.
    if (const size_t nul = text.find('\0'); nul != std::string_view::npos)
        return core::makeError(
            "{}:{}: a NUL byte is not JSON",
            tree->name,
            1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(nul), '\n')
        );
    TreeBuilder builder(text, limits, *tree);
    const bool parsed = json::sax_parse(
        CountingIterator(text.data(), &builder.progress()),
        CountingIterator(text.data() + text.size(), &builder.progress()),
        &builder
    );
    if (!parsed)
        return core::Error{tree->error};
    return tree;
}

} // namespace shutter::json
