// SPDX-License-Identifier: MIT
// Guertin, McGuire, Nowrouzezahrai 2014, "A Fast and Stable Feature-Aware Motion Blur Filter".
#include "spirv/motion_blur/guertin2014.comp.h"

#include "modules/motion_blur/budget_ladder.h"
#include "modules/motion_blur/passes/filter.h"
#include "modules/motion_blur/passes/tile_motion.h"
#include "modules/motion_blur/shared_passes.h"
#include "shaders/motion_blur/guertin2014_shared.h"

#include <array>

namespace shutter::motion_blur {

extern const Method kGuertin2014;

namespace {

class GuertinPasses : public BlockMethod {
  public:
    explicit GuertinPasses(gpu::Device& device)
        : mTiles(device),
          mFilter(device, shader::kMixedList, {"guertin2014", motion_blur_guertin2014_comp, 4}) {}

  protected:
    graph::ImageHandle filter(
        graph::Graph& graph,
        const BlockInputs& inputs,
        graph::ImageHandle target,
        const PassParams& params,
        std::vector<View>& views
    ) const override {
        const GuertinTilesOutputs tiles = mTiles.add(graph, inputs.tiles.tiles, params);
        for (View& view : views)
            if (view.name == "tiles")
                view.image = tiles.dominant;
        views.push_back({"variance", tiles.variance});
        const std::array images{
            inputs.frame.color, inputs.frame.motionDepth, tiles.dominant, tiles.variance};
        return mFilter.add(graph, images, inputs.blocks.lists, target, params);
    }

  private:
    GuertinTiles mTiles;
    BlockFilter mFilter;
};

} // namespace

const Method kGuertin2014 = {
    .name = "guertin2014",
    .description = "gather along two directions, feature-aware",
    .publication = "Guertin, McGuire, Nowrouzezahrai 2014",
    .defaultSamples = 35,
    .settings =
        {"tileSizePx",
         "neighbourhoodTiles",
         "softDepthExtent",
         "softDepthShare",
         "jitter",
         "maxMotionDepth",
         "centreBias",
         "speedThresholdPx"},
    .views = {"tile_max", "tiles", "variance", "cost"},
    .resolve =
        [](const MotionBlurSettings& settings, PassParams& params) {
            params.marginPx = measureTileJitter(params);
            params.setMethod(shader::Guertin2014Params{
                settings.centreBias, settings.speedThresholdPx});
        },
    .addBudgetLevels = addSampleLevels,
    .makePasses = [](gpu::Device& device, VkDescriptorSetLayout) -> std::unique_ptr<MethodPasses> {
        return std::make_unique<GuertinPasses>(device);
    },
};

} // namespace shutter::motion_blur
