// SPDX-License-Identifier: MIT
#include "engine/math/sampling.h"

#include "engine/core/check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>

namespace shutter::math {

namespace {

constexpr uint32_t kNoRank = 0xFFFFFFFFu;
/// Standard deviation of the Gaussian by which points crowd each other, pixels (Ulichney: 1.5).
constexpr double kSigmaPx = 1.5;
/// The Gaussian at 0. Sums of all weights stay far below 2^32.
constexpr double kWeightScale = 1 << 20;
/// Beyond it weights round to 0.
constexpr int kReachPx = 8;
constexpr int kReachSide = 2 * kReachPx + 1;
/// Share of the pixels that the pattern has at the start: 1 / this.
constexpr uint32_t kStartDivisor = 10;

std::vector<uint32_t> makeWeights() {
    std::vector<uint32_t> weights;
    for (int y = -kReachPx; y <= kReachPx; ++y)
        for (int x = -kReachPx; x <= kReachPx; ++x)
            weights.push_back(static_cast<uint32_t>(
                std::lround(kWeightScale * std::exp(-(x * x + y * y) / (2.0 * kSigmaPx * kSigmaPx)))
            ));
    return weights;
}

/// Points on a torus, and how crowded each place is by them.
class Pattern {
  public:
    explicit Pattern(uint32_t side)
        : mSide(side), mWeights(makeWeights()), mCrowding(size_t(side) * side),
          mIsSet(size_t(side) * side) {}

    [[nodiscard]] bool isSet(size_t at) const { return mIsSet[at]; }

    void set(size_t at, bool value) {
        mIsSet[at] = value;
        const uint32_t x = static_cast<uint32_t>(at) % mSide;
        const uint32_t y = static_cast<uint32_t>(at) / mSide;
        const uint32_t corner = mSide - kReachPx; // of the weights, one turn on
        for (uint32_t row = 0; row < kReachSide; ++row)
            for (uint32_t column = 0; column < kReachSide; ++column) {
                const uint32_t weight = mWeights[row * kReachSide + column];
                uint32_t& sum = mCrowding
                    [(y + corner + row) % mSide * size_t(mSide) + (x + corner + column) % mSide];
                sum = value ? sum + weight : sum - weight;
            }
    }

    /// The point that is crowded most, of equals the first.
    [[nodiscard]] size_t findCluster() const {
        size_t found = 0;
        for (size_t i = 0; i < mCrowding.size(); ++i)
            if (mIsSet[i] && (!mIsSet[found] || mCrowding[i] > mCrowding[found]))
                found = i;
        return found;
    }

    /// The free place that is crowded least, of equals the first.
    [[nodiscard]] size_t findVoid() const {
        size_t found = 0;
        for (size_t i = 0; i < mCrowding.size(); ++i)
            if (!mIsSet[i] && (mIsSet[found] || mCrowding[i] < mCrowding[found]))
                found = i;
        return found;
    }

  private:
    uint32_t mSide;
    std::vector<uint32_t> mWeights;
    std::vector<uint32_t> mCrowding; ///< by place
    std::vector<bool> mIsSet;        ///< by place
};

/// Random points, moved from clusters to voids until that changes nothing any more.
Pattern makeStart(uint32_t side, uint32_t seed, uint32_t count) {
    Pattern pattern(side);
    std::mt19937 random(seed); // whose numbers the standard defines
    for (uint32_t placed = 0; placed < count;) {
        const size_t at = random() % (side * side);
        if (pattern.isSet(at))
            continue;
        pattern.set(at, true);
        ++placed;
    }
    while (true) {
        const size_t cluster = pattern.findCluster();
        pattern.set(cluster, false);
        const size_t gap = pattern.findVoid();
        pattern.set(gap, true);
        if (gap == cluster)
            return pattern;
    }
}

} // namespace

std::vector<uint32_t> makeBlueNoise(uint32_t side, uint32_t seed) {
    SHUTTER_CHECK(side >= kReachPx && side <= 256, "a side of {}", side);
    const uint32_t cells = side * side;
    const uint32_t startCount = cells / kStartDivisor;
    Pattern pattern = makeStart(side, seed, startCount);
    std::vector<uint32_t> ranks(cells, kNoRank);
    Pattern rest = pattern;
    for (uint32_t rank = startCount; rank > 0; --rank) {
        const size_t cluster = rest.findCluster();
        rest.set(cluster, false);
        ranks[cluster] = rank - 1;
    }
    // Once most are set, the paper searches the tightest cluster of free places: on a torus that is
    // the largest void of the set ones.
    for (uint32_t rank = startCount; rank < cells; ++rank) {
        const size_t gap = pattern.findVoid();
        pattern.set(gap, true);
        ranks[gap] = rank;
    }
    return ranks;
}

} // namespace shutter::math
