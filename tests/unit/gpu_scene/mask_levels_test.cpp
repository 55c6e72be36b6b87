// SPDX-License-Identifier: MIT
#include "engine/gpu_scene/mask_levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>
#include <utility>

namespace shutter::gpu_scene {
namespace {

/// Red discs on transparent green, one in each square of this many texels.
scene::TextureImage makeDiscs(uint32_t sizePx, uint32_t squarePx, double radiusPx) {
    scene::TextureImage image;
    image.width = image.height = sizePx;
    for (uint32_t y = 0; y < sizePx; ++y)
        for (uint32_t x = 0; x < sizePx; ++x) {
            const double right = x % squarePx + 0.5 - squarePx / 2.0;
            const double down = y % squarePx + 0.5 - squarePx / 2.0;
            const bool isDisc = right * right + down * down < radiusPx * radiusPx;
            const uint8_t disc[] = {255, 0, 0, 255};
            const uint8_t hole[] = {0, 255, 0, 0};
            image.rgba.insert(image.rgba.end(), isDisc ? disc : hole, (isDisc ? disc : hole) + 4);
        }
    return image;
}

/// Share of a square level whose alpha, interpolated between texels, reaches the cutoff.
double coverageOf(const std::vector<uint8_t>& rgba, float cutoff) {
    const auto size = uint32_t(std::lround(std::sqrt(double(rgba.size()) / 4.0)));
    const auto alphaAt = [&](uint32_t x, uint32_t y) {
        return double(rgba[(size_t(y % size) * size + x % size) * 4 + 3]) / 255.0;
    };
    constexpr uint32_t kPlaces = 8; // per texel, along an axis
    size_t reached = 0;
    for (uint32_t y = 0; y < size * kPlaces; ++y)
        for (uint32_t x = 0; x < size * kPlaces; ++x) {
            const double right = (x % kPlaces + 0.5) / kPlaces;
            const double down = (y % kPlaces + 0.5) / kPlaces;
            const uint32_t i = x / kPlaces;
            const uint32_t j = y / kPlaces;
            const double above = std::lerp(alphaAt(i, j), alphaAt(i + 1, j), right);
            const double below = std::lerp(alphaAt(i, j + 1), alphaAt(i + 1, j + 1), right);
            reached += std::lerp(above, below, down) >= double(cutoff) ? 1 : 0;
        }
    return double(reached) / std::pow(double(size * kPlaces), 2.0);
}

TEST(MaskLevels, EachLevelReachesTheCutoffAsMuchAsTheFirst) {
    constexpr uint32_t kSizePx = 256;
    scene::TextureImage image;
    image.width = image.height = kSizePx;
    image.rgba.assign(size_t(kSizePx) * kSizePx * 4, 0);
    std::mt19937 random(1);
    for (int blade = 0; blade < 400; ++blade) { // 3 x 24 texels
        const auto left = uint32_t(random() % (kSizePx - 3));
        const auto top = uint32_t(random() % (kSizePx - 24));
        for (uint32_t y = top; y < top + 24; ++y)
            for (uint32_t x = left; x < left + 3; ++x)
                image.rgba[(size_t(y) * kSizePx + x) * 4 + 3] = 255;
    }
    for (const float cutoff : {0.1f, 0.5f, 0.9f}) {
        const double coverage = coverageOf(image.rgba, 0.5f); // of its texels, too
        ASSERT_NEAR(coverage, 0.35, 0.01);
        const auto levels = makeMaskLevels(image, cutoff);
        ASSERT_EQ(levels.size(), 8u);
        for (size_t level = 0; level < 5; ++level) // means alone: 0 or 1 in the last
            EXPECT_NEAR(coverageOf(levels[level], cutoff), coverage, 0.05) << cutoff << level;
    }
}

TEST(MaskLevels, LevelsThatAreEvenCoverAllOrNothing) {
    // Means alone would do the opposite.
    for (const auto& [radiusPx, cutoff] : {std::pair{2.6, 0.3f}, {3.8, 0.9f}}) {
        const scene::TextureImage image = makeDiscs(64, 8, radiusPx);
        const double coverage = coverageOf(image.rgba, 0.5f);
        const auto levels = makeMaskLevels(image, cutoff);
        for (size_t level = 2; level < levels.size(); ++level)
            EXPECT_EQ(coverageOf(levels[level], cutoff), coverage < 0.5 ? 0.0 : 1.0) << level;
    }
}

TEST(MaskLevels, WhatIsCutOutDoesNotTintTheRest) {
    const auto levels = makeMaskLevels(makeDiscs(64, 8, 2.6), 0.5f);
    for (size_t level = 0; level < 2; ++level)
        for (size_t i = 0; i < levels[level].size(); i += 4)
            if (levels[level][i + 3] >= 128) {
                EXPECT_GE(levels[level][i], 250);
                EXPECT_LE(levels[level][i + 1], 30);
            }
}

TEST(MaskLevels, ImagesOfAnySizeHaveAllLevelsAndOpaqueOnesStayOpaque) {
    for (const auto& [width, height] :
         {std::pair{1u, 1u}, {5u, 3u}, {1u, 6u}, {64u, 16u}, {63u, 49u}}) {
        scene::TextureImage image;
        image.width = width;
        image.height = height;
        image.rgba.assign(size_t(width) * height * 4, 255);
        const auto levels = makeMaskLevels(image, 0.5f);
        ASSERT_EQ(levels.size(), size_t(std::bit_width(std::max(width, height)) - 1));
        for (size_t level = 0; level < levels.size(); ++level) {
            const size_t texels =
                size_t(std::max(width >> (level + 1), 1u)) * std::max(height >> (level + 1), 1u);
            EXPECT_EQ(levels[level], std::vector<uint8_t>(texels * 4, 255))
                << width << " " << level;
        }
    }
}

TEST(MaskLevels, OnlyImagesThatMasksOfOneCutoffReadAreMasks) {
    scene::Assets assets;
    for (uint32_t i = 0; i < 5; ++i)
        assets.textures.push_back({.image = i, .isLoose = i == 4});
    const auto add = [&](scene::AssetIndex texture, scene::AlphaMode mode, float factor) {
        scene::Material material;
        material.alphaMode = mode;
        material.baseColorFactor.a = factor;
        material.baseColor.texture = texture;
        assets.materials.push_back(material);
    };
    add(0, scene::AlphaMode::Mask, 1.0f);
    add(0, scene::AlphaMode::Opaque, 1.0f);
    add(1, scene::AlphaMode::Mask, 0.8f);
    add(2, scene::AlphaMode::Mask, 1.0f);
    add(2, scene::AlphaMode::Blend, 1.0f);
    add(3, scene::AlphaMode::Mask, 1.0f);
    add(3, scene::AlphaMode::Mask, 0.8f);
    add(4, scene::AlphaMode::Mask, 1.0f);
    add(scene::kNone, scene::AlphaMode::Mask, 1.0f);
    const std::map<scene::AssetIndex, float> expected{{0, 0.5f}, {1, 0.625f}};
    EXPECT_EQ(findMasks(assets), expected);
    for (const float factor : {0.0f, 0.4f}) { // none of it reaches the cutoff
        assets.materials.clear();
        add(0, scene::AlphaMode::Mask, factor);
        EXPECT_TRUE(findMasks(assets).empty()) << factor;
    }
}

} // namespace
} // namespace shutter::gpu_scene
