// SPDX-License-Identifier: MIT
// What a host says wrongly of its motion is refused by one sentence that names it.
#include "tests/unit/motion_blur/host_motion_fixture.h"

#include <functional>
#include <limits>
#include <string>

namespace shutter::motion_blur {
namespace {

using math::dmat4;
using math::dvec4;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class HostMotionCheck : public HostMotionFixture {
  protected:
    void SetUp() override { reset(); }

    void reset() {
        motion = {};
        frame.hasResponse = false;
        setKeys({0.0, 0.5, 1.0});
        addTumbler();
        response = {};
        response.knotCount = 2;
        response.knots[1] = {1.0f, 2.0f, 1.0f, 0.0f};
    }

    /// Refused after the change, by one sentence with `part`; accepted without it.
    void refuse(const std::function<void()>& change, const std::string& part) {
        reset();
        ASSERT_TRUE(check().ok()) << check().error().message;
        change();
        const core::Status status = check();
        ASSERT_FALSE(status.ok()) << "expected: " << part;
        const std::string& message = status.error().message;
        EXPECT_NE(message.find(part), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }

    void giveResponse() {
        motion.response = &response;
        frame.hasResponse = true;
    }

    shader::ResponseTable response{};
};

TEST_F(HostMotionCheck, EachBadKeyIsNamed) {
    refuse([&] { motion.keys = {}; }, "motion.keys holds 0, it needs 1 to 64");
    refuse([&] { setKeys(std::vector<double>(65, 0.5)); }, "motion.keys holds 65");
    refuse(
        [&] {
            motion.keys = {static_cast<const HostCameraKey*>(nullptr), 3};
        },
        "motion.keys is null, its size is 3"
    );
    refuse([&] { keys[1].time = kNan; }, "motion.keys[1].time is nan");
    refuse([&] { keys[2].time = 2.0e6; }, "motion.keys[2].time is 2000000, it must be -1000000 to");
    refuse([&] { keys[0].time = -2.0e6; }, "motion.keys[0].time is -2000000");
    refuse([&] { keys[0].time = -HUGE_VAL; }, "motion.keys[0].time is -inf");
    refuse([&] { keys[1].time = 0.0; }, "motion.keys[1].time is 0, not after");
    refuse([&] { keys[2].time = 0.9; }, "motion.keys has no key at rasterTime, which is 1");
    refuse(
        [&] { keys[1].viewFromWorld[2][1] = kNan; }, "motion.keys[1].viewFromWorld is not finite"
    );
    refuse(
        [&] { keys[0].viewFromWorld[2] = dvec4(0.0); }, "motion.keys[0].viewFromWorld is singular"
    );
    refuse([&] { keys[0].viewFromWorld[1].w = 1.0; }, "motion.keys[0].viewFromWorld is not affine");
    refuse(
        [&] { keys[0].viewFromWorld = dmat4(0.0); }, "motion.keys[0].viewFromWorld is not affine"
    );
}

TEST_F(HostMotionCheck, EachBadProjectionIsNamed) {
    const std::string name = "motion.keys[1].clipFromView ";
    refuse([&] { keys[1].clipFromView[0][0] = kNan; }, name + "is not finite");
    refuse([&] { keys[1].clipFromView[0][0] = 0.0; }, name + "is singular");
    refuse([&] { keys[1].clipFromView = dmat4(0.0); }, name + "is neither perspective nor ortho");
    refuse([&] { keys[1].clipFromView[0].w = 0.5; }, name + "is neither perspective nor ortho");
    refuse([&] { keys[1].clipFromView[3].w = 1.0; }, name + "is neither perspective nor ortho");
    refuse(
        [&] { keys[1].clipFromView = math::clipFromViewOrthographic(1.0, 1.0, 0.1, 9.0); },
        name + "is orthographic, motion.keys[0].clipFromView is not"
    );
    refuse([&] { keys[1].clipFromView[2] *= -1.0; }, name + "looks along +Z");
    refuse([&] { motion.aheadIsPlusZ = true; }, "motion.keys[0].clipFromView looks along -Z");
}

TEST_F(HostMotionCheck, EachBadMoverIsNamed) {
    refuse([&] { motion.rowCount = 0; }, "motion.rowCount is 0, it must be 1 to 16777215");
    refuse([&] { motion.rowCount = 1u << 24u; }, "motion.rowCount is 16777216");
    refuse([&] { movers[0].row = kRows; }, "motion.movers[0].row is 4, rowCount 4");
    refuse(
        [&] {
            movers.push_back(movers[0]);
            motion.movers = movers;
        },
        "motion.movers[1].row is 1, as another mover's is"
    );
    refuse(
        [&] {
            motion.movers = {static_cast<const HostMover*>(nullptr), 1};
        },
        "motion.movers is null, its size is 1"
    );
    refuse(
        [&] { movers[0].worldFromObject = movers[0].worldFromObject.first(2); },
        "motion.movers[0].worldFromObject holds 2, motion.keys 3"
    );
    refuse(
        [&] {
            movers[0].worldFromObject = {static_cast<const dmat4*>(nullptr), 3};
        },
        "motion.movers[0].worldFromObject is null"
    );
    refuse([&] { matrices[2][3][0] = kNan; }, "motion.movers[0].worldFromObject[2] is not finite");
    refuse([&] { matrices[1][1].w = 0.5; }, "motion.movers[0].worldFromObject[1] is not affine");
}

TEST_F(HostMotionCheck, BadIdsAreNamed) {
    const std::vector<uint64_t> ids(3);
    refuse([&] { motion.rowIds = ids; }, "motion.rowIds holds 3, rowCount is 4");
    refuse(
        [&] {
            motion.rowIds = {static_cast<const uint64_t*>(nullptr), kRows};
        },
        "motion.rowIds is null"
    );
}

TEST_F(HostMotionCheck, ABadResponseIsNamed) {
    refuse([&] { frame.hasResponse = true; }, "motion.response is null, response is not 0");
    refuse([&] { motion.response = &response; }, "motion.response is given, response is 0");
    reset();
    giveResponse();
    EXPECT_TRUE(check().ok());
    const auto refuseTable = [&](const std::function<void()>& change, const std::string& part) {
        refuse(
            [&] {
                giveResponse();
                change();
            },
            part
        );
    };
    refuseTable([&] { response.knotCount = 1; }, "motion.response->knotCount is 1");
    refuseTable([&] { response.knotCount = 65; }, "motion.response->knotCount is 65");
    refuseTable([&] { response.knots[0].s = 0.5f; }, "motion.response->knots[0]");
    refuseTable([&] { response.knots[1].s = 0.5f; }, "motion.response->knots[1]");
    refuseTable([&] { response.knots[1].density = float(kNan); }, "motion.response->knots[1]");
    refuseTable([&] { response.knots[1].cumulative = 2.0f; }, "motion.response->knots[1]");
    refuseTable([&] { response.firstKnots[0] = 1; }, "motion.response->firstKnots[0] is 1");
    refuseTable([&] { response.firstKnots[9] = 64; }, "motion.response->firstKnots[9] is 64");
}

} // namespace
} // namespace shutter::motion_blur
