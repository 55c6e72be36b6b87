// SPDX-License-Identifier: MIT
#include "tests/gpu/effect_rig.h"

#include "spirv/accumulate/accumulate.comp.h"

#include "engine/scene/components.h"
#include "shaders/accumulate/accumulate_shared.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

namespace shutter::test {

graph::Plan run(GraphRig& rig) {
    auto plan = rig.run();
    if (plan)
        return std::move(plan).value();
    ADD_FAILURE() << plan.error().message;
    return {};
}

EffectRig::EffectRig(GraphRig& rig, graph::ImageHandle color, uint32_t width, uint32_t height)
    : context{
          .graph = rig.graph,
          .view = view,
          .frame = frame,
          .shapes = shapes,
          .facts = facts,
          .gbuffer = gbuffer,
          .rays = nullptr,
          .timedRays = nullptr,
          .color = color,
          .intermediates = intermediates,
          .explainer = explainer} {
    facts.width = width;
    facts.height = height;
    facts.displayWanted = true;
}

core::Decision decide(const render::Effect& effect, const render::ViewFacts& facts) {
    scene::World world;
    const ecs::Entity camera = world.registry.create();
    world.registry.add(camera, scene::Camera{});
    world.registry.add(camera, scene::LocalTransform{});
    const scene::ExposureMotion motion(world, camera, {});
    return effect.decide({facts, world, {}, {}, motion, {}}).run;
}

gpu::ComputePipelineDesc describeScalePipeline() {
    gpu::ComputePipelineDesc desc;
    desc.name = "scale";
    desc.spirv = accumulate_accumulate_comp;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    desc.interface.pushConstantBytes = sizeof(shader::AccumulateParams);
    return desc;
}

gpu::Pipeline makeScalePipeline(gpu::Device& device) {
    return gpu::Pipeline(device, describeScalePipeline());
}

image::Image makePicture(uint32_t width, uint32_t height, float value) {
    image::Image picture(width, height, 4);
    std::fill(picture.pixels.begin(), picture.pixels.end(), value);
    return picture;
}

image::Image makeNoise(uint32_t width, uint32_t height) {
    image::Image picture(width, height, 4);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (float& value : picture.pixels)
        value = image::roundToHalf(unit(random));
    return picture;
}

} // namespace shutter::test
