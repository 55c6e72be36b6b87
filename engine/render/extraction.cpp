// SPDX-License-Identifier: MIT
#include "engine/render/extraction.h"

#include "engine/render/frame_extractor.h"

#include <utility>

namespace shutter::render {

core::Error describeFullTable(uint32_t limit) {
    return {fmt::format(
        "the scene draws more than {} entities, the most the entity table holds", limit
    )};
}

core::Result<ExtractedFrame>
extractFrame(const scene::World& world, const SceneLayout& layout, const ViewRequest& request) {
    FrameExtractor extractor;
    auto frame = extractor.update(world, layout, request);
    if (!frame)
        return frame.error();
    return std::move(*frame.value());
}

} // namespace shutter::render
