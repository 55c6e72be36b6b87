// SPDX-License-Identifier: MIT
#include "engine/extract/spatial_order.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <utility>

namespace shutter::extract {

namespace {

/// Below this a split is by the longest axis alone: the exact choice no longer pays.
constexpr size_t kSmallRange = 8;

float halfArea(const Box& box) {
    const math::vec3 size = box.max - box.min;
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

class Sorter {
  public:
    explicit Sorter(std::span<const Box> boxes) : mBoxes(boxes), mOrder(boxes.size()) {
        std::iota(mOrder.begin(), mOrder.end(), 0u);
        mCentres.reserve(boxes.size());
        for (const Box& box : boxes)
            mCentres.push_back((box.min + box.max) * 0.5f);
    }

    std::vector<uint32_t> run() {
        split(0, mOrder.size());
        return std::move(mOrder);
    }

  private:
    // Recursion depth is log2 of the count.
    void split(size_t begin, size_t end) {
        const size_t count = end - begin;
        if (count <= 2) {
            // nth_element leaves a pair in either order.
            std::sort(mOrder.begin() + ptrdiff_t(begin), mOrder.begin() + ptrdiff_t(end));
            return;
        }
        const size_t middle = begin + (count - 1) / 2 + 1;
        const int best = count <= kSmallRange ? findLongestAxis(begin, end)
                                              : findCheapestAxis(begin, middle, end);
        partition(begin, middle, end, best);
        split(begin, middle);
        split(middle, end);
    }

    void partition(size_t begin, size_t middle, size_t end, int axis) {
        const auto at = [&](size_t i) { return mOrder.begin() + static_cast<ptrdiff_t>(i); };
        std::nth_element(at(begin), at(middle), at(end), [&](uint32_t a, uint32_t b) {
            // The index breaks ties, so that the order does not depend on the library.
            const float ca = mCentres[a][axis];
            const float cb = mCentres[b][axis];
            return ca != cb ? ca < cb : a < b;
        });
    }

    int findLongestAxis(size_t begin, size_t end) const {
        const Box box = boundOf(begin, end);
        const math::vec3 size = box.max - box.min;
        return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    }

    int findCheapestAxis(size_t begin, size_t middle, size_t end) {
        int best = 0;
        float bestArea = std::numeric_limits<float>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            partition(begin, middle, end, axis);
            const float area = halfArea(boundOf(begin, middle)) + halfArea(boundOf(middle, end));
            if (area < bestArea)
                bestArea = area, best = axis;
        }
        return best;
    }

    Box boundOf(size_t begin, size_t end) const {
        Box box = mBoxes[mOrder[begin]];
        for (size_t i = begin + 1; i < end; ++i) {
            box.min = glm::min(box.min, mBoxes[mOrder[i]].min);
            box.max = glm::max(box.max, mBoxes[mOrder[i]].max);
        }
        return box;
    }

    std::span<const Box> mBoxes;
    std::vector<math::vec3> mCentres;
    std::vector<uint32_t> mOrder;
};

} // namespace

std::vector<uint32_t> computeSpatialOrder(std::span<const Box> boxes) {
    return Sorter(boxes).run();
}

void sortTriangles(std::span<const math::vec3> positions, std::vector<uint32_t>& indices) {
    std::vector<Box> boxes(indices.size() / 3);
    for (size_t i = 0; i < boxes.size(); ++i) {
        const math::vec3 a = positions[indices[3 * i]];
        const math::vec3 b = positions[indices[3 * i + 1]];
        const math::vec3 c = positions[indices[3 * i + 2]];
        boxes[i] = {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))};
    }
    const std::vector<uint32_t> order = computeSpatialOrder(boxes);
    std::vector<uint32_t> sorted;
    sorted.reserve(indices.size());
    for (uint32_t triangle : order)
        for (uint32_t corner = 0; corner < 3; ++corner)
            sorted.push_back(indices[3 * triangle + corner]);
    indices = std::move(sorted);
}

} // namespace shutter::extract
