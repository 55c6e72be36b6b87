// SPDX-License-Identifier: MIT
#include "engine/app/window_output.h"

#include "spirv/app/window.frag.h"
#include "spirv/app/window.vert.h"

#include "engine/core/check.h"
#include "engine/graph/execute.h"
#include "shaders/app/app_shared.h"

#include <algorithm>

namespace shutter::app {

namespace {

constexpr float kLineHalfWidthPx = 1.0f;

gpu::GraphicsPipelineDesc describePipeline(VkFormat format) {
    gpu::GraphicsPipelineDesc desc;
    desc.name = "window";
    desc.vertexSpirv = app_window_vert;
    desc.fragmentSpirv = app_window_frag;
    desc.interface.bindings = {
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
    desc.interface.pushConstantBytes = sizeof(shader::WindowParams);
    desc.colorFormats = {format};
    return desc;
}

shader::WindowParams makeParams(const PixelRect& rect, const WindowTarget& target) {
    shader::WindowParams params{};
    params.originPx = rect.origin;
    params.extentPx = rect.extent;
    params.dividerPx = -1.0f;
    if (target.left) {
        const double share = std::clamp(target.dividerShare, 0.0, 1.0);
        params.dividerPx = static_cast<float>(share * target.size.x);
        params.lineHalfWidthPx = kLineHalfWidthPx;
    }
    return params;
}

} // namespace

PixelRect fitPicture(const math::uvec2& picture, const math::uvec2& window) {
    const math::dvec2 own(picture);
    const math::dvec2 whole(window);
    const double scale = std::min(whole.x / own.x, whole.y / own.y);
    PixelRect rect{math::dvec2(0.0), own * scale};
    for (int axis = 0; axis < 2; ++axis) {
        if (whole[axis] - rect.extent[axis] < 1.0)
            rect.extent[axis] = whole[axis];
        rect.origin[axis] = glm::floor(0.5 * (whole[axis] - rect.extent[axis]));
    }
    return rect;
}

WindowOutput::WindowOutput(gpu::Device& device) : mDevice(device) {
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = VK_FILTER_LINEAR;
    info.minFilter = VK_FILTER_LINEAR;
    info.addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.maxLod = VK_LOD_CLAMP_NONE; // clamping costs on some devices, and images have one level
    gpu::require(vkCreateSampler(device.handle(), &info, nullptr, &mLinear), "creating a sampler");
}

WindowOutput::~WindowOutput() {
    mDevice.retire([device = mDevice.handle(), sampler = mLinear] {
        vkDestroySampler(device, sampler, nullptr);
    });
}

const gpu::Pipeline& WindowOutput::findPipeline(VkFormat format) {
    auto found = mPipelines.find(format);
    if (found == mPipelines.end())
        found = mPipelines.emplace(format, gpu::Pipeline(mDevice, describePipeline(format))).first;
    return found->second;
}

void WindowOutput::declare(render::PictureContext& context) {
    SHUTTER_CHECK(context.display.isValid(), "there is no picture to show");

    struct Data {
        graph::ImageHandle left;
        graph::ImageHandle right;
        graph::ImageHandle window;
    };

    const WindowTarget target = mTarget;
    graph::Graph& graph = context.graph;
    const graph::TransientImageDesc& picture = graph.describeImage(context.display);
    const math::uvec2 size(picture.width, picture.height);
    std::optional<gpu::SwapchainImage> shown;
    if (target.acquire)
        shown = target.acquire();
    if (shown)
        context.semaphores = shown->semaphores;
    const VkFormat format = shown ? shown->image->desc().format : VK_FORMAT_R8G8B8A8_UNORM;
    const auto window = shown ? graph.importImage(
                                    "window",
                                    *shown->image,
                                    VK_IMAGE_LAYOUT_UNDEFINED,
                                    VK_IMAGE_LAYOUT_PRESENT_SRC_KHR
                                )
                              : graph.createImage("window", {target.size.x, target.size.y, format});
    constexpr VkImageLayout kRead = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    const auto left = target.left ? graph.importImage("kept picture", *target.left, kRead, kRead)
                                  : context.display;
    const shader::WindowParams params = makeParams(fitPicture(size, target.size), target);
    const VkSampler sampler = size == target.size ? mDevice.nearestSampler() : mLinear;
    const gpu::Pipeline& pipeline = findPipeline(format);
    const OverlayTarget over{format, target.size.x, target.size.y, context.slot};
    const Data& pass = graph.addPass<Data>(
        "window",
        graph::PassKind::Raster,
        [&](graph::PassBuilder& builder, Data& data) {
            data.right = builder.read(context.display, graph::Access::SampledFragment);
            data.left = data.right;
            if (target.left)
                data.left = builder.read(left, graph::Access::SampledFragment);
            data.window = builder.colorTarget(window, graph::ClearColor::floats(0, 0, 0, 1));
            graph.markOutput(data.window);
            if (shown)
                builder.startBatch();
        },
        [params, sampler, over, &pipeline, overlay = target.overlay](
            const Data& data, graph::PassContext& recording
        ) {
            gpu::BindingList bindings;
            bindings.sampled(recording.resources.view(data.left), sampler)
                .sampled(recording.resources.view(data.right), sampler);
            recording.frame.bind(pipeline, bindings, &params, sizeof(params));
            vkCmdSetCullMode(recording.commands, VK_CULL_MODE_NONE);
            vkCmdSetFrontFace(recording.commands, VK_FRONT_FACE_COUNTER_CLOCKWISE);
            vkCmdDraw(recording.commands, 3, 1, 0, 0);
            if (overlay)
                overlay->record(recording.frame, over);
        }
    );
    context.display = pass.window;
}

} // namespace shutter::app
