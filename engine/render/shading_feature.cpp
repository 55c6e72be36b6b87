// SPDX-License-Identifier: MIT
#include "engine/render/shading_feature.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace shutter::render {

core::Result<RasterShading>
extractShading(std::span<ShadingFeature* const> features, const RasterExtract& raster) {
    RasterShading all;
    for (ShadingFeature* feature : features) {
        auto extracted = feature->extract(raster);
        if (!extracted)
            return extracted.error();
        Shading& own = extracted.value();
        std::move(
            own.explanations.begin(), own.explanations.end(), std::back_inserter(all.explanations)
        );
        if (!own.run.run)
            continue;
        all.running.push_back({feature, std::move(own.passReason)});
        all.revision += own.revision;
        for (size_t slot = 0; slot < own.slots.size(); ++slot)
            all.slots[slot] = std::max(all.slots[slot], own.slots[slot]);
    }
    return all;
}

uint32_t listSlots(const ShadingSlots& slots) {
    uint32_t bits = 0;
    for (size_t slot = 0; slot < slots.size(); ++slot)
        bits |= slots[slot] != 0 ? 1u << slot : 0u;
    return bits;
}

} // namespace shutter::render
