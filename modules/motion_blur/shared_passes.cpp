// SPDX-License-Identifier: MIT
#include "modules/motion_blur/shared_passes.h"

#include "modules/motion_blur/passes/filter.h"

namespace shutter::motion_blur {

namespace {

class OnePassMethod : public BlockMethod {
  public:
    OnePassMethod(
        gpu::Device& device,
        const char* pass,
        std::span<const uint32_t> spirv,
        DominantMotion dominant
    )
        : mReadsDominant(dominant == DominantMotion::Read),
          mFilter(device, shader::kMixedList, {pass, spirv, mReadsDominant ? 3u : 2u}) {}

  protected:
    graph::ImageHandle filter(
        graph::Graph& graph,
        const BlockInputs& inputs,
        graph::ImageHandle target,
        const PassParams& params,
        std::vector<View>& /*views*/
    ) const override {
        std::vector<graph::ImageHandle> images{inputs.frame.color, inputs.frame.motionDepth};
        if (mReadsDominant)
            images.push_back(inputs.tiles.dominant);
        return mFilter.add(graph, images, inputs.blocks.lists, target, params);
    }

  private:
    bool mReadsDominant;
    BlockFilter mFilter;
};

} // namespace

void SharedPasses::chooseStillPixelsBy(const MotionBlurInputs& inputs) {
    if (inputs.target.isValid()) {
        stillPixelsBy =
            inputs.mayWriteColor() ? StaticPixelsBy::CopyBack : StaticPixelsBy::WholeCopy;
        return;
    }
    // The share of the slot's last frame is a good guess at this one's; the picture is the same
    // either way.
    const BlockCounters last = sorter.counters(inputs.slot);
    const uint32_t moving = last.uniform + last.mixed + last.masked;
    const uint32_t all = moving + last.still;
    if (!inputs.colorIsWritable || all == 0)
        stillPixelsBy = StaticPixelsBy::WholeCopy;
    else
        stillPixelsBy = chooseStaticPixels(double(moving) / double(all), stillPixelsBy);
}

MotionBlurOutputs BlockMethod::add(
    graph::Graph& graph,
    const MotionBlurInputs& inputs,
    const MotionBlurSettings& /*settings*/,
    const PassParams& params,
    SharedPasses& shared
) {
    const TileMotionOutputs tiles = shared.tileMotion.add(graph, inputs.motionDepth, params);
    const SortedBlocks blocks = shared.sorter.add(graph, tiles, params, false);
    if (inputs.wantsCounters)
        shared.sorter.addCounters(graph, blocks, params, inputs.slot);
    const graph::ImageHandle target = shared.stillPixels.begin(
        graph, inputs.color, inputs.target, shared.stillPixelsBy, blocks.lists, params
    );
    MotionBlurOutputs outputs;
    outputs.views = {{"tile_max", tiles.tiles}, {"tiles", tiles.dominant}};
    const graph::ImageHandle filtered =
        filter(graph, {inputs, tiles, blocks}, target, params, outputs.views);
    outputs.views.push_back(
        {"cost", shared.costView.add(graph, inputs.motionDepth, {}, blocks, params)}
    );
    outputs.color = shared.stillPixels.end(
        graph, inputs.color, filtered, blocks, false, params, shared.stillPixelsBy
    );
    return outputs;
}

std::unique_ptr<MethodPasses> makeOnePassMethod(
    gpu::Device& device, const char* pass, std::span<const uint32_t> spirv, DominantMotion dominant
) {
    return std::make_unique<OnePassMethod>(device, pass, spirv, dominant);
}

} // namespace shutter::motion_blur
