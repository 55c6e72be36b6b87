/* SPDX-License-Identifier: MIT The scene of both hosts, and the Vulkan around it, in the words that
 * C11 and C++17 share: a striped wall that is static, and a square before it that moves by kMovedPx
 * to the right during the exposure, as images that a renderer would have. The camera is at the
 * origin with -Z forward.
 *
 * With HOST_USES_VOLK the host's functions are volk's variables. */
#ifndef SCENE_H
#define SCENE_H

#ifdef HOST_USES_VOLK
#include <volk.h>
#else
#include <vulkan/vulkan.h>
#endif

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { kWidth = 96, kHeight = 64, kPixels = kWidth * kHeight };

enum { kLeft = 40, kTop = 20, kSidePx = 24, kMovedPx = 16 }; /* of the square, now */

enum { kPartBytes = kPixels * 16 }; /* RGBA32F is the largest format */

static const double kWallMetres = 10.0, kSquareMetres = 5.0, kNearMetres = 0.1;

typedef enum Part { kColor, kVectors, kDepth, kIds, kNormal, kOutput, kPartCount } Part;

typedef struct Scene {
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    VkCommandBuffer commands;
    VkBuffer buffer; /* of all parts, one after another */
    void* mapped;
    VkImage images[kPartCount];
} Scene;

static const VkFormat kFormats[kPartCount] = {
    VK_FORMAT_R32G32B32A32_SFLOAT,
    VK_FORMAT_R32G32_SFLOAT,
    VK_FORMAT_R32_SFLOAT,
    VK_FORMAT_R32_UINT,
    VK_FORMAT_R32G32B32A32_SFLOAT,
    VK_FORMAT_R32G32B32A32_SFLOAT};

static inline void require(int condition, const char* what) {
    if (condition)
        return;
    fprintf(stderr, "host: %s\n", what);
    exit(1);
}

static inline int isSquare(int x, int y) {
    return x >= kLeft && x < kLeft + kSidePx && y >= kTop && y < kTop + kSidePx;
}

/* Perspective: a point at a distance of d metres and d to the right is at the picture's edge. The
 * depth is reversed, its far plane infinite. Column by column. */
static inline void fillProjection(double* clipFromView) {
    memset(clipFromView, 0, 16 * sizeof(double));
    clipFromView[0] = 1.0;
    clipFromView[5] = -(double)kWidth / (int)kHeight;
    clipFromView[11] = -1.0;
    clipFromView[14] = kNearMetres;
}

/* Where the square was `share` of its way ago. */
static inline void fillTransform(double* worldFromSquare, double share) {
    memset(worldFromSquare, 0, 16 * sizeof(double));
    worldFromSquare[0] = worldFromSquare[5] = worldFromSquare[10] = worldFromSquare[15] = 1.0;
    worldFromSquare[12] = -share * (int)kMovedPx * 2.0 / (int)kWidth * kSquareMetres;
}

static inline VkDeviceMemory
allocateMemory(const Scene* scene, VkMemoryRequirements needs, VkMemoryPropertyFlags flags) {
    VkPhysicalDeviceMemoryProperties of;
    VkMemoryAllocateInfo info;
    VkDeviceMemory memory;
    uint32_t type = 0; /* Vulkan guarantees a type of each kind needed here */
    vkGetPhysicalDeviceMemoryProperties(scene->physical, &of);
    while (!(needs.memoryTypeBits >> type & 1) || flags & ~of.memoryTypes[type].propertyFlags)
        ++type;
    memset(&info, 0, sizeof(info));
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs.size;
    info.memoryTypeIndex = type;
    require(!vkAllocateMemory(scene->device, &info, NULL, &memory), "no memory");
    return memory;
}

