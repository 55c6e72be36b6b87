// SPDX-License-Identifier: MIT
// Options of the command line as rows: how each is parsed, and what of it a picture depends on.
#pragma once

#include "engine/core/frame_rate.h"
#include "engine/core/result.h"
#include "engine/core/setting_row.h"
#include "engine/math/math.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <concepts>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter::game {

/// The parts between separators: one more than there are, empty ones too.
[[nodiscard]] std::vector<std::string> splitAt(const std::string& text, char separator);

/// Width and height of a picture, pixels.
struct PictureSize {
    uint32_t width = 0;
    uint32_t height = 0;
};

/// Whether pictures depend on an option.
enum class Matters : uint8_t { ToPictures, ToNoPicture };

/// One option of a command.
template <class Arguments> struct OptionRow {
    const char* name; ///< "--camera"
    const char* help;
    CLI::Option* (*define)(CLI::App& command, const OptionRow& row, Arguments& arguments);
    std::string (*describe)(const Arguments& arguments); ///< differs wherever the value does
    Matters matters = Matters::ToPictures;
};

template <class Arguments> using OptionRows = std::span<const OptionRow<Arguments>>;

template <class Arguments>
void defineRows(CLI::App& command, OptionRows<Arguments> rows, Arguments& arguments) {
    for (const OptionRow<Arguments>& row : rows)
        row.define(command, row, arguments);
}

/// The values that pictures depend on, "--camera=main --time=0 ...", typed or not.
template <class Arguments>
[[nodiscard]] std::string describeRows(OptionRows<Arguments> rows, const Arguments& arguments) {
    std::string text;
    for (const OptionRow<Arguments>& row : rows)
        if (row.matters == Matters::ToPictures)
            text += fmt::format("{}={} ", row.name, row.describe(arguments));
    return text;
}

/// Adds an option that `parse` reads. Its errors are prefixed with the option's name.
template <class Parse>
CLI::Option*
addParsedOption(CLI::App& command, const char* name, const std::string& help, Parse&& parse) {
    return command.add_option_function<std::string>(
        name,
        [name, parse = std::forward<Parse>(parse)](const std::string& text) {
            if (const core::Status parsed = parse(text); !parsed)
                throw CLI::ValidationError(name, parsed.error().message);
        },
        help
    );
}

/// "1280x720".
[[nodiscard]] core::Status parseOption(const std::string& text, PictureSize& size);
/// "R,G,B", each 0 or more.
[[nodiscard]] core::Status parseOption(const std::string& text, math::vec3& color);
/// "24", "29.97" or "24000/1001".
[[nodiscard]] core::Status parseOption(const std::string& text, core::FrameRate& rate);
/// "on" or "off".
[[nodiscard]] core::Status parseOption(const std::string& text, bool& isOn);

/// Types that have a parser of ours; CLI11 parses the others.
template <class T>
concept ParsedOption = requires(const std::string& text, T& value) {
    parseOption(text, value);
};

template <ParsedOption T>
[[nodiscard]] core::Status parseOption(const std::string& text, std::optional<T>& value) {
    T parsed{};
    SHUTTER_TRY(parseOption(text, parsed));
    value = parsed;
    return {};
}

[[nodiscard]] std::string describeOption(const PictureSize& size);
[[nodiscard]] std::string describeOption(const math::vec3& color);
[[nodiscard]] std::string describeOption(const core::FrameRate& rate);
[[nodiscard]] std::string describeOption(const std::vector<std::string>& words);

template <class T> [[nodiscard]] std::string describeOption(const T& value) {
    return fmt::format("{}", value);
}

template <class T> [[nodiscard]] std::string describeOption(const std::optional<T>& value) {
    return value ? describeOption(*value) : std::string("none");
}

/// The class that a pointer to member points into, and the member's type.
template <class> struct MemberOf;

template <class Owner_, class Value_> struct MemberOf<Value_ Owner_::*> {
    using Owner = Owner_;
    using Value = Value_;
};

