// SPDX-License-Identifier: MIT
#include "tests/gpu/checker_changes.h"

#include <utility>

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
             g.inputs.convention.vectors.lackCamera = true;
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
         [](Given& g, int, Drawn, Drawn) {
             g.layer = g.inputs.motion.view;
             g.isResolved = true;
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
         [](Given& g, int, Drawn, Drawn) {
             g.isNative = g.isResolved = true;
             g.keys = {
                 {0.0, g.cameras.viewFromWorldBefore, g.cameras.clipFromViewBefore},
                 {1.0, g.cameras.viewFromWorld, g.cameras.clipFromView}};
         }},
        {"resolved, with each mover listed", "", [](Given& g, int, Drawn, Drawn) {
             g.isResolved = true;
         }}};
}

/// A camera and movers that are known at these shutter times.
CheckCase makeKeyed(const char* name, std::vector<double> times, bool hasVectors) {
    CheckCase one{name, "", [times, hasVectors](Given& g, int, Drawn, Drawn) {
                      g.isResolved = true;
                      g.hasVectors = hasVectors;
                      if (!times.empty())
                          giveKeysAt(g, times);
                      giveMatrices(g);
                      if (!hasVectors)
                          std::erase_if(g.listed, [](const auto& mover) {
                              return mover.worldFromObject.empty();
                          });
                  }};
    return one;
}

std::vector<CheckCase> listMotion() {
    CheckCase uneven = makeKeyed("movers in frames of uneven length", {}, true);
    uneven.isUneven = true;
    return {
        makeKeyed("movers by the two frames that a game knows", {}, true),
        makeKeyed("the same without vectors", {}, false),
        makeKeyed("movers by exact keys", {0.0, 1.0}, true),
        makeKeyed("movers by exact keys, without vectors", {0.0, 0.5, 1.0}, false),
        uneven,
        {"one world, without ids, vectors and movers",
         "",
         [](Given& g, int, Drawn, Drawn) {
             g.isResolved = true;
             g.hasVectors = g.hasIds = false;
             g.listed.clear();
         }},
        {"a raster in the middle of the exposure",
         "",
         [](Given& g, int, Drawn, Drawn) {
             g.isResolved = true;
             g.inputs.rasterTime = 0.5;
             giveKeysAt(g, {0.0, 0.5});
         }},
        {"rows in another order in each frame, and their ids",
         "",
         [](Given& g, int frame, Drawn, Drawn) {
             g.isResolved = true;
             g.rowIds.resize(g.rowCount);
             const auto rowOf = [&](uint32_t row) { return (row + uint32_t(frame)) % g.rowCount; };
             for (uint32_t row = 0; row < g.rowCount; ++row)
                 g.rowIds[rowOf(row)] = row + 1000;
             for (uint32_t& id : g.ids)
                 id = id < g.rowCount ? rowOf(id) : id;
             for (motion_blur::HostMover& mover : g.listed)
                 mover.row = rowOf(mover.row);
         }},
        {"no history, by the settings",
         "",
         [](Given& g, int, Drawn, Drawn) {
             g.isResolved = true;
             g.history = false;
             g.inputs.motion.followsLast = false;
         }},
        {"a first frame that has none before it", "", [](Given& g, int frame, Drawn, Drawn) {
             g.isResolved = true;
             giveKeys(g);
             giveMatrices(g);
             if (frame > 0)
                 return;
             g.inputs.convention.scales.isCut = true;
             g.cameras.viewFromWorldBefore = g.cameras.clipFromViewBefore = dmat4(0.0);
             g.keys.front().viewFromWorld = g.keys.front().clipFromView = dmat4(0.0);
             for (std::vector<dmat4>& matrices : g.matrices)
                 matrices.front() = dmat4(0.0);
         }}};
}

} // namespace

const std::vector<CheckCase>& listRightHosts() {
    static const std::vector<CheckCase> kCases = [] {
        std::vector<CheckCase> all = listVectors();
        for (const auto& more : {listDepthAndCameras(), listImagesAndMethods(), listMotion()})
            all.insert(all.end(), more.begin(), more.end());
        return all;
    }();
    return kCases;
}

} // namespace shutter::test
