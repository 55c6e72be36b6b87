// SPDX-License-Identifier: MIT
// What tests of single passes put around the rig of tests/kit: failures are the test's, a post
// effect gets its context.
#pragma once

#include "engine/render/effect.h"
#include "tests/kit/graph_rig.h"

#include <cstdint>

namespace shutter::test {

/// GraphRig::run() that fails the test, and returns an empty plan, if the graph does not compile.
graph::Plan run(GraphRig& rig);

/// What an effect is given, around one picture.
struct EffectRig {
    EffectRig(GraphRig& rig, graph::ImageHandle color, uint32_t width, uint32_t height);

    extract::ViewRequest view;
    extract::ExtractedFrame frame;
    gpu_scene::DeformedMeshes shapes;
    render::ViewFacts facts;
    render::GBuffer gbuffer;
    render::Intermediates intermediates{{}};
    render::Explainer explainer;
    render::PictureContext context;
};

/// Whether the effect runs in a frame of an empty world.
[[nodiscard]] core::Decision decide(const render::Effect& effect, const render::ViewFacts& facts);

/// The shader that adds pictures: with index 0, rgb = source's rgb times the scale. Something to
/// dispatch, pushed AccumulateParams.
[[nodiscard]] gpu::ComputePipelineDesc describeScalePipeline();
[[nodiscard]] gpu::Pipeline makeScalePipeline(gpu::Device& device);

/// Motion right and down in pixels, and depth, of each pixel.
/// \param at of a pixel's x and y, a vec3
template <class At> image::Image makeMotion(uint32_t width, uint32_t height, const At& at) {
    image::Image motion(width, height, 4);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) {
            const math::vec3 value = at(x, y);
            for (uint32_t c = 0; c < 3; ++c)
                motion.at(x, y, c) = value[int(c)];
        }
    return motion;
}

/// One value in all four channels.
[[nodiscard]] image::Image makePicture(uint32_t width, uint32_t height, float value);
/// Half floats, so that a colour image holds the picture itself.
[[nodiscard]] image::Image makeNoise(uint32_t width, uint32_t height);

} // namespace shutter::test
