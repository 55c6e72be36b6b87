// SPDX-License-Identifier: MIT
// Valid hosts: conventions, formats and placement of images, and ways to describe motion.
#include "tests/gpu/checker_host.h"

namespace shutter::test {

namespace {

using math::dmat4;
using Given = GivenFrame;

constexpr float kFloatWidth = kCheckedWidth;
constexpr float kFloatHeight = kCheckedHeight;

void lookAlongPlusZ(Given& given) {
    motion_blur::HostCameras& cameras = given.cameras;
    const dmat4 mirror = glm::scale(dmat4(1.0), math::dvec3(1.0, 1.0, -1.0));
    cameras.aheadIsPlusZ = true;
    for (dmat4* view : {&cameras.viewFromWorld, &cameras.viewFromWorldBefore})
        *view = mirror * *view;
    for (dmat4* clip : {&cameras.clipFromView, &cameras.clipFromViewBefore})
        *clip = *clip * mirror;
}

void listVectors(Cases& add) {
    add("pixels, reversed depth", [](Given&) {});
    add("texture coordinates to the frame before", [](Given& g) {
        scaleVectors(g, {-1.0f / kFloatWidth, -1.0f / kFloatHeight});
        g.inputs.convention.vectors.pixelsPerUnit = {-kFloatWidth, -kFloatHeight};
    });
    add("normalised coordinates, y up", [](Given& g) {
        scaleVectors(g, {2.0f / kFloatWidth, -2.0f / kFloatHeight});
        g.inputs.convention.vectors.pixelsPerUnit = {kFloatWidth / 2.0f, kFloatHeight / -2.0f};
    });
    add("half floats", [](Given& g) { g.vectorFormat = VK_FORMAT_R16G16_SFLOAT; });
    add("half floats of texture coordinates", [](Given& g) {
        g.vectorFormat = VK_FORMAT_R16G16_SFLOAT;
        scaleVectors(g, {-1.0f / kFloatWidth, -1.0f / kFloatHeight});
        g.inputs.convention.vectors.pixelsPerUnit = {-kFloatWidth, -kFloatHeight};
    });
    add("over the exposure, and declared to be",
        [](Given& g) { g.inputs.convention.scales.exposureShare = 1.0f; });
    add("scales of the blur", [](Given& g) {
        g.inputs.convention.scales.camera = 0.25f;
        g.inputs.convention.scales.object = 2.0f;
        g.inputs.convention.scales.displayedPerRendered = 2.0f;
    });
    add("without the camera's part, and declared to be", [](Given& g) {
        g.inputs.convention.vectors.lackCamera = true;
        keepObjectsOnly(g);
    });
    add("no vectors, so that only the camera moves", [](Given& g) {
        g.hasVectors = false;
        g.isResolved = true;
        g.listed.clear();
    });
    add("vectors of no sky", [](Given& g) {
        for (size_t i = 0; i < kCheckedPixels; ++i)
            if (g.metres[i] >= shader::kSkyDepth)
                g.motion[i] = {};
    });
    add("jitter left in, and declared to be", [](Given& g) {
        leaveJitter(g);
        g.inputs.convention.vectors.haveJitter = true;
    });
    add("jitter taken out, and reported", [](Given& g) { declareJitter(g); });
}

void listDepthAndCameras(Cases& add) {
    add("forward depth", [](Given& g) {
        storeForwardDepth(g);
        declareForwardDepth(g);
    });
    add("linear depth in centimetres", [](Given& g) {
        storeLinearDepth(g, 100.0f);
        g.inputs.convention.depth.metresPerUnit = 0.01f;
    });
    add("linear depth in half floats", [](Given& g) {
        storeLinearDepth(g, 1.0f);
        g.depthFormat = VK_FORMAT_R16_SFLOAT; // infinity for the background
    });
    add("depth of 16 bits", [](Given& g) { g.depthFormat = VK_FORMAT_D16_UNORM; });
    add("a view along +Z", [](Given& g) { lookAlongPlusZ(g); });
    add("a lens that is shifted", [](Given& g) { cutOut(g, {{64, 36}, {128, 72}}); });
    add("no cameras", [](Given& g) {
        g.cameras = {};
        storeLinearDepth(g, 1.0f);
    });
    add("nothing moves", [](Given& g) { g.motion.assign(kCheckedPixels, {}); }).isStatic = true;
    add("a cut, and reported", [](Given& g) {
        turnAway(g);
        g.inputs.convention.scales.isCut = g.frame > 0;
    });
}

void listImagesAndMethods(Cases& add) {
    add("parts of larger images", [](Given& g) { g.isSurrounded = true; });
    add("vectors and depth at half the size", [](Given& g) { g.coarseness = 2; });
    add("parts at half the size", [](Given& g) {
        g.coarseness = 2;
        g.isSurrounded = true;
    });
    add("two eyes in layers", [](Given& g) { g.layer = g.inputs.motion.view; }).viewCount = 2;
    add("two eyes in layers, resolved", [](Given& g) {
        g.layer = g.inputs.motion.view;
        g.isResolved = true;
    }).viewCount = 2;
    add("one image of vectors and depth", [](Given& g) { g.isNative = true; });
    add("the same, over half of the time between the cameras", [](Given& g) {
        g.isNative = true;
        scaleVectors(g, {0.5f, 0.5f});
    });
    add("one image of vectors and depth, resolved", [](Given& g) {
        g.isNative = g.isResolved = true;
        g.keys = {
            {0.0, g.cameras.viewFromWorldBefore, g.cameras.clipFromViewBefore},
            {1.0, g.cameras.viewFromWorld, g.cameras.clipFromView}};
    });
    add("resolved, with each mover listed", [](Given& g) { g.isResolved = true; });
}

void listMotion(Cases& add) {
    // A camera and movers that are known at these shutter times.
    const auto addKeyed = [&](const char* name, std::vector<double> times, bool hasVectors) {
        return &add(name, [times, hasVectors](Given& g) {
            g.isResolved = true;
            g.hasVectors = hasVectors;
            if (!times.empty())
                giveKeysAt(g, times);
            giveMatrices(g);
            if (!hasVectors)
                std::erase_if(g.listed, [](const auto& mover) {
                    return mover.worldFromObject.empty();
                });
        });
    };
    addKeyed("movers by the two frames that a game knows", {}, true);
    addKeyed("the same without vectors", {}, false);
    addKeyed("movers by exact keys", {0.0, 1.0}, true);
    addKeyed("movers by exact keys, without vectors", {0.0, 0.5, 1.0}, false);
    addKeyed("movers in frames of uneven length", {}, true)->isUneven = true;
    add("one world, without ids, vectors and movers", [](Given& g) {
        g.isResolved = true;
        g.hasVectors = g.hasIds = false;
        g.listed.clear();
    });
    add("a raster in the middle of the exposure", [](Given& g) {
        g.isResolved = true;
        g.inputs.rasterTime = 0.5;
        giveKeysAt(g, {0.0, 0.5});
    });
    add("rows in another order in each frame, and their ids", [](Given& g) {
        g.isResolved = true;
        g.rowIds.resize(g.rowCount);
        const auto rowOf = [&](uint32_t row) { return (row + uint32_t(g.frame)) % g.rowCount; };
        for (uint32_t row = 0; row < g.rowCount; ++row)
            g.rowIds[rowOf(row)] = row + 1000;
        for (uint32_t& id : g.ids)
            id = id < g.rowCount ? rowOf(id) : id;
        for (motion_blur::HostMover& mover : g.listed)
            mover.row = rowOf(mover.row);
    });
    add("no history, by the settings", [](Given& g) {
        g.isResolved = true;
        g.history = false;
        g.inputs.motion.followsLast = false;
    });
    add("a first frame that has none before it", [](Given& g) {
        g.isResolved = true;
        giveKeys(g);
        giveMatrices(g);
        if (g.frame > 0)
            return;
        g.inputs.convention.scales.isCut = true;
        g.cameras.viewFromWorldBefore = g.cameras.clipFromViewBefore = dmat4(0.0);
        g.keys.front().viewFromWorld = g.keys.front().clipFromView = dmat4(0.0);
        for (std::vector<dmat4>& matrices : g.matrices)
            matrices.front() = dmat4(0.0);
    });
}

} // namespace

const std::vector<CheckCase>& listRightHosts() {
    static const std::vector<CheckCase> kCases = [] {
        Cases add;
        listVectors(add);
        listDepthAndCameras(add);
        listImagesAndMethods(add);
        listMotion(add);
        return add.all;
    }();
    return kCases;
}

} // namespace shutter::test
