/* SPDX-License-Identifier: MIT
 * Motion blur in a forward renderer of the old kind, in C11: an 8-bit target in gamma space, ids in
 * the stencil, a level of one mesh, a drone with parts, a weapon with a projection and range of
 * depth of its own, smoke in the same pass, a display afterwards; no motion vectors. It averages
 * frames of its own, prints how far each method is from them, and writes "before.ppm" and
 * "after.ppm". Shutter's part is marked (1) to (4). */
#include "spirv/forward.frag.h"
#include "spirv/forward.vert.h"

#include <shutter_motion_blur.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define TYPE(name) VK_STRUCTURE_TYPE_##name
#define MAKE(Kind, handle, ...) require( \
    !vkCreate##Kind(sDevice, &(const Vk##Kind##CreateInfo){__VA_ARGS__}, NULL, handle), "no " #Kind)
#define STATE(Name, NAME, ...) &(const VkPipeline##Name##StateCreateInfo){ \
    VK_STRUCTURE_TYPE_PIPELINE_##NAME##_STATE_CREATE_INFO, NULL, 0, __VA_ARGS__}

enum { kWidth = 480, kHeight = 270, kPixels = kWidth * kHeight, kMostBoxes = 4096, kTruth = 48 };
enum { kSky, kLevel, kBody, kBlades, kIds }; /* values of the stencil */
enum { kLevelMesh, kBodyMesh, kBladeMesh, kWeaponMesh, kSmokeMesh, kMeshes };
enum { kFirst = 2, kLast = 5 }; /* frames of each method; the last one is compared */
static const double kFrame = 1.0 / 30.0, kShare = 0.5; /* seconds; of it the shutter is open */
static const double kNearest = 0.2; /* the weapon's depths lie below, the world's above */
static const VkRect2D kArea = {{0, 0}, {kWidth, kHeight}};
static const VkFormat kColorFormat = VK_FORMAT_B8G8R8A8_UNORM;
static const VkImageUsageFlags kBlurredUsage = /* in place: read by shaders, and copied into */
    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
static const VkImageLayout kColor = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
static const VkImageLayout kCopied = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
static const VkImageLayout kDepth = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;

typedef struct { double m[16]; } Matrix; /* column by column */
typedef struct { float corner[3], size[3], color[4]; } Box;
typedef struct { VkImage image; VkImageView view; } Target;
static VkPhysicalDevice sPhysical;
static VkDevice sDevice;
static VkQueue sQueue;
static VkCommandBuffer sCommands;
static VkFormat sDepthFormat = VK_FORMAT_D24_UNORM_S8_UINT;
static Target sColor, sDepth;
static VkRenderPass sScene, sOverlay;
static VkFramebuffer sTargets;
static VkPipelineLayout sLayout;
static VkPipeline sOpaque, sBlended;
static VkBuffer sBoxBuffer, sReadback;
static Box* sBoxes; /* instances that are drawn */
static const uint8_t* sBytes; /* the picture: blue, green, red, alpha */
static uint32_t sBoxCount, sEnds[kMeshes]; /* of the meshes, in the boxes */
static ShutterBlur* sBlur;

static void require(int condition, const char* what) {
    if (!condition) exit(fprintf(stderr, "forward_host: %s\n", what) > 0);
}
static void check(ShutterBlurResult result) { require(!result, shutterBlurGetMessage()); }
static void print(void* user, const char* sentence) { fprintf(user, "%s\n", sentence); }
static Matrix multiply(Matrix a, Matrix b) {
    Matrix r = {{0}};
    for (int i = 0; i < 64; ++i)
        r.m[i % 16] += a.m[i % 4 + i / 16 * 4] * b.m[i % 16 / 4 * 4 + i / 16];
    return r;
}
static Matrix translate(double x, double y, double z) {
    return (Matrix){{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1}};
}
static Matrix turn(double angle) { /* about y */
    const double c = cos(angle), s = sin(angle);
    return (Matrix){{c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0, 0, 0, 1}};
}
/* Looks along -Z, y down in the picture, depths from `least` (near) to `most`. */
static Matrix project(double focal, double least, double most) {
    const double near = 0.05, far = 100.0, k = (most - least) * far / (near - far);
    return (Matrix){{focal * kHeight / kWidth, 0, 0, 0, 0, -focal, 0, 0, 0, 0, k - least, -1, 0, 0,
                     k * near, 0}};
}

