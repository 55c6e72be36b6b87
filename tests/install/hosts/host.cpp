// SPDX-License-Identifier: MIT
// A renderer in C++17: host METHOD... blurs the scene by each method and writes METHOD.raw. It is
// compiled without exceptions and run-time types, too.
#include "rays.h"

#include <shutter_motion_blur.hpp>

#include <array>
#include <string>

namespace {

void check(const shutter::BlurStatus& status) {
    require(bool(status), status.message().c_str());
}

void enableFeatures(VkPhysicalDeviceFeatures2* features) {
    check(shutter::MotionBlur::addFeatures(*features));
}

shutter::BlurImage describeImage(const Scene& scene, Part part) {
    const VkImageLayout before =
        part == kOutput ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_GENERAL;
    return {scene.images[part], before, VK_IMAGE_LAYOUT_GENERAL, kFormats[part]};
}

shutter::BlurInputs describeInputs(const Scene& scene) {
    shutter::BlurInputs inputs(kWidth, kHeight);
    inputs.color = describeImage(scene, kColor);
    inputs.output = describeImage(scene, kOutput);
    inputs.vectors = describeImage(scene, kVectors);
    inputs.depth = describeImage(scene, kDepth);
    inputs.pixelsPerUnit[0] = -kWidth;
    inputs.pixelsPerUnit[1] = -kHeight;
    inputs.depthIsLinear = VK_TRUE;
    inputs.skyValue = 1e9f;
    inputs.exposureShare = 1.0f;
    inputs.entityId = describeImage(scene, kIds);
    inputs.normal = describeImage(scene, kNormal);
    return inputs;
}

} // namespace

extern "C" int runHost(int count, char** methods) {
    Scene scene;
    openDevice(&scene, enableFeatures);
    Rays rays;
    makeRays(&rays, scene.device);
    shutter::BlurDevice device(scene.physical, scene.device, 0);
    device.headerVersion += 1u << 12;
    const auto newer = shutter::MotionBlur::create(device);
    require(
        !newer && newer.message().find("headers of version") != std::string::npos,
        "a host with newer headers is not refused"
    );
    device.headerVersion = SHUTTER_BLUR_VERSION;
    auto blur = shutter::MotionBlur::create(device);
    check(blur);

    shutter::BlurInputs inputs = describeInputs(scene);
    const float unit[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    std::array<ShutterBlurCameraKey, 2> keys;
    std::array<std::array<double, 16>, 2> transforms;
    for (int i = 0; i < 2; ++i) {
        keys[i].time = i;
        shutter::setMatrix(keys[i].viewFromWorld, unit);
        fillProjection(keys[i].clipFromView);
        fillTransform(transforms[i].data(), 1.0 - i);
    }
    const std::array<ShutterBlurMover, 1> movers{{{1, transforms[0].data()}}};
    inputs.setKeys(keys);
    inputs.setMovers(movers);
    inputs.rowCount = 2;
    const auto trace = [&rays](const ShutterBlurRevealTask* task) {
        traceRays(
            &rays,
            task->commands,
            task->list,
            task->groups,
            task->color.view,
            task->motionDepth.view,
            task->entityId.view
        );
    };
    inputs.setReveal(trace);
    for (int i = 0; i < count; ++i) {
        beginCommands(&scene);
        check(blur->record(scene.commands, 0, inputs, shutter::BlurSettings(methods[i])));
        copyPart(&scene, kOutput, 0);
        finishCommands(&scene);
        writePicture(&scene, methods[i]);
    }
    printf("rays %u\n", rays.calls);
    return 0;
}

#ifndef HOST_IS_PLUGIN
int main(int count, char** arguments) {
    return runHost(count - 1, arguments + 1);
}
#endif
