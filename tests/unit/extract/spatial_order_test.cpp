// SPDX-License-Identifier: MIT
#include "engine/extract/spatial_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <random>
#include <set>

namespace shutter::extract {
namespace {

using math::vec3;

/// Small boxes in the cells of a grid, in random order.
std::vector<Box> makeShuffledGrid(int side, uint32_t seed) {
    std::vector<Box> boxes;
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y)
            for (int z = 0; z < side; ++z) {
                const vec3 corner{float(x), float(y), float(z)};
                boxes.push_back({corner, corner + 0.5f});
            }
    std::shuffle(boxes.begin(), boxes.end(), std::mt19937(seed));
    return boxes;
}

void expectPermutation(const std::vector<Box>& boxes) {
    std::vector<uint32_t> order = computeSpatialOrder(boxes);
    std::sort(order.begin(), order.end());
    std::vector<uint32_t> expected(boxes.size());
    std::iota(expected.begin(), expected.end(), 0u);
    EXPECT_EQ(order, expected);
}

double surface(const Box& box) {
    const math::dvec3 size(box.max - box.min);
    return 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
}

/// Surface of all nodes of the tree that halving makes.
double sumSurfaces(const std::vector<Box>& boxes, size_t begin, size_t end) {
    Box bound = boxes[begin];
    for (size_t i = begin; i < end; ++i) {
        bound.min = glm::min(bound.min, boxes[i].min);
        bound.max = glm::max(bound.max, boxes[i].max);
    }
    if (end - begin < 2)
        return surface(bound);
    const size_t middle = begin + (end - begin - 1) / 2 + 1;
    return surface(bound) + sumSurfaces(boxes, begin, middle) + sumSurfaces(boxes, middle, end);
}

using Triangle = std::array<uint32_t, 3>;

/// A triangle begun at its smallest index: equal where the set and the winding are.
std::multiset<Triangle> listTriangles(const std::vector<uint32_t>& indices) {
    std::multiset<Triangle> triangles;
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        Triangle triangle{indices[i], indices[i + 1], indices[i + 2]};
        std::rotate(
            triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end()
        );
        triangles.insert(triangle);
    }
    return triangles;
}

TEST(SpatialOrder, AnyBoxesGetAPermutation) {
    for (size_t count = 0; count <= 70; ++count) {
        std::vector<Box> boxes = makeShuffledGrid(5, static_cast<uint32_t>(count));
        boxes.resize(count);
        expectPermutation(boxes);
    }
    for (const size_t count : {2u, 3u, 9u, 1000u}) // all equal
        expectPermutation(std::vector<Box>(count, Box{vec3(1.0f), vec3(2.0f)}));
    std::vector<Box> flat(64, Box{vec3(3.0f), vec3(3.0f)});
    for (size_t i = 0; i < 32; ++i)
        flat[i].max.x = flat[i].min.x = static_cast<float>(i);
    expectPermutation(flat);
    constexpr float kLargest = std::numeric_limits<float>::max();
    std::vector<Box> largest(20, Box{vec3(-kLargest), vec3(kLargest)});
    largest.resize(40, Box{vec3(kLargest), vec3(kLargest)});
    largest.resize(60, Box{vec3(-kLargest, 0.0f, 0.0f), vec3(-kLargest, 0.0f, 0.0f)});
    expectPermutation(largest);
}

TEST(SpatialOrder, HalvingGivesLessThanHalfTheSurfaceOfARandomOrder) {
    for (uint32_t seed = 1; seed <= 3; ++seed) {
        const std::vector<Box> boxes = makeShuffledGrid(8, seed);
        std::vector<Box> sorted;
        for (const uint32_t index : computeSpatialOrder(boxes))
            sorted.push_back(boxes[index]);
        EXPECT_LT(sumSurfaces(sorted, 0, sorted.size()), 0.5 * sumSurfaces(boxes, 0, boxes.size()));
    }
}

TEST(SpatialOrder, ACloudIsCutAcrossItsLongAxis) {
    // The third of three boxes is next to the first: they must share the left half.
    const std::vector<Box> three = {
        {vec3(0.0f), vec3(1.0f)}, {vec3(100.0f), vec3(101.0f)}, {vec3(1.0f), vec3(2.0f)}};
    EXPECT_EQ(computeSpatialOrder(three).at(2), 1u);
    std::vector<Box> boxes;
    for (int i = 0; i < 64; ++i) {
        const vec3 corner{float(i % 2), 20.0f * float((i * 37) % 64), float(i % 3)};
        boxes.push_back({corner, corner + 1.0f});
    }
    const std::vector<uint32_t> order = computeSpatialOrder(boxes);
    const auto high = [&](uint32_t index) { return boxes[index].min.y >= 20.0f * 32.0f; };
    EXPECT_TRUE(std::none_of(order.begin(), order.begin() + 32, high));
    EXPECT_TRUE(std::all_of(order.begin() + 32, order.end(), high));
}

TEST(SpatialOrder, SortingKeepsTheSetOfTrianglesAndTheirWinding) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> place(-10.0f, 10.0f);
    std::vector<vec3> positions(200);
    for (vec3& position : positions)
        position = {place(random), place(random), place(random)};
    std::vector<uint32_t> indices(3 * 333);
    for (uint32_t& index : indices)
        index = static_cast<uint32_t>(random() % positions.size());
    const std::vector<uint32_t> before = indices;
    sortTriangles(positions, indices);
    EXPECT_NE(indices, before);
    EXPECT_EQ(listTriangles(indices), listTriangles(before));
}

TEST(SpatialOrder, SortingBringsTrianglesOfOnePlaceTogether) {
    // Even triangles lie at the left, odd ones far at the right.
    std::vector<vec3> positions;
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < 40; ++i) {
        const vec3 corner{i % 2 == 0 ? 0.0f : 1000.0f, float(i) * 0.1f, 0.0f};
        positions.insert(positions.end(), {corner, corner + vec3(1, 0, 0), corner + vec3(0, 1, 0)});
        indices.insert(indices.end(), {3 * i, 3 * i + 1, 3 * i + 2});
    }
    sortTriangles(positions, indices);
    const auto right = [&](size_t triangle) { return positions[indices[3 * triangle]].x > 500.0f; };
    for (size_t triangle = 1; triangle < 20; ++triangle) {
        EXPECT_EQ(right(triangle), right(0));
        EXPECT_NE(right(triangle + 20), right(0));
    }
}

} // namespace
} // namespace shutter::extract
