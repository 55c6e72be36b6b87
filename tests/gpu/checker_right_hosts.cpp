// SPDX-License-Identifier: MIT
#include "tests/gpu/checker_changes.h"

namespace shutter::test {

namespace {

using math::dmat4;
using Given = GivenFrame;
using Drawn = const CheckedDrawing&;

constexpr float kWidth = kCheckedWidth;
constexpr float kHeight = kCheckedHeight;

void lookAlongPlusZ(Given& given) {
    motion_blur::HostCameras& cameras = given.cameras;
    const dmat4 mirror = glm::scale(dmat4(1.0), math::dvec3(1.0, 1.0, -1.0));
    cameras.aheadIsPlusZ = true;
    for (dmat4* view : {&cameras.viewFromWorld, &cameras.viewFromWorldBefore})
        *view = mirror * *view;
    for (dmat4* clip : {&cameras.clipFromView, &cameras.clipFromViewBefore})
        *clip = *clip * mirror;
}

std::vector<CheckCase> listVectors() {
    return {
        {"pixels, reversed depth", "", [](Given&, int, Drawn, Drawn) {}},
        {"texture coordinates to the frame before",
         "",
         [](Given& g, int, Drawn, Drawn) {
             scaleVectors(g, {-1.0f / kWidth, -1.0f / kHeight});
             g.inputs.convention.vectors.pixelsPerUnit = {-kWidth, -kHeight};
         }},
        {"normalised coordinates, y up",
         "",
         [](Given& g, int, Drawn, Drawn) {
             scaleVectors(g, {2.0f / kWidth, -2.0f / kHeight});
             g.inputs.convention.vectors.pixelsPerUnit = {kWidth / 2.0f, kHeight / -2.0f};
         }},
        {"half floats",
         "",
         [](Given& g, int, Drawn, Drawn) { g.vectorFormat = VK_FORMAT_R16G16_SFLOAT; }},
        {"half floats of texture coordinates",
         "",
         [](Given& g, int, Drawn, Drawn) {
             g.vectorFormat = VK_FORMAT_R16G16_SFLOAT;
             scaleVectors(g, {-1.0f / kWidth, -1.0f / kHeight});
             g.inputs.convention.vectors.pixelsPerUnit = {-kWidth, -kHeight};
         }},
        {"over the exposure, and said to be",
         "",
         [](Given& g, int, Drawn, Drawn) { g.inputs.convention.scales.exposureShare = 1.0f; }},
        {"scales of the blur",
         "",
         [](Given& g, int, Drawn, Drawn) {
             g.inputs.convention.scales.camera = 0.25f;
             g.inputs.convention.scales.object = 2.0f;
             g.inputs.convention.scales.displayedPerRendered = 2.0f;
         }},
        {"without the camera's part, and said to be",
         "",
         [](Given& g, int, Drawn, Drawn) {
             g.inputs.convention.vectors.haveCamera = false;
             keepObjectsOnly(g);
         }},
        {"no vectors, so that only the camera moves",
         "",
         [](Given& g, int, Drawn, Drawn) {
             g.hasVectors = false;
             g.isResolved = true;
             g.listed.clear();
         }},
        {"vectors of no sky",
         "",
         [](Given& g, int, Drawn, Drawn) {
             for (size_t i = 0; i < kCheckedPixels; ++i)
                 if (g.metres[i] >= shader::kSkyDepth)
                     g.motion[i] = {};
         }},
        {"jitter left in, and said to be",
         "",
         [](Given& g, int frame, Drawn, Drawn) {
             leaveJitter(g, frame);
             g.inputs.convention.vectors.haveJitter = true;
         }},
        {"jitter taken out, and told", "", [](Given& g, int frame, Drawn, Drawn) {
             declareJitter(g, frame);
         }}};
}

std::vector<CheckCase> listDepthAndCameras() {
    return {
        {"forward depth",
         "",
         [](Given& g, int, Drawn, Drawn) {
             storeForwardDepth(g);
             declareForwardDepth(g);
         }},
        {"linear depth in centimetres",
         "",
         [](Given& g, int, Drawn, Drawn) {
             storeLinearDepth(g, 100.0f);
             g.inputs.convention.depth.metresPerUnit = 0.01f;
         }},
        {"linear depth in half floats",
         "",
         [](Given& g, int, Drawn, Drawn) {
             storeLinearDepth(g, 1.0f);
             g.depthFormat = VK_FORMAT_R16_SFLOAT; // infinity where nothing is
         }},
        {"depth of 16 bits",
         "",
         [](Given& g, int, Drawn, Drawn) { g.depthFormat = VK_FORMAT_D16_UNORM; }},
        {"a view along +Z", "", [](Given& g, int, Drawn, Drawn) { lookAlongPlusZ(g); }},
        {"a lens that is shifted",
         "",
         [](Given& g, int, Drawn, Drawn) {
             cutOut(g, {{64, 36}, {128, 72}});
         }},
        {"no cameras",
         "",
         [](Given& g, int, Drawn, Drawn) {
             g.cameras = {};
             storeLinearDepth(g, 1.0f);
         }},
        {"nothing moves",
         "",
         [](Given& g, int, Drawn, Drawn) { g.motion.assign(kCheckedPixels, {}); },
         true},
        {"a cut, and told", "", [](Given& g, int frame, Drawn, Drawn) {
             turnAway(g, frame);
             g.inputs.convention.scales.isCut = frame > 0;
         }}};
}

std::vector<CheckCase> listImagesAndMethods() {
    return {
        {"parts of larger images", "", [](Given& g, int, Drawn, Drawn) { g.isSurrounded = true; }},
        {"vectors and depth at half the size",
         "",
         [](Given& g, int, Drawn, Drawn) { g.coarseness = 2; }},
        {"parts at half the size",
         "",
         [](Given& g, int, Drawn, Drawn) {
             g.coarseness = 2;
             g.isSurrounded = true;
         }},
        {"two eyes in layers",
         "",
         [](Given& g, int, Drawn, Drawn) { g.layer = g.inputs.motion.view; },
         false,
         2},
        {"two eyes in layers, resolved",
         "",
         [](Given& g, int frame, Drawn, Drawn) {
             g.layer = g.inputs.motion.view;
             g.isResolved = true;
             g.inputs.motion.followsLast = frame > 0;
         },
         false,
         2},
        {"one image of vectors and depth",
         "",
         [](Given& g, int, Drawn, Drawn) { g.isNative = true; }},
        {"the same, over half of the time between the cameras",
         "",
         [](Given& g, int, Drawn, Drawn) {
             g.isNative = true;
             scaleVectors(g, {0.5f, 0.5f});
         }},
        {"one image of vectors and depth, resolved",
         "",
         [](Given& g, int frame, Drawn, Drawn) {
             g.isNative = g.isResolved = true;
             g.keys = {
                 {0.0, g.cameras.viewFromWorldBefore, g.cameras.clipFromViewBefore},
                 {1.0, g.cameras.viewFromWorld, g.cameras.clipFromView}};
             g.inputs.motion.followsLast = frame > 0;
         }},
        {"resolved, with each mover listed", "", [](Given& g, int frame, Drawn, Drawn) {
             g.isResolved = true;
             g.inputs.motion.followsLast = frame > 0;
         }}};
}

} // namespace

const std::vector<CheckCase>& listRightHosts() {
    static const std::vector<CheckCase> kCases = [] {
        std::vector<CheckCase> all = listVectors();
        for (const auto& more : {listDepthAndCameras(), listImagesAndMethods()})
            all.insert(all.end(), more.begin(), more.end());
        return all;
    }();
    return kCases;
}

} // namespace shutter::test
