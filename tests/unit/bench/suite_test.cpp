// SPDX-License-Identifier: MIT
#include "game/bench/contenders.h"
#include "game/bench/suites/suite.h"

#include <gtest/gtest.h>

#include <algorithm>
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

TEST(Suites, ClaimsAreToldApartAndSayWhatTheyCompare) {
    const auto suite = findSuite("demand");
    ASSERT_TRUE(suite.ok());
    EXPECT_EQ(suite.value().size.width, 1280u);
    EXPECT_EQ(suite.value().size.height, 720u);
    std::set<std::string> names;
    for (const demand::Claim& claim : suite.value().claims) {
        EXPECT_TRUE(names.insert(claim.name).second) << claim.name;
        EXPECT_FALSE(claim.title.empty()) << claim.name;
        EXPECT_TRUE(claim.description.ends_with('.')) << claim.name;
        EXPECT_TRUE(claim.measure) << claim.name;
    }
    EXPECT_EQ(names.size(), 8u);
}

TEST(Suites, AnUnknownNameIsAnsweredWithTheKnownOnes) {
    const auto found = findSuite("nosuch");
    ASSERT_FALSE(found.ok());
    for (const char* part : {"--suite", "nosuch", "paper", "hard", "scaling"})
        EXPECT_NE(found.error().message.find(part), std::string::npos) << part;
}

TEST(Sweep, RisesWithinAMethodAndHoldsItsDefaultOnce) {
    std::vector<const game::MethodInfo*> methods;
    for (const game::MethodInfo& method : listContenders())
        methods.push_back(&method);
    const std::vector<SamplePoint> sweep = makeSweep(methods, 256);
    for (size_t i = 1; i < sweep.size(); ++i)
        if (sweep[i].method == sweep[i - 1].method) {
            EXPECT_LT(sweep[i - 1].samples, sweep[i].samples) << sweep[i].method->name;
        }
    for (const game::MethodInfo* method : methods) {
        const auto isDefault = [&](const SamplePoint& point) {
            return point.method == method && point.isDefault;
        };
        const auto count = std::count_if(sweep.begin(), sweep.end(), isDefault);
        // The truth's own default is what the others are compared with.
        EXPECT_EQ(count, method->family == game::MethodFamily::Accumulate ? 0 : 1) << method->name;
    }
}

TEST(Contenders, AreTheMethodsAndThePapersWithItsNumbers) {
    for (const game::MethodInfo& method : game::listMethods()) {
        const auto found = findContender(method.name);
        ASSERT_TRUE(found.ok()) << found.error().message;
        const game::MethodOptions options =
            makeMethodOptions({found.value(), method.defaultSamples, true});
        EXPECT_STREQ(options.method->name, method.name);
        motion_blur::MotionBlurSettings expected;
        if (method.blur) {
            expected.method = method.blur;
            expected.sampleCount = method.defaultSamples;
        }
        EXPECT_EQ(options.motionBlur, expected) << method.name;
    }
    const game::MethodInfo* paper = findContender("hybrid_paper").value();
    EXPECT_EQ(makeMethodOptions({paper, 15, true}).motionBlur, motion_blur::paperSettings());
    const auto missing = findContender("nosuch");
    ASSERT_FALSE(missing.ok());
    EXPECT_NE(missing.error().message.find("gather_paper"), std::string::npos);
}

} // namespace shutter::bench
