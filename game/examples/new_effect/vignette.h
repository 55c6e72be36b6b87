// SPDX-License-Identifier: MIT
// A custom post effect: darkens the picture towards its corners, in place.
#pragma once
#include "engine/graph/execute.h"
#include "engine/render/effect.h"

#include <spirv/vignette.comp.h>

class Vignette : public shutter::render::Effect {
    float mLoss;
    shutter::gpu::Pipeline mPipeline;

  public:
    Vignette(shutter::gpu::Device& device, float lossInCorners)
        : mLoss(lossInCorners),
          mPipeline(device, {"vignette", vignette_comp, {{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}, 4}}) {}

    std::string name() const override { return "vignette"; }

    shutter::render::Needs decide(const shutter::render::DecideContext&) const override {
        return {.run = {mLoss > 0.0f, "light is lost"}};
    }

    void declare(shutter::render::PictureContext& context) override {
        using namespace shutter::graph;
        const auto setup = [&](PassBuilder& builder, ImageHandle& color) {
            color = builder.write(context.color, Access::StorageWrite);
        };
        const auto run = [this](const ImageHandle& color, PassContext& pass) {
            const shutter::gpu::ImageDesc& desc = pass.resources.image(color).desc();
            shutter::gpu::BindingList bindings;
            bindings.storage(pass.resources.image(color));
            pass.frame.bind(mPipeline, bindings, &mLoss, sizeof(mLoss));
            vkCmdDispatch(pass.commands, (desc.width + 7) / 8, (desc.height + 7) / 8, 1);
        };
        context.color = context.graph.addPass<ImageHandle>(name(), PassKind::Compute, setup, run);
    }
};
