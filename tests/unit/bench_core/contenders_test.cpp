// SPDX-License-Identifier: MIT
#include "game/bench/contenders.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace shutter::bench {

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
