// SPDX-License-Identifier: MIT
#include "engine/extract/extracted_frame.h"

#include "engine/extract/frame_extractor.h"

#include <algorithm>
#include <array>
#include <utility>

namespace shutter::extract {

using math::dmat4;
using math::dvec3;
using math::dvec4;

core::Error describeFullTable(uint32_t limit) {
    return {fmt::format(
        "the scene draws more than {} entities, the most the entity table holds", limit
    )};
}

core::Result<ExtractedFrame>
extractFrame(const scene::World& world, const SceneLayout& layout, const ViewRequest& request) {
    FrameExtractor extractor;
    if (const auto frame = extractor.update(world, layout, request); !frame)
        return frame.error();
    return extractor.take();
}

const DeformedEntity* findDeformed(const ExtractedFrame& frame, uint32_t row) {
    const auto found = std::lower_bound(
        frame.deformed.begin(),
        frame.deformed.end(),
        row,
        [](const DeformedEntity& entity, uint32_t wanted) { return entity.row < wanted; }
    );
    return found != frame.deformed.end() && found->row == row ? &*found : nullptr;
}

const math::Bounds&
findRowBounds(const ExtractedFrame& frame, const SceneLayout& layout, uint32_t row) {
    if (const DeformedEntity* deformed = findDeformed(frame, row))
        return deformed->bounds;
    return layout.bounds[frame.entityMeshes[row]];
}

bool isOutsideView(const dmat4& clipFromObject, const math::Bounds& bounds) {
    std::array<int, 5> outside{};
    for (int corner = 0; corner < 8; ++corner) {
        const dvec3 point(
            corner & 1 ? bounds.max.x : bounds.min.x,
            corner & 2 ? bounds.max.y : bounds.min.y,
            corner & 4 ? bounds.max.z : bounds.min.z
        );
        const dvec4 clip = clipFromObject * dvec4(point, 1.0);
        outside[0] += clip.x < -clip.w;
        outside[1] += clip.x > clip.w;
        outside[2] += clip.y < -clip.w;
        outside[3] += clip.y > clip.w;
        outside[4] += clip.z > clip.w; // reversed depth: nearer than the near plane
    }
    return std::any_of(outside.begin(), outside.end(), [](int count) { return count == 8; });
}

} // namespace shutter::extract
