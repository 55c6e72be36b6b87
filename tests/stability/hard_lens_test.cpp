// SPDX-License-Identifier: MIT
// Lenses of all sizes, focused anywhere, in front of bright, near and absent things, by every
// method that has one.
#include "engine/image/metrics.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/history.h"
#include "engine/scene/lens.h"
#include "game/shot/methods.h"
#include "tests/stability/hard_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <ostream>

namespace shutter::stability {
namespace {

using scene::CameraLens;

constexpr double kNearPlane = 0.05; ///< of makeEmptyScene()'s camera

struct LensCase {
    const char* name;
    CameraLens lens;
    /// Of `resolved` against `accumulate`, linear, of values up to 1; what moves over a second is
    /// blurred as well.
    double leastDecibels = 0.0;
    void (*change)(SceneBuilder& scene) = [](SceneBuilder&) {};
    uint32_t width = 64;
    uint32_t height = 48;
};

/// How googletest prints a parameter.
void PrintTo(const LensCase& one, std::ostream* stream) {
    *stream << one.name;
}

void addBright(SceneBuilder& scene) {
    scene::Material lamp;
    lamp.baseColorFactor = {0, 0, 0, 1};
    lamp.emissive = math::vec3(65000.0f);
    scene.add(test::makeQuad(0.2, 0.2, scene.addMaterial(lamp)), {.position = {0.5, 0.4, -1.2}});
}

void addAtNearPlane(SceneBuilder& scene) {
    scene.add(
        test::makeQuad(0.02, 0.02, scene.addColor({1, 1, 1})),
        {.position = {0, 0, -1.001 * kNearPlane}}
    );
}

void removeAll(SceneBuilder& scene) {
    std::vector<ecs::Entity> drawn;
    for (auto [entity, instance] : scene.world.registry.view<scene::MeshInstance>()) {
        (void)instance;
        drawn.push_back(entity);
    }
    for (const ecs::Entity entity : drawn)
        scene::despawn(scene.world, entity);
}

/// The camera is cut while its autofocus is on its way to the sphere.
void cutDuringEasing(SceneBuilder& scene) {
    const ecs::Entity target = scene.add(
        test::makeSphere(0.2, scene.addLitWaves()),
        {.position = {-0.4, -0.3, -1.5}, .velocity = {0, 0, -4}}
    );
    scene.world.registry.add(scene.camera, scene::AutoFocus{target, 0.3});
    scene::advanceAutoFocus(scene.world, -0.6);
    scene::cut(scene.world, scene.camera, 0.1);
    scene::advanceAutoFocus(scene.world, 0.6);
}

const LensCase kLensCases[] = {
    {"FocusAtTheNearPlane", {.fStop = 0.5, .focusDistance = kNearPlane}, 27.5},
    {"FocusAtAMillimetre", {.fStop = 2.0, .focusDistance = 1.0e-3}, 21.0},
    {"FocusAtAThousandKilometres", {.fStop = 0.2, .focusDistance = 1.0e6}, 31.5},
    {"WidestLens", {.fStop = 0.01, .focusDistance = 2.5}, 26.5},
    {"SmallestLens", {.fStop = 1.0e9, .focusDistance = 2.5}, 32.0},
    {"ConfusionWiderThanThePicture", {.fStop = 0.02, .focusDistance = 0.1}, 21.0},
    {"SkyOnly", {.fStop = 0.05, .focusDistance = 1.0}, 60.0, removeAll},
    // One sample's colour is the pixel's: nothing is held.
    {"OnePixel", {.fStop = 0.1, .focusDistance = 2.5}, 0.0, addAtNearPlane, 1, 1},
    {"OddSize", {.fStop = 0.1, .focusDistance = 2.5}, 21.0, addAtNearPlane, 41, 39},
    {"AtTheNearPlane", {.fStop = 0.1, .focusDistance = 2.5}, 21.5, addAtNearPlane},
    {"BrightAs65000", {.fStop = 0.1, .focusDistance = 2.5}, 20.5, addBright},
    {"CutDuringEasing", {.fStop = 0.2, .focusDistance = 2.5}, 33.5, cutDuringEasing},
};

class HardLens : public test::GpuTest, public testing::WithParamInterface<LensCase> {};

INSTANTIATE_TEST_SUITE_P(Lenses, HardLens, testing::ValuesIn(kLensCases), [](const auto& instance) {
    return std::string(instance.param.name);
});

image::Image clampToOne(image::Image picture) {
    for (float& value : picture.pixels)
        value = std::min(value, 1.0f);
    return picture;
}

TEST_P(HardLens, EveryMethodThatHasOneIsFiniteInRangeAndNearTheMeanOfManyPictures) {
    const LensCase& one = GetParam();
    SceneBuilder scene = makeBusyScene();
    scene.world.registry.add(scene.camera, one.lens);
    one.change(scene);
    Stage stage(device(), scene);
    Shot shot = makeLitShot();
    shot.width = one.width;
    shot.height = one.height;
    shot.instants = 64;
    Shot many = shot;
    many.method = "accumulate";
    many.instants = 256;
    const image::Image mean = stage.render(many).color;
    Worst notFinite;
    Worst negative;
    Worst beyond;
    Worst decibels;
    float brightest = 65504.0f;
    if (one.change != addBright) {
        brightest = 0.0f;
        for (const float value : mean.pixels)
            brightest = std::max(brightest, value);
    }
    for (const game::MethodInfo& method : game::listMethods()) {
        if (!method.hasLens || !game::canRun(method, device()))
            continue;
        const render::FrameResult frame = draw(stage, shot, method.name);
        notFinite.addNotFinite(frame.color, method.name);
        for (const auto& [name, picture] : frame.intermediates)
            notFinite.addNotFinite(picture, fmt::format("{}, {}", method.name, name));
        for (const float value : frame.color.pixels) {
            negative.add(-double(value), method.name);
            beyond.add(double(value) - 1.5 * brightest, method.name);
        }
        const double near = image::computePsnr(clampToOne(frame.color), clampToOne(mean));
        RecordProperty(std::string(method.name) + "_dB", std::to_string(near));
        if (std::string_view(method.name) == "resolved")
            decibels.add(one.leastDecibels - near, method.name);
    }
    hold("values that are not finite", notFinite);
    hold("values below 0", negative);
    hold("values beyond the brightest, half as much again", beyond);
    hold("dB below the bound of resolved", decibels, 0.0, "dB");
}

TEST(HardLensCamera, AnOrthographicCameraIsAPinholeWhateverFocusesIt) {
    SceneBuilder scene = makeBusyScene();
    scene.cameraSettings().kind = scene::CameraKind::Orthographic;
    scene.world.registry.add(scene.camera, CameraLens{.fStop = 0.1, .focusDistance = 1.0});
    scene.world.registry.add(scene.camera, scene::LensOverride{.fStop = 0.1});
    scene.world.registry.add(
        scene.camera, scene::FocusMotion{{{0.0, 1.0, 0.1, false}, {1.0, 2.0, 0.2, false}}}
    );
    EXPECT_FALSE(scene::hasLens(scene.world, scene.camera));
    EXPECT_EQ(scene::lensAt(scene.world, scene.camera, 0.5).fStop, 0.0);
}

} // namespace
} // namespace shutter::stability
