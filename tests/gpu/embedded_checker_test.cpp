// SPDX-License-Identifier: MIT
// The checker finds what a host gets wrong, on real scenes under a moving camera, and says nothing
// of hosts that are right, whatever their convention.
#include "tests/gpu/checker_host.h"
#include "tests/support/picture.h"

#include <memory>
#include <set>
#include <string>
#include <vector>

namespace shutter {
namespace {

class EmbeddedChecker : public test::CheckerHost {};

TEST_P(EmbeddedChecker, CostsNothingWhenOffAndChangesNoBit) {
    const test::CheckCase& plain = test::listRightHosts().front();
    motion_blur::HostDevice host = describeHost();
    const auto off = create(host);
    host.checksInputs = true;
    const auto on = create(host);
    const auto drawWith = [&](motion_blur::EmbeddedMotionBlur& blur,
                              std::set<std::string>& passes) {
        test::GivenFrame given = give(0, plain);
        given.inputs.observe = [&](graph::Graph& graph, const auto&, const auto&) {
            for (const graph::PassRecord& pass : graph.passes())
                passes.insert(pass.name);
        };
        const test::Picture output(device(), "output", {test::kCheckedWidth, test::kCheckedHeight});
        given.inputs.output = {output.handle(), test::kNothing, test::kCopied};
        record(blur, 0, given, &output);
        return output.read();
    };
    std::set<std::string> without;
    std::set<std::string> with;
    EXPECT_TRUE(test::sameBits(drawWith(*off, without), drawWith(*on, with)));
    for (const std::string& pass : without)
        EXPECT_EQ(pass.find("check"), std::string::npos) << pass;
    EXPECT_TRUE(with.contains("check picture") && with.contains("check ids"));
    // What the checker holds is made in the first frame.
    std::set<std::string> again;
    (void)drawWith(*on, again);
    const gpu::LivingObjects before = on->living();
    for (int i = 0; i < 3; ++i)
        (void)drawWith(*on, again);
    EXPECT_EQ(on->living(), before);
}

TEST_P(EmbeddedChecker, NamesEachMistake) {
    if (GetParam().hidesMistakes)
        return;
    std::vector<test::CheckCase> mistakes = test::listMistakes();
    const auto& more = test::listMotionMistakes();
    mistakes.insert(mistakes.end(), more.begin(), more.end());
    for (const test::CheckCase& one : mistakes) {
        SCOPED_TRACE(one.name);
        if (one.name == "a mover that is not listed" && give(0, one).movers.empty())
            continue; // none is in view
        if (one.needsMovers && give(0, one).matrices.empty())
            continue; // the same
        std::string all;
        for (const std::string& sentence : check(one))
            all += sentence + "\n";
        const bool isOther = GetParam().orthographicYMag > 0.0 && !one.orthographicSentence.empty();
        const std::string& wanted = isOther ? one.orthographicSentence : one.sentence;
        EXPECT_NE(all.find(wanted), std::string::npos) << wanted << "\nsaid:\n" << all;
    }
}

TEST_P(EmbeddedChecker, SaysNothingOfWhatIsRight) {
    for (const test::CheckCase& one : test::listRightHosts()) {
        SCOPED_TRACE(one.name);
        for (const std::string& sentence : check(one))
            EXPECT_NE(sentence.find("is checked"), std::string::npos) << sentence;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes,
    EmbeddedChecker,
    testing::ValuesIn(test::listCheckScenes()),
    [](const auto& scene) { return scene.param.name; }
);

} // namespace
} // namespace shutter
