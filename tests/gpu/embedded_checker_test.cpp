// SPDX-License-Identifier: MIT
// The checker reports mistakes of hosts on real scenes under a moving camera, and nothing for valid
// hosts of any convention; and inputs that `resolved` does not require: vectors of movers with
// matrices, ids without movers, the previous frame at a cut.
#include "engine/image/metrics.h"
#include "tests/gpu/checker_host.h"
#include "tests/kit/sweep.h"

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace shutter {
namespace {

constexpr auto kNameOfScene = [](const auto& scene) { return scene.param.name; };

class EmbeddedChecker : public test::CheckerHost {
  protected:
    /// Those of even or of odd numbers; all with SHUTTER_ALL.
    static std::vector<test::CheckCase>
    takeHalf(const std::vector<test::CheckCase>& all, size_t first) {
        if (test::drawsAll())
            return all;
        std::vector<test::CheckCase> taken;
        for (size_t i = first; i < all.size(); i += 2)
            taken.push_back(all[i]);
        return taken;
    }

    /// A car was made to drive before the camera, so that each mistake can be seen.
    static bool hasSureMover() { return GetParam().prepare != nullptr; }
};

TEST_P(EmbeddedChecker, EachMistakeIsNamed) {
    if (GetParam().hidesMistakes)
        return;
    size_t hidden = 0;
    const auto& all = test::listMistakes();
    for (const test::CheckCase& one : hasSureMover() ? all : takeHalf(all, 1)) {
        SCOPED_TRACE(one.name);
        if (one.needsMovers && give(0, one).matrices.empty()) {
            ++hidden; // none is in view
            continue;
        }
        const bool isOther = GetParam().orthographicYMag > 0.0 && !one.orthographicSentence.empty();
        const std::string& wanted = isOther ? one.orthographicSentence : one.sentence;
        const auto report = [&] {
            std::string sentences;
            for (const std::string& sentence : check(one))
                sentences += sentence + "\n";
            return sentences;
        };
        if (report().find(wanted) != std::string::npos)
            continue;
        replaceShared(); // it may have reported another mistake of this kind
        const std::string again = report();
        EXPECT_NE(again.find(wanted), std::string::npos) << wanted << "\nsaid:\n" << again;
    }
    EXPECT_TRUE(hidden == 0 || !hasSureMover()) << "no mover is in view";
}

TEST_P(EmbeddedChecker, ValidInputsAreNotReported) {
    for (const test::CheckCase& one : takeHalf(test::listRightHosts(), hasSureMover() ? 0 : 1)) {
        SCOPED_TRACE(one.name);
        for (const std::string& sentence : check(one))
            EXPECT_NE(sentence.find("is checked"), std::string::npos) << sentence;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, EmbeddedChecker, testing::ValuesIn(test::listCheckScenes()), kNameOfScene
);

/// Hosts whose inputs are not checked, in the first of the scenes; all with SHUTTER_ALL.
class EmbeddedWorld : public test::CheckerHost {
  protected:
    [[nodiscard]] motion_blur::HostDevice hostOfSuite() const override { return describeHost(); }

    /// The last of three frames by `resolved`.
    image::Image draw(const std::function<void(test::GivenFrame&)>& change) {
        forgetFrames();
        const test::Picture output(device(), {test::kCheckedWidth, test::kCheckedHeight});
        for (int frame = 0; frame < 3; ++frame) {
            test::GivenFrame given = give(frame, test::listRightHosts().front());
            given.isResolved = true;
            test::giveMatricesOnly(given);
            given.inputs.output = output.output();
            change(given);
            given.inputs.convention.cameras = given.cameras;
            record(*mBlur, uint32_t(frame % 2), given, &output);
        }
        return output.read();
    }

    image::Image drawSharp() {
        return draw([](test::GivenFrame& given) {
            given.keys = {given.keys.back()};
            given.listed.clear();
            given.inputs.motion.followsLast = false;
        });
    }
};

TEST_P(EmbeddedWorld, TheCheckerIsFreeWhenOffAndChangesNoBit) {
    motion_blur::HostDevice host = describeHost();
    host.checksInputs = true;
    const auto on = create(host);
    const auto drawWith = [&](motion_blur::EmbeddedMotionBlur& blur,
                              std::set<std::string>& passes) {
        test::GivenFrame given = give(0, test::listRightHosts().front());
        given.inputs.observe = [&](graph::Graph& graph, const auto&, const auto&) {
            for (const graph::PassRecord& pass : graph.passes())
                passes.insert(pass.name);
        };
        const test::Picture output(device(), {test::kCheckedWidth, test::kCheckedHeight});
        given.inputs.output = output.output();
        record(blur, 0, given, &output);
        return output.read();
    };
    std::set<std::string> without;
    std::set<std::string> with;
    EXPECT_TRUE(test::sameBits(drawWith(*mBlur, without), drawWith(*on, with)));
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

TEST_P(EmbeddedWorld, RigidMoversNeedNoVectors) {
    const image::Image with = draw([](test::GivenFrame&) {});
    const image::Image without = draw([](test::GivenFrame& given) { given.hasVectors = false; });
    EXPECT_GT(image::computePsnr(without, with), 60.0);
    EXPECT_LT(image::computePsnr(with, drawSharp()), 45.0) << "nothing was blurred";
    const image::Image still = draw([](test::GivenFrame& given) {
        given.hasVectors = false;
        given.listed.clear();
    });
    EXPECT_LT(image::computePsnr(still, with), 50.0) << "no mover was blurred";
}

TEST_P(EmbeddedWorld, AStillWorldNeedsNoIds) {
    const auto listNothing = [](test::GivenFrame& given) {
        given.listed.clear();
        given.hasVectors = false;
    };
    const image::Image one = draw([&](test::GivenFrame& given) {
        listNothing(given);
        for (size_t i = 0; i < test::kCheckedPixels; ++i)
            given.ids[i] = given.metres[i] >= shader::kSkyDepth ? 0xFFFFFFFFu : 0u;
        given.rowCount = 1;
    });
    const image::Image none = draw([&](test::GivenFrame& given) {
        listNothing(given);
        given.hasIds = false;
        given.rowCount = 0; // does not count
    });
    EXPECT_TRUE(test::sameBits(none, one));
    EXPECT_LT(image::computePsnr(one, drawSharp()), 45.0) << "nothing was blurred";
}

TEST_P(EmbeddedWorld, OnlyTheRasterKeyIsUsedAtACut) {
    const image::Image cut = draw([](test::GivenFrame& given) {
        given.hasVectors = false;
        if (given.frame < 2)
            return;
        given.cutFromLast();
    });
    EXPECT_TRUE(test::sameBits(cut, drawSharp()));
}

std::vector<test::CheckScene> listWorldScenes() {
    std::vector<test::CheckScene> scenes = test::listCheckScenes();
    scenes.resize(test::drawsAll() ? 3 : 1); // which have movers with matrices
    return scenes;
}

INSTANTIATE_TEST_SUITE_P(Scenes, EmbeddedWorld, testing::ValuesIn(listWorldScenes()), kNameOfScene);

} // namespace
} // namespace shutter
