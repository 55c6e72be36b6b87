// SPDX-License-Identifier: MIT
#include "modules/motion_blur/raster_history.h"

namespace shutter::motion_blur {

namespace {

bool hasSize(const gpu::Image& image, glm::uvec2 sizePx) {
    return image.handle() && image.desc().width == sizePx.x && image.desc().height == sizePx.y;
}

} // namespace

bool RasterHistory::holds(glm::uvec2 sizePx) const {
    return mHasContents && hasSize(newest().color, sizePx);
}

const RasterHistory::Raster& RasterHistory::turn(glm::uvec2 sizePx) {
    mNewest = 1 - mNewest;
    mHasContents = true;
    Raster& raster = mRasters.at(mNewest);
    if (hasSize(raster.color, sizePx))
        return raster;
    gpu::ImageDesc desc;
    desc.width = sizePx.x;
    desc.height = sizePx.y;
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT; // for those who want to see it
    desc.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    raster.color = gpu::Image(mDevice, "kept colour", desc);
    desc.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    desc.format = VK_FORMAT_R32G32_UINT;
    raster.surface = gpu::Image(mDevice, "kept surface", desc);
    return raster;
}

void RasterHistory::forget() {
    mRasters = {};
    mHasContents = false;
}

uint64_t RasterHistory::bytes() const {
    uint64_t bytes = 0;
    for (const Raster& raster : mRasters)
        for (const gpu::Image* image : {&raster.color, &raster.surface})
            if (image->handle())
                bytes += uint64_t(image->desc().width) * image->desc().height *
                         gpu::texelBytes(image->desc().format);
    return bytes;
}

} // namespace shutter::motion_blur
