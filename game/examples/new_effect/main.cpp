// SPDX-License-Identifier: MIT
// Draws a glTF scene with the motion blur and then a custom effect (vignette.h, .comp).
#include "vignette.h"

#include "engine/gltf/gltf_loader.h"
#include "engine/io/image_file.h"
#include "engine/scene/camera.h"
#include "modules/motion_blur/plugin/motion_blur_plugin.h"
#include "modules/tonemap/tonemap.h"

using namespace shutter;

core::Status draw(const char* scene, const char* out) {
    auto loaded = gltf::loadGltf(scene);
    auto device = gpu::Device::create({});
    if (!loaded || !device)
        return loaded ? device.error() : loaded.error();
    scene::World& world = loaded.value().world;
    if (world.cameras.empty())
        scene::addFramingCamera(world, 16.0 / 9.0, 0.0);
    render::FrameRequest request;
    request.view.camera = world.cameras[0];
    request.view.exposure = scene::computeExposure({.exposureSeconds = 1.0 / 60.0}, 0.0);
    request.wantDisplay = true;
    render::Renderer renderer(*device.value(), world.assets);
    const motion_blur::MotionBlurSettings settings{&motion_blur::getMethod("gather")};
    motion_blur::MotionBlurPlugin blur(*device.value(), renderer.scene(), settings);
    Vignette vignette(*device.value(), 1.0f);
    tonemap::Tonemap tonemap(*device.value(), {});
    const std::array<render::Effect*, 3> effects{&blur, &vignette, &tonemap};
    auto frame = renderer.renderFrame(world, request, {.effects = effects});
    return frame ? io::writeImage(out, frame.value().display) : frame.error();
}

int main(int argc, char** argv) {
    const char* usage = "usage: new_effect SCENE OUT.png";
    const auto drawn = argc == 3 ? draw(argv[1], argv[2]) : core::makeError("{}", usage);
    if (!drawn)
        fmt::print(stderr, "new_effect: {}\n", drawn.error().message);
    return drawn ? 0 : 1;
}
