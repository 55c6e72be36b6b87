// SPDX-License-Identifier: MIT
#include "tests/gpu/checker_host.h"

#include <array>

namespace shutter::test {

namespace {

using math::dmat4;

constexpr double kFar = 1000.0;

const std::array<glm::dvec2, 3> kJitters{{{0.31, -0.22}, {-0.4, 0.13}, {0.12, 0.44}}};

std::array<dmat4*, 2> clipsOf(GivenFrame& given) {
    return {&given.cameras.clipFromView, &given.cameras.clipFromViewBefore};
}

} // namespace

void scaleVectors(GivenFrame& given, const glm::vec2& factor) {
    for (glm::vec2& vector : given.motion)
        vector *= factor;
}

void keepObjectsOnly(GivenFrame& given) {
    const motion_blur::HostCameras& cameras = given.cameras;
    std::vector<bool> moves(given.rowCount);
    for (const uint32_t row : given.movers)
        moves[row] = true;
    for (size_t i = 0; i < kCheckedPixels; ++i) {
        const bool isMover = given.ids[i] < given.rowCount && moves[given.ids[i]];
        const glm::dvec2 then =
            seeFrom(given, i, cameras.viewFromWorldBefore, cameras.clipFromViewBefore);
        const glm::vec2 camera(placeOf(i) - then);
        given.motion[i] = isMover ? given.motion[i] - camera : glm::vec2(0.0f);
    }
}

void storeForwardDepth(GivenFrame& given) {
    const dmat4& clip = given.cameras.clipFromView;
    const double near = clip[3].z; // of a perspective camera
    for (size_t i = 0; i < kCheckedPixels; ++i) {
        const double metres = given.metres[i];
        if (given.metres[i] >= shader::kSkyDepth)
            given.depth[i] = 1.0f;
        else if (clip[3].w != 0.0)
            given.depth[i] = 1.0f - storeDepth(clip, given.metres[i]);
        else
            given.depth[i] = float(kFar / (kFar - near) - near * kFar / ((kFar - near) * metres));
    }
}

void declareForwardDepth(GivenFrame& given) {
    for (dmat4* clip : clipsOf(given)) {
        dmat4& m = *clip;
        const double near = m[3].z;
        if (m[3].w != 0.0) {
            m[2].z = -m[2].z;
            m[3].z = 1.0 - m[3].z;
        } else {
            m[2].z = -kFar / (kFar - near);
            m[3].z = -near * kFar / (kFar - near);
        }
    }
    given.inputs.convention.depth.skyValue = 1.0f;
}

void storeLinearDepth(GivenFrame& given, float unitsPerMetre) {
    for (size_t i = 0; i < kCheckedPixels; ++i)
        given.depth[i] = given.metres[i] >= shader::kSkyDepth ? shader::kSkyDepth
                                                              : unitsPerMetre * given.metres[i];
    given.inputs.convention.depth.isLinear = true;
    given.inputs.convention.depth.skyValue = shader::kSkyDepth;
}

void declareJitter(GivenFrame& given) {
    given.jitterPx = kJitters[size_t(given.frame)];
    given.jitterPxBefore = kJitters[size_t(given.frame + 2) % kJitters.size()];
}

void leaveJitter(GivenFrame& given) {
    declareJitter(given);
    const glm::vec2 more(given.jitterPxBefore - given.jitterPx);
    for (size_t i = 0; i < kCheckedPixels; ++i)
        if (given.metres[i] < shader::kSkyDepth)
            given.motion[i] += more;
}

void turnAway(GivenFrame& given) {
    given.inputs.frameNumber = given.frame + 1;
    const dmat4 turn = glm::rotate(dmat4(1.0), 0.3 * given.frame, math::dvec3(0.0, 1.0, 0.0));
    given.cameras.viewFromWorld *= turn;
    given.cameras.viewFromWorldBefore *= turn;
}

double shareAt(const GivenFrame& given, double shutterTime) {
    const double share = given.inputs.convention.scales.exposureShare;
    return 1.0 - (given.inputs.rasterTime - shutterTime) * share;
}

void giveKeys(GivenFrame& given) {
    const motion_blur::HostCameras& cameras = given.cameras;
    given.keys = {
        {motion_blur::timeOfFrameBefore(given.inputs),
         cameras.viewFromWorldBefore,
         cameras.clipFromViewBefore},
        {given.inputs.rasterTime, cameras.viewFromWorld, cameras.clipFromView}};
}

void giveKeysAt(GivenFrame& given, const std::vector<double>& times) {
    given.keys.clear();
    for (const double time : times) {
        given.keys.push_back(given.cameraAt(shareAt(given, time)));
        given.keys.back().time = time;
    }
}

void giveMatrices(GivenFrame& given) {
    if (given.keys.empty())
        giveKeys(given);
    given.matrices.clear();
    for (motion_blur::HostMover& mover : given.listed) {
        if (given.deforms[mover.row])
            continue;
        std::vector<dmat4>& matrices = given.matrices.emplace_back();
        for (const motion_blur::HostCameraKey& key : given.keys)
            matrices.push_back(given.placeAt(mover.row, shareAt(given, key.time)));
        mover.worldFromObject = matrices;
    }
}

void cutOut(GivenFrame& given, const VkRect2D& part) {
    given.part = part;
    given.inputs.width = part.extent.width;
    given.inputs.height = part.extent.height;
    const glm::dvec2 whole(kCheckedWidth, kCheckedHeight);
    const glm::dvec2 size(part.extent.width, part.extent.height);
    const glm::dvec2 offset(part.offset.x, part.offset.y);
    dmat4 partFromWhole(1.0);
    partFromWhole[0].x = whole.x / size.x;
    partFromWhole[1].y = whole.y / size.y;
    const glm::dvec2 shift = (whole - 2.0 * offset) / size - 1.0;
    partFromWhole[3].x = shift.x;
    partFromWhole[3].y = shift.y;
    for (dmat4* clip : clipsOf(given))
        *clip = partFromWhole * *clip;
}

} // namespace shutter::test
