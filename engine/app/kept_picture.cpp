// SPDX-License-Identifier: MIT
#include "engine/app/kept_picture.h"

#include "engine/core/check.h"
#include "engine/graph/execute.h"

namespace shutter::app {

void KeptPicture::declare(render::PictureContext& context) {
    SHUTTER_CHECK(context.display.isValid(), "there is no picture to keep");
    const graph::TransientImageDesc& picture = context.graph.describeImage(context.display);
    gpu::ImageDesc desc;
    desc.width = picture.width;
    desc.height = picture.height;
    desc.format = picture.format;
    desc.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (!(mImage.desc() == desc))
        mImage = gpu::Image(mDevice, "kept picture", desc);

    struct Data {
        graph::ImageHandle from;
        graph::ImageHandle to;
    };

    const auto kept = context.graph.importImage(
        "kept picture", mImage, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL
    );
    context.graph.addPass<Data>(
        "keep picture",
        graph::PassKind::Transfer,
        [&](graph::PassBuilder& builder, Data& data) {
            data.from = builder.read(context.display, graph::Access::TransferRead);
            data.to = builder.write(kept, graph::Access::TransferWrite);
            context.graph.markOutput(data.to);
        },
        [](const Data& data, graph::PassContext& recording) {
            const gpu::Image& from = recording.resources.image(data.from);
            VkImageCopy region{};
            region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.dstSubresource = region.srcSubresource;
            region.extent = {from.desc().width, from.desc().height, 1};
            vkCmdCopyImage(
                recording.commands,
                from.handle(),
                VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                recording.resources.image(data.to).handle(),
                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                1,
                &region
            );
        }
    );
}

} // namespace shutter::app
