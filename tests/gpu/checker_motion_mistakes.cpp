// SPDX-License-Identifier: MIT
// What hosts get wrong of camera keys, movers, history and, without motion vectors, cameras.
#include "tests/gpu/checker_changes.h"

namespace shutter::test {

namespace {

using math::dmat4;
using Given = GivenFrame;
using Drawn = const CheckedDrawing&;

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

std::vector<CheckCase> listKeys() {
    return {
        {"keys that run backwards",
         "keys run backwards",
         [](Given& g, int, Drawn, Drawn) {
             g.isResolved = true;
             giveKeysAt(g, {0.0, 1.0});
             std::swap(g.keys[0].viewFromWorld, g.keys[1].viewFromWorld);
         }},
        {"keys that run backwards around the raster instant",
         "keys run backwards",
         [](Given& g, int, Drawn, Drawn) {
             g.isResolved = true;
             g.inputs.rasterTime = 0.5;
             giveKeysAt(g, {0.0, 0.5});
             // What lies ahead of the raster, as far as what lies before it.
             const dmat4 ahead = g.keys[1].viewFromWorld * glm::inverse(g.keys[0].viewFromWorld) *
                                 g.keys[1].viewFromWorld;
             g.keys.push_back({1.0, g.keys[0].viewFromWorld, g.keys[0].clipFromView});
             g.keys[0].viewFromWorld = ahead;
         }},
        {"keys that are all this frame's",
         "keys do not move in the exposure",
         [](Given& g, int, Drawn, Drawn) {
             g.isResolved = true;
             giveKeysAt(g, {0.0, 1.0});
             g.keys[0].viewFromWorld = g.keys[1].viewFromWorld;
         }},
        {"keys over the frame in place of the exposure",
         "keys go over the whole time between the frames",
         [](Given& g, int, Drawn, Drawn) {
             g.isResolved = true;
             giveKeys(g);
             g.keys.front().time = 0.0;
         }},
        {"keys of the frame before",
         "keys are those of the frame before",
         [](Given& g, int frame, Drawn before, Drawn) {
             g.isResolved = true;
             giveKeysAt(g, {0.0, 1.0});
             if (frame == 0)
                 return;
             for (motion_blur::HostCameraKey& key : g.keys) {
                 const double time = key.time;
                 key = before.cameraAt(shareAt(g, time));
                 key.time = time;
             }
         }},
        {"a raster at the end, said to be in the middle",
         "set rasterTime = 1",
         [](Given& g, int, Drawn, Drawn) {
             g.isResolved = true;
             giveKeysAt(g, {0.0, 0.5, 1.0});
             g.inputs.rasterTime = 0.5;
         }},
        {"keys that are the camera's place",
         "keys hold the camera's own place (world from view)",
         [](Given& g, int, Drawn, Drawn) {
             g.isResolved = true;
             giveKeys(g);
             for (motion_blur::HostCameraKey& key : g.keys)
                 key.viewFromWorld = glm::inverse(key.viewFromWorld);
         }},
        {"history that is never used",
         "followsLast is false, although 2 recordings of view 0 in a row",
         [](Given& g, int, Drawn, Drawn) {
             g.isResolved = true;
             g.inputs.motion.followsLast = false;
         }}};
}

std::vector<CheckCase> listMatrices(bool hasVectors) {
    const auto begin = [hasVectors](Given& g) {
        g.isResolved = true;
        if (!hasVectors)
            leaveVectorsOut(g);
    };
    const std::string with = hasVectors ? "" : ", without vectors";
    std::vector<CheckCase> cases{
        {"matrices of object from world" + with,
         "is inverted (object from world)",
         [begin](Given& g, int, Drawn, Drawn) {
             begin(g);
             changeMatrices(g, [](const dmat4& m, size_t) { return glm::inverse(m); });
         }},
        {"matrices that are all this frame's" + with,
         "is the same at all keys",
         [begin](Given& g, int, Drawn, Drawn) {
             begin(g);
             for (std::vector<dmat4>& matrices : g.matrices)
                 matrices.front() = matrices.back();
         }},
        {"matrices of view from object" + with,
         "is in view space",
         [begin](Given& g, int, Drawn, Drawn) {
             begin(g);
             changeMatrices(g, [&](const dmat4& m, size_t key) {
                 return g.keys[key].viewFromWorld * m;
             });
         }}};
    for (CheckCase& one : cases)
        one.needsMovers = true;
    return cases;
}

std::vector<CheckCase> listWithoutVectors() {
    return {
        {"a projection with y up, without vectors",
         "the second row of cameras.clipFromView is negated",
         [](Given& g, int, Drawn, Drawn) {
             leaveVectorsOut(g);
             scaleLens(g, {1.0, -1.0});
         }},
        {"the camera's place for its view, without vectors",
         "world from view",
         [](Given& g, int, Drawn, Drawn) {
             leaveVectorsOut(g);
             invertViews(g);
         }},
        {"another field of view, without vectors",
         "the last frame's depth agrees with the cameras if cameras.clipFromView ",
         [](Given& g, int, Drawn, Drawn) {
             leaveVectorsOut(g);
             scaleLens(g, glm::dvec2(kOtherLens));
         }},
        {"centimetres, without vectors",
         "set metresPerUnit = 0.01",
         [](Given& g, int, Drawn, Drawn) {
             leaveVectorsOut(g);
             storeLinearDepth(g, 100.0f);
         }},
        {"ids that change while the camera moves, without vectors",
         "an entity keeps its id",
         [](Given& g, int frame, Drawn, Drawn) {
             g.isResolved = true;
             g.hasVectors = false;
             g.listed.clear();
             for (uint32_t& id : g.ids)
                 if (id < g.rowCount)
                     id = (id + uint32_t(frame)) % g.rowCount;
         }}};
}

std::vector<CheckCase> listWithVectors() {
    CheckCase late{
        "matrices of the frame before",
        "is that of the frame before",
        [](Given& g, int frame, Drawn before, Drawn) {
            g.isResolved = true;
            if (frame == 0)
                return;
            auto matrices = g.matrices.begin();
            for (const motion_blur::HostMover& mover : g.listed)
                if (!mover.worldFromObject.empty()) {
                    for (size_t key = 0; key < matrices->size(); ++key)
                        (*matrices)[key] = before.placeAt(mover.row, shareAt(g, g.keys[key].time));
                    ++matrices;
                }
        }};
    late.needsMovers = late.isUneven = true;
    return {
        late,
        {"another field of view",
         "the cameras if cameras.clipFromView had a field of view of",
         [](Given& g, int, Drawn, Drawn) { scaleLens(g, glm::dvec2(kOtherLens)); },
         false,
         1,
         "cameras.clipFromView ha"}, // s another field of view; d an aspect ratio of
        {"another aspect ratio",
         "the cameras if cameras.clipFromView had an aspect ratio of",
         [](Given& g, int, Drawn, Drawn) {
             scaleLens(g, {kOtherLens, 1.0});
         },
         false,
         1,
         "cameras.clipFromView ha"}, // s another field of view; d an aspect ratio of
        {"depth that is a hundred times as far",
         "set metresPerUnit = 1",
         [](Given& g, int, Drawn, Drawn) {
             storeLinearDepth(g, 1.0f);
             g.inputs.convention.depth.metresPerUnit = 100.0f;
         }},
        {"ids that change while the camera moves",
         "an entity keeps its id",
         [](Given& g, int frame, Drawn, Drawn) {
             for (uint32_t& id : g.ids)
                 if (id < g.rowCount)
                     id = (id + uint32_t(frame)) % g.rowCount;
         }},
        {"vectors that are turned by 50 degrees",
         "px off from what the cameras imply at",
         [](Given& g, int, Drawn, Drawn) {
             g.isResolved = true;
             const double angle = glm::radians(50.0);
             const glm::dmat2 turn(
                 std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle)
             );
             for (glm::vec2& vector : g.motion)
                 vector = glm::vec2(turn * glm::dvec2(vector));
         }}};
}

} // namespace

const std::vector<CheckCase>& listMotionMistakes() {
    static const std::vector<CheckCase> kCases = [] {
        std::vector<CheckCase> all = listKeys();
        for (const auto& more :
             {listMatrices(true), listMatrices(false), listWithVectors(), listWithoutVectors()})
            all.insert(all.end(), more.begin(), more.end());
        return all;
    }();
    return kCases;
}

} // namespace shutter::test
