// SPDX-License-Identifier: MIT
// Arithmetic as Vulkan allows it: quotients, roots and powers that are up to two units in the last
// place off. By how many depends on the result's bits alone, so that every run errs alike.
#pragma once

#include <glm/glm.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace shutter::erring {

/// `exact` moved by -2 ... 2 units in the last place. Zero, NaN and infinity do not change, nor do
/// values that would become one of them.
inline float err(float exact) {
    if (exact == 0.0f || !std::isfinite(exact))
        return exact;
    const auto bits = std::bit_cast<uint32_t>(exact);
    uint32_t hash = bits * 0x9E3779B1u;
    hash = (hash ^ (hash >> 15u)) * 0x85EBCA77u;
    const auto moved = std::bit_cast<float>(bits + (hash >> 16u) % 5u - 2u);
    return std::isfinite(moved) && (moved > 0.0f) == (exact > 0.0f) ? moved : exact;
}

template <glm::length_t n> glm::vec<n, float> err(glm::vec<n, float> exact) {
    for (glm::length_t i = 0; i < n; ++i)
        exact[i] = err(exact[i]);
    return exact;
}

/// Placed between two divisions: a / kErring / b is an erring a / b. Whole numbers divide exactly,
/// and so do constants, which compilers fold.
struct Division {};

inline constexpr Division kErring;

template <class T> struct Dividend { T value; };

template <class T> constexpr Dividend<T> operator/(const T& value, Division) {
    return {value};
}

template <class A, class B> constexpr auto operator/(const Dividend<A>& a, const B& b) {
    const auto exact = a.value / b;
    if constexpr (requires { err(exact); } && !std::is_integral_v<decltype(exact)>)
        if (!std::is_constant_evaluated())
            return err(exact);
    return exact;
}

} // namespace shutter::erring

namespace shutter::shader {

using erring::kErring;

// These hide GLM's functions of the same names from the shaders.
inline float sqrt(float x) {
    return erring::err(std::sqrt(x));
}

inline float inversesqrt(float x) {
    return erring::err(1.0f / std::sqrt(x));
}

inline float pow(float x, float y) {
    return erring::err(std::pow(x, y));
}

inline float exp(float x) {
    return erring::err(std::exp(x));
}

inline float exp2(float x) {
    return erring::err(std::exp2(x));
}

inline float log2(float x) {
    return erring::err(std::log2(x));
}

template <glm::length_t n> float length(const glm::vec<n, float>& v) {
    return sqrt(glm::dot(v, v));
}

template <glm::length_t n> glm::vec<n, float> normalize(const glm::vec<n, float>& v) {
    return erring::err(v / length(v));
}

} // namespace shutter::shader
