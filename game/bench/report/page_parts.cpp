// SPDX-License-Identifier: MIT
#include "game/bench/report/page_parts.h"

#include "game/bench/report/about_js.h"
#include "game/bench/report/chart_js.h"
#include "game/bench/report/charts_js.h"
#include "game/bench/report/data_js.h"
#include "game/bench/report/dial_js.h"
#include "game/bench/report/equal_time_js.h"
#include "game/bench/report/format_js.h"
#include "game/bench/report/headline_js.h"
#include "game/bench/report/main_js.h"
#include "game/bench/report/marks_js.h"
#include "game/bench/report/matrix_js.h"
#include "game/bench/report/page_html.h"
#include "game/bench/report/pictures_js.h"
#include "game/bench/report/player_css.h"
#include "game/bench/report/player_js.h"
#include "game/bench/report/scaling_js.h"
#include "game/bench/report/sequences_js.h"
#include "game/bench/report/slider_js.h"
#include "game/bench/report/style_css.h"
#include "game/bench/report/tables_js.h"
#include "game/bench/report/tradeoff_js.h"
#include "game/bench/report/viewport_js.h"

#include <set>

namespace shutter::bench {

namespace {

/// All bytes of an embedded file; the array has a zero after them.
template <size_t N> constexpr std::string_view viewOf(const char (&bytes)[N]) {
    return {bytes, N - 1};
}

} // namespace

core::Result<std::string>
fillPage(std::string_view page, const std::map<std::string, std::string_view>& values) {
    std::string filled;
    std::set<std::string> used;
    while (true) {
        const size_t open = page.find("{{");
        filled += page.substr(0, open);
        if (open == std::string_view::npos)
            break;
        const size_t close = page.find("}}", open);
        if (close == std::string_view::npos)
            return core::makeError("the page has '{{{{' without '}}}}'");
        const std::string name(page.substr(open + 2, close - open - 2));
        const auto value = values.find(name);
        if (value == values.end())
            return core::makeError("the page needs '{}', which has no value", name);
        filled += value->second;
        used.insert(name);
        page.remove_prefix(close + 2);
    }
    for (const auto& [name, value] : values)
        if (!used.contains(name))
            return core::makeError("the page has no place for '{}'", name);
    return filled;
}

std::string escapeForScript(std::string_view json) {
    // Outside its strings JSON holds none of these, and inside a string each may be written so.
    constexpr std::string_view kLineSeparators = "\xE2\x80"; // then A8 (U+2028) or A9 (U+2029)
    std::string escaped;
    escaped.reserve(json.size());
    for (size_t i = 0; i < json.size(); ++i) {
        const std::string_view rest = json.substr(i);
        const bool separates = rest.size() >= 3 && rest.starts_with(kLineSeparators) &&
                               (rest[2] == '\xA8' || rest[2] == '\xA9');
        if (separates) {
            escaped += rest[2] == '\xA8' ? "\\u2028" : "\\u2029";
            i += 2;
        } else if (json[i] == '<') {
            escaped += "\\u003c";
        } else {
            escaped += json[i];
        }
    }
    return escaped;
}

std::string encodeBase64(std::span<const uint8_t> bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t count = bytes.size() - i < 3 ? bytes.size() - i : 3;
        uint32_t group = uint32_t(bytes[i]) << 16;
        if (count > 1)
            group |= uint32_t(bytes[i + 1]) << 8;
        if (count > 2)
            group |= bytes[i + 2];
        text += kDigits[group >> 18];
        text += kDigits[(group >> 12) & 63U];
        text += count > 1 ? kDigits[(group >> 6) & 63U] : '=';
        text += count > 2 ? kDigits[group & 63U] : '=';
    }
    return text;
}

std::string_view getReportPage() {
    return viewOf(kPageHtml);
}

std::string getReportStyle() {
    return std::string(viewOf(kStyleCss)) + std::string(viewOf(kPlayerCss));
}

std::string_view getChartJs() {
    return viewOf(kChartJs);
}

std::string joinReportScripts() {
    constexpr std::string_view kScripts[] = {
        viewOf(k_data_js),
        viewOf(k_marks_js),
        viewOf(k_format_js),
        viewOf(k_charts_js),
        viewOf(k_headline_js),
        viewOf(k_tradeoff_js),
        viewOf(k_dial_js),
        viewOf(k_matrix_js),
        viewOf(k_viewport_js),
        viewOf(k_pictures_js),
        viewOf(k_slider_js),
        viewOf(k_tables_js),
        viewOf(k_equal_time_js),
        viewOf(k_scaling_js),
        viewOf(k_sequences_js),
        viewOf(k_player_js),
        viewOf(k_about_js),
        viewOf(k_main_js),
    };
    std::string joined;
    for (const std::string_view script : kScripts)
        joined += script;
    return joined;
}

} // namespace shutter::bench
