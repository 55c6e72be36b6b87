// SPDX-License-Identifier: MIT
// The shader's skinning, morphing and waves against double precision.
#include "engine/extract/motion_keys.h"
#include "engine/math/math.h"
#include "shaders/render/deform.glsl"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace shutter::shader {

namespace {

using math::dmat3;
using math::dmat4;
using math::dvec3;
using math::dvec4;

constexpr float kInfinite = std::numeric_limits<float>::infinity();
constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

class RandomMatrices {
  public:
    double operator()() { return mValue(mEngine); }

    dvec3 vector() { return {(*this)(), (*this)(), (*this)()}; }

    dmat4 matrix() {
        dmat4 result(1.0);
        for (int column = 0; column < 4; ++column)
            result[column] = dvec4(vector(), column == 3 ? 1.0 : 0.0);
        return result;
    }

  private:
    std::mt19937 mEngine{7};
    std::uniform_real_distribution<double> mValue{-1.0, 1.0};
};

DeformedVertex makeVertex(const dvec3& position, const dvec3& normal, const dvec3& tangent) {
    return {vec3(position), vec3(normal), vec3(tangent)};
}

const DeformedVertex kRest = makeVertex({1, 2, 3}, {0, 0, 1}, {1, 0, 0});

double distance(const vec3& a, const dvec3& b) {
    return glm::length(dvec3(a) - b);
}

bool isFiniteVector(const vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

} // namespace

TEST(Deform, SkinningIsTheWeightedSumOfWhatEachJointDoes) {
    RandomMatrices random;
    for (int round = 0; round < 200; ++round) {
        const std::array joints{random.matrix(), random.matrix(), random.matrix()};
        const std::array weights{0.5, 0.375, 0.125};
        const DeformedVertex rest = makeVertex(
            random.vector(), glm::normalize(random.vector()), glm::normalize(random.vector())
        );
        MotionKey blended = noJoint();
        dmat4 exact(0.0);
        for (size_t i = 0; i < joints.size(); ++i) {
            blended = addJoint(blended, extract::makeKey(joints[i]), float(weights[i]));
            exact += joints[i] * weights[i];
        }
        const DeformedVertex skinned = finishVertex(skinVertex(rest, blended));
        EXPECT_LT(
            distance(skinned.position, dvec3(exact * dvec4(dvec3(rest.position), 1.0))), 1e-6
        );
        const dmat3 linear(exact);
        const dvec3 normal =
            glm::determinant(linear) * (glm::transpose(glm::inverse(linear)) * dvec3(rest.normal));
        EXPECT_LT(distance(skinned.normal, glm::normalize(normal)), 1e-4);
        EXPECT_LT(distance(skinned.tangent, glm::normalize(linear * dvec3(rest.tangent))), 1e-4);
    }
}

TEST(Deform, AMirroringMatrixTurnsTheNormalAsItTurnsTheWinding) {
    const MotionKey mirror = extract::makeKey(glm::scale(dmat4(1.0), dvec3(-2.0, 1.0, 1.0)));
    const DeformedVertex mirrored = finishVertex(skinVertex(kRest, mirror));
    EXPECT_EQ(mirrored.position, vec3(-2, 2, 3));
    EXPECT_EQ(mirrored.normal, vec3(0, 0, -1));
    EXPECT_EQ(mirrored.tangent, vec3(-1, 0, 0));
}

TEST(Deform, MorphTargetsAddUpBeforeTheSkin) {
    const MorphDelta first{vec4(1, 0, 0, 9), vec4(0, 1, 0, 9), vec4(0, 0, 1, 9)};
    const MorphDelta second{vec4(0, -2, 0, 9), vec4(0, 0, -1, 9), vec4(0, 0, 0, 9)};
    const DeformedVertex morphed = morphVertex(morphVertex(kRest, first, 0.5f), second, 0.25f);
    EXPECT_EQ(morphed.position, vec3(1.5, 1.5, 3));
    EXPECT_EQ(morphed.normal, vec3(0, 0.5, 0.75));
    EXPECT_EQ(morphed.tangent, vec3(1, 0, 0.5));
    const dmat4 turn = glm::rotate(dmat4(1.0), 1.0, dvec3(0, 0, 1));
    const DeformedVertex skinned = finishVertex(skinVertex(morphed, extract::makeKey(turn)));
    EXPECT_LT(distance(skinned.position, dvec3(turn * dvec4(1.5, 1.5, 3, 1))), 1e-6);
    EXPECT_NEAR(glm::length(skinned.normal), 1.0f, 1e-6f);
}

DeformJob makeWaveJob(uint share, float exponent) {
    DeformJob job{};
    job.waveShare = share;
    job.waveExponent = exponent;
    job.waveHeight = vec4(0.0f, 0.5f, 0.1f, 0.2f);
    return job;
}

vec3 waveAt(const DeformJob& job, const WaveRow& row, const vec3& position) {
    const WaveShareAt at = findWaveShare(job, position, vec4(0.25f));
    return waveVertex(
               {position, vec3(0, 0, 1), vec3(1, 0, 0)}, addWave(noWave(), row, at, position)
    )
        .position;
}

TEST(DeformWaves, WavesTurnNormalsAndTangentsWithTheSurface) {
    const WaveRow row{vec4(0.1f, 0.05f, 0.3f, 0.4f), vec4(2.0f, 1.0f, -0.5f, 0.0f)};
    for (const uint share : {kWaveShareAll, kWaveShareHeight})
        for (const vec3& position : {vec3(0.1f, 0.6f, 0.2f), vec3(-0.4f, 1.0f, -0.3f)}) {
            const DeformJob job = makeWaveJob(share, 2.0f);
            const WaveShareAt at = findWaveShare(job, position, vec4(1.0f));
            const DeformedVertex waved = finishVertex(waveVertex(
                {position, vec3(0, 0, 1), vec3(1, 0, 0)}, addWave(noWave(), row, at, position)
            ));
            const float step = 1e-2f;
            const auto along = [&](const vec3& way) {
                return (waveAt(job, row, position + step * way) -
                        waveAt(job, row, position - step * way)) /
                       (2.0f * step);
            };
            const vec3 x = along({1, 0, 0});
            const vec3 y = along({0, 1, 0});
            EXPECT_LT(distance(waved.tangent, dvec3(glm::normalize(x))), 1e-3);
            EXPECT_LT(distance(waved.normal, dvec3(glm::normalize(glm::cross(x, y)))), 1e-3);
        }
}

TEST(DeformWaves, SharesOfHeightAndOfColorLieWithinZeroAndOne) {
    const DeformJob job = makeWaveJob(kWaveShareHeight, 3.0f);
    EXPECT_EQ(findWaveShare(job, vec3(0, -0.4f, 0), vec4(1)).share, 0.0f);
    EXPECT_EQ(findWaveShare(job, vec3(0, 1.7f, 0), vec4(1)).share, 1.0f);
    EXPECT_EQ(findWaveShare(job, vec3(0, 1.7f, 0), vec4(1)).gradient, vec3(0.0f));
    EXPECT_NEAR(findWaveShare(job, vec3(0, 0.6f, 0), vec4(1)).share, 0.125f, 1e-6f);
    EXPECT_EQ(findWaveShare(job, vec3(kNotANumber, 0, 0), vec4(1)).share, 0.0f);
    EXPECT_EQ(findWaveShare(job, vec3(0, kInfinite, 0), vec4(1)).share, 1.0f);
    const vec4 color(0.5f, -1.0f, 7.0f, kNotANumber);
    const float expected[] = {0.25f, 0.0f, 1.0f, 0.0f};
    for (uint channel = 0; channel < 4; ++channel)
        EXPECT_EQ(
            findWaveShare(makeWaveJob(kWaveShareColor + channel, 2.0f), vec3(0), color).share,
            expected[channel]
        ) << channel;
}

TEST(DeformWaves, ManyTurnsFromTheOriginAreTheSineOfTheRest) {
    const DeformJob job = makeWaveJob(kWaveShareAll, 1.0f);
    const WaveRow row{vec4(0, 0, 1, 0.5f), vec4(6.2831853f, 0, 0, 0)};
    EXPECT_NEAR(waveAt(job, row, vec3(-100, 0, 0)).z, std::sin(0.5f), 1e-3f);
    EXPECT_TRUE(isFiniteVector(waveAt(job, row, vec3(1e30f, 0, 0))));
}

TEST(Deform, AVectorWithoutADirectionIsZero) {
    for (const vec3& nothing :
         {vec3(0.0f),
          vec3(kNotANumber, 1, 1),
          vec3(1, kNotANumber, 1),
          vec3(1, 1, kNotANumber),
          vec3(kInfinite, 0, 0),
          vec3(0, -kInfinite, 1)})
        EXPECT_EQ(unitOrZero(nothing), vec3(0.0f));
    for (const float size : {1e-38f, 1e-20f, 1.0f, 1e20f, 3e38f}) {
        const vec3 unit = unitOrZero(vec3(0, size, 0));
        EXPECT_NEAR(unit.y, 1.0f, 1e-6f) << size;
    }
}

TEST(Deform, CollapsedJointsAndPositionsThatAreNotFiniteLeaveFiniteVertices) {
    const DeformedVertex point = finishVertex(skinVertex(kRest, noJoint()));
    EXPECT_EQ(point.position, vec3(0.0f));
    EXPECT_EQ(point.normal, vec3(0.0f));
    EXPECT_EQ(point.tangent, vec3(0.0f));
    const DeformedVertex flat = finishVertex(
        skinVertex(kRest, extract::makeKey(glm::scale(dmat4(1.0), dvec3(1.0, 1.0, 0.0))))
    );
    EXPECT_EQ(flat.position, vec3(1, 2, 0));
    EXPECT_EQ(flat.normal, vec3(0, 0, 1));
    for (const float bad : {kNotANumber, kInfinite, -kInfinite})
        for (int axis = 0; axis < 3; ++axis) {
            DeformedVertex vertex = kRest;
            vertex.position[axis] = bad;
            const DeformedVertex finished = finishVertex(vertex);
            EXPECT_EQ(finished.position, vec3(0.0f));
            EXPECT_EQ(finished.normal, vec3(0, 0, 1));
        }
}

TEST(Deform, JointsAreUnpackedInTheirOrder) {
    const uint expected[] = {0xFFFFu, 2u, 3u, 65534u};
    for (uint i = 0; i < 4; ++i)
        EXPECT_EQ(unpackJoint(uvec2(0xFFFFu | 2u << 16u, 3u | 65534u << 16u), i), expected[i]) << i;
}

} // namespace shutter::shader
