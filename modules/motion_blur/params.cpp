// SPDX-License-Identifier: MIT
#include "modules/motion_blur/params.h"

#include "modules/motion_blur/methods.h"

#include <algorithm>

namespace shutter::motion_blur {

float measureTileJitter(const PassParams& params) {
    return 0.25f * static_cast<float>(params.tileSizePx) * params.jitter;
}

PassParams
resolve(const MotionBlurSettings& wanted, uint32_t width, uint32_t height, double rasterTime) {
    const MotionBlurSettings settings = complete(wanted);
    PassParams params{};
    const uint32_t tile = chooseTileSize(settings, height);
    params.sizePx = {width, height};
    params.tileCount = {(width + tile - 1) / tile, (height + tile - 1) / tile};
    params.tileSizePx = tile;
    params.neighbourRadius = static_cast<int32_t>(settings.neighbourhoodTiles / 2);
    params.sampleCount = settings.sampleCount;
    params.softDepthExtent = settings.softDepthExtent;
    params.softDepthShare = settings.softDepthShare;
    params.rasterTime = static_cast<float>(std::clamp(rasterTime, 0.0, 1.0));
    params.jitter = settings.jitter;
    params.maxMotionDepth = settings.maxMotionDepth;
    params.uniformMotionPx = settings.method->usesUniformMotion ? settings.uniformMotionPx : 0.0f;
    if (settings.method->resolve)
        settings.method->resolve(settings, params);
    return params;
}

} // namespace shutter::motion_blur
