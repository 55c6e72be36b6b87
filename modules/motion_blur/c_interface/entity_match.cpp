// SPDX-License-Identifier: MIT
#include "modules/motion_blur/c_interface/entity_match.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace shutter::motion_blur {

namespace {

struct Pair {
    double distance;
    uint32_t before;
    uint32_t now;

    bool operator<(const Pair& other) const {
        return std::tie(distance, before, now) < std::tie(other.distance, other.before, other.now);
    }
};

double measure(const ShutterBlurEntity& a, const ShutterBlurEntity& b) {
    return std::hypot(a.place[0] - b.place[0], a.place[1] - b.place[1], a.place[2] - b.place[2]);
}

/// Indices by model and x, without places that are not finite.
std::vector<uint32_t> sortEntities(std::span<const ShutterBlurEntity> entities) {
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < entities.size(); ++i) {
        const double* place = entities[i].place;
        if (std::isfinite(place[0]) && std::isfinite(place[1]) && std::isfinite(place[2]))
            order.push_back(i);
    }
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        return std::tie(entities[a].model, entities[a].place[0], a) <
               std::tie(entities[b].model, entities[b].place[0], b);
    });
    return order;
}

} // namespace

std::vector<uint32_t> matchEntities(
    std::span<const ShutterBlurEntity> before, std::span<const ShutterBlurEntity> now, double reach
) {
    std::vector<Pair> pairs;
    const std::vector<uint32_t> then = sortEntities(before);
    size_t first = 0; // no later entity can be nearer to those before it
    for (const uint32_t i : sortEntities(now)) {
        const auto isBehind = [&](const ShutterBlurEntity& other) {
            return other.model < now[i].model ||
                   (other.model == now[i].model && now[i].place[0] - other.place[0] > reach);
        };
        while (first < then.size() && isBehind(before[then[first]]))
            ++first;
        for (size_t k = first; k < then.size(); ++k) {
            const ShutterBlurEntity& other = before[then[k]];
            if (other.model != now[i].model || other.place[0] - now[i].place[0] > reach)
                break;
            const double distance = measure(other, now[i]);
            if (distance <= reach)
                pairs.push_back({distance, then[k], i});
        }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<uint32_t> found(now.size(), UINT32_MAX);
    std::vector<bool> isTaken(before.size());
    for (const Pair& pair : pairs)
        if (found[pair.now] == UINT32_MAX && !isTaken[pair.before]) {
            found[pair.now] = pair.before;
            isTaken[pair.before] = true;
        }
    return found;
}

} // namespace shutter::motion_blur
