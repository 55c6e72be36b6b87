// SPDX-License-Identifier: MIT
// A host that hands in the engine's own layer of blended surfaces gets the engine's picture.
#include "engine/extract/blended_layer.h"
#include "engine/render/blended_layer.h"
#include "tests/gpu/gbuffer_host.h"

#include <vector>

namespace shutter {
namespace {

using math::vec4;
using motion_blur::HostInputs;
using motion_blur::MotionBlurSettings;
using test::HostTexels;

/// Panes before a wall and a mover, the layer of which a host hands in as its own.
class EmbeddedLayer : public test::EmbeddedTest {
  protected:
    static scene::AssetIndex addGlass(test::SceneBuilder& scene, const math::vec3& color) {
        scene::Material material;
        material.baseColorFactor = vec4(color, 0.5f);
        material.alphaMode = scene::AlphaMode::Blend;
        material.unlit = true;
        material.doubleSided = true;
        return scene.addMaterial(std::move(material));
    }

    static void addPanes(test::SceneBuilder& scene) {
        scene.setPerspective(1.0);
        scene.add(
            test::makeQuad(12.0, 8.0, scene.addTextured(scene.addWaveTexture(), true)),
            {.position = {0, 0, -6}}
        );
        scene.add(
            test::makeQuad(1.4, 1.2, addGlass(scene, {0.2f, 0.5f, 0.9f})),
            {.position = {0, 0, -3}, .velocity = {1.6, 0.4, 0}}
        );
        scene.add(
            test::makeQuad(1.0, 1.6, addGlass(scene, {0.9f, 0.3f, 0.1f})),
            {.position = {0.5, 0, -2.5}, .velocity = {-1.2, 0, 0}}
        );
    }

    /// Draws once to learn the layer, and once more with it as the host's.
    void expectEnginesPicture(test::SceneBuilder& scene, const MotionBlurSettings& settings) {
        SCOPED_TRACE(settings.method->name);
        test::BlurStage stage(device(), scene, describeHost(), settings, settings);
        test::MotionDescriber describer(settings.sampleCount);
        if (settings.method->readsInstantMotions)
            stage.declareMotion(describer);
        render::BlendedLayerPass pass(device(), stage.renderer.scene());
        extract::BlendedLayer layer;
        stage.host.changeInputs = [&](const render::PostContext& context, HostInputs&) {
            layer = plan(scene, stage, settings, context);
            ASSERT_FALSE(layer.empty());
            ASSERT_FALSE(layer.readsInstants) << "the host has one part";
            const render::BlendedPart drawn = pass.declare(context, layer, {}, 0);
            context.intermediates.publish("layer color", drawn.color);
            context.intermediates.publish("layer opacity", drawn.opacity);
        };
        stage.request.intermediates = {"layer color", "layer opacity"};
        const test::StagedFrame without = stage.draw();
        if (HasFatalFailure())
            return;
        EXPECT_FALSE(test::sameBits(without.output, without.result.color)) << "no layer was drawn";
        const HostTexels& texels = makeLayer(
            layer,
            without.result.intermediates.at("layer color"),
            without.result.intermediates.at("layer opacity")
        );
        submit([&](VkCommandBuffer commands) { texels.record(commands); });
        stage.host.changeInputs = [&](const render::PostContext&, HostInputs& inputs) {
            inputs.blended = texels.describe();
            inputs.blended.after = inputs.blended.before; // three recordings read it
        };
        stage.request.intermediates = {};
        test::expectSame(stage.draw());
    }

    static extract::BlendedLayer plan(
        const test::SceneBuilder& scene,
        const test::BlurStage& stage,
        const MotionBlurSettings& settings,
        const render::PostContext& context
    ) {
        const scene::ExposureMotion motion(scene.world, context.view.camera, context.view.exposure);
        extract::LayerLimits limits;
        if (settings.method->sampleUnit == motion_blur::SampleUnit::Instants)
            limits.instants = settings.sampleCount;
        limits.findsInstants = settings.method->readsInstantMotions;
        limits.surfaceBytes = device().limits().maxStorageBufferRange;
        return extract::planBlendedLayer(
            scene.world,
            stage.renderer.scene().layout(),
            context.view,
            motion,
            context.frame,
            limits
        );
    }

    /// The picture's size, opacity in alpha.
    const HostTexels& makeLayer(
        const extract::BlendedLayer& layer, const image::Image& color, const image::Image& opacity
    ) {
        std::vector<uint64_t> texels(size_t{test::kStageSize.x} * test::kStageSize.y, 0);
        for (uint32_t y = 0; y < layer.sizePx.y; ++y)
            for (uint32_t x = 0; x < layer.sizePx.x; ++x) {
                const size_t from = size_t{y} * color.width + x; // it is larger than the layer
                const float* const rgb = &color.pixels[from * color.channels];
                const size_t to =
                    size_t{y + layer.originPx.y} * test::kStageSize.x + x + layer.originPx.x;
                texels[to] =
                    test::packHalf({rgb[0], rgb[1], rgb[2], opacity.pixels[from * opacity.channels]}
                    );
            }
        return makeTexels(
            VK_FORMAT_R16G16B16A16_SFLOAT, {test::kStageSize.x, test::kStageSize.y}, texels
        );
    }
};

TEST_F(EmbeddedLayer, GivenAsAnImageIsTheEnginesPictureByEachMethod) {
    for (const motion_blur::Method* method : motion_blur::listMethods()) {
        if (!method->readsImagesOnly())
            continue;
        test::SceneBuilder scene;
        addPanes(scene);
        expectEnginesPicture(scene, test::settingsOf(method->name));
    }
    // Nothing moves behind the panes, so that they have one part here, too.
    test::SceneBuilder scene;
    addPanes(scene);
    MotionBlurSettings resolved = test::settingsOf("resolved", 7);
    resolved.history = false;
    expectEnginesPicture(scene, resolved);
}

} // namespace
} // namespace shutter
