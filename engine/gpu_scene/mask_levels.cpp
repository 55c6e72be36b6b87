// SPDX-License-Identifier: MIT
#include "engine/gpu_scene/mask_levels.h"

#include "engine/math/math.h"
#include "engine/math/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace shutter::gpu_scene {

namespace {

/// Linear colour and alpha.
struct Level {
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<math::vec4> texels;
};

/// The part of one level's axis that a texel of the next one covers.
struct Span {
    double from = 0.0;
    double to = 0.0;

    [[nodiscard]] uint32_t first() const { return uint32_t(from); }

    [[nodiscard]] uint32_t last() const { return uint32_t(std::ceil(to)) - 1; }

    /// \return of texel i, [0, 1]
    [[nodiscard]] float share(uint32_t i) const {
        return float(std::min(to, i + 1.0) - std::max(from, double(i)));
    }
};

/// The span of texel i of `count` on an axis of `size` texels. Rounding cannot take it beyond
/// `size`.
Span spanOf(uint32_t i, uint32_t count, uint32_t size) {
    return {double(i) * size / count, double(i + 1) * size / count};
}

/// \param read the texel of the larger level at x, y
template <typename Read> Level halve(uint32_t width, uint32_t height, const Read& read) {
    Level half{std::max(width / 2, 1u), std::max(height / 2, 1u), {}};
    half.texels.reserve(size_t(half.width) * half.height);
    for (uint32_t y = 0; y < half.height; ++y)
        for (uint32_t x = 0; x < half.width; ++x) {
            const Span columns = spanOf(x, half.width, width);
            const Span rows = spanOf(y, half.height, height);
            math::vec3 color(0.0f);
            float alpha = 0.0f;
            float seen = 0.0f;
            float area = 0.0f;
            for (uint32_t j = rows.first(); j <= rows.last(); ++j)
                for (uint32_t i = columns.first(); i <= columns.last(); ++i) {
                    const float share = columns.share(i) * rows.share(j);
                    const math::vec4 texel = read(i, j);
                    // Where all are transparent, all count alike.
                    const float weight = share * (texel.a + 1.0f / 255.0f);
                    color += weight * math::vec3(texel);
                    seen += weight;
                    alpha += share * texel.a;
                    area += share;
                }
            half.texels.emplace_back(color / seen, alpha / area);
        }
    return half;
}

/// Share of a level whose alpha, times a factor and interpolated as lookups do, reaches the cutoff.
double coverageOf(const Level& level, float factor, float cutoff) {
    constexpr size_t kManyTexels = 65536;
    const uint32_t places = level.texels.size() >= kManyTexels ? 1 : 4; // per texel, along an axis
    const auto read = [&](uint32_t x, uint32_t y) {
        const float alpha =
            level.texels[size_t(y % level.height) * level.width + x % level.width].a;
        return std::min(alpha * factor, 1.0f);
    };
    size_t reached = 0;
    for (uint32_t y = 0; y < level.height; ++y)
        for (uint32_t x = 0; x < level.width; ++x) {
            const std::array corners{
                read(x, y), read(x + 1, y), read(x, y + 1), read(x + 1, y + 1)};
            for (uint32_t place = 0; place < places * places; ++place) {
                const float right = float(place % places) / float(places);
                const float down = float(place / places) / float(places);
                const float above = glm::mix(corners[0], corners[1], right);
                const float below = glm::mix(corners[2], corners[3], right);
                reached += glm::mix(above, below, down) >= cutoff ? 1 : 0;
            }
        }
    return double(reached) / double(level.texels.size() * places * places);
}

/// The factor on alpha by which as much of a level reaches the cutoff, as nearly as can be.
float findFactor(const Level& level, float cutoff, double coverage) {
    constexpr int kSteps = 10;
    // What the least alpha above 0 reaches, and what 1 just reaches.
    float greatest = 255.0f * cutoff;
    float least = cutoff;
    float best = 1.0f;
    double leastError = 1.0;
    for (int step = 0; step < kSteps; ++step) {
        const float factor = std::sqrt(least * greatest);
        const double excess = coverageOf(level, factor, cutoff) - coverage;
        if (std::abs(excess) < leastError) {
            leastError = std::abs(excess);
            best = factor;
        }
        (excess > 0.0 ? greatest : least) = factor;
    }
    return best;
}

uint8_t toByte(float value) {
    return uint8_t(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

std::vector<uint8_t> pack(const Level& level, float factor) {
    std::vector<uint8_t> rgba;
    rgba.reserve(level.texels.size() * 4);
    for (const math::vec4& texel : level.texels) {
        for (int c = 0; c < 3; ++c)
            rgba.push_back(toByte(math::encodeSrgb(texel[c])));
        rgba.push_back(toByte(texel.a * factor));
    }
    return rgba;
}

} // namespace

std::map<scene::AssetIndex, float> findMasks(const scene::Assets& assets) {
    std::map<scene::AssetIndex, float> masks;
    std::set<scene::AssetIndex> others;
    for (const scene::Material& material : assets.materials) {
        if (material.baseColor.texture == scene::kNone)
            continue;
        const scene::AssetIndex image = assets.textures[material.baseColor.texture].image;
        const float cutoff = material.alphaCutoff / material.baseColorFactor.a;
        if (material.alphaMode == scene::AlphaMode::Blend)
            others.insert(image);
        if (material.alphaMode != scene::AlphaMode::Mask || !(cutoff > 0.0f && cutoff <= 1.0f))
            continue;
        const auto [known, isNew] = masks.try_emplace(image, cutoff);
        if (!isNew && known->second != cutoff)
            others.insert(image);
    }
    for (const scene::Texture& texture : assets.textures)
        if (texture.isLoose)
            others.insert(texture.image);
    for (const scene::AssetIndex image : others)
        masks.erase(image);
    return masks;
}

std::vector<std::vector<uint8_t>> makeMaskLevels(const scene::TextureImage& image, float cutoff) {
    std::array<float, 256> decoded{};
    for (size_t i = 0; i < decoded.size(); ++i)
        decoded[i] = math::decodeSrgb(float(i) / 255.0f);
    const auto readImage = [&](uint32_t x, uint32_t y) {
        const uint8_t* const texel = &image.rgba[(size_t(y) * image.width + x) * 4];
        return math::vec4(
            decoded[texel[0]], decoded[texel[1]], decoded[texel[2]], float(texel[3]) / 255.0f
        );
    };
    size_t reached = 0;
    for (size_t i = 3; i < image.rgba.size(); i += 4)
        reached += float(image.rgba[i]) / 255.0f >= cutoff ? 1 : 0;
    const double coverage = double(reached) / (double(image.width) * image.height);
    std::vector<std::vector<uint8_t>> levels;
    Level level{image.width, image.height, {}};
    while (level.width > 1 || level.height > 1) {
        level = levels.empty() ? halve(image.width, image.height, readImage)
                               : halve(level.width, level.height, [&](uint32_t x, uint32_t y) {
                                     return level.texels[size_t(y) * level.width + x];
                                 });
        const bool isCut = coverage > 0.0 && coverage < 1.0;
        levels.push_back(pack(level, isCut ? findFactor(level, cutoff, coverage) : 1.0f));
    }
    return levels;
}

} // namespace shutter::gpu_scene
