// SPDX-License-Identifier: MIT
#include "engine/extract/extracted_frame.h"

#include "engine/extract/frame_extractor.h"

#include <utility>

namespace shutter::extract {

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

} // namespace shutter::extract
