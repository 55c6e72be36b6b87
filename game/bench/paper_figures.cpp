// SPDX-License-Identifier: MIT
#include "game/bench/results.h"

#include <nlohmann/json.hpp>

#include <array>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

namespace shutter::bench {

namespace {

using nlohmann::json;

json describeQuality() {
    return {
        {"columns", {"psnr", "ssim"}},
        {"baseline", "Adapted Post-Process"},
        {"rows",
         {{{"name", "Adapted Post-Process"}, {"values", {24.20, 0.91}}, {"ours", "gather_paper"}},
          {{"name", "UE4 Post-Process"}, {"values", {12.32, 0.68}}},
          {{"name", "Hybrid MBlur"}, {"values", {25.69, 0.92}}, {"ours", "hybrid_paper"}}}}};
}

json describePassTimes() {
    using Shots = std::array<double, 3>;
    json rows = json::array();
    const auto add = [&](const char* pass, Shots cpu, Shots gpu, const char* field, json value) {
        json row = {{"pass", pass}, {"cpu", cpu}, {"gpu", gpu}};
        row[field] = std::move(value);
        rows.push_back(std::move(row));
    };
    const auto names = [](std::initializer_list<const char*> passes) {
        return json(std::vector<std::string>(passes.begin(), passes.end()));
    };
    add("G-Buffer", {0.26, 0.54, 1.74}, {1.19, 3.54, 6.43}, "ours", names({"G-buffer"}));
    add("Ray Mask",
        {0.05, 0.05, 0.06},
        {0.33, 0.38, 0.33},
        "ours",
        names({"sort blocks", "clear lists", "edge", "ray mask", "find jumps", "list missing"}));
    add("Ray Trace",
        {1.13, 2.27, 2.99},
        {0.59, 0.65, 0.62},
        "ours",
        names({"build TLAS", "ray reveal"}));
    add("Tile-Dilate",
        {0.05, 0.06, 0.08},
        {1.48, 1.44, 1.43},
        "ours",
        names({"tile max", "neighbour max", "tile max of reveal", "neighbour max of reveal"}));
    add("PP-Composite",
        {0.03, 0.04, 0.04},
        {0.85, 0.82, 0.82},
        "ours",
        names(
            {"copy still pixels",
             "gather uniform",
             "gather",
             "gather without mask",
             "gather and composite",
             "count alone",
             "count",
             "count revealed",
             "write uniform blocks",
             "write mixed blocks",
             "write candidate blocks"}
        ));
    add("Others", {3.14, 4.67, 3.48}, {0.39, 0.42, 0.29}, "others", true);
    add("Total Duration", {4.66, 7.63, 8.39}, {4.83, 7.25, 9.92}, "total", true);
    return {
        {"device", "NVIDIA GeForce RTX 2080 Ti, Intel Core i7-8700K"},
        {"shots", names({"Pink Room", "Sun Temple", "Bistro Interior"})},
        {"rows", rows},
        {"framesPerSecond", {205, 148, 112}}};
}

} // namespace

json describePaperFigures() {
    return {
        {"source", "Tan, Cui and Bhojan, Hybrid MBlur, Tables 1 and 2"},
        {"case", "vase"},
        {"method", "hybrid_paper"},
        {"table1", describeQuality()},
        {"table2", describePassTimes()},
        {"findings",
         json::array(
             {"The paper's shot, exposure and tone mapping are not published, so its decibels "
              "compare its methods with each other and not with ours. PSNR is taken over the whole "
              "picture: it falls as more of the picture moves and as the background's contrast "
              "grows, and our mover covers less of the picture than the paper's.",
              "What can be held against the paper is the order of the methods and the lead of "
              "hybrid over gather. Settings are the paper's in gather_paper and hybrid_paper; "
              "gather "
              "and hybrid have the defaults, which measure better.",
              "Our times are of another device. Shares of the frame mean more than milliseconds: "
              "on a processor the G-buffer with its shading takes most of the frame, on a graphics "
              "card the filters take most of the rest."}
         )}};
}

} // namespace shutter::bench
