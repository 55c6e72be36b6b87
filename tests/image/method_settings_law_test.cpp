// SPDX-License-Identifier: MIT
// Which settings a method reads, found by what they change: a setting that a method lists changes
// its picture, and one that it does not list changes no bit, whatever its value.
#include "modules/motion_blur/methods.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "modules/motion_blur/settings.h"
#include "tests/kit/scene_builder.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using math::dvec3;
using motion_blur::Method;
using motion_blur::MotionBlurSettings;
using Row = core::SettingRow<MotionBlurSettings>;

class MethodSettingsLaw : public test::GpuTest {};

/// A bit of everything that a setting may be about: long uniform motion, directions that cross,
/// still and moving surfaces at depths near and far, surfaces behind one another within one entity
/// and across, edges sharp and soft.
test::SceneBuilder makeScene() {
    test::SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.moveCamera({.velocity = {-1.0, 0.2, 0}});
    const scene::AssetIndex waves = scene.addTextured(scene.addWaveTexture(), true);
    // The wall alone is seen at the left and right: uniform motion, far from all else.
    scene.add(test::makeQuad(64, 18, waves), {.position = {0, 0, -12}, .velocity = {0.6, 0.2, 0}});
    scene.add(test::makeQuad(2.4, 1.2, waves), {.position = {1, 1, -4}, .velocity = {2.5, 0, 0}});
    scene.add(
        test::makeBox({0.9, 0.7, 0.6}, waves),
        {.position = {-0.6, 0, -3}, .velocity = {0.9, 0.3, 0}}
    );
    scene.add(
        test::makeBox({0.5, 0.5, 0.5}, waves),
        {.position = {0.3, -0.2, -3.02}, .velocity = {-0.7, 0.9, 0.4}, .angularVelocity = {0, 1, 3}}
    );
    scene.add(test::makeQuad(0.8, 0.3, waves), {.position = {0.6, -0.6, -2}});
    // One entity of more layers than a stepping ray passes.
    std::vector<scene::Primitive> layers;
    for (int i = 0; i < 16; ++i)
        layers.push_back(test::transformed(
            test::makeQuad(0.5, 0.5, waves),
            glm::translate(math::dmat4(1.0), dvec3(0.0, 0.0, -0.01 * i))
        ));
    scene.add(
        scene.addMesh(std::move(layers)), {.position = {-0.4, 0.8, -3}, .velocity = {0.9, -0.3, 0}}
    );
    return scene;
}

/// Draws with one renderer and one set of pipelines.
class Drawer {
  public:
    Drawer(gpu::Device& device, const test::SceneBuilder& scene)
        : mScene(scene), mRenderer(device, scene.world.assets),
          mBlur(device, mRenderer.scene(), {}) {}

    image::Image draw(const MotionBlurSettings& settings) {
        mBlur.configure(settings, {});
        // The frame before is there for the methods that look things up in it.
        if (settings.method->readsInstantMotions)
            (void)drawAt(-kFrameSeconds);
        return drawAt(0.0);
    }

  private:
    static constexpr double kFrameSeconds = 0.5;

    image::Image drawAt(double seconds) {
        render::FrameRequest request;
        request.view.camera = mScene.camera;
        request.view.exposure =
            scene::computeExposure({0.5, scene::ShutterPhase::Centre}, seconds, kFrameSeconds);
        request.view.width = 320;
        request.view.height = 96;
        render::PostEffect* effects[] = {&mBlur};
        auto drawn = mRenderer.renderFrame(mScene.world, request, effects);
        EXPECT_TRUE(drawn.ok());
        return drawn ? std::move(drawn.value().color) : image::Image();
    }

    const test::SceneBuilder& mScene;
    render::Renderer mRenderer;
    motion_blur::MotionBlurPlugin mBlur;
};

/// Settings to start from: the defaults, and those with which what waits for another setting
/// counts.
std::vector<MotionBlurSettings> listBases(const Method& method) {
    MotionBlurSettings plain;
    plain.method = &method;
    plain.sampleCount = std::min(method.defaultSamples, 8u);
    MotionBlurSettings steps = plain;
    steps.revealTraversal = motion_blur::RevealTraversal::Stepping;
    steps.uniformMotionPx = 4.0f;
    MotionBlurSettings luminance = plain;
    luminance.objectTest = motion_blur::ObjectTest::Luminance;
    return {plain, steps, luminance};
}

/// The settings with other values of the row.
std::vector<MotionBlurSettings> varyRow(const Row& row, const MotionBlurSettings& base) {
    std::vector<MotionBlurSettings> varied;
    if (const auto* words = std::get_if<core::WordField<MotionBlurSettings>>(&row.field)) {
        for (size_t word = 0; word < words->words.size(); ++word)
            words->set(varied.emplace_back(base), word);
        return varied;
    }
    if (std::holds_alternative<bool MotionBlurSettings::*>(row.field)) {
        auto& flag = varied.emplace_back(base).*std::get<bool MotionBlurSettings::*>(row.field);
        flag = !flag;
        return varied;
    }
    for (const double value : {row.range.lowest, 4.0, 0.25, 7.0, row.range.highest}) {
        MotionBlurSettings other = base;
        if (core::setNumber(row, other, value))
            varied.push_back(other);
    }
    return varied;
}

} // namespace

TEST_F(MethodSettingsLaw, AMethodReadsTheSettingsThatItListsAndNoOther) {
    const test::SceneBuilder scene = makeScene();
    Drawer drawer(device(), scene);
    for (const std::string_view name : test::listBlurMethods(device())) {
        const Method& method = motion_blur::getMethod(name);
        const std::vector<MotionBlurSettings> bases = listBases(method);
        std::vector<image::Image> expected;
        for (const MotionBlurSettings& base : bases)
            expected.push_back(drawer.draw(base));
        for (const Row& row : motion_blur::listSettingRows()) {
            bool changes = false;
            for (size_t i = 0; i < bases.size(); ++i)
                for (const MotionBlurSettings& settings : varyRow(row, bases[i]))
                    if (!changes)
                        changes = !test::sameBits(drawer.draw(settings), expected[i]);
            const auto& listed = method.settings;
            const bool isListed = std::string_view(row.name) == "sampleCount" ||
                                  std::find(listed.begin(), listed.end(), row.name) != listed.end();
            EXPECT_EQ(changes, isListed) << name << " " << row.name;
        }
    }
}

} // namespace shutter
