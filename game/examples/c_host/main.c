/* SPDX-License-Identifier: MIT
 * Motion blur in a renderer in C11 that has nothing of Shutter but its shared library: it draws
 * stripes and a square that moves, with motion vectors in normalised device coordinates and linear
 * depth, and writes "after.ppm". Shutter's part is marked (1) to (4). */
#include <shutter_motion_blur.h>

#include <stdio.h>
#include <stdlib.h>

enum { kWidth = 320, kHeight = 180, kPixels = kWidth * kHeight, kSpeedPx = 24 };
enum { kPartBytes = kPixels * 16 }; /* of the buffer: RGBA32F is largest */
enum { kUsage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
                VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT };

static VkPhysicalDevice sPhysical;
static VkDevice sDevice;

static void require(int condition, const char* what) {
    if (!condition) exit(fprintf(stderr, "c_host: %s\n", what) > 0);
}
static void check(ShutterBlurResult result) { require(!result, shutterBlurGetMessage()); }

static VkDeviceMemory allocate(VkMemoryRequirements needs, VkMemoryPropertyFlags flags) {
    VkPhysicalDeviceMemoryProperties of;
    vkGetPhysicalDeviceMemoryProperties(sPhysical, &of);
    uint32_t type = 0; /* Vulkan guarantees a type of each kind needed here */
    while (!(needs.memoryTypeBits >> type & 1) || flags & ~of.memoryTypes[type].propertyFlags)
        ++type;
    const VkMemoryAllocateInfo info = {
        VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, NULL, needs.size, type};
    VkDeviceMemory memory;
    require(!vkAllocateMemory(sDevice, &info, NULL, &memory), "no memory");
    return memory;
}

static VkImage makeImage(VkFormat format) {
    const VkImageCreateInfo info = {
        VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, .imageType = VK_IMAGE_TYPE_2D, .format = format,
        .extent = {kWidth, kHeight, 1}, .mipLevels = 1, .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT, .usage = kUsage};
    VkImage image;
    VkMemoryRequirements needs;
    require(!vkCreateImage(sDevice, &info, NULL, &image), "no image");
    vkGetImageMemoryRequirements(sDevice, image, &needs);
    vkBindImageMemory(sDevice, image, allocate(needs, 0), 0);
    return image;
}

