// SPDX-License-Identifier: MIT
#include "modules/motion_blur/passes/masked_pixels.h"

#include "modules/motion_blur/passes/dispatch.h"

namespace shutter::motion_blur {

MaskListing chooseMaskListing(const gpu::Device& device) {
    return isSoftware(device) ? MaskListing::PixelByPixel : MaskListing::BlockByBlock;
}

MaskedPixels MaskedPixels::create(graph::Graph& graph, const PassParams& params, Clears& clears) {
    const glm::uvec2 size = params.sizePx;
    const VkDeviceSize pixelCount = VkDeviceSize(size.x) * size.y;
    const MaskedPixels created{
        graph.createImage("ray mask", {size.x, size.y, VK_FORMAT_R8_UNORM}),
        graph.createBuffer(
            "masked pixels",
            {sizeof(shader::MaskHeader) + pixelCount * sizeof(uint32_t), kListUsage}
        ),
        graph.createBuffer(
            "reveal arguments", {sizeof(shader::DispatchArguments), kArgumentsUsage}
        )};
    clears.add(created.mask);
    clears.addHead(created.list, sizeof(shader::MaskHeader));
    clears.addArguments(created.arguments, 1);
    return created;
}

MaskedPixels MaskedPixels::getCleared(const MaskedPixels& created, const Clears& clears) {
    return {clears.get(created.mask), clears.get(created.list), clears.get(created.arguments)};
}

} // namespace shutter::motion_blur