static inline void makeImage(Scene* scene, Part part) {
    VkImageCreateInfo info;
    VkMemoryRequirements needs;
    memset(&info, 0, sizeof(info));
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = kFormats[part];
    info.extent.width = kWidth;
    info.extent.height = kHeight;
    info.extent.depth = info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    require(!vkCreateImage(scene->device, &info, NULL, &scene->images[part]), "no image");
    vkGetImageMemoryRequirements(scene->device, scene->images[part], &needs);
    vkBindImageMemory(scene->device, scene->images[part], allocateMemory(scene, needs, 0), 0);
}

static inline void makeBuffer(Scene* scene) {
    VkBufferCreateInfo info;
    VkMemoryRequirements needs;
    VkDeviceMemory memory;
    memset(&info, 0, sizeof(info));
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = (VkDeviceSize)kPartCount * kPartBytes;
    info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    require(!vkCreateBuffer(scene->device, &info, NULL, &scene->buffer), "no buffer");
    vkGetBufferMemoryRequirements(scene->device, scene->buffer, &needs);
    memory = allocateMemory(
        scene, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
    );
    vkBindBufferMemory(scene->device, scene->buffer, memory, 0);
    require(!vkMapMemory(scene->device, memory, 0, VK_WHOLE_SIZE, 0, &scene->mapped), "no map");
}

static inline void draw(const Scene* scene) {
    float* colors = (float*)scene->mapped;
    float* vectors = colors + (size_t)kVectors * 4 * kPixels;
    float* metres = colors + (size_t)kDepth * 4 * kPixels;
    uint32_t* ids = (uint32_t*)scene->mapped + (size_t)kIds * 4 * kPixels;
    float* normals = colors + (size_t)kNormal * 4 * kPixels;
    int i;
    for (i = 0; i < kPixels; ++i) {
        const int x = i % kWidth;
        const int square = isSquare(x, i / kWidth);
        colors[4 * i] = square ? 1.0f : x / 8 % 2 ? 0.125f : 0.5f; /* half floats hold these */
        colors[4 * i + 1] = 0.25f;
        colors[4 * i + 2] = square ? 0.125f : 0.375f;
        colors[4 * i + 3] = 1.0f;
        vectors[2 * i] =
            square ? -(float)kMovedPx / (int)kWidth : 0.0f; /* back, by texture coordinates */
        vectors[2 * i + 1] = 0.0f;
        metres[i] = (float)(square ? kSquareMetres : kWallMetres);
        ids[i] = square ? 1 : 0;
        memset(normals + 4 * i, 0, 16);
        normals[4 * i + 2] = 1.0f;
    }
}

static inline void beginCommands(const Scene* scene) {
    VkCommandBufferBeginInfo info;
    memset(&info, 0, sizeof(info));
    info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    require(!vkBeginCommandBuffer(scene->commands, &info), "commands do not begin");
}

static inline void finishCommands(const Scene* scene) {
    VkSubmitInfo info;
    memset(&info, 0, sizeof(info));
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &scene->commands;
    require(!vkEndCommandBuffer(scene->commands), "commands do not end");
    require(!vkQueueSubmit(scene->queue, 1, &info, VK_NULL_HANDLE), "not submitted");
    require(!vkDeviceWaitIdle(scene->device), "the device is lost");
}

static inline void copyPart(const Scene* scene, Part part, int toImage) {
    VkBufferImageCopy copy;
    memset(&copy, 0, sizeof(copy));
    copy.bufferOffset = (VkDeviceSize)part * kPartBytes;
    copy.imageSubresource.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
    copy.imageSubresource.layerCount = 1;
    copy.imageExtent.width = kWidth;
    copy.imageExtent.height = kHeight;
    copy.imageExtent.depth = 1;
    if (toImage)
        vkCmdCopyBufferToImage(
            scene->commands, scene->buffer, scene->images[part], VK_IMAGE_LAYOUT_GENERAL, 1, &copy
        );
    else
        vkCmdCopyImageToBuffer(
            scene->commands, scene->images[part], VK_IMAGE_LAYOUT_GENERAL, scene->buffer, 1, &copy
        );
}

