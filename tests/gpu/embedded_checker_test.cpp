// SPDX-License-Identifier: MIT
// The checker reports mistakes of hosts on real scenes under a moving camera, and nothing for valid
// hosts of any convention; and inputs that `resolved` does not require: vectors of movers with
// matrices, ids without movers, the previous frame at a cut.
#include "engine/image/metrics.h"
#include "tests/gpu/checker_host.h"

#include <cstdlib>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace shutter {
namespace {

class EmbeddedChecker : public test::CheckerHost {
  protected:
    /// Every second one, those that scenes of even numbers leave out in scenes of odd numbers; all
    /// with SHUTTER_CHECK_ALL set. The pipelines of each case take lavapipe a second or two.
    static std::vector<test::CheckCase> choose(const std::vector<test::CheckCase>& all) {
        if (std::getenv("SHUTTER_CHECK_ALL"))
            return all;
        const std::vector<test::CheckScene> scenes = test::listCheckScenes();
        size_t i = 0;
        while (scenes[i].name != GetParam().name)
            ++i;
        std::vector<test::CheckCase> chosen;
        for (i %= 2; i < all.size(); i += 2)
            chosen.push_back(all[i]);
        return chosen;
    }
};

TEST_P(EmbeddedChecker, TheCheckerIsFreeWhenOffAndChangesNoBit) {
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
        const test::Picture output(device(), {test::kCheckedWidth, test::kCheckedHeight});
        given.inputs.output = output.output();
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

TEST_P(EmbeddedChecker, EachMistakeIsNamed) {
    if (GetParam().hidesMistakes)
        return;
    for (const test::CheckCase& one : choose(test::listMistakes())) {
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

TEST_P(EmbeddedChecker, ValidInputsAreNotReported) {
    for (const test::CheckCase& one : choose(test::listRightHosts())) {
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

class EmbeddedWorld : public test::CheckerHost {
  protected:
    /// The last of three frames by `resolved`.
    image::Image draw(const std::function<void(test::GivenFrame&)>& change) {
        const auto blur = create(describeHost());
        const test::Picture output(device(), {test::kCheckedWidth, test::kCheckedHeight});
        for (int frame = 0; frame < 3; ++frame) {
            test::GivenFrame given = give(frame, test::listRightHosts().front());
            given.isResolved = true;
            test::giveMatrices(given);
            std::erase_if(given.listed, [](const auto& mover) {
                return mover.worldFromObject.empty();
            });
            given.inputs.output = output.output();
            change(given);
            given.inputs.convention.cameras = given.cameras;
            record(*blur, uint32_t(frame % 2), given, &output);
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
        given.inputs.convention.scales.isCut = true;
        given.cameras.viewFromWorldBefore = given.cameras.clipFromViewBefore = math::dmat4(0.0);
        given.keys.front().viewFromWorld = math::dmat4(0.0);
        given.keys.front().clipFromView = math::dmat4(0.0);
        for (std::vector<math::dmat4>& matrices : given.matrices)
            matrices.front() = math::dmat4(0.0);
    });
    EXPECT_TRUE(test::sameBits(cut, drawSharp()));
}

std::vector<test::CheckScene> listGenerated() {
    std::vector<test::CheckScene> scenes = test::listCheckScenes();
    scenes.resize(3);
    return scenes;
}

INSTANTIATE_TEST_SUITE_P(
    Scenes,
    EmbeddedWorld,
    testing::ValuesIn(listGenerated()),
    [](const auto& scene) { return scene.param.name; }
);

} // namespace
} // namespace shutter
