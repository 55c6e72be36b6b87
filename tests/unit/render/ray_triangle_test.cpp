// SPDX-License-Identifier: MIT
#include "engine/math/math.h"
#include "shaders/render/ray_triangle.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace shutter::shader {

namespace {

using math::dvec3;

class Random {
  public:
    vec3 operator()() { return {mValue(mEngine), mValue(mEngine), mValue(mEngine)}; }

  private:
    std::mt19937 mEngine{11};
    std::uniform_real_distribution<float> mValue{-1.0f, 1.0f};
};

} // namespace

TEST(RayTriangle, MeetsWhatDoublePrecisionMeets) {
    Random random;
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const vec3 origin = 2.0f * random();
        const vec3 direction = random() * 3.0f;
        const vec3 a = random();
        const vec3 b = random();
        const vec3 c = random();
        const TriangleHit hit = intersectTriangle(origin, direction, a, b, c);
        const math::dmat3 columns(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a), -dvec3(direction));
        const double determinant = glm::determinant(columns);
        if (std::abs(determinant) < 1e-3)
            continue; // seen from its edge
        const dvec3 uvt = glm::inverse(columns) * (dvec3(origin) - dvec3(a));
        const double inside = std::min({uvt.x, uvt.y, 1.0 - uvt.x - uvt.y});
        if (std::abs(inside) < 1e-4)
            continue; // either may be right
        ASSERT_EQ(hit.found, inside > 0.0) << i;
        if (!hit.found)
            continue;
        ++hits;
        EXPECT_NEAR(hit.t, uvt.z, 1e-3);
        EXPECT_NEAR(hit.barycentrics.x, uvt.x, 1e-3);
        EXPECT_NEAR(hit.barycentrics.y, uvt.y, 1e-3);
        const dvec3 normal = glm::cross(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a));
        EXPECT_EQ(hit.frontFace, glm::dot(normal, dvec3(direction)) < 0.0);
    }
    EXPECT_GT(hits, 300);
}

TEST(RayTriangle, NoRayGetsThroughASharedEdgeOrCorner) {
    // A fan of triangles around a corner, in general position; rays at points of its inner edges.
    Random random;
    for (int fan = 0; fan < 200; ++fan) {
        const vec3 centre = 0.1f * random();
        vec3 rim[6];
        for (int i = 0; i < 6; ++i) {
            const float angle = 1.0472f * float(i);
            rim[i] = vec3(std::cos(angle), std::sin(angle), 0.0f) + 0.2f * random();
        }
        const vec3 origin = vec3(0.0f, 0.0f, 3.0f) + 0.5f * random();
        for (int i = 0; i < 6; ++i)
            for (int step = 0; step <= 20; ++step) {
                const vec3 at = mix(centre, rim[i], 0.045f * float(step));
                const vec3 direction = at - origin;
                bool met = false;
                for (int k = 0; k < 6; ++k)
                    met = met ||
                          intersectTriangle(origin, direction, centre, rim[k], rim[(k + 1) % 6])
                              .found;
                ASSERT_TRUE(met) << fan << ", " << i << ", " << step;
            }
    }
}

TEST(RayTriangle, LiesInFrontOrBehindByTheSignOfT) {
    const vec3 a(-1, -1, -2);
    const vec3 b(1, -1, -2);
    const vec3 c(0, 1, -2);
    const TriangleHit front = intersectTriangle(vec3(0), vec3(0, 0, -0.5f), a, b, c);
    EXPECT_TRUE(front.found);
    EXPECT_FLOAT_EQ(front.t, 4.0f);
    EXPECT_TRUE(front.frontFace);
    const TriangleHit behind = intersectTriangle(vec3(0), vec3(0, 0, 1), a, b, c);
    EXPECT_TRUE(behind.found);
    EXPECT_FLOAT_EQ(behind.t, -2.0f);
    EXPECT_FALSE(behind.frontFace);
    EXPECT_FALSE(intersectTriangle(vec3(0), vec3(0, 0, -1), a, c, b).frontFace);
}

TEST(RayTriangle, NothingDegenerateIsMet) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const vec3 a(-1, -1, -2);
    const vec3 b(1, -1, -2);
    const vec3 c(0, 1, -2);
    const vec3 ahead(0, 0, -1);
    EXPECT_TRUE(intersectTriangle(vec3(0), ahead, a, b, c).found);
    EXPECT_FALSE(intersectTriangle(vec3(0), vec3(0), a, b, c).found);
    EXPECT_FALSE(intersectTriangle(vec3(0), vec3(kNaN, 0, -1), a, b, c).found);
    EXPECT_FALSE(intersectTriangle(vec3(0), vec3(0, 0, -kInfinity), a, b, c).found);
    EXPECT_FALSE(intersectTriangle(vec3(kNaN), ahead, a, b, c).found);
    EXPECT_FALSE(intersectTriangle(vec3(0), ahead, a, b, vec3(kNaN)).found);
    EXPECT_FALSE(intersectTriangle(vec3(0), ahead, a, b, vec3(0, kInfinity, -2)).found);
    EXPECT_FALSE(intersectTriangle(vec3(0), ahead, c, c, c).found);
    EXPECT_FALSE(intersectTriangle(vec3(0, -1, 0), ahead, a, b, b).found);
    // In the plane of the ray.
    EXPECT_FALSE(
        intersectTriangle(vec3(0), ahead, vec3(0, 0, -1), vec3(0, 0, -2), vec3(0, 1, -2)).found
    );
}

} // namespace shutter::shader
