// SPDX-License-Identifier: MIT
// An effect of the C interface, and the inputs of the C++ interface in the words of the C one.
#pragma once

#include "engine/gpu/device.h"
#include "modules/motion_blur/c_interface/shutter_motion_blur.h"
#include "modules/motion_blur/embedding/host_inputs.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace shutter::test {

inline ShutterBlurDevice describeForC(const gpu::Device& device) {
    ShutterBlurDevice described = shutterBlurDefaultDevice();
    described.physical = device.physical();
    described.device = device.handle();
    described.queueFamily = device.queueFamily();
    described.hasDebugUtils = VK_TRUE;
    return described;
}

class BlurOfC {
  public:
    explicit BlurOfC(const ShutterBlurDevice& described) {
        EXPECT_EQ(shutterBlurCreate(&described, &blur), SHUTTER_BLUR_SUCCESS)
            << shutterBlurGetMessage();
    }

    explicit BlurOfC(const gpu::Device& device) : BlurOfC(describeForC(device)) {}

    ~BlurOfC() { shutterBlurDestroy(blur); }

    BlurOfC(const BlurOfC&) = delete;
    BlurOfC& operator=(const BlurOfC&) = delete;

    ShutterBlur* blur = nullptr;
};

inline ShutterBlurImage convertForC(const motion_blur::HostImage& image) {
    const auto use = [](const graph::OutsideUse& given) {
        return ShutterBlurUse{given.layout, given.stages, given.access};
    };
    ShutterBlurImage made{};
    made.image = image.image;
    made.format = image.format;
    made.extent = image.extent;
    made.area = image.area;
    made.usage = image.usage;
    made.layer = image.layer;
    made.before = use(image.before);
    made.after = use(image.after);
    return made;
}

/// What `inputs` points to; both must last until it is recorded.
struct InputsForC {
    explicit InputsForC(const motion_blur::HostInputs& given) : mGiven(given) {
        inputs.width = given.width;
        inputs.height = given.height;
        inputs.color = convertForC(given.color);
        inputs.output = convertForC(given.output);
        inputs.motionDepth = convertForC(given.motionDepth);
        inputs.normal = convertForC(given.normal);
        inputs.entityId = convertForC(given.entityId);
        inputs.blended = convertForC(given.blended);
        inputs.rasterTime = given.rasterTime;
        inputs.frameNumber = given.frameNumber;
        takeMotion(given.motion);
        takeCameras(given.convention);
        for (const math::ResponsePoint& point : given.responsePoints)
            mResponse.push_back({point.s, point.sensitivity});
        inputs.responsePoints = mResponse.data();
        inputs.responsePointCount = static_cast<uint32_t>(mResponse.size());
        if (given.reveal.record) {
            inputs.revealUser = this;
            inputs.recordReveal = [](void* self, const ShutterBlurRevealTask* task) {
                EXPECT_EQ(task->structBytes, sizeof(*task));
                static_cast<InputsForC*>(self)->mGiven.reveal.record(*task);
            };
        }
        if (given.samples.record) {
            inputs.samplesUser = this;
            inputs.recordSamples = [](void* self, const ShutterBlurSampleTask* task) {
                EXPECT_EQ(task->structBytes, sizeof(*task));
                static_cast<InputsForC*>(self)->mGiven.samples.record(*task);
            };
        }
        if (given.drawn.record) {
            inputs.blendedUser = this;
            inputs.recordBlended = [](void* self, const ShutterBlurBlendedTask* task) {
                EXPECT_EQ(task->structBytes, sizeof(*task));
                static_cast<InputsForC*>(self)->mGiven.drawn.record(*task);
            };
        }
        inputs.blendedArea = given.drawn.area;
        inputs.blendedInstants = given.drawn.instantCount;
        inputs.blendedParts = given.drawn.partCount;
        inputs.blendedOpacityInAlpha = given.drawn.isOpacityInAlpha ? VK_TRUE : VK_FALSE;
    }

    ShutterBlurInputs inputs = shutterBlurDefaultInputs();

  private:
    void takeMotion(const motion_blur::HostMotion& motion) {
        for (const motion_blur::HostCameraKey& key : motion.keys) {
            ShutterBlurCameraKey& made = mKeys.emplace_back();
            made.time = key.time;
            std::memcpy(made.viewFromWorld, &key.viewFromWorld, sizeof(made.viewFromWorld));
            std::memcpy(made.clipFromView, &key.clipFromView, sizeof(made.clipFromView));
        }
        for (const motion_blur::HostMover& mover : motion.movers)
            mMovers.push_back(
                {mover.row,
                 mover.worldFromObject.empty() ? nullptr : &mover.worldFromObject[0][0].x}
            );
        inputs.keyCount = static_cast<uint32_t>(mKeys.size());
        inputs.keys = mKeys.data();
        inputs.moverCount = static_cast<uint32_t>(mMovers.size());
        inputs.movers = mMovers.data();
        inputs.rowCount = motion.rowCount;
        inputs.rowIds = motion.rowIds.empty() ? nullptr : motion.rowIds.data();
        inputs.followsLast = motion.followsLast ? VK_TRUE : VK_FALSE;
        ShutterBlurLens& lens = inputs.lens;
        lens.radius = motion.lens.radius;
        lens.focusDistance = motion.lens.focusDistance;
        if (!motion.lens.focusDistances.empty())
            lens.focusDistances = motion.lens.focusDistances.data();
        lens.bladeRotation = motion.lens.bladeRotation;
        lens.roundness = motion.lens.roundness;
        lens.squeeze = motion.lens.squeeze;
        lens.blades = motion.lens.blades;
        inputs.cameras.aheadIsPlusZ = motion.aheadIsPlusZ ? VK_TRUE : VK_FALSE;
    }

    void takeCameras(const motion_blur::HostConvention& convention) {
        const motion_blur::HostCameras& cameras = convention.cameras;
        ShutterBlurCameras& made = inputs.cameras;
        const auto copy = [](double* to, const glm::dmat4& from) {
            std::memcpy(to, &from, sizeof(from));
        };
        made.areGiven = cameras.areGiven ? VK_TRUE : VK_FALSE;
        copy(made.viewFromWorld, cameras.viewFromWorld);
        copy(made.clipFromView, cameras.clipFromView);
        copy(made.viewFromWorldBefore, cameras.viewFromWorldBefore);
        copy(made.clipFromViewBefore, cameras.clipFromViewBefore);
        inputs.exposureShare = convention.scales.exposureShare;
        inputs.cameraScale = convention.scales.camera;
        inputs.objectScale = convention.scales.object;
    }

    const motion_blur::HostInputs& mGiven;
    std::vector<ShutterBlurCameraKey> mKeys;
    std::vector<ShutterBlurMover> mMovers;
    std::vector<ShutterBlurResponsePoint> mResponse;
};

} // namespace shutter::test
