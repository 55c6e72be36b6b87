// SPDX-License-Identifier: MIT
#include "tests/conformance/demand/floor_effect.h"

namespace shutter::demand {

FloorEffect::FloorEffect(gpu::Device& device, const motion_blur::MotionBlurSettings& settings)
    : mSettings(settings), mTileMotion(device), mSorter(device), mFloor(device) {}

core::Decision FloorEffect::ask(const render::ViewFacts& facts) const {
    const bool moves = facts.moves && facts.exposureSeconds > 0.0;
    return {moves, moves ? "something moves during the exposure" : "nothing moves"};
}

void FloorEffect::declare(render::PostContext& context) {
    const auto params = motion_blur::resolve(
        mSettings, context.facts.width, context.facts.height, context.facts.rasterTime
    );
    const auto tiles = mTileMotion.add(context.graph, context.gbuffer.motionDepth, params);
    const auto sorted = mSorter.add(context.graph, tiles, params, false);
    context.color = mFloor.add(
        context.graph,
        {context.color, context.gbuffer.motionDepth, tiles.dominant},
        sorted.lists,
        params
    );
}

} // namespace shutter::demand
