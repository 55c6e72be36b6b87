// SPDX-License-Identifier: MIT
#include "game/film/film.h"
#include "game/film/film_arguments.h"
#include "tests/unit/options/command_words.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

namespace shutter::film {
namespace {

using game::Words;

/// A command line of `shutter film`; its options live as long as this.
class Typed {
  public:
    explicit Typed(Words words) {
        words.insert(words.begin(), "scene.glb");
        std::reverse(words.begin(), words.end()); // as CLI11 takes them
        defineFilmOptions(mApp, mArguments);
        mApp.parse(std::move(words));
    }

    [[nodiscard]] core::Status check() const {
        const auto options = game::interpret(mArguments.render);
        return options ? checkFilm(mArguments, options.value()) : core::Status(options.error());
    }

    [[nodiscard]] const FilmArguments& arguments() const { return mArguments; }

  private:
    CLI::App mApp;
    FilmArguments mArguments;
};

void expectRefused(const Words& more, const std::string& mention) {
    Words words = {"--out", "f.mp4", "--frames", "0:9"};
    words.insert(words.end(), more.begin(), more.end());
    const core::Status checked = Typed(words).check();
    ASSERT_FALSE(checked.ok()) << mention;
    EXPECT_NE(checked.error().message.find(mention), std::string::npos) << checked.error().message;
}

} // namespace

TEST(FilmArgumentsTest, ThePlansWordsMeanWhatWasTyped) {
    const Words words = {"--out",
                         "f_%d.exr",
                         "--frames",
                         "-2:7",
                         "--clip",
                         "a",
                         "--clip",
                         "b",
                         "--unlit",
                         "--method",
                         "accumulate",
                         "--samples",
                         "3",
                         "--jobs",
                         "4",
                         "--parts",
                         "5",
                         "--restart",

                         "--framing-time",
                         "-1.5",
                         "--background",
                         "1,0,0"};
    const Typed typed(words);
    const Words kept = listRenderWords(typed.arguments());
    for (const char* own : {"--jobs", "--parts", "--restart"})
        EXPECT_EQ(std::count(kept.begin(), kept.end(), own), 0) << own;
    const auto direct = game::interpret(typed.arguments().render);
    ASSERT_TRUE(direct.ok()) << direct.error().message;
    const auto again = interpretWords(kept);
    ASSERT_TRUE(again.ok()) << again.error().message;
    EXPECT_EQ(again.value().fingerprint, direct.value().fingerprint);
    EXPECT_EQ(again.value().shot.frameTimes, direct.value().shot.frameTimes);
    EXPECT_EQ(again.value().shot.clips, direct.value().shot.clips);
    EXPECT_EQ(again.value().shot.framingSeconds, direct.value().shot.framingSeconds);
    EXPECT_EQ(again.value().shot.scene, direct.value().shot.scene);
    EXPECT_EQ(again.value().output.out, direct.value().output.out);
    EXPECT_FALSE(again.value().output.restart);
}

TEST(FilmArgumentsTest, WhatDependsOnTheSplitIsRefused) {
    EXPECT_TRUE(Typed({"--out", "f.mp4", "--frames", "0:9", "--jobs", "4"}).check().ok());
    EXPECT_TRUE(Typed({"--out", "f.mp4", "--frames", "0:9", "--aa", "taa"}).check().ok());
    expectRefused({"--aa", "taa", "--jobs", "2"}, "--aa taa");
    expectRefused({"--aa", "taa", "--slurm"}, "--aa taa");
    expectRefused({"--budget", "8"}, "--budget");
    expectRefused({"--stats", "s.json"}, "--stats");
    expectRefused({"--explain"}, "--explain");
    expectRefused({"--repeat", "2"}, "--repeat");
    expectRefused({"--wait"}, "--wait needs --slurm");
    expectRefused({"--slurm", "--jobs", "2"}, "--jobs and --slurm");
    const core::Status single = Typed({"--out", "f.png"}).check();
    ASSERT_FALSE(single.ok());
    EXPECT_NE(single.error().message.find("--flythrough or --frames"), std::string::npos);
}

TEST(FilmArgumentsTest, PartsAreAsManyAsProcessesUnlessTyped) {
    const auto count = [](const Words& more) {
        Words words = {"--out", "f.mp4", "--frames", "0:99"};
        words.insert(words.end(), more.begin(), more.end());
        return countParts(Typed(words).arguments());
    };
    EXPECT_EQ(count({}), 1u);
    EXPECT_EQ(count({"--jobs", "3"}), 3u);
    EXPECT_EQ(count({"--jobs", "3", "--parts", "7"}), 7u);
    EXPECT_EQ(count({"--slurm"}), kSlurmParts);
}

} // namespace shutter::film