/* Where all is at a time. */
static Matrix findCamera(double t) { /* view from world */
    return multiply(turn(0.4 * t), translate(2.0 - 14.0 * t, -1.4, 0));
}
static Matrix findPart(int id, double t) { /* world from object */
    const Matrix body = translate(-5.0 + 30.0 * t, 1.9 + sin(6.0 * t) / 4, -4.0);
    return multiply(body, id == kBody ? turn(0.8 * t) : turn(25.0 * t));
}
static Matrix findWeapon(double t) { /* view from object */
    return translate(0.17 + sin(9.0 * t) / 40, -0.22, -0.5 + cos(9.0 * t) / 40);
}
static void addBox(float x, float y, float z, float w, float h, float d, unsigned rgb) {
    sBoxes[sBoxCount++] = (Box){{x, y, z}, {w, h, d},
        {(rgb >> 16) / 255.0f, (rgb >> 8 & 255) / 255.0f, (rgb & 255) / 255.0f, 0.15f}};
}
static unsigned mix(unsigned x, unsigned y) { /* a colour of its own for each stone */
    return 0x303030 + ((x * 73856093u ^ y * 19349663u) * 2654435761u >> 25) * 0x10101;
}
static void buildScene(void) {
    for (unsigned x = 0; x < 60; ++x) /* far wall, floor, railings: one mesh */
        for (unsigned y = 0; y < 12; ++y) {
            addBox(x * 0.8 - 20, y * 0.6 - 0.5, -14.5, 0.8, 0.6, 0.5, mix(x, y));
            if (y < 11) addBox(x * 0.8 - 20, -0.6, -14.0 + y, 0.8, 0.1, 1.0, mix(x, y + 99));
        }
    for (int x = 0; x < 60; ++x) addBox(x * 0.5 - 15, -0.5, -3.0, 0.08, 1.7, 0.08, 0xD8B040);
    addBox(-15, 1.2, -3.03, 30, 0.1, 0.14, 0xE8E0D0);
    sEnds[kLevelMesh] = sBoxCount;
    addBox(-0.4, -0.15, -0.4, 0.8, 0.3, 0.8, 0xC04030);
    sEnds[kBodyMesh] = sBoxCount;
    addBox(-1.2, 0.2, -0.07, 2.4, 0.05, 0.14, 0xF0F0F0);
    sEnds[kBladeMesh] = sBoxCount;
    addBox(-0.03, -0.03, -0.4, 0.06, 0.06, 0.6, 0x405060);
    addBox(-0.05, -0.06, -0.1, 0.1, 0.12, 0.3, 0x708090);
    sEnds[kWeaponMesh] = sBoxCount;
    for (int i = 0; i < 8; ++i) /* the farthest first */
        addBox(i % 3 * 1.5 - 2.0, 0.2, i - 12.0, 1.2, 1.4, 0, 0xF8F0E8);
    sEnds[kSmokeMesh] = sBoxCount;
}

