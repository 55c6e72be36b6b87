// SPDX-License-Identifier: MIT
#include "assets/generator/picture.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <mutex>
#include <stb/stb_image_write.h>
#include <string_view>

namespace shutter::generator {

namespace {

uint8_t toByte(float value) {
    return static_cast<uint8_t>(std::lround(glm::clamp(value, 0.0f, 1.0f) * 255.0f));
}

int wrap(int value, int period) {
    return ((value % period) + period) % period;
}

std::vector<uint8_t> encodeAnew(const Picture& picture) {
    const size_t channels = picture.alpha.empty() ? 3 : 4;
    std::vector<uint8_t> pixels = picture.rgb;
    if (!picture.alpha.empty()) {
        pixels.clear();
        for (size_t i = 0; i < picture.alpha.size(); ++i) {
            pixels.insert(pixels.end(), &picture.rgb[3 * i], &picture.rgb[3 * i] + 3);
            pixels.push_back(picture.alpha[i]);
        }
    }
    std::vector<uint8_t> bytes;
    const auto append = [](void* context, void* data, int size) {
        auto& out = *static_cast<std::vector<uint8_t>*>(context);
        const auto* first = static_cast<const uint8_t*>(data);
        out.insert(out.end(), first, first + size);
    };
    const int written = stbi_write_png_to_func(
        append,
        &bytes,
        picture.width,
        picture.height,
        static_cast<int>(channels),
        pixels.data(),
        picture.width * static_cast<int>(channels)
    );
    if (written == 0) {
        bytes.clear();
    }
    return bytes;
}

} // namespace

Picture paintAnew(int width, int height, const Painter& painter) {
    Picture picture{.width = width, .height = height, .rgb = {}};
    picture.rgb.reserve(static_cast<size_t>(width) * static_cast<size_t>(height) * 3);
    const glm::vec2 size(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            glm::vec3 sum(0.0f);
            for (int sample = 0; sample < 4; ++sample) {
                const glm::vec2 offset(sample % 2 == 0 ? 0.25f : 0.75f, sample < 2 ? 0.25f : 0.75f);
                sum += painter((glm::vec2(x, y) + offset) / size);
            }
            for (int channel = 0; channel < 3; ++channel) {
                picture.rgb.push_back(toByte(sum[channel] * 0.25f));
            }
        }
    }
    return picture;
}

void paintAlpha(Picture& picture, const AlphaPainter& painter) {
    const glm::vec2 size(picture.width, picture.height);
    picture.alpha.clear();
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            picture.alpha.push_back(toByte(painter((glm::vec2(x, y) + 0.5f) / size)));
}

std::vector<uint8_t> encodePng(const Picture& picture) {
    const auto view = [](const std::vector<uint8_t>& bytes) {
        return std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    };
    const std::hash<std::string_view> digest;
    const std::array key = {
        static_cast<size_t>(picture.width), digest(view(picture.rgb)), digest(view(picture.alpha))};
    static std::mutex guard;
    static std::map<std::array<size_t, 3>, std::vector<uint8_t>> encoded;
    const std::scoped_lock lock(guard);
    const auto [found, isNew] = encoded.try_emplace(key);
    if (isNew)
        found->second = encodeAnew(picture);
    return found->second;
}

float hash(int x, int y, int seed) {
    uint32_t h = static_cast<uint32_t>(x) * 0x9E3779B1u ^ static_cast<uint32_t>(y) * 0x85EBCA77u ^
                 static_cast<uint32_t>(seed) * 0xC2B2AE3Du;
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12)) * 0x297A2D39u;
    h ^= h >> 15;
    return static_cast<float>(h >> 8) / 16777216.0f;
}

float noise(glm::vec2 p, glm::ivec2 period, int seed) {
    const glm::vec2 cell = glm::floor(p);
    const glm::vec2 f = p - cell;
    const glm::vec2 t = f * f * (3.0f - 2.0f * f);
    const int x0 = wrap(static_cast<int>(cell.x), period.x);
    const int y0 = wrap(static_cast<int>(cell.y), period.y);
    const int x1 = wrap(x0 + 1, period.x);
    const int y1 = wrap(y0 + 1, period.y);
    const float top = glm::mix(hash(x0, y0, seed), hash(x1, y0, seed), t.x);
    const float bottom = glm::mix(hash(x0, y1, seed), hash(x1, y1, seed), t.x);
    return glm::mix(top, bottom, t.y);
}

float fractalNoise(glm::vec2 p, glm::ivec2 period, int seed) {
    return (noise(p, period, seed) * 4.0f + noise(p * 2.0f, period * 2, seed + 1) * 2.0f +
            noise(p * 4.0f, period * 4, seed + 2)) /
           7.0f;
}

float band(float value, float centre, float halfWidth) {
    return std::abs(value - centre) < halfWidth ? 1.0f : 0.0f;
}

float triangleWave(float value) {
    return 1.0f - std::abs(2.0f * glm::fract(value) - 1.0f);
}

float grain(glm::vec2 uv, int seed) {
    return fractalNoise(uv * glm::vec2(4.0f, 64.0f), {4, 64}, seed);
}

} // namespace shutter::generator
