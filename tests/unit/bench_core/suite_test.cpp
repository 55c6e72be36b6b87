// SPDX-License-Identifier: MIT
#include "game/bench/suites/suite.h"

#include <gtest/gtest.h>

#include <set>

namespace shutter::bench {

TEST(Suites, AreFoundByNameAndTheirShotsAreValidOptions) {
    for (const char* name : {"paper", "hard", "scaling"}) {
        auto suite = findSuite(name);
        ASSERT_TRUE(suite.ok()) << name;
        std::vector<Case> cases = suite.value().cases;
        for (const ScalingAxis& axis : suite.value().axes)
            for (const ScalingPoint& point : axis.points)
                cases.push_back(point.shot);
        EXPECT_FALSE(cases.empty()) << name;
        std::set<std::string> names;
        for (Case& shot : cases) {
            EXPECT_TRUE(names.insert(shot.name).second) << shot.name;
            EXPECT_EQ(shot.name.find_first_of("/ "), std::string::npos) << shot.name;
            shot.shot.scene = "x.glb";
            const auto options = game::interpret(shot.shot);
            EXPECT_TRUE(options.ok()) << shot.name << ": " << options.error().message;
        }
    }
}

TEST(Suites, TheHardOneHasTwelveCases) {
    EXPECT_EQ(findSuite("hard").value().cases.size(), 12u);
}

TEST(Suites, SequencesAreThreeFlightsAndThreePlayedDemos) {
    const auto suite = findSuite("sequence");
    ASSERT_TRUE(suite.ok());
    std::set<std::string> names;
    std::set<std::string> demos;
    for (const SequenceCase& film : suite.value().sequences) {
        EXPECT_TRUE(names.insert(film.name).second) << film.name;
        EXPECT_EQ(film.name.find_first_of("/ "), std::string::npos) << film.name;
        EXPECT_TRUE(film.description.ends_with('.')) << film.name;
        EXPECT_TRUE(film.writeScene) << film.name;
        EXPECT_TRUE(film.script.starts_with('{')) << film.name;
        if (!film.demo.empty())
            demos.insert(film.demo);
    }
    EXPECT_EQ(names.size(), 6u);
    EXPECT_EQ(demos, (std::set<std::string>{"gallery", "rally", "spin"}));
}

TEST(Suites, AnUnknownNameIsAnsweredWithTheKnownOnes) {
    const auto found = findSuite("nosuch");
    ASSERT_FALSE(found.ok());
    for (const char* part : {"--suite", "nosuch", "paper", "hard", "scaling"})
        EXPECT_NE(found.error().message.find(part), std::string::npos) << part;
}

} // namespace shutter::bench
