// SPDX-License-Identifier: MIT
#include "tests/gpu/checker_changes.h"

#include <cmath>

namespace shutter::test {

namespace {

using math::dmat4;
using Given = GivenFrame;
using Drawn = const CheckedDrawing&;

/// Moves samples right and down of the pixels' centres.
void addJitter(dmat4& clipFromView, const glm::dvec2& jitterPx) {
    const glm::dvec2 shift = 2.0 * jitterPx / glm::dvec2(kCheckedWidth, kCheckedHeight);
    for (int column = 0; column < 4; ++column)
        for (int axis = 0; axis < 2; ++axis)
            clipFromView[column][axis] -= shift[axis] * clipFromView[column].w;
}

} // namespace

const std::vector<CheckCase>& listMistakes() {
    static const std::vector<CheckCase> kCases{
        {"texture coordinates taken for pixels",
         "as for texture coordinates that lead to this frame with y down: set "
         "pixelsPerUnit = (192, 108)",
         [](Given& g, int, Drawn, Drawn) {
             scaleVectors(g, {1.0f / kCheckedWidth, 1.0f / kCheckedHeight});
         }},
        {"normalised coordinates taken for texture coordinates",
         "as for normalised device coordinates that lead to the frame before with y up: set "
         "pixelsPerUnit = (-96, 54)",
         [](Given& g, int, Drawn, Drawn) {
             scaleVectors(g, {-2.0f / kCheckedWidth, 2.0f / kCheckedHeight});
             g.inputs.convention.vectors.pixelsPerUnit = {
                 -float(kCheckedWidth), -float(kCheckedHeight)};
         }},
        {"the other way in time",
         "x is negated and y is negated",
         [](Given& g, int, Drawn, Drawn) {
             scaleVectors(g, {-1.0f, -1.0f});
         }},
        {"y up",
         "y is negated, as for pixels that lead to this frame with y up: set "
         "pixelsPerUnit = (1, -1)",
         [](Given& g, int, Drawn, Drawn) {
             scaleVectors(g, {1.0f, -1.0f});
         }},
        {"x left",
         "x is negated",
         [](Given& g, int, Drawn, Drawn) {
             scaleVectors(g, {-1.0f, 1.0f});
         }},
        {"pixels of a smaller picture",
         "pixelsPerUnit = (1.5, 1.5)",
         [](Given& g, int, Drawn, Drawn) {
             scaleVectors(g, {1.0f / 1.5f, 1.0f / 1.5f});
         }},
        {"axes exchanged",
         "after x and y are exchanged",
         [](Given& g, int, Drawn, Drawn) {
             for (glm::vec2& vector : g.motion)
                 vector = {vector.y, vector.x};
         }},
        {"over the exposure already",
         "1 / exposureShare: they are over the exposure already, set exposureShare = 1",
         [](Given& g, int, Drawn, Drawn) {
             scaleVectors(g, {0.4f, 0.4f});
         }},
        {"without the camera's part",
         "set vectorsLackCamera = true",
         [](Given& g, int, Drawn, Drawn) { keepObjectsOnly(g); }},
        {"with the camera's part, said to be without",
         "set vectorsLackCamera = false",
         [](Given& g, int, Drawn, Drawn) { g.inputs.convention.vectors.lackCamera = true; }},
        {"vectors of the frame before",
         "vectors are those of the frame before",
         [](Given& g, int, Drawn before, Drawn) { g.motion = before.motion; }},
        {"vectors to the next frame",
         "vectors lead from this frame to the next one",
         [](Given& g, int, Drawn, Drawn after) {
             for (size_t i = 0; i < kCheckedPixels; ++i)
                 if (g.metres[i] < shader::kSkyDepth)
                     g.motion[i] =
                         seeFrom(g, i, after.cameras.viewFromWorld, after.cameras.clipFromView) -
                         placeOf(i);
         }},
        {"the same camera twice",
         "cameras.viewFromWorldBefore is not: set it",
         [](Given& g, int, Drawn, Drawn) {
             g.cameras.viewFromWorldBefore = g.cameras.viewFromWorld;
         }},
        {"the camera's place for its view",
         "world from view",
         [](Given& g, int, Drawn, Drawn) {
             g.cameras.viewFromWorld = glm::inverse(g.cameras.viewFromWorld);
             g.cameras.viewFromWorldBefore = glm::inverse(g.cameras.viewFromWorldBefore);
         }},
        {"a projection with y up",
         "the second row of cameras.clipFromView is negated",
         [](Given& g, int, Drawn, Drawn) {
             for (dmat4* clip : {&g.cameras.clipFromView, &g.cameras.clipFromViewBefore})
                 for (int column = 0; column < 4; ++column)
                     (*clip)[column].y = -(*clip)[column].y;
         }},
        {"jitter left in, and told",
         "set vectorsHaveJitter = true",
         [](Given& g, int frame, Drawn, Drawn) { leaveJitter(g, frame); }},
        {"jitter left in, and not told",
         "is temporal jitter left in the vectors?",
         [](Given& g, int frame, Drawn, Drawn) {
             leaveJitter(g, frame);
             g.jitterPx = g.jitterPxBefore = math::dvec2(0.0);
         }},
        {"jitter said to be left in",
         "set vectorsHaveJitter = false",
         [](Given& g, int frame, Drawn, Drawn) {
             declareJitter(g, frame);
             g.inputs.convention.vectors.haveJitter = true;
         }},
        {"jitter left in, and told with the wrong sign",
         "cameras.jitterPx and jitterPxBefore have the wrong sign",
         [](Given& g, int frame, Drawn, Drawn) {
             leaveJitter(g, frame);
             g.inputs.convention.vectors.haveJitter = true;
             g.jitterPx = -g.jitterPx;
             g.jitterPxBefore = -g.jitterPxBefore;
         }},
        {"jitter in the projection",
         "the jitter is in cameras.clipFromView",
         [](Given& g, int frame, Drawn, Drawn) {
             declareJitter(g, frame);
             addJitter(g.cameras.clipFromView, g.jitterPx);
             addJitter(g.cameras.clipFromViewBefore, g.jitterPxBefore);
         }},
        {"forward depth, reversed projection",
         "is forward depth (far is 1), so give the forward projection",
         [](Given& g, int, Drawn, Drawn) { storeForwardDepth(g); },
         false,
         1,
         "cameras.clipFromView has"},
        {"reversed depth, forward projection",
         "is reversed depth (far is 0), so give the reversed projection",
         [](Given& g, int, Drawn, Drawn) { declareForwardDepth(g); },
         false,
         1,
         "cameras.clipFromView has"},
        {"the sky at the near plane",
         "set skyValue = 0",
         [](Given& g, int, Drawn, Drawn) { g.inputs.convention.depth.skyValue = 1.0f; }},
        {"linear depth said to be raw",
         "for linear depth set depthIsLinear = true",
         [](Given& g, int, Drawn, Drawn) { g.depth = g.metres; }},
        {"centimetres",
         "set metresPerUnit = 0.01",
         [](Given& g, int, Drawn, Drawn) { storeLinearDepth(g, 100.0f); }},
        {"negative depth",
         "store -z",
         [](Given& g, int, Drawn, Drawn) { storeLinearDepth(g, -1.0f); }},
        {"a depth image that was only cleared",
         "at every pixel",
         [](Given& g, int, Drawn, Drawn) { g.depth.assign(kCheckedPixels, 0.5f); }},
        {"NaN in the colour",
         "color holds NaN at 2 pixels",
         [](Given& g, int, Drawn, Drawn) { g.color[77].y = g.color[3000].x = std::nanf(""); }},
        {"infinity in the colour",
         "color holds infinity at 1 pixel",
         [](Given& g, int, Drawn, Drawn) { g.color[77].z = HUGE_VALF; }},
        {"negative colour",
         "color is negative at 300 pixels",
         [](Given& g, int, Drawn, Drawn) {
             for (size_t i = 0; i < 300; ++i)
                 g.color[i] = {0.5f, -0.25f, 0.0f, 1.0f};
         }},
        {"NaN in the vectors",
         "vectors holds NaN at 1 pixel",
         [](Given& g, int, Drawn, Drawn) { g.motion[9].x = std::nanf(""); }},
        {"NaN in the depth",
         "depth holds NaN at 1 pixel",
         [](Given& g, int, Drawn, Drawn) { g.depth[9] = std::nanf(""); }},
        {"vectors far too long",
         "is longer than the picture's diagonal",
         [](Given& g, int, Drawn, Drawn) {
             g.inputs.convention.vectors.pixelsPerUnit = {
                 float(kCheckedWidth), float(kCheckedHeight)};
         }},
        {"ids that are no rows",
         "entityId is not below rowCount",
         [](Given& g, int, Drawn, Drawn) {
             g.isResolved = true;
             for (size_t i = 0; i < 40; ++i)
                 g.ids[i] = g.rowCount + 5;
         }},
        {"ids that change",
         "an entity keeps its id",
         [](Given& g, int frame, Drawn, Drawn) {
             g.motion.assign(kCheckedPixels, {});
             for (uint32_t& id : g.ids)
                 if (id < 0xFFFFFFFF)
                     id = id * 3 + uint32_t(frame);
         },
         true},
        {"a mover that is not listed",
         "but is not in movers",
         [](Given& g, int, Drawn, Drawn) {
             g.isResolved = true;
             g.listed.clear();
         }},
        {"a cut that is not told",
         "is not the viewFromWorld of the frame before",
         [](Given& g, int frame, Drawn, Drawn) { turnAway(g, frame); }}};
    return kCases;
}

} // namespace shutter::test
