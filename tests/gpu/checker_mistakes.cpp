// SPDX-License-Identifier: MIT
// What hosts get wrong: of vectors, depth and cameras, and of what "resolved" reads besides, with
// and without motion vectors.
#include "tests/gpu/checker_host.h"

#include <cmath>

namespace shutter::test {

namespace {

using math::dmat4;
using Given = GivenFrame;

/// Moves samples right and down of the pixels' centres.
void addJitter(dmat4& clipFromView, const glm::dvec2& jitterPx) {
    const glm::dvec2 shift = 2.0 * jitterPx / glm::dvec2(kCheckedWidth, kCheckedHeight);
    for (int column = 0; column < 4; ++column)
        for (int axis = 0; axis < 2; ++axis)
            clipFromView[column][axis] -= shift[axis] * clipFromView[column].w;
}

void listConventions(Cases& add) {
    add("texture coordinates taken for pixels",
        "as for texture coordinates that lead to this frame with y down: set "
        "pixelsPerUnit = (192, 108)",
        [](Given& g) {
            scaleVectors(g, {1.0f / kCheckedWidth, 1.0f / kCheckedHeight});
        });
    add("normalised coordinates taken for texture coordinates",
        "as for normalised device coordinates that lead to the frame before with y up: set "
        "pixelsPerUnit = (-96, 54)",
        [](Given& g) {
            scaleVectors(g, {-2.0f / kCheckedWidth, 2.0f / kCheckedHeight});
            g.inputs.convention.vectors.pixelsPerUnit = {
                -float(kCheckedWidth), -float(kCheckedHeight)};
        });
    add("the other way in time", "x is negated and y is negated", [](Given& g) {
        scaleVectors(g, {-1.0f, -1.0f});
    });
    add("y up",
        "y is negated, as for pixels that lead to this frame with y up: set "
        "pixelsPerUnit = (1, -1)",
        [](Given& g) {
            scaleVectors(g, {1.0f, -1.0f});
        });
    add("x left", "x is negated", [](Given& g) { scaleVectors(g, {-1.0f, 1.0f}); });
    add("pixels of a smaller picture", "pixelsPerUnit = (1.5, 1.5)", [](Given& g) {
        scaleVectors(g, {1.0f / 1.5f, 1.0f / 1.5f});
    });
    add("axes exchanged", "after x and y are exchanged", [](Given& g) {
        for (glm::vec2& vector : g.motion)
            vector = {vector.y, vector.x};
    });
    add("over the exposure already",
        "1 / exposureShare: they are over the exposure already, set exposureShare = 1",
        [](Given& g) {
            scaleVectors(g, {0.4f, 0.4f});
        });
    add("without the camera's part", "set vectorsLackCamera = true", [](Given& g) {
        keepObjectsOnly(g);
    });
    add("with the camera's part, declared to be without",
        "set vectorsLackCamera = false",
        [](Given& g) { g.inputs.convention.vectors.lackCamera = true; });
    add("vectors of the frame before", "vectors are those of the frame before", [](Given& g) {
        g.motion = g.before->motion;
    });
    add("vectors to the next frame", "vectors lead from this frame to the next one", [](Given& g) {
        for (size_t i = 0; i < kCheckedPixels; ++i)
            if (g.metres[i] < shader::kSkyDepth)
                g.motion[i] =
                    seeFrom(g, i, g.after->cameras.viewFromWorld, g.after->cameras.clipFromView) -
                    placeOf(i);
    });
    add("the same camera twice", "cameras.viewFromWorldBefore is not: set it", [](Given& g) {
        g.cameras.viewFromWorldBefore = g.cameras.viewFromWorld;
    });
    add("the camera's place for its view", "world from view", [](Given& g) {
        g.cameras.viewFromWorld = glm::inverse(g.cameras.viewFromWorld);
        g.cameras.viewFromWorldBefore = glm::inverse(g.cameras.viewFromWorldBefore);
    });
    add("a projection with y up",
        "the second row of cameras.clipFromView is negated",
        [](Given& g) {
            for (dmat4* clip : {&g.cameras.clipFromView, &g.cameras.clipFromViewBefore})
                for (int column = 0; column < 4; ++column)
                    (*clip)[column].y = -(*clip)[column].y;
        });
    add("jitter left in, and reported", "set vectorsHaveJitter = true", [](Given& g) {
        leaveJitter(g);
    });
    add("jitter left in, and not reported",
        "is temporal jitter left in the vectors?",
        [](Given& g) {
            leaveJitter(g);
            g.jitterPx = g.jitterPxBefore = math::dvec2(0.0);
        });
    add("jitter declared to be left in", "set vectorsHaveJitter = false", [](Given& g) {
        declareJitter(g);
        g.inputs.convention.vectors.haveJitter = true;
    });
    add("jitter left in, and reported with the wrong sign",
        "cameras.jitterPx and jitterPxBefore have the wrong sign",
        [](Given& g) {
            leaveJitter(g);
            g.inputs.convention.vectors.haveJitter = true;
            g.jitterPx = -g.jitterPx;
            g.jitterPxBefore = -g.jitterPxBefore;
        });
    add("jitter in the projection", "the jitter is in cameras.clipFromView", [](Given& g) {
        declareJitter(g);
        addJitter(g.cameras.clipFromView, g.jitterPx);
        addJitter(g.cameras.clipFromViewBefore, g.jitterPxBefore);
    });
    add("forward depth, reversed projection",
        "is forward depth (far is 1), so give the forward projection",
        [](Given& g) { storeForwardDepth(g); }
    ).orthographicSentence = "cameras.clipFromView has";
    add("reversed depth, forward projection",
        "is reversed depth (far is 0), so give the reversed projection",
        [](Given& g) { declareForwardDepth(g); }
    ).orthographicSentence = "cameras.clipFromView has";
    add("the sky at the near plane", "set skyValue = 0", [](Given& g) {
        g.inputs.convention.depth.skyValue = 1.0f;
    });
    add("linear depth declared to be raw",
        "for linear depth set depthIsLinear = true",
        [](Given& g) { g.depth = g.metres; });
    add("centimetres", "set metresPerUnit = 0.01", [](Given& g) { storeLinearDepth(g, 100.0f); });
    add("negative depth", "store -z", [](Given& g) { storeLinearDepth(g, -1.0f); });
    add("a depth image that was only cleared", "at every pixel", [](Given& g) {
        g.depth.assign(kCheckedPixels, 0.5f);
    });
    add("NaN in the colour", "color holds NaN at 2 pixels", [](Given& g) {
        g.color[77].y = g.color[3000].x = std::nanf("");
    });
    add("infinity in the colour", "color holds infinity at 1 pixel", [](Given& g) {
        g.color[77].z = HUGE_VALF;
    });
    add("negative colour", "color is negative at 300 pixels", [](Given& g) {
        for (size_t i = 0; i < 300; ++i)
            g.color[i] = {0.5f, -0.25f, 0.0f, 1.0f};
    });
    add("NaN in the vectors", "vectors holds NaN at 1 pixel", [](Given& g) {
        g.motion[9].x = std::nanf("");
    });
    add("NaN in the depth", "depth holds NaN at 1 pixel", [](Given& g) {
        g.depth[9] = std::nanf("");
    });
    add("vectors far too long", "is longer than the picture's diagonal", [](Given& g) {
        g.inputs.convention.vectors.pixelsPerUnit = {float(kCheckedWidth), float(kCheckedHeight)};
    });
    add("ids that are no rows", "entityId is not below rowCount", [](Given& g) {
        g.isResolved = true;
        for (size_t i = 0; i < 40; ++i)
            g.ids[i] = g.rowCount + 5;
    });
    add("ids that change", "an entity keeps its id", [](Given& g) {
        g.motion.assign(kCheckedPixels, {});
        for (uint32_t& id : g.ids)
            if (id < 0xFFFFFFFF)
                id = id * 3 + uint32_t(g.frame);
    }).isStatic = true;
    add("a mover that is not listed", "but is not in movers", [](Given& g) {
        g.isResolved = true;
        g.listed.clear();
    });
    add("a cut that is not reported", "is not the viewFromWorld of the frame before", [](Given& g) {
        turnAway(g);
    });
}

constexpr double kOtherLens = 0.7; ///< of the focal length

void scaleLens(Given& given, const glm::dvec2& scale) {
    for (dmat4* clip : {&given.cameras.clipFromView, &given.cameras.clipFromViewBefore})
        for (int column = 0; column < 4; ++column)
            for (int axis = 0; axis < 2; ++axis)
                (*clip)[column][axis] *= scale[axis];
}

void invertViews(Given& given) {
    for (dmat4* view : {&given.cameras.viewFromWorld, &given.cameras.viewFromWorldBefore})
        *view = glm::inverse(*view);
}

/// A host of "resolved" without motion vectors, all of whose movers have matrices.
void leaveVectorsOut(Given& given) {
    given.isResolved = true;
    given.hasVectors = false;
    giveMatrices(given);
    std::erase_if(given.listed, [](const auto& mover) { return mover.worldFromObject.empty(); });
}

template <class Change> void changeMatrices(Given& given, const Change& change) {
    for (std::vector<dmat4>& matrices : given.matrices)
        for (size_t key = 0; key < matrices.size(); ++key)
            matrices[key] = change(matrices[key], key);
}

void listKeys(Cases& add) {
    add("keys that run backwards", "keys run backwards", [](Given& g) {
        g.isResolved = true;
        giveKeysAt(g, {0.0, 1.0});
        std::swap(g.keys[0].viewFromWorld, g.keys[1].viewFromWorld);
    });
    add("keys that run backwards around the raster instant", "keys run backwards", [](Given& g) {
        g.isResolved = true;
        g.inputs.rasterTime = 0.5;
        giveKeysAt(g, {0.0, 0.5});
        // The same distance ahead of the raster as behind it.
        const dmat4 ahead = g.keys[1].viewFromWorld * glm::inverse(g.keys[0].viewFromWorld) *
                            g.keys[1].viewFromWorld;
        g.keys.push_back({1.0, g.keys[0].viewFromWorld, g.keys[0].clipFromView});
        g.keys[0].viewFromWorld = ahead;
    });
    add("keys that are all this frame's", "keys do not move in the exposure", [](Given& g) {
        g.isResolved = true;
        giveKeysAt(g, {0.0, 1.0});
        g.keys[0].viewFromWorld = g.keys[1].viewFromWorld;
    });
    add("keys over the frame in place of the exposure",
        "keys go over the whole time between the frames",
        [](Given& g) {
            g.isResolved = true;
            giveKeys(g);
            g.keys.front().time = 0.0;
        });
    add("keys of the frame before", "keys are those of the frame before", [](Given& g) {
        g.isResolved = true;
        giveKeysAt(g, {0.0, 1.0});
        if (g.frame == 0)
            return;
        for (motion_blur::HostCameraKey& key : g.keys) {
            const double time = key.time;
            key = g.before->cameraAt(shareAt(g, time));
            key.time = time;
        }
    });
    add("a raster at the end, declared to be in the middle", "set rasterTime = 1", [](Given& g) {
        g.isResolved = true;
        giveKeysAt(g, {0.0, 0.5, 1.0});
        g.inputs.rasterTime = 0.5;
    });
    add("keys that are the camera's place",
        "keys hold the camera's own place (world from view)",
        [](Given& g) {
            g.isResolved = true;
            giveKeys(g);
            for (motion_blur::HostCameraKey& key : g.keys)
                key.viewFromWorld = glm::inverse(key.viewFromWorld);
        });
    add("history that is never used",
        "followsLast is false, although 2 recordings of view 0 in a row",
        [](Given& g) {
            g.isResolved = true;
            g.inputs.motion.followsLast = false;
        });
}

void listMatrices(Cases& add, bool hasVectors) {
    const auto begin = [hasVectors](Given& g) {
        g.isResolved = true;
        if (!hasVectors)
            leaveVectorsOut(g);
    };
    const std::string with = hasVectors ? "" : ", without vectors";
    const size_t first = add.all.size();
    add("matrices of object from world" + with,
        "is inverted (object from world)",
        [begin](Given& g) {
            begin(g);
            changeMatrices(g, [](const dmat4& m, size_t) { return glm::inverse(m); });
        });
    add("matrices that are all this frame's" + with, "is the same at all keys", [begin](Given& g) {
        begin(g);
        for (std::vector<dmat4>& matrices : g.matrices)
            matrices.front() = matrices.back();
    });
    add("matrices of view from object" + with, "is in view space", [begin](Given& g) {
        begin(g);
        changeMatrices(g, [&](const dmat4& m, size_t key) {
            return g.keys[key].viewFromWorld * m;
        });
    });
    for (size_t i = first; i < add.all.size(); ++i)
        add.all[i].needsMovers = true;
}

void listWithoutVectors(Cases& add) {
    add("a projection with y up, without vectors",
        "the second row of cameras.clipFromView is negated",
        [](Given& g) {
            leaveVectorsOut(g);
            scaleLens(g, {1.0, -1.0});
        });
    add("the camera's place for its view, without vectors", "world from view", [](Given& g) {
        leaveVectorsOut(g);
        invertViews(g);
    });
    add("another field of view, without vectors",
        "the last frame's depth agrees with the cameras if cameras.clipFromView ",
        [](Given& g) {
            leaveVectorsOut(g);
            scaleLens(g, glm::dvec2(kOtherLens));
        });
    add("centimetres, without vectors", "set metresPerUnit = 0.01", [](Given& g) {
        leaveVectorsOut(g);
        storeLinearDepth(g, 100.0f);
    });
    add("ids that change while the camera moves, without vectors",
        "an entity keeps its id",
        [](Given& g) {
            g.isResolved = true;
            g.hasVectors = false;
            g.listed.clear();
            for (uint32_t& id : g.ids)
                if (id < g.rowCount)
                    id = (id + uint32_t(g.frame)) % g.rowCount;
        });
}

void listWithVectors(Cases& add) {
    CheckCase& late =
        add("matrices of the frame before", "is that of the frame before", [](Given& g) {
            g.isResolved = true;
            if (g.frame == 0)
                return;
            auto matrices = g.matrices.begin();
            for (const motion_blur::HostMover& mover : g.listed)
                if (!mover.worldFromObject.empty()) {
                    for (size_t key = 0; key < matrices->size(); ++key)
                        (*matrices)[key] =
                            g.before->placeAt(mover.row, shareAt(g, g.keys[key].time));
                    ++matrices;
                }
        });
    late.needsMovers = late.isUneven = true;
    add("another field of view",
        "the cameras if cameras.clipFromView had a field of view of",
        [](Given& g) { scaleLens(g, glm::dvec2(kOtherLens)); }
    ).orthographicSentence =
        "cameras.clipFromView ha"; // s another field of view; d an aspect ratio of
    add("another aspect ratio",
        "the cameras if cameras.clipFromView had an aspect ratio of",
        [](Given& g) {
            scaleLens(g, {kOtherLens, 1.0});
        }
    ).orthographicSentence =
        "cameras.clipFromView ha"; // s another field of view; d an aspect ratio of
    add("depth that is a hundred times as far", "set metresPerUnit = 1", [](Given& g) {
        storeLinearDepth(g, 1.0f);
        g.inputs.convention.depth.metresPerUnit = 100.0f;
    });
    add("ids that change while the camera moves", "an entity keeps its id", [](Given& g) {
        for (uint32_t& id : g.ids)
            if (id < g.rowCount)
                id = (id + uint32_t(g.frame)) % g.rowCount;
    });
    add("vectors that are turned by 50 degrees",
        "px off from what the cameras imply at",
        [](Given& g) {
            g.isResolved = true;
            const double angle = glm::radians(50.0);
            const glm::dmat2 turn(
                std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle)
            );
            for (glm::vec2& vector : g.motion)
                vector = glm::vec2(turn * glm::dvec2(vector));
        });
}

} // namespace

const std::vector<CheckCase>& listMistakes() {
    static const std::vector<CheckCase> kCases = [] {
        Cases add;
        listConventions(add);
        listKeys(add);
        for (const bool hasVectors : {true, false})
            listMatrices(add, hasVectors);
        listWithVectors(add);
        listWithoutVectors(add);
        return add.all;
    }();
    return kCases;
}

} // namespace shutter::test
