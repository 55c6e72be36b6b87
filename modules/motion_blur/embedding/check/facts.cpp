// SPDX-License-Identifier: MIT
// Copies a host's declarations for a recording until its images have been checked.
#include "modules/motion_blur/embedding/check/checked_frame.h"
#include "modules/motion_blur/embedding/host_input_check.h"
#include "modules/motion_blur/embedding/host_inputs.h"
#include "modules/motion_blur/embedding/host_instants.h"
#include "modules/motion_blur/embedding/host_ways.h"
#include "modules/motion_blur/settings.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace shutter::motion_blur {

namespace {

/// Movers whose matrices are held against their pixels, and ids that are compared: copies of a
/// megabyte or so.
constexpr size_t kMaxMovers = 4096;

/// A pair of cameras with -Z forward.
HostCameras makePair(const HostCamera& now, const HostCamera& before) {
    HostCameras pair;
    pair.areGiven = true;
    pair.viewFromWorld = now.viewFromWorld;
    pair.clipFromView = now.clipFromView;
    pair.viewFromWorldBefore = before.viewFromWorld;
    pair.clipFromViewBefore = before.clipFromView;
    return pair;
}

void keepKeys(const HostMotion& motion, double rasterTime, CheckFacts& facts) {
    for (const HostCameraKey& key : motion.keys) {
        const HostCamera camera = normalize(key, motion.aheadIsPlusZ).value();
        if (isRasterKey(key, rasterTime))
            facts.rasterKey = facts.keys.size();
        facts.keys.push_back({key.time, camera.viewFromWorld, camera.clipFromView});
    }
    facts.hasExposureCameras = facts.isNative && facts.keys.size() > 1 &&
                               facts.keys.front().time <= 0.0 && facts.keys.back().time >= 1.0;
    if (!facts.hasExposureCameras)
        return;
    const CameraWay way(facts.keys, false);
    const HostCamera& raster = way.atKey(facts.rasterKey);
    facts.open = makePair(raster, way.at(locate(facts.keys, 0.0)));
    facts.close = makePair(raster, way.at(locate(facts.keys, 1.0)));
}

/// Where the mover's origin is at the raster instant.
void findOrigin(
    const glm::dmat4& worldFromObject, const CheckFacts& facts, CheckFacts::Mover& mover
) {
    const HostCameraKey& key = facts.keys[facts.rasterKey];
    const HostCamera camera{key.viewFromWorld, key.clipFromView};
    const glm::dvec4 view = camera.viewFromWorld * worldFromObject[3];
    const glm::dvec4 clip = camera.clipFromView * view;
    mover.isInView =
        clip.w > 0.0 && std::abs(clip.x) < 0.8 * clip.w && std::abs(clip.y) < 0.8 * clip.w;
    const glm::dvec2 size(facts.picture.width, facts.picture.height);
    mover.place = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * size;
    mover.metres = -view.z;
}

void keepMovers(const HostMotion& motion, CheckFacts& facts) {
    for (const HostMover& given : motion.movers) {
        CheckFacts::Mover& mover = facts.movers.emplace_back();
        mover.row = given.row;
        if (given.worldFromObject.size() != facts.keys.size())
            continue;
        findOrigin(given.worldFromObject[facts.rasterKey], facts, mover);
        if (facts.movers.size() > kMaxMovers)
            continue;
        mover.firstMatrix = facts.matrices.size();
        facts.matrices.insert(
            facts.matrices.end(), given.worldFromObject.begin(), given.worldFromObject.end()
        );
    }
}

void keepMotion(const HostInputs& inputs, CheckFacts& facts) {
    std::vector<HostMover> movers;
    const HostMotion motion = countedMotion(inputs, movers);
    facts.followsLast = motion.followsLast;
    facts.rowCount = motion.rowCount;
    keepKeys(motion, inputs.rasterTime, facts);
    keepMovers(motion, facts);
    facts.viewModelRows.assign(motion.viewModelRows.begin(), motion.viewModelRows.end());
    const size_t ids = std::min<size_t>(motion.rowIds.size(), shader::kCheckRows);
    facts.rowIds.assign(motion.rowIds.begin(), motion.rowIds.begin() + std::ptrdiff_t(ids));
}

} // namespace

void describeFacts(
    const HostInputs& inputs, const MotionBlurSettings& settings, CheckFacts& facts
) {
    facts.picture = {inputs.width, inputs.height};
    facts.isNative = inputs.motionDepth.image != VK_NULL_HANDLE;
    facts.hasVectors = facts.isNative || inputs.convention.vectors.image.image;
    facts.convention = facts.isNative ? describeMotionDepth(inputs.motionDepth, inputs.convention)
                                      : inputs.convention;
    facts.convention.cameras = countedCameras(facts.convention); // at a cut they may be anything
    facts.rasterTime = inputs.rasterTime;
    facts.hasIds = inputs.entityId.image != VK_NULL_HANDLE;
    facts.readsMotion = settings.method->readsInstantMotions;
    facts.hasDeformed = facts.readsMotion && inputs.deformedMotion.image;
    facts.wantsHistory = settings.history;
    facts.noEntity = inputs.noEntity;
    facts.frameNumber = inputs.frameNumber;
    facts.view = inputs.motion.view;
    facts.followsLast = false;
    facts.hasExposureCameras = false;
    facts.rowCount = 0;
    facts.rasterKey = 0;
    facts.keys.clear();
    facts.movers.clear();
    facts.matrices.clear();
    facts.rowIds.clear();
    facts.viewModelRows.clear();
    facts.convention.viewModel.viewFromObject = {}; // the host's, which is not copied
    if (facts.readsMotion)
        keepMotion(inputs, facts);
}

} // namespace shutter::motion_blur
