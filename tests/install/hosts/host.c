/* SPDX-License-Identifier: MIT
 * A renderer in C11: host METHOD... blurs the scene by each method and writes METHOD.raw. */
#include "rays.h"

#include <shutter_motion_blur.h>

static void enableFeatures(VkPhysicalDeviceFeatures2* features) {
    require(!shutterBlurAddFeatures(features), shutterBlurGetMessage());
}

static void traceTask(void* user, const ShutterBlurRevealTask* task) {
    traceRays(
        (Rays*)user,
        task->commands,
        task->list,
        task->groups,
        task->color.view,
        task->motionDepth.view,
        task->entityId.view
    );
}

static ShutterBlurImage describeImage(const Scene* scene, Part part) {
    ShutterBlurImage image;
    memset(&image, 0, sizeof(image));
    image.image = scene->images[part];
    image.format = kFormats[part];
    image.before.layout = part == kOutput ? VK_IMAGE_LAYOUT_UNDEFINED : VK_IMAGE_LAYOUT_GENERAL;
    image.after.layout = VK_IMAGE_LAYOUT_GENERAL;
    return image;
}

static void checkVersions(void) {
    uint32_t i;
    require(shutterBlurIsCompatible(SHUTTER_BLUR_VERSION), "the library is not the header's");
    require(
        !shutterBlurIsCompatible(SHUTTER_BLUR_VERSION + (1u << 12)),
        "the library takes headers that are newer than it"
    );
    for (i = 0; shutterBlurGetMethod(i); ++i)
        printf("method %s\n", shutterBlurGetMethod(i));
}

int runHost(int count, char** methods);

int runHost(int count, char** methods) {
    Scene scene;
    Rays rays;
    ShutterBlur* blur = NULL;
    ShutterBlurDevice device = shutterBlurDefaultDevice();
    ShutterBlurInputs inputs = shutterBlurDefaultInputs();
    ShutterBlurCameraKey keys[2];
    double transforms[2][16];
    ShutterBlurMover square;
    int i;
    checkVersions();
    openDevice(&scene, enableFeatures);
    makeRays(&rays, scene.device);
    device.physical = scene.physical;
    device.device = scene.device;
    device.headerVersion = SHUTTER_BLUR_VERSION + (1u << 12);
    require(
        shutterBlurCreate(&device, &blur) == SHUTTER_BLUR_ERROR_REFUSED &&
            strstr(shutterBlurGetMessage(), "headers of version"),
        "a host with newer headers is not refused"
    );
    device.headerVersion = SHUTTER_BLUR_VERSION;
    require(!shutterBlurCreate(&device, &blur), shutterBlurGetMessage());

    inputs.width = kWidth;
    inputs.height = kHeight;
    inputs.color = describeImage(&scene, kColor);
    inputs.output = describeImage(&scene, kOutput);
    inputs.vectors = describeImage(&scene, kVectors);
    inputs.depth = describeImage(&scene, kDepth);
    inputs.pixelsPerUnit[0] = -kWidth;
    inputs.pixelsPerUnit[1] = -kHeight;
    inputs.depthIsLinear = VK_TRUE;
    inputs.skyValue = 1e9f;
    inputs.exposureShare = 1.0f;
    inputs.entityId = describeImage(&scene, kIds);
    inputs.rowCount = 2;
    memset(keys, 0, sizeof(keys));
    for (i = 0; i < 2; ++i) {
        keys[i].time = i;
        keys[i].viewFromWorld[0] = keys[i].viewFromWorld[5] = 1.0;
        keys[i].viewFromWorld[10] = keys[i].viewFromWorld[15] = 1.0;
        fillProjection(keys[i].clipFromView);
        fillTransform(transforms[i], 1.0 - i);
    }
    square.row = 1;
    square.worldFromObject = transforms[0];
    inputs.keys = keys;
    inputs.keyCount = 2;
    inputs.movers = &square;
    inputs.moverCount = 1;
    inputs.normal = describeImage(&scene, kNormal);
    inputs.recordReveal = traceTask;
    inputs.revealUser = &rays;

    for (i = 0; i < count; ++i) {
        ShutterBlurSettings settings = shutterBlurDefaultSettings();
        settings.method = methods[i];
        beginCommands(&scene);
        require(
            !shutterBlurRecord(blur, scene.commands, 0, &inputs, &settings), shutterBlurGetMessage()
        );
        copyPart(&scene, kOutput, 0);
        finishCommands(&scene);
        writePicture(&scene, methods[i]);
    }
    printf("rays %u\n", rays.calls);
    shutterBlurDestroy(blur); /* all else goes with the process */
    return 0;
}

#ifndef HOST_IS_PLUGIN
int main(int count, char** arguments) {
    return runHost(count - 1, arguments + 1);
}
#endif
