// SPDX-License-Identifier: MIT
#include "game/bench/report/about_js.h"
#include "game/bench/report/chart_js.h"
#include "game/bench/report/charts_js.h"
#include "game/bench/report/data_js.h"
#include "game/bench/report/equal_time_js.h"
#include "game/bench/report/format_js.h"
#include "game/bench/report/headline_js.h"
#include "game/bench/report/main_js.h"
#include "game/bench/report/marks_js.h"
#include "game/bench/report/matrix_js.h"
#include "game/bench/report/page_html.h"
#include "game/bench/report/page_template.h"
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

namespace shutter::bench {

namespace {

/// All bytes of an embedded file; the array has a zero after them.
template <size_t N> constexpr std::string_view viewOf(const char (&bytes)[N]) {
    return {bytes, N - 1};
}

} // namespace

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
