// SPDX-License-Identifier: MIT
#include "game/statistics.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <sys/resource.h>

namespace shutter::game {

namespace {

render::FrameStatistics makeFrame(double milliseconds) {
    render::FrameStatistics frame;
    frame.passes = {{"draw", milliseconds, 2.0 * milliseconds}, {"blur", 10.0, 1.0}};
    frame.cpuMilliseconds = 3.0 * milliseconds;
    frame.wallMilliseconds = 4.0 * milliseconds;
    frame.counters = {{"rays traced", 5}};
    frame.transientBytes = static_cast<uint64_t>(milliseconds) * 100;
    return frame;
}

render::FrameStatistics medianOf(const std::vector<double>& milliseconds) {
    std::vector<render::FrameStatistics> frames;
    for (const double value : milliseconds)
        frames.push_back(makeFrame(value));
    return computeMedian(frames);
}

} // namespace

TEST(Statistics, TheMedianOfOneIsItself) {
    EXPECT_EQ(medianOf({7.0}).passes.at(0).gpuMilliseconds, 7.0);
}

TEST(Statistics, TheMedianOfAnOddNumberIsTheMiddleWhateverTheOrder) {
    const render::FrameStatistics median = medianOf({100.0, 1.0, 3.0});
    EXPECT_EQ(median.passes.at(0).gpuMilliseconds, 3.0);
    EXPECT_EQ(median.passes.at(0).cpuMilliseconds, 6.0);
    EXPECT_EQ(median.cpuMilliseconds, 9.0);
    EXPECT_EQ(median.wallMilliseconds, 12.0);
    EXPECT_EQ(median.passes.at(1).gpuMilliseconds, 10.0);
}

TEST(Statistics, TheMedianOfAnEvenNumberIsBetweenTheTwoInTheMiddle) {
    EXPECT_EQ(medianOf({4.0, 100.0, 2.0, 1.0}).wallMilliseconds, 12.0);
}

TEST(Statistics, SumsAreByPassNameInTheOrderOfFirstAppearance) {
    render::FrameStatistics total;
    addStatistics(total, makeFrame(1.0));
    render::FrameStatistics next = makeFrame(2.0);
    next.passes = {{"blur", 5.0, 1.0}, {"tone map", 7.0, 1.0}, {"draw", 2.0, 4.0}};
    next.explanations = {{render::ExplainedKind::Effect, "motion blur", {true, "later"}}};
    total.measures = {{"standard error", 0.5}, {"other", 2.0}};
    next.measures = {{"standard error", 0.25}};
    addStatistics(total, next);
    EXPECT_EQ(total.measures.at("standard error"), 0.25) << "the later frame's";
    EXPECT_EQ(total.measures.at("other"), 2.0);
    ASSERT_EQ(total.passes.size(), 3u);
    EXPECT_EQ(total.passes[0].name, "draw");
    EXPECT_EQ(total.passes[0].gpuMilliseconds, 3.0);
    EXPECT_EQ(total.passes[0].cpuMilliseconds, 6.0);
    EXPECT_EQ(total.passes[1].gpuMilliseconds, 15.0);
    EXPECT_EQ(total.passes[2].name, "tone map");
    EXPECT_EQ(total.cpuMilliseconds, 9.0);
    EXPECT_EQ(total.wallMilliseconds, 12.0);
    EXPECT_EQ(total.counters.at("rays traced"), 10u);
    const core::Decision* blur = render::findDecision(total.explanations, "motion blur");
    ASSERT_NE(blur, nullptr);
    EXPECT_EQ(core::describe(*blur), "ran: later");
}

TEST(Statistics, MemoryIsUsedAgainSoItsSumIsItsMaximum) {
    render::FrameStatistics total;
    addStatistics(total, makeFrame(5.0));
    addStatistics(total, makeFrame(2.0));
    EXPECT_EQ(total.transientBytes, 500u);
}

TEST(Statistics, AFigureThatIsNotFiniteIsNullAndOthersKeepEveryBit) {
    const test::TempFolder folder;
    const std::filesystem::path path = folder.path() / "stats.json";
    RenderOptions options;
    options.method = findMethod("sharp").value();
    options.scene = "a\xFF.gltf";
    render::FrameStatistics frame = makeFrame(1.0 / 3.0);
    frame.measures = {
        {"error", std::numeric_limits<double>::infinity()}, {"ms", std::nextafter(0.1, 1.0)}};
    ASSERT_TRUE(writeStatistics(path, options, {}, {{0.0, frame}}).ok());
    std::ifstream stream(path);
    const auto root = nlohmann::ordered_json::parse(stream);
    EXPECT_EQ(root.at("scene"), "a\uFFFD.gltf");
    const auto& picture = root.at("pictures").at(0);
    EXPECT_TRUE(picture.at("measures").at("error").is_null());
    EXPECT_EQ(picture.at("measures").at("ms").get<double>(), std::nextafter(0.1, 1.0));
    EXPECT_EQ(picture.at("passes").at(0).at("gpu_ms").get<double>(), 1.0 / 3.0);
    std::vector<std::string> names;
    for (const auto& [name, value] : picture.items())
        names.push_back(name);
    EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
}

TEST(Statistics, AFileThatCannotBeFinishedLeavesTheOldOneAndNothingElse) {
    std::string pattern = (std::filesystem::temp_directory_path() / "shutter-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    const std::filesystem::path folder = pattern;
    const std::filesystem::path path = folder / "stats.json";
    RenderOptions options;
    options.method = findMethod("sharp").value();
    ASSERT_TRUE(writeStatistics(path, options, {}, {{0.0, makeFrame(1.0)}}).ok());
    const auto size = std::filesystem::file_size(path);
    // No file may grow beyond 100 bytes.
    rlimit old{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
    const auto oldHandler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit tight{100, old.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
    const core::Status written = writeStatistics(path, options, {}, {{0.0, makeFrame(2.0)}});
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &old), 0);
    std::signal(SIGXFSZ, oldHandler);
    ASSERT_FALSE(written.ok());
    EXPECT_NE(written.error().message.find("--stats"), std::string::npos);
    EXPECT_NE(written.error().message.find(path.string()), std::string::npos);
    EXPECT_EQ(std::filesystem::file_size(path), size);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
    std::filesystem::remove_all(folder);
}

} // namespace shutter::game
