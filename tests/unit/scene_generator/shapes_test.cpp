// SPDX-License-Identifier: MIT
// Shapes of our own scenes, and hard cases.
#include "assets/generator/hard_cases.h"
#include "assets/generator/mesh_shapes.h"
#include "assets/generator/props.h"
#include "tests/support/rows.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace shutter::generator {
namespace {

using glm::vec2;
using glm::vec3;

/// Positive where triangles are counter-clockwise seen from outside.
double computeVolume(const Shape& shape) {
    double six = 0.0;
    for (size_t i = 0; i < shape.indices.size(); i += 3) {
        const glm::dvec3 a = shape.positions[shape.indices[i]];
        const glm::dvec3 b = shape.positions[shape.indices[i + 1]];
        const glm::dvec3 c = shape.positions[shape.indices[i + 2]];
        six += glm::dot(a, glm::cross(b, c));
    }
    return six / 6.0;
}

/// Edges that do not have as many triangles on one side as on the other, by place (0.01 mm), not by
/// index: seams have separate vertices.
size_t countOpenEdges(const Shape& shape) {
    using Place = std::tuple<long, long, long>;
    const auto placeOf = [&](uint32_t index) {
        const vec3 p = shape.positions[index] * 1e5f;
        return Place(std::lround(p.x), std::lround(p.y), std::lround(p.z));
    };
    std::map<std::pair<Place, Place>, int> edges;
    for (size_t i = 0; i < shape.indices.size(); i += 3)
        for (size_t k = 0; k < 3; ++k) {
            const Place from = placeOf(shape.indices[i + k]);
            const Place to = placeOf(shape.indices[i + (k + 1) % 3]);
            if (from < to)
                ++edges[{from, to}];
            else
                --edges[{to, from}];
        }
    size_t open = 0;
    for (const auto& [edge, balance] : edges)
        open += balance != 0;
    return open;
}

/// Normals on the side that the winding calls outside, for all but grazing ones.
size_t countNormalsAgainstTheWinding(const Shape& shape) {
    size_t wrong = 0;
    for (size_t i = 0; i < shape.indices.size(); i += 3) {
        const uint32_t a = shape.indices[i];
        const vec3 face = glm::cross(
            shape.positions[shape.indices[i + 1]] - shape.positions[a],
            shape.positions[shape.indices[i + 2]] - shape.positions[a]
        );
        wrong += glm::dot(face, shape.normals[a]) < -0.3f * glm::length(face);
    }
    return wrong;
}

void expectSolid(const char* name, const Shape& shape) {
    SCOPED_TRACE(name);
    ASSERT_FALSE(shape.indices.empty());
    EXPECT_GT(computeVolume(shape), 0.0);
    EXPECT_EQ(countOpenEdges(shape), 0u);
    EXPECT_EQ(countNormalsAgainstTheWinding(shape), 0u);
    for (const vec3 normal : shape.normals)
        ASSERT_NEAR(glm::length(normal), 1.0f, 1e-4f);
}

TEST(Shapes, PropsAreClosedAndFaceOutwards) {
    const Glider plane = glider(0.6f);
    expectSolid("glider body", plane.body);
    expectSolid("glider wings", plane.wings);
    expectSolid("jug", jug());
    expectSolid("pinwheel", pinwheel(0.6f, 5));
    expectSolid("coil", coilWithRing());
    expectSolid("gate", wireGate({0.7f, 0.5f}, 0.003f, {5, 4}));
    expectSolid("grass", grassClump(12, 0.5f, 3));
    expectSolid("bicycle frame", highWheeler().frame);
    expectSolid("saddle", highWheeler().saddle);
}

TEST(Shapes, ALoftIsClosedAndGoesThroughItsSections) {
    const std::array sections = {
        LoftSection{-1.0f, 0.4f, -0.2f, 0.1f},
        LoftSection{0.0f, 0.6f, -0.3f, 0.5f},
        LoftSection{2.0f, 0.2f, 0.0f, 0.4f}};
    for (const float roundness : {0.01f, 0.5f, 0.95f}) {
        const Shape shape = loft(sections, roundness);
        expectSolid("loft", shape);
        vec3 least(1e9f);
        vec3 greatest(-1e9f);
        for (const vec3 place : shape.positions) {
            least = glm::min(least, place);
            greatest = glm::max(greatest, place);
        }
        EXPECT_LT(glm::distance(least, vec3(-0.6f, -0.3f, -1.0f)), 1e-5f);
        EXPECT_LT(glm::distance(greatest, vec3(0.6f, 0.5f, 2.0f)), 1e-5f);
    }
}

TEST(Shapes, ATubeWithATipIsClosedHasNoEmptyTriangleAndMayRunAlongTheVertical) {
    const std::array path = {vec3(0, 0, 0), vec3(0, 1, 0), vec3(0.5f, 2, 0)};
    const std::array radii = {0.1f, 0.05f, 0.0f};
    const Shape shape = tube(path, radii, 7);
    expectSolid("tube", shape);
    for (size_t i = 0; i < shape.indices.size(); i += 3) {
        const vec3 a = shape.positions[shape.indices[i]];
        const vec3 b = shape.positions[shape.indices[i + 1]];
        const vec3 c = shape.positions[shape.indices[i + 2]];
        EXPECT_GT(glm::length(glm::cross(b - a, c - a)), 1e-6f);
    }
    for (const vec3 direction : {vec3(0, 1, 0), vec3(0, -1, 0), vec3(1, 0, 0), vec3(0, 0, -1)}) {
        const std::array straight = {vec3(0.0f), direction};
        expectSolid("tube", tube(straight, 0.1f, 12));
    }
}

TEST(Shapes, SmoothNormalsLeaveAVertexWithoutATriangleItsOwn) {
    Shape shape = sheet({1.0f, 1.0f}, 1.0f);
    addVertex(shape, {5, 5, 5}, {0, 1, 0}, {0, 0});
    smoothNormals(shape);
    EXPECT_EQ(shape.normals.back(), vec3(0, 1, 0));
    EXPECT_EQ(shape.normals.front(), vec3(0, 0, 1));
}

TEST(HardCases, HardCasesAreThoseOfTheBench) {
    std::set<std::string> names;
    for (const BenchCase& hardCase : listHardCases())
        names.insert(hardCase.name);
    const std::vector<std::string> promised = test::rowsOf(
        "translation|spin|wheel_spokes|camera_pan|camera_dolly|camera_orbit|crossing_same_colour|"
        "static_post|self_overlap|long_motion|thin_geometry|sky_horizon|walking_figure|"
        "running_figure_pan|morphing_ball|waving_flag|whip|collapsing_limb|sliding_pane|"
        "mover_behind_glass|glass_carriage|sparks|smoke|additive_sparks"
    );
    EXPECT_EQ(names, std::set<std::string>(promised.begin(), promised.end()));
    EXPECT_EQ(listHardCases().size(), promised.size()) << "a name stands twice";
}

TEST(HardCases, EachCaseStatesItsMotionInASentenceAndAllowsForEightTimesItsExposure) {
    for (const BenchCase& hardCase : listHardCases()) {
        SCOPED_TRACE(hardCase.name);
        const std::string& text = hardCase.description;
        EXPECT_EQ(std::count(text.begin(), text.end(), '.'), 1) << text;
        EXPECT_TRUE(text.ends_with("px at 640x360.")) << text;
        const glm::vec2 peak = hardCase.peakMotionPx;
        EXPECT_NE(text.find(fmt::format("{} to {} px", peak.x, peak.y)), std::string::npos) << text;
        EXPECT_GT(peak.x, 0.0f);
        EXPECT_LT(peak.x, peak.y);
        EXPECT_GT(hardCase.exposureSeconds, 0.0);
        // Clips hold before time 0: an exposure that began earlier would see them stop.
        EXPECT_GE(hardCase.timeSeconds - 8.0 * hardCase.exposureSeconds, 0.0);
        EXPECT_EQ(std::string_view(hardCase.phase), "end");
    }
}

} // namespace
} // namespace shutter::generator
