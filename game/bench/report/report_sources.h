// SPDX-License-Identifier: MIT
// The parts of the report page that the program carries in itself.
#pragma once

#include <string>
#include <string_view>

namespace shutter::bench {

/// HTML with the placeholders style, chart, results, pictures and scripts.
[[nodiscard]] std::string_view getReportPage();

[[nodiscard]] std::string_view getReportStyle();

/// Chart.js with its licence notice; empty where the program was built without it.
[[nodiscard]] std::string_view getChartJs();

/// The page's own scripts, one after another: they run as one ECMAScript module.
[[nodiscard]] std::string joinReportScripts();

} // namespace shutter::bench