static VkDeviceMemory allocate(VkMemoryRequirements needs, VkMemoryPropertyFlags flags) {
    VkPhysicalDeviceMemoryProperties of;
    vkGetPhysicalDeviceMemoryProperties(sPhysical, &of);
    uint32_t type = 0; /* Vulkan guarantees a type of each kind needed here */
    while (!(needs.memoryTypeBits >> type & 1) || flags & ~of.memoryTypes[type].propertyFlags)
        ++type;
    const VkMemoryAllocateInfo info = {TYPE(MEMORY_ALLOCATE_INFO), NULL, needs.size, type};
    VkDeviceMemory memory;
    require(!vkAllocateMemory(sDevice, &info, NULL, &memory), "no memory");
    return memory;
}
static VkBuffer makeBuffer(VkDeviceSize bytes, VkBufferUsageFlags usage, void** mapped) {
    VkBuffer buffer;
    VkMemoryRequirements needs;
    MAKE(Buffer, &buffer, TYPE(BUFFER_CREATE_INFO), .size = bytes, .usage = usage);
    vkGetBufferMemoryRequirements(sDevice, buffer, &needs);
    const VkDeviceMemory memory = allocate(
        needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    vkBindBufferMemory(sDevice, buffer, memory, 0);
    require(!vkMapMemory(sDevice, memory, 0, VK_WHOLE_SIZE, 0, mapped), "not mapped");
    return buffer;
}
static Target makeTarget(VkFormat format, VkImageUsageFlags usage, VkImageAspectFlags aspects) {
    Target target;
    VkMemoryRequirements needs;
    MAKE(Image, &target.image, TYPE(IMAGE_CREATE_INFO), .imageType = VK_IMAGE_TYPE_2D,
        .format = format, .extent = {kWidth, kHeight, 1}, .mipLevels = 1, .arrayLayers = 1,
        .samples = 1, .usage = usage);
    vkGetImageMemoryRequirements(sDevice, target.image, &needs);
    vkBindImageMemory(sDevice, target.image, allocate(needs, 0), 0);
    MAKE(ImageView, &target.view, TYPE(IMAGE_VIEW_CREATE_INFO), .image = target.image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D, .format = format,
        .subresourceRange = {aspects, 0, 1, 0, 1});
    return target;
}

/* The scene's clears the targets; the other goes on in them, and leaves the picture for a copy. */
static VkRenderPass makePass(int isScene) {
    const VkAttachmentLoadOp clear = VK_ATTACHMENT_LOAD_OP_CLEAR;
    const VkAttachmentLoadOp load = isScene ? clear : VK_ATTACHMENT_LOAD_OP_LOAD;
    const VkAttachmentStoreOp store = VK_ATTACHMENT_STORE_OP_STORE;
    const VkImageLayout none = VK_IMAGE_LAYOUT_UNDEFINED, color = isScene ? kColor : kCopied;
    const VkAttachmentDescription attachments[2] = {
        {0, kColorFormat, 1, load, store, load, store, isScene ? none : kColor, color},
        {0, sDepthFormat, 1, load, store, load, store, isScene ? none : kDepth, kDepth}};
    const VkSubpassDescription subpass = {
        .colorAttachmentCount = 1, .pColorAttachments = &(VkAttachmentReference){0, kColor},
        .pDepthStencilAttachment = &(VkAttachmentReference){1, kDepth}};
    const VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    const VkPipelineStageFlags draws = VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT;
    const VkAccessFlags write = VK_ACCESS_MEMORY_WRITE_BIT, any = write | VK_ACCESS_MEMORY_READ_BIT;
    const VkSubpassDependency waits[2] = {{VK_SUBPASS_EXTERNAL, 0, all, draws, write, any, 0},
                                          {0, VK_SUBPASS_EXTERNAL, draws, all, write, any, 0}};
    VkRenderPass pass;
    MAKE(RenderPass, &pass, TYPE(RENDER_PASS_CREATE_INFO), NULL, 0, 2, attachments, 1, &subpass, 2,
        waits);
    return pass;
}
static VkPipelineShaderStageCreateInfo makeStage(
    VkShaderStageFlagBits stage, const uint32_t* words, size_t bytes) {
    VkShaderModule module;
    MAKE(ShaderModule, &module, TYPE(SHADER_MODULE_CREATE_INFO), .codeSize = bytes, .pCode = words);
    return (VkPipelineShaderStageCreateInfo){
        TYPE(PIPELINE_SHADER_STAGE_CREATE_INFO), NULL, 0, stage, module, "main", NULL};
}
static VkPipeline makePipeline(VkBool32 blends) {
    const VkPipelineShaderStageCreateInfo stages[2] = {
        makeStage(VK_SHADER_STAGE_VERTEX_BIT, forward_vert, sizeof(forward_vert)),
        makeStage(VK_SHADER_STAGE_FRAGMENT_BIT, forward_frag, sizeof(forward_frag))};
    const VkVertexInputBindingDescription boxes = {0, sizeof(Box), VK_VERTEX_INPUT_RATE_INSTANCE};
    const VkVertexInputAttributeDescription attributes[3] = {
        {0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}, {1, 0, VK_FORMAT_R32G32B32_SFLOAT, 12},
        {2, 0, VK_FORMAT_R32G32B32A32_SFLOAT, 24}};
    const VkStencilOpState writesId = {.passOp = VK_STENCIL_OP_REPLACE,
        .compareOp = VK_COMPARE_OP_ALWAYS, .writeMask = 0xFF};
    const VkPipelineColorBlendAttachmentState blend = {
        blends, VK_BLEND_FACTOR_SRC_ALPHA, VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA, VK_BLEND_OP_ADD,
        VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_ONE, VK_BLEND_OP_ADD, 0xF};
    const VkDynamicState dynamic[2] = {
        VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_STENCIL_REFERENCE};
    const VkGraphicsPipelineCreateInfo info = {
        TYPE(GRAPHICS_PIPELINE_CREATE_INFO), .stageCount = 2, .pStages = stages,
        .pVertexInputState = STATE(VertexInput, VERTEX_INPUT, 1, &boxes, 3, attributes),
        .pInputAssemblyState = STATE(
            InputAssembly, INPUT_ASSEMBLY, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, VK_FALSE),
        .pViewportState = STATE(Viewport, VIEWPORT, 1, NULL, 1, &kArea),
        .pRasterizationState = STATE(Rasterization, RASTERIZATION, .lineWidth = 1.0f),
        .pMultisampleState = STATE(Multisample, MULTISAMPLE, .rasterizationSamples = 1),
        .pDepthStencilState = STATE(DepthStencil, DEPTH_STENCIL, VK_TRUE, !blends,
            VK_COMPARE_OP_LESS_OR_EQUAL, VK_FALSE, !blends, writesId, writesId, 0, 1),
        .pColorBlendState = STATE(ColorBlend, COLOR_BLEND, VK_FALSE, 0, 1, &blend, {0}),
        .pDynamicState = STATE(Dynamic, DYNAMIC, 2, dynamic),
        .layout = sLayout, .renderPass = sScene};
    VkPipeline pipeline;
    require(!vkCreateGraphicsPipelines(sDevice, NULL, 1, &info, NULL, &pipeline), "no pipeline");
    return pipeline;
}
static void makeDevice(void) {
    const VkApplicationInfo app = {TYPE(APPLICATION_INFO), .apiVersion = VK_API_VERSION_1_3};
    const VkInstanceCreateInfo info = {TYPE(INSTANCE_CREATE_INFO), .pApplicationInfo = &app};
    VkInstance instance;
    uint32_t count = 1;
    require(!vkCreateInstance(&info, NULL, &instance), "no Vulkan");
    require(vkEnumeratePhysicalDevices(instance, &count, &sPhysical) >= 0 && count, "no device");
    VkPhysicalDeviceVulkan13Features v13 = {.sType = TYPE(PHYSICAL_DEVICE_VULKAN_1_3_FEATURES)};
    VkPhysicalDeviceVulkan12Features v12 = {
        TYPE(PHYSICAL_DEVICE_VULKAN_1_2_FEATURES), .pNext = &v13};
    VkPhysicalDeviceFeatures2 features = {TYPE(PHYSICAL_DEVICE_FEATURES_2), &v12, {0}};
    check(shutterBlurAddFeatures(&features)); /* (1) required device features */
    const float one = 1.0f;
    const VkDeviceQueueCreateInfo queue = {TYPE(DEVICE_QUEUE_CREATE_INFO), NULL, 0, 0, 1, &one};
    const VkDeviceCreateInfo deviceInfo = {
        TYPE(DEVICE_CREATE_INFO), &features, 0, 1, &queue, 0, NULL, 0, NULL, NULL};
    require(!vkCreateDevice(sPhysical, &deviceInfo, NULL, &sDevice), "no device");
    vkGetDeviceQueue(sDevice, 0, 0, &sQueue);
    VkCommandPool pool;
    MAKE(CommandPool, &pool, TYPE(COMMAND_POOL_CREATE_INFO),
        .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT);
    const VkCommandBufferAllocateInfo commandsInfo = {
        TYPE(COMMAND_BUFFER_ALLOCATE_INFO), NULL, pool, 0, 1};
    require(!vkAllocateCommandBuffers(sDevice, &commandsInfo, &sCommands), "no commands");

    ShutterBlurDevice device = shutterBlurDefaultDevice(); /* (2) the effect, for queue family 0 */
    device.physical = sPhysical, device.device = sDevice, device.framesInFlight = 1;
    device.enabledFeatures = &features, device.apiVersion = VK_API_VERSION_1_3;
    device.checksInputs = VK_TRUE, device.message = print, device.messageUser = stderr;
    check(shutterBlurCreate(&device, &sBlur));
}
static void makeTargets(void) {
    VkFormatProperties properties; /* a device has one of the two */
    vkGetPhysicalDeviceFormatProperties(sPhysical, sDepthFormat, &properties);
    if (!(properties.optimalTilingFeatures & VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT))
        sDepthFormat = VK_FORMAT_D32_SFLOAT_S8_UINT;
    sColor = makeTarget(kColorFormat, kBlurredUsage | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
        VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_IMAGE_ASPECT_COLOR_BIT);
    sDepth = makeTarget(sDepthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
        VK_IMAGE_USAGE_SAMPLED_BIT, VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT);
    sScene = makePass(1), sOverlay = makePass(0);
    const VkImageView views[2] = {sColor.view, sDepth.view};
    MAKE(Framebuffer, &sTargets, TYPE(FRAMEBUFFER_CREATE_INFO), NULL, 0, sScene, 2, views, kWidth,
        kHeight, 1);
    MAKE(PipelineLayout, &sLayout, TYPE(PIPELINE_LAYOUT_CREATE_INFO), .pushConstantRangeCount = 1,
        .pPushConstantRanges = &(VkPushConstantRange){VK_SHADER_STAGE_VERTEX_BIT, 0, 64});
    sOpaque = makePipeline(VK_FALSE), sBlended = makePipeline(VK_TRUE);
    void *bytes, *boxes;
    sReadback = makeBuffer(kPixels * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT, &bytes);
    sBoxBuffer = makeBuffer(kMostBoxes * sizeof(Box), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, &boxes);
    sBytes = bytes, sBoxes = boxes;
}
static void draw(int mesh, Matrix clipFromObject, uint32_t id) {
    const uint32_t first = mesh ? sEnds[mesh - 1] : 0;
    float pushed[16];
    for (int i = 0; i < 16; ++i) pushed[i] = (float)clipFromObject.m[i];
    vkCmdPushConstants(sCommands, sLayout, VK_SHADER_STAGE_VERTEX_BIT, 0, 64, pushed);
    vkCmdSetStencilReference(sCommands, VK_STENCIL_FACE_FRONT_AND_BACK, id);
    vkCmdDraw(sCommands, 36, sEnds[mesh] - first, 0, first);
}
static void use(VkPipeline pipeline, double least, double most) { /* in a range of depth */
    const VkViewport viewport = {0, 0, kWidth, kHeight, (float)least, (float)most};
    vkCmdBindPipeline(sCommands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdSetViewport(sCommands, 0, 1, &viewport);
}
static void beginPass(VkRenderPass pass) {
    const VkClearValue clears[2] = {
        {.color = {.float32 = {0.55f, 0.7f, 0.9f, 1.0f}}}, {.depthStencil = {1.0f, kSky}}};
    const VkRenderPassBeginInfo begin = {
        TYPE(RENDER_PASS_BEGIN_INFO), NULL, pass, sTargets, kArea, 2, clears};
    vkCmdBeginRenderPass(sCommands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindVertexBuffers(sCommands, 0, 1, &sBoxBuffer, &(VkDeviceSize){0});
}
static void drawScene(double t) {
    const Matrix world = multiply(project(1.6, 0, 1), findCamera(t));
    beginPass(sScene);
    use(sOpaque, kNearest, 1.0);
    draw(kLevelMesh, world, kLevel);
    draw(kBodyMesh, multiply(world, findPart(kBody, t)), kBody);
    draw(kBladeMesh, multiply(world, findPart(kBlades, t)), kBlades);
    use(sBlended, kNearest, 1.0);
    draw(kSmokeMesh, world, kSky);
    use(sOpaque, 0.0, kNearest);
    draw(kWeaponMesh, multiply(project(2.2, 0, 1), findWeapon(t)), kSky);
    vkCmdEndRenderPass(sCommands);
}
static void copyMatrix(double* to, Matrix from) { memcpy(to, from.m, sizeof(from.m)); }
static void blur(const char* method, int frame, VkBool32 follows) {
    const double then = (frame - 1) * kFrame, now = frame * kFrame;
    ShutterBlurInputs inputs = shutterBlurDefaultInputs(); /* (3) its inputs and outputs */
    inputs.width = kWidth, inputs.height = kHeight, inputs.frameNumber = frame;
    inputs.color = (ShutterBlurImage){ /* blurred in place: there is no output */
        .image = sColor.image, .format = kColorFormat, .extent = kArea.extent,
        .usage = kBlurredUsage, .samples = 1, .before.layout = kColor, .after.layout = kColor};
    inputs.transfer = SHUTTER_BLUR_TRANSFER_SRGB, inputs.cameras.areGiven = VK_TRUE;
    inputs.depth = (ShutterBlurImage){
        .image = sDepth.image, .format = sDepthFormat, .extent = kArea.extent,
        .usage = VK_IMAGE_USAGE_SAMPLED_BIT, .samples = 1, .before.layout = kDepth,
        .after.layout = kDepth};
    inputs.entityId = inputs.depth; /* its stencil */
    inputs.skyValue = 1.0f, inputs.noEntity = kSky, inputs.rowCount = kIds;
    copyMatrix(inputs.cameras.viewFromWorld, findCamera(now));
    copyMatrix(inputs.cameras.viewFromWorldBefore, findCamera(then));
    copyMatrix(inputs.cameras.clipFromView, project(1.6, kNearest, 1.0));
    copyMatrix(inputs.cameras.clipFromViewBefore, project(1.6, kNearest, 1.0));
    inputs.exposureShare = (float)kShare, inputs.followsLast = follows;
    Matrix parts[kIds][2];
    ShutterBlurMover movers[kIds];
    for (int id = kBody; id < kIds; ++id) {
        parts[id][0] = findPart(id, then), parts[id][1] = findPart(id, now);
        movers[inputs.moverCount++] = (ShutterBlurMover){(uint32_t)id, parts[id][0].m};
    }
    inputs.movers = movers;
    const Matrix weapon[2] = {findWeapon(then), findWeapon(now)};
    inputs.viewModel.depthMax = (float)kNearest;
    copyMatrix(inputs.viewModel.clipFromView, project(2.2, 0.0, kNearest));
    inputs.viewModel.viewFromObject = weapon[0].m;
    const ShutterBlurSettings settings = {.structBytes = sizeof(settings), .method = method};
    check(shutterBlurRecord(sBlur, sCommands, 0, &inputs, &settings)); /* (4) in the frame */
}
/* Draws the scene at a time, blurs it unless `method` is null, and reads it. */
static void render(double t, const char* method, int frame, VkBool32 follows, int hasDisplay) {
    const VkCommandBufferBeginInfo begin = {TYPE(COMMAND_BUFFER_BEGIN_INFO), .pNext = NULL};
    vkBeginCommandBuffer(sCommands, &begin);
    drawScene(t);
    if (method) blur(method, frame, follows);
    beginPass(sOverlay);
    const VkClearAttachment green = {VK_IMAGE_ASPECT_COLOR_BIT, 0, {{{0.2f, 1.0f, 0.2f, 1.0f}}}};
    const VkClearRect dot = {{{kWidth / 2 - 3, kHeight / 2 - 3}, {6, 6}}, 0, 1};
    if (hasDisplay) vkCmdClearAttachments(sCommands, 1, &green, 1, &dot);
    vkCmdEndRenderPass(sCommands);
    const VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                                    .imageExtent = {kWidth, kHeight, 1}};
    vkCmdCopyImageToBuffer(sCommands, sColor.image, kCopied, sReadback, 1, &copy);
    vkCmdPipelineBarrier(sCommands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0,
        1, &(VkMemoryBarrier){TYPE(MEMORY_BARRIER), NULL, VK_ACCESS_TRANSFER_WRITE_BIT,
        VK_ACCESS_HOST_READ_BIT}, 0, NULL, 0, NULL);
    vkEndCommandBuffer(sCommands);
    const VkSubmitInfo submit = {TYPE(SUBMIT_INFO), NULL, 0, NULL, NULL, 1, &sCommands, 0, NULL};
    require(!vkQueueSubmit(sQueue, 1, &submit, VK_NULL_HANDLE), "not submitted");
    require(!vkDeviceWaitIdle(sDevice), "the device is lost");
}
static double decode(uint8_t byte) { /* sRGB */
    return byte <= 10 ? byte / 255.0 / 12.92 : pow((byte / 255.0 + 0.055) / 1.055, 2.4);
}
static void compare(const double* truth, const char* name) {
    double sum = 0.0;
    for (int i = 0; i < kPixels * 4; ++i)
        if (i % 4 != 3) sum += pow(decode(sBytes[i]) - truth[i], 2.0);
    printf("%s %.2f dB\n", name, 10.0 * log10(3.0 * kPixels / sum));
}
static void write(const char* path) {
    FILE* file = fopen(path, "wb");
    require(file && fprintf(file, "P6 %d %d 255\n", kWidth, kHeight) > 0, "cannot write");
    for (int i = 0; i < kPixels; ++i)
        for (int channel = 2; channel >= 0; --channel) fputc(sBytes[4 * i + channel], file);
    require(!fclose(file), "cannot write");
}

static void film(const char* method, int hasDisplay) {
    for (int frame = kFirst; frame <= kLast; ++frame)
        render(frame * kFrame, method, frame, frame > kFirst, hasDisplay);
}
int main(void) {
    static double truth[kPixels * 4];
    const double now = kLast * kFrame;
    makeDevice(), makeTargets(), buildScene();
    for (int i = 0; i < kTruth; ++i) {
        render(now - kFrame * kShare * (1 - (i + 0.5) / kTruth), NULL, 0, VK_FALSE, 0);
        for (int k = 0; k < kPixels * 4; ++k) truth[k] += decode(sBytes[k]) / kTruth;
    }
    film(NULL, 0);
    compare(truth, "sharp");
    const char* method;
    for (uint32_t i = 0; (method = shutterBlurGetMethod(i)); ++i) {
        if (!strcmp(method, "hybrid") || !strcmp(method, "adaptive")) continue; /* they need rays */
        film(method, 0);
        compare(truth, method);
    }
    film(NULL, 1);
    write("before.ppm");
    film("resolved", 1);
    write("after.ppm");
    shutterBlurDestroy(sBlur); /* all else goes with the process */
}