int main(void) {
    const VkInstanceCreateInfo instanceInfo = {
        VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, .pApplicationInfo = &(VkApplicationInfo){
            VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3}};
    VkInstance instance;
    uint32_t count = 1;
    require(!vkCreateInstance(&instanceInfo, NULL, &instance), "no Vulkan");
    require(vkEnumeratePhysicalDevices(instance, &count, &sPhysical) >= 0 && count, "no device");
    VkPhysicalDeviceVulkan13Features v13 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features v12 = {
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &v13};
    VkPhysicalDeviceFeatures2 features = {
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &v12};
    check(shutterBlurAddFeatures(&features)); /* (1) required device features */
    const VkDeviceQueueCreateInfo queueInfo = {
        VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, NULL, 0, 0, 1, &(float){1.0f}};
    const VkDeviceCreateInfo deviceInfo = {
        VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, .pNext = &features, .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queueInfo};
    require(!vkCreateDevice(sPhysical, &deviceInfo, NULL, &sDevice), "no device");

    const VkBufferCreateInfo bufferInfo = {
        VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = 4 * kPartBytes,
        .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT};
    VkBuffer buffer; /* colours, vectors, depth and the result */
    VkMemoryRequirements needs;
    void* mapped;
    require(!vkCreateBuffer(sDevice, &bufferInfo, NULL, &buffer), "no buffer");
    vkGetBufferMemoryRequirements(sDevice, buffer, &needs);
    const VkDeviceMemory memory = allocate(
        needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    vkBindBufferMemory(sDevice, buffer, memory, 0);
    require(!vkMapMemory(sDevice, memory, 0, VK_WHOLE_SIZE, 0, &mapped), "not mapped");
    float *colors = mapped, *moved = colors + 4 * kPixels, *metres = moved + 4 * kPixels;
    for (int i = 0; i < kPixels; ++i) {
        const int x = i % kWidth, y = i / kWidth, isSquare = x / 60 == 2 && y / 60 == 1;
        colors[4 * i] = isSquare ? 1.0f : x / 10 % 2 ? 0.125f : 0.5f;
        colors[4 * i + 1] = 0.25f; /* half floats hold all of them */
        colors[4 * i + 2] = isSquare ? 0.125f : 0.375f;
        moved[2 * i] = isSquare ? -2.0f * kSpeedPx / kWidth : 0.0f; /* to the previous frame */
        metres[i] = isSquare ? 5.0f : 10.0f;
    }
    ShutterBlurDevice device = shutterBlurDefaultDevice(); /* (2) the effect, for queue family 0 */
    ShutterBlur* blur = NULL;
    device.physical = sPhysical, device.device = sDevice;
    check(shutterBlurCreate(&device, &blur));
    ShutterBlurInputs inputs = shutterBlurDefaultInputs(); /* (3) its inputs and outputs */
    inputs.width = kWidth, inputs.height = kHeight;
    inputs.color.format = VK_FORMAT_R32G32B32A32_SFLOAT; /* blurred in place: there is no output */
    inputs.vectors.format = VK_FORMAT_R32G32_SFLOAT, inputs.depth.format = VK_FORMAT_R32_SFLOAT;
    inputs.pixelsPerUnit[0] = -kWidth / 2.0f, inputs.pixelsPerUnit[1] = -kHeight / 2.0f;
    inputs.depthIsLinear = VK_TRUE, inputs.skyValue = 1e9f, inputs.exposureShare = 1.0f;
    inputs.color.after.layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    const VkCommandPoolCreateInfo poolInfo = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    VkCommandPool pool;
    require(!vkCreateCommandPool(sDevice, &poolInfo, NULL, &pool), "no pool");
    const VkCommandBufferAllocateInfo commandsInfo = {
        VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, NULL, pool, 0, 1};
    VkCommandBuffer commands;
    require(!vkAllocateCommandBuffers(sDevice, &commandsInfo, &commands), "no commands");
    const VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    vkBeginCommandBuffer(commands, &begin);
    ShutterBlurImage* images[3] = {&inputs.color, &inputs.vectors, &inputs.depth};
    VkBufferImageCopy copy = {.imageExtent = {kWidth, kHeight, 1}};
    copy.imageSubresource = (VkImageSubresourceLayers){VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    for (int i = 0; i < 3; ++i, copy.bufferOffset += kPartBytes) {
        images[i]->image = makeImage(images[i]->format);
        images[i]->before.layout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        const VkImageMemoryBarrier barrier = {
            VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER, .image = images[i]->image,
            .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT, .newLayout = images[i]->before.layout,
            .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TOP_OF_PIPE_BIT,
            VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 0, NULL, 1, &barrier);
        vkCmdCopyBufferToImage(commands, buffer, barrier.image, barrier.newLayout, 1, &copy);
    }
    const ShutterBlurSettings settings = {.structBytes = sizeof(settings), .method = "gather"};
    check(shutterBlurRecord(blur, commands, 0, &inputs, &settings)); /* (4) in the frame */
    vkCmdCopyImageToBuffer(commands, images[0]->image, images[0]->after.layout, buffer, 1, &copy);
    const VkMemoryBarrier shown = {VK_STRUCTURE_TYPE_MEMORY_BARRIER, NULL,
        VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_HOST_READ_BIT};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
        &shown, 0, NULL, 0, NULL);
    vkEndCommandBuffer(commands);
    const VkSubmitInfo submit = {
        VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
    VkQueue queue;
    vkGetDeviceQueue(sDevice, 0, 0, &queue);
    require(!vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), "not submitted");
    require(!vkDeviceWaitIdle(sDevice), "the device is lost");
    shutterBlurDestroy(blur); /* all else goes with the process */

    for (int part = 0; part < 4; part += 3) {
        FILE* file = fopen(part ? "after.ppm" : "before.ppm", "wb");
        require(file && fprintf(file, "P6 %d %d 255\n", kWidth, kHeight) > 0, "cannot write");
        for (int i = 0; i < 4 * kPixels; ++i)
            if (i % 4 != 3) fputc((int)(255.0f * colors[4 * kPixels * part + i] + 0.5f), file);
        require(!fclose(file), "cannot write");
    }
    return 0;
}
