// SPDX-License-Identifier: MIT
// A renderer in C++20: host METHOD... blurs the scene by each method and writes METHOD.raw. What is
// here is free of exceptions and of run-time types.
#include "rays.h"

#include "modules/motion_blur/embedding/embedded_motion_blur.h"

#include <array>

namespace {

using namespace shutter::motion_blur;

void enableFeatures(VkPhysicalDeviceFeatures2* features) {
    const auto enabled = addHostFeatures(*features);
    require(enabled.ok(), enabled.ok() ? "" : enabled.error().message.c_str());
}

HostImage describeImage(const Scene& scene, Part part) {
    HostImage image;
    image.image = scene.images[part];
    image.format = kFormats[part];
    image.before.layout = part == kOutput ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_GENERAL;
    image.after.layout = VK_IMAGE_LAYOUT_GENERAL;
    return image;
}

HostInputs describeInputs(const Scene& scene) {
    HostInputs inputs;
    inputs.width = kWidth;
    inputs.height = kHeight;
    inputs.color = describeImage(scene, kColor);
    inputs.output = describeImage(scene, kOutput);
    HostConvention& own = inputs.convention;
    own.vectors.image = describeImage(scene, kVectors);
    own.vectors.pixelsPerUnit = {-kWidth, -kHeight};
    own.depth.image = describeImage(scene, kDepth);
    own.depth.isLinear = true;
    own.depth.skyValue = 1e9f;
    own.scales.exposureShare = 1.0f;
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
    HostDevice device;
    device.physical = scene.physical;
    device.device = scene.device;
    require(
        !EmbeddedMotionBlur::create(device, kHeaderVersion + (1u << 12)).ok(),
        "a host with newer headers is not refused"
    );
    auto blur = EmbeddedMotionBlur::create(device);
    require(blur.ok(), blur.ok() ? "" : blur.error().message.c_str());

    HostInputs inputs = describeInputs(scene);
    std::array<HostCameraKey, 2> keys;
    std::array<glm::dmat4, 2> transforms;
    for (int i = 0; i < 2; ++i) {
        keys[i].time = i;
        fillProjection(&keys[i].clipFromView[0][0]);
        fillTransform(&transforms[i][0][0], 1.0 - i);
    }
    const std::array<HostMover, 1> movers{{{1, transforms}}};
    inputs.motion.keys = keys;
    inputs.motion.rowCount = 2;
    inputs.motion.movers = movers;
    inputs.reveal.record = [&](const RevealTask& task) {
        traceRays(
            &rays,
            task.commands,
            task.list,
            task.groups,
            task.color.view,
            task.motionDepth.view,
            task.entityId.view
        );
    };
    for (int i = 0; i < count; ++i) {
        MotionBlurSettings settings;
        settings.method = findMethod(methods[i]);
        beginCommands(&scene);
        const auto done = blur.value()->record(scene.commands, 0, inputs, settings);
        require(done.ok(), done.ok() ? "" : done.error().message.c_str());
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