/// Defines the option of a member by its type.
template <auto member>
CLI::Option* defineMember(
    CLI::App& command,
    const OptionRow<typename MemberOf<decltype(member)>::Owner>& row,
    typename MemberOf<decltype(member)>::Owner& arguments
) {
    using Value = typename MemberOf<decltype(member)>::Value;
    Value& target = arguments.*member;
    if constexpr (std::same_as<Value, bool>)
        return command.add_flag(row.name, target, row.help);
    else if constexpr (requires { parseOption(std::string(), target); })
        return addParsedOption(command, row.name, row.help, [&target](const std::string& text) {
            return parseOption(text, target);
        });
    else
        return command.add_option(row.name, target, row.help);
}

/// The row of a member with a scalar value.
template <auto member>
[[nodiscard]] constexpr auto
makeRow(const char* name, const char* help, Matters matters = Matters::ToPictures) {
    using Owner = typename MemberOf<decltype(member)>::Owner;
    return OptionRow<Owner>{
        name,
        help,
        defineMember<member>,
        [](const Owner& arguments) { return describeOption(arguments.*member); },
        matters};
}

/// \param words name the enum's values from 0 on
template <class Value>
[[nodiscard]] core::Status
parseWord(const std::string& text, std::span<const std::string_view> words, Value& value) {
    for (size_t i = 0; i < words.size(); ++i)
        if (words[i] == text) {
            value = static_cast<Value>(i);
            return {};
        }
    return core::makeError("'{}' is not one of {}", text, fmt::join(words, ", "));
}

/// The row of an enum's member; `words` name its values from 0 on.
template <auto member, const auto& words>
[[nodiscard]] constexpr auto makeWordRow(const char* name, const char* help) {
    using Owner = typename MemberOf<decltype(member)>::Owner;
    using Value = typename MemberOf<decltype(member)>::Value;
    return OptionRow<Owner>{
        name,
        help,
        [](CLI::App& command, const OptionRow<Owner>& row, Owner& arguments) {
            Value& target = arguments.*member;
            return addParsedOption(command, row.name, row.help, [&target](const std::string& text) {
                return parseWord(text, words, target);
            });
        },
        [](const Owner& arguments) {
            return std::string(words[static_cast<size_t>(arguments.*member)]);
        }};
}

/// The same for an optional enum, which stays empty unless it is typed.
template <auto member, const auto& words>
[[nodiscard]] constexpr auto
makeOptionalWordRow(const char* name, const char* help, Matters matters = Matters::ToPictures) {
    using Owner = typename MemberOf<decltype(member)>::Owner;
    using Value = typename MemberOf<decltype(member)>::Value::value_type;
    return OptionRow<Owner>{
        name,
        help,
        [](CLI::App& command, const OptionRow<Owner>& row, Owner& arguments) {
            auto& target = arguments.*member;
            return addParsedOption(
                command,
                row.name,
                row.help,
                [&target](const std::string& text) -> core::Status {
                    Value value{};
                    SHUTTER_TRY(parseWord(text, words, value));
                    target = value;
                    return {};
                }
            );
        },
        [](const Owner& arguments) {
            const auto& value = arguments.*member;
            return value ? std::string(words[static_cast<size_t>(*value)]) : std::string("none");
        },
        matters};
}

/// Adds the options that setting rows name; a switch is "on" or "off".
/// \param typed gets the names of the options that were typed
/// \param defaults in the help, in place of the owner's values
template <class Owner>
void defineSettingOptions(
    CLI::App& command,
    core::SettingRows<Owner> rows,
    Owner& owner,
    std::set<std::string>& typed,
    const std::string& defaults = {}
) {
    for (const core::SettingRow<Owner>& row : rows) {
        if (*row.option == '\0')
            continue;
        const auto* isOn = std::get_if<bool Owner::*>(&row.field);
        const std::string values = isOn ? "on or off" : core::describeValues(row);
        const std::string fallback = !defaults.empty() ? defaults
                                     : isOn            ? (owner.**isOn ? "on" : "off")
                                                       : core::describeValue(row, owner);
        const auto parse = [&row, &owner, &typed, isOn](const std::string& text) -> core::Status {
            typed.insert(row.option);
            if (!isOn)
                return core::parseValue(row, text, owner);
            return parseOption(text, owner.**isOn);
        };
        addParsedOption(
            command,
            row.option,
            fmt::format("{} {}; default {}", row.meaning, values, fallback),
            parse
        );
    }
}

} // namespace shutter::game
