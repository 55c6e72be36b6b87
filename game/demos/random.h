// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace shutter::game {

/// SplitMix64 (Steele, Lea, Flood 2014): the same numbers everywhere.
class Random {
  public:
    explicit Random(uint64_t seed) : mState(seed) {}

    /// [0, 1)
    [[nodiscard]] double next() {
        mState += 0x9E3779B97F4A7C15u;
        uint64_t z = mState;
        z = (z ^ (z >> 30u)) * 0xBF58476D1CE4E5B9u;
        z = (z ^ (z >> 27u)) * 0x94D049BB133111EBu;
        z ^= z >> 31u;
        return static_cast<double>(z >> 11u) * 0x1.0p-53;
    }

    /// [low, high)
    [[nodiscard]] double between(double low, double high) { return low + (high - low) * next(); }

  private:
    uint64_t mState;
};

} // namespace shutter::game