/* All images are in VK_IMAGE_LAYOUT_GENERAL from here on. */
static inline void uploadParts(Scene* scene) {
    int part;
    makeBuffer(scene);
    draw(scene);
    beginCommands(scene);
    for (part = 0; part < kPartCount; ++part) {
        VkImageMemoryBarrier barrier;
        makeImage(scene, (Part)part);
        memset(&barrier, 0, sizeof(barrier));
        barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
        barrier.image = scene->images[part];
        barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.newLayout = VK_IMAGE_LAYOUT_GENERAL;
        barrier.subresourceRange.aspectMask = VK_IMAGE_ASPECT_COLOR_BIT;
        barrier.subresourceRange.levelCount = barrier.subresourceRange.layerCount = 1;
        vkCmdPipelineBarrier(
            scene->commands,
            VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
            VK_PIPELINE_STAGE_TRANSFER_BIT,
            0,
            0,
            NULL,
            0,
            NULL,
            1,
            &barrier
        );
        if (part != kOutput)
            copyPart(scene, (Part)part, 1);
    }
    finishCommands(scene);
}

/* `enable` switches the motion blur's features on. */
static inline void openDevice(Scene* scene, void (*enable)(VkPhysicalDeviceFeatures2*)) {
    const float priority = 1.0f;
    VkApplicationInfo application;
    VkInstanceCreateInfo instance;
    VkPhysicalDeviceVulkan13Features v13;
    VkPhysicalDeviceVulkan12Features v12;
    VkPhysicalDeviceFeatures2 features;
    VkDeviceQueueCreateInfo queue;
    VkDeviceCreateInfo device;
    VkCommandPoolCreateInfo pool;
    VkCommandBufferAllocateInfo commands;
    VkCommandPool made;
    uint32_t count = 1;
    memset(scene, 0, sizeof(*scene));
    memset(&application, 0, sizeof(application));
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_3;
    memset(&instance, 0, sizeof(instance));
    instance.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    instance.pApplicationInfo = &application;
#ifdef HOST_USES_VOLK
    require(!volkInitialize(), "no Vulkan");
#endif
    require(!vkCreateInstance(&instance, NULL, &scene->instance), "no Vulkan");
#ifdef HOST_USES_VOLK
    volkLoadInstance(scene->instance);
#endif
    require(
        vkEnumeratePhysicalDevices(scene->instance, &count, &scene->physical) >= 0 && count,
        "no device"
    );
    memset(&v13, 0, sizeof(v13));
    v13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
    memset(&v12, 0, sizeof(v12));
    v12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    v12.pNext = &v13;
    memset(&features, 0, sizeof(features));
    features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    features.pNext = &v12;
    enable(&features);
    memset(&queue, 0, sizeof(queue));
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    memset(&device, 0, sizeof(device));
    device.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    device.pNext = &features;
    device.queueCreateInfoCount = 1;
    device.pQueueCreateInfos = &queue;
    require(!vkCreateDevice(scene->physical, &device, NULL, &scene->device), "no device");
#ifdef HOST_USES_VOLK
    volkLoadDevice(scene->device);
#endif
    vkGetDeviceQueue(scene->device, 0, 0, &scene->queue);
    memset(&pool, 0, sizeof(pool));
    pool.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    require(!vkCreateCommandPool(scene->device, &pool, NULL, &made), "no pool");
    memset(&commands, 0, sizeof(commands));
    commands.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
    commands.commandPool = made;
    commands.commandBufferCount = 1;
    require(!vkAllocateCommandBuffers(scene->device, &commands, &scene->commands), "no commands");
    uploadParts(scene);
}

/* RGBA of 32-bit floats, row by row. */
static inline void writePicture(const Scene* scene, const char* method) {
    char name[64];
    FILE* file;
    snprintf(name, sizeof(name), "%s.raw", method);
    file = fopen(name, "wb");
    require(
        file && fwrite((char*)scene->mapped + (size_t)kOutput * kPartBytes, kPartBytes, 1, file) &&
            !fclose(file),
        "cannot write the picture"
    );
}

#endif
