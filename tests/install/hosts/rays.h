/* SPDX-License-Identifier: MIT The hosts' own rays, in a compute shader (rays.comp), for the pixels
 * that "hybrid" requests. */
#ifndef RAYS_H
#define RAYS_H

#include "scene.h"

#include <stdint.h>

/* kRaysSpirv, an array of uint32_t: made by glslangValidator --vn. */
#include "rays_spirv.h"

enum { kRayBindings = 4 };

typedef struct Rays {
    VkDevice device;
    VkDescriptorSetLayout setLayout;
    VkPipelineLayout layout;
    VkPipeline pipeline;
    VkDescriptorSet set;
    uint32_t calls;
} Rays;

static inline void makeRaysLayout(Rays* rays) {
    VkDescriptorSetLayoutBinding bindings[kRayBindings];
    VkDescriptorSetLayoutCreateInfo set;
    VkPushConstantRange constants;
    VkPipelineLayoutCreateInfo layout;
    uint32_t i;
    memset(bindings, 0, sizeof(bindings));
    for (i = 0; i < kRayBindings; ++i) {
        bindings[i].binding = i;
        bindings[i].descriptorType =
            i ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        bindings[i].descriptorCount = 1;
        bindings[i].stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    }
    memset(&set, 0, sizeof(set));
    set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set.bindingCount = kRayBindings;
    set.pBindings = bindings;
    require(
        !vkCreateDescriptorSetLayout(rays->device, &set, NULL, &rays->setLayout), "no set layout"
    );
    memset(&constants, 0, sizeof(constants));
    constants.stageFlags = VK_SHADER_STAGE_COMPUTE_BIT;
    constants.size = 5 * sizeof(float);
    memset(&layout, 0, sizeof(layout));
    layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &rays->setLayout;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &constants;
    require(!vkCreatePipelineLayout(rays->device, &layout, NULL, &rays->layout), "no layout");
}

static inline void makeRays(Rays* rays, VkDevice device) {
    const VkDescriptorPoolSize sizes[2] = {
        {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1}, {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 3}};
    VkShaderModuleCreateInfo module;
    VkShaderModule shader;
    VkComputePipelineCreateInfo pipeline;
    VkDescriptorPoolCreateInfo pool;
    VkDescriptorPool made;
    VkDescriptorSetAllocateInfo set;
    memset(rays, 0, sizeof(*rays));
    rays->device = device;
    makeRaysLayout(rays);
    memset(&module, 0, sizeof(module));
    module.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    module.codeSize = sizeof(kRaysSpirv);
    module.pCode = kRaysSpirv;
    require(!vkCreateShaderModule(device, &module, NULL, &shader), "no shader");
    memset(&pipeline, 0, sizeof(pipeline));
    pipeline.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    pipeline.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    pipeline.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    pipeline.stage.module = shader;
    pipeline.stage.pName = "main";
    pipeline.layout = rays->layout;
    require(
        !vkCreateComputePipelines(device, VK_NULL_HANDLE, 1, &pipeline, NULL, &rays->pipeline),
        "no pipeline"
    );
    memset(&pool, 0, sizeof(pool));
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.maxSets = 1;
    pool.poolSizeCount = 2;
    pool.pPoolSizes = sizes;
    require(!vkCreateDescriptorPool(device, &pool, NULL, &made), "no descriptor pool");
    memset(&set, 0, sizeof(set));
    set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    set.descriptorPool = made;
    set.descriptorSetCount = 1;
    set.pSetLayouts = &rays->setLayout;
    require(!vkAllocateDescriptorSets(device, &set, &rays->set), "no descriptor set");
}

/* Traces the pixels of `list`, as a ShutterBlurRevealTask has them. */
static inline void traceRays(
    Rays* rays,
    VkCommandBuffer commands,
    VkBuffer list,
    VkBuffer groups,
    VkImageView color,
    VkImageView motionDepth,
    VkImageView entityId
) {
    const VkImageView views[3] = {color, motionDepth, entityId};
    const float constants[5] = {kLeft, kTop, kSidePx, (float)kSquareMetres, (float)kWallMetres};
    VkDescriptorBufferInfo buffer;
    VkDescriptorImageInfo images[3];
    VkWriteDescriptorSet writes[kRayBindings];
    uint32_t i;
    buffer.buffer = list;
    buffer.offset = 0;
    buffer.range = VK_WHOLE_SIZE;
    memset(images, 0, sizeof(images));
    memset(writes, 0, sizeof(writes));
    for (i = 0; i < kRayBindings; ++i) {
        writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
        writes[i].dstSet = rays->set;
        writes[i].dstBinding = i;
        writes[i].descriptorCount = 1;
        writes[i].descriptorType =
            i ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
        writes[i].pBufferInfo = &buffer;
        if (i) {
            images[i - 1].imageView = views[i - 1];
            images[i - 1].imageLayout = VK_IMAGE_LAYOUT_GENERAL;
            writes[i].pImageInfo = &images[i - 1];
        }
    }
    vkUpdateDescriptorSets(rays->device, kRayBindings, writes, 0, NULL);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, rays->pipeline);
    vkCmdBindDescriptorSets(
        commands, VK_PIPELINE_BIND_POINT_COMPUTE, rays->layout, 0, 1, &rays->set, 0, NULL
    );
    vkCmdPushConstants(
        commands, rays->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(constants), constants
    );
    vkCmdDispatchIndirect(commands, groups, 0);
    ++rays->calls;
}

#endif
