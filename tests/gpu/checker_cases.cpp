// SPDX-License-Identifier: MIT
// What hosts get wrong: of vectors, depth and cameras, and of what "resolved" reads besides, with
// and without motion vectors. What they may do: conventions, formats and placement of images, and
// ways to describe motion.
#include "tests/gpu/checker_host.h"

#include <array>
#include <cmath>
#include <optional>

namespace shutter::test {

namespace {

using math::dmat4;
using math::dvec2;
using Given = GivenFrame;
using Change = std::function<void(Given&)>;

constexpr double kFar = 1000.0;
constexpr double kOtherLens = 0.7; ///< of the focal length
constexpr float kFloatWidth = kCheckedWidth;
constexpr float kFloatHeight = kCheckedHeight;

/// Gathers cases; the one that is returned may be changed until the next.
struct Cases {
    CheckCase& operator()(const std::string& name, const char* sentence, Change change) {
        return all.emplace_back(CheckCase{name, sentence, std::move(change)});
    }

    /// Adds a host whose inputs are valid.
    CheckCase& operator()(const std::string& name, Change change) {
        return (*this)(name, "", std::move(change));
    }

    std::vector<CheckCase> all;
};

// Changes that several cases share.

/// The change, for a host that draws by `resolved`.
Change resolved(Change change) {
    return [change = std::move(change)](Given& g) {
        g.isResolved = true;
        change(g);
    };
}

/// To units in which vectors are so many times as long.
Change scaled(const glm::vec2& factor) {
    return [factor](Given& g) {
        for (glm::vec2& vector : g.motion)
            vector *= factor;
    };
}

/// The same, with pixels to the unit as declared.
Change scaledAndDeclared(const glm::vec2& factor, const glm::vec2& pixelsPerUnit) {
    return [=](Given& g) {
        scaled(factor)(g);
        g.inputs.convention.vectors.pixelsPerUnit = pixelsPerUnit;
    };
}

/// Takes the camera's part out of the vectors.
void keepObjectsOnly(Given& g) {
    std::vector<bool> moves(g.rowCount);
    for (const uint32_t row : g.movers)
        moves[row] = true;
    for (size_t i = 0; i < kCheckedPixels; ++i) {
        const bool isMover = g.ids[i] < g.rowCount && moves[g.ids[i]];
        const dvec2 then =
            seeFrom(g, i, g.cameras.viewFromWorldBefore, g.cameras.clipFromViewBefore);
        g.motion[i] = isMover ? g.motion[i] - glm::vec2(placeOf(i) - then) : glm::vec2(0.0f);
    }
}

std::array<dmat4*, 2> clipsOf(Given& g) {
    return {&g.cameras.clipFromView, &g.cameras.clipFromViewBefore};
}

std::array<dmat4*, 2> viewsOf(Given& g) {
    return {&g.cameras.viewFromWorld, &g.cameras.viewFromWorldBefore};
}

/// Stores depth with far at 1, at 1000 m where the camera is perspective.
void storeForwardDepth(Given& g) {
    const dmat4& clip = g.cameras.clipFromView;
    const double near = clip[3].z; // of a perspective camera
    for (size_t i = 0; i < kCheckedPixels; ++i) {
        const double metres = g.metres[i];
        if (g.metres[i] >= shader::kSkyDepth)
            g.depth[i] = 1.0f;
        else if (clip[3].w != 0.0)
            g.depth[i] = 1.0f - storeDepth(clip, g.metres[i]);
        else
            g.depth[i] = float(kFar / (kFar - near) - near * kFar / ((kFar - near) * metres));
    }
}

/// Gives cameras of that depth.
void declareForwardDepth(Given& g) {
    for (dmat4* clip : clipsOf(g)) {
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
    g.inputs.convention.depth.skyValue = 1.0f;
}

/// Stores depth along the view, and declares how many metres a unit has.
Change storeLinearDepth(float unitsPerMetre, float metresPerUnit = 1.0f) {
    return [=](Given& g) {
        for (size_t i = 0; i < kCheckedPixels; ++i)
            g.depth[i] =
                g.metres[i] >= shader::kSkyDepth ? shader::kSkyDepth : unitsPerMetre * g.metres[i];
        motion_blur::HostDepth& depth = g.inputs.convention.depth;
        depth.isLinear = true;
        depth.skyValue = shader::kSkyDepth;
        depth.metresPerUnit = metresPerUnit;
    };
}

/// Another jitter in each frame.
void declareJitter(Given& g) {
    static const std::array<dvec2, 3> kJitters{{{0.31, -0.22}, {-0.4, 0.13}, {0.12, 0.44}}};
    g.jitterPx = kJitters[size_t(g.frame)];
    g.jitterPxBefore = kJitters[size_t(g.frame + 2) % kJitters.size()];
}

/// Draws with it, and leaves it in the vectors.
void leaveJitter(Given& g) {
    declareJitter(g);
    const glm::vec2 more(g.jitterPxBefore - g.jitterPx);
    for (size_t i = 0; i < kCheckedPixels; ++i)
        if (g.metres[i] < shader::kSkyDepth)
            g.motion[i] += more;
}

/// Moves samples right and down of the pixels' centres.
void addJitter(dmat4& clipFromView, const dvec2& jitterPx) {
    const dvec2 shift = 2.0 * jitterPx / dvec2(kCheckedWidth, kCheckedHeight);
    for (int column = 0; column < 4; ++column)
        for (int axis = 0; axis < 2; ++axis)
            clipFromView[column][axis] -= shift[axis] * clipFromView[column].w;
}

/// Turns the cameras of each frame away from those of the previous frame.
void turnAway(Given& g) {
    g.inputs.frameNumber = g.frame + 1;
    for (dmat4* view : viewsOf(g))
        *view *= glm::rotate(dmat4(1.0), 0.3 * g.frame, math::dvec3(0.0, 1.0, 0.0));
}

/// Lengthens both focal lengths.
Change scaleLens(const dvec2& scale) {
    return [scale](Given& g) {
        for (dmat4* clip : clipsOf(g))
            *clip = glm::scale(dmat4(1.0), math::dvec3(scale, 1.0)) * *clip;
    };
}

void invertViews(Given& g) {
    for (dmat4* view : viewsOf(g))
        *view = glm::inverse(*view);
}

void lookAlongPlusZ(Given& g) {
    const dmat4 mirror = glm::scale(dmat4(1.0), math::dvec3(1.0, 1.0, -1.0));
    g.cameras.aheadIsPlusZ = true;
    for (dmat4* view : viewsOf(g))
        *view = mirror * *view;
    for (dmat4* clip : clipsOf(g))
        *clip = *clip * mirror;
}

/// Keeps part of the picture only, which the lens does not lie in the middle of.
void cutOut(Given& g, const VkRect2D& part) {
    g.part = part;
    g.inputs.width = part.extent.width;
    g.inputs.height = part.extent.height;
    const dvec2 whole(kCheckedWidth, kCheckedHeight);
    const dvec2 size(part.extent.width, part.extent.height);
    const dvec2 shift = (whole - 2.0 * dvec2(part.offset.x, part.offset.y)) / size - 1.0;
    const dmat4 partFromWhole = glm::translate(dmat4(1.0), math::dvec3(shift, 0.0)) *
                                glm::scale(dmat4(1.0), math::dvec3(whole / size, 1.0));
    for (dmat4* clip : clipsOf(g))
        *clip = partFromWhole * *clip;
}

/// Share of the time between the frames at a shutter time: 0 the previous frame, 1 this one.
double shareAt(const Given& g, double shutterTime) {
    return 1.0 - (g.inputs.rasterTime - shutterTime) * g.inputs.convention.scales.exposureShare;
}

/// Keys at these shutter times.
void giveKeysAt(Given& g, const std::vector<double>& times) {
    g.keys.clear();
    for (const double time : times) {
        g.keys.push_back(g.cameraAt(shareAt(g, time)));
        g.keys.back().time = time;
    }
}

/// A host that only lists movers of which it has matrices.
void dropDeforming(Given& g) {
    std::erase_if(g.listed, [](const auto& mover) { return mover.worldFromObject.empty(); });
}

/// A host of `resolved` without motion vectors, all of whose movers have matrices.
Change withoutVectors(Change change) {
    return resolved([change = std::move(change)](Given& g) {
        g.hasVectors = false;
        giveMatrices(g);
        dropDeforming(g);
        change(g);
    });
}

/// Draws a weapon before the world's lower right, which follows the camera, with a row of its own.
void drawWeapon(Given& g, std::optional<float> stored) {
    constexpr float kMetres = 0.4f;
    for (size_t i = 0; i < kCheckedPixels; ++i) {
        const size_t x = i % kCheckedWidth;
        const size_t y = i / kCheckedWidth;
        if (3 * x < 2 * kCheckedWidth || 2 * y < kCheckedHeight)
            continue;
        g.metres[i] = kMetres;
        g.depth[i] = stored.value_or(storeDepth(g.cameras.clipFromView, kMetres));
        g.motion[i] = {};
        g.ids[i] = g.rowCount;
    }
    ++g.rowCount;
}

/// Other ids in each frame.
void changeIds(Given& g) {
    for (uint32_t& id : g.ids)
        if (id < g.rowCount)
            id = (id + uint32_t(g.frame)) % g.rowCount;
}

void listConventions(Cases& add) {
    add("texture coordinates taken for pixels",
        "as for texture coordinates that lead to this frame with y down: set "
        "pixelsPerUnit = (192, 108)",
        scaled({1.0f / kFloatWidth, 1.0f / kFloatHeight}));
    add("normalised coordinates taken for texture coordinates",
        "as for normalised device coordinates that lead to the frame before with y up: set "
        "pixelsPerUnit = (-96, 54)",
        scaledAndDeclared({-2.0f / kFloatWidth, 2.0f / kFloatHeight}, {-kFloatWidth, -kFloatHeight})
    );
    add("the other way in time", "x is negated and y is negated", scaled({-1.0f, -1.0f}));
    add("y up",
        "y is negated, as for pixels that lead to this frame with y up: set "
        "pixelsPerUnit = (1, -1)",
        scaled({1.0f, -1.0f}));
    add("x left", "x is negated", scaled({-1.0f, 1.0f}));
    add("pixels of a smaller picture", "pixelsPerUnit = (1.5, 1.5)", scaled(glm::vec2(1.0f / 1.5f))
    );
    add("axes exchanged", "after x and y are exchanged", [](Given& g) {
        for (glm::vec2& vector : g.motion)
            vector = {vector.y, vector.x};
    });
    add("over the exposure already",
        "1 / exposureShare: they are over the exposure already, set exposureShare = 1",
        scaled(glm::vec2(0.4f)));
    add("without the camera's part", "set vectorsLackCamera = true", keepObjectsOnly);
    add("with the camera's part, declared to be without",
        "set vectorsLackCamera = false",
        [](Given& g) { g.inputs.convention.vectors.lackCamera = true; });
    add("vectors of the frame before", "vectors are those of the frame before", [](Given& g) {
        g.motion = g.before->motion;
    });
    add("vectors to the next frame", "vectors lead from this frame to the next one", [](Given& g) {
        const motion_blur::HostCameras& next = g.after->cameras;
        for (size_t i = 0; i < kCheckedPixels; ++i)
            if (g.metres[i] < shader::kSkyDepth)
                g.motion[i] = seeFrom(g, i, next.viewFromWorld, next.clipFromView) - placeOf(i);
    });
    add("the same camera twice", "cameras.viewFromWorldBefore is not: set it", [](Given& g) {
        g.cameras.viewFromWorldBefore = g.cameras.viewFromWorld;
    });
    add("the camera's place for its view", "world from view", invertViews);
    add("a projection with y up",
        "the second row of cameras.clipFromView is negated",
        scaleLens({1.0, -1.0}));
    add("jitter left in, and reported", "set vectorsHaveJitter = true", leaveJitter);
    add("jitter left in, and not reported",
        "is temporal jitter left in the vectors?",
        [](Given& g) {
            leaveJitter(g);
            g.jitterPx = g.jitterPxBefore = dvec2(0.0);
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
        storeForwardDepth)
        .orthographicSentence = "cameras.clipFromView has";
    add("reversed depth, forward projection",
        "is reversed depth (far is 0), so give the reversed projection",
        declareForwardDepth)
        .orthographicSentence = "cameras.clipFromView has";
    add("the sky at the near plane", "set skyValue = 0", [](Given& g) {
        g.inputs.convention.depth.skyValue = 1.0f;
    });
    add("linear depth declared to be raw",
        "for linear depth set depthIsLinear = true",
        [](Given& g) { g.depth = g.metres; });
    add("centimetres", "set metresPerUnit = 0.01", storeLinearDepth(100.0f));
    add("negative depth", "store -z", storeLinearDepth(-1.0f));
    add("vectors far too long",
        "is longer than the picture's diagonal",
        scaledAndDeclared(glm::vec2(1.0f), {kFloatWidth, kFloatHeight}));
    add("a cut that is not reported", "is not the viewFromWorld of the frame before", turnAway);
}

void listValues(Cases& add) {
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
    add("ids that are no rows", "entityId is not below rowCount", resolved([](Given& g) {
            for (size_t i = 0; i < 40; ++i)
                g.ids[i] = g.rowCount + 5;
        }));
    add("ids that change", "an entity keeps its id", [](Given& g) {
        g.motion.assign(kCheckedPixels, {});
        for (uint32_t& id : g.ids)
            if (id < 0xFFFFFFFF)
                id = id * 3 + uint32_t(g.frame);
    }).isStatic = true;
    add("a mover that is not listed", "but is not in movers", resolved([](Given& g) {
            g.listed.clear();
        })
    ).needsMovers = true;
}

void listKeys(Cases& add) {
    add("keys that run backwards", "keys run backwards", resolved([](Given& g) {
            giveKeysAt(g, {0.0, 1.0});
            std::swap(g.keys[0].viewFromWorld, g.keys[1].viewFromWorld);
        }));
    add("keys that run backwards around the raster instant",
        "keys run backwards",
        resolved([](Given& g) {
            g.inputs.rasterTime = 0.5;
            giveKeysAt(g, {0.0, 0.5});
            // The same distance ahead of the raster as behind it.
            const dmat4 ahead = g.keys[1].viewFromWorld * glm::inverse(g.keys[0].viewFromWorld) *
                                g.keys[1].viewFromWorld;
            g.keys.push_back({1.0, g.keys[0].viewFromWorld, g.keys[0].clipFromView});
            g.keys[0].viewFromWorld = ahead;
        }));
    add("keys that are all this frame's",
        "keys do not move in the exposure",
        resolved([](Given& g) {
            giveKeysAt(g, {0.0, 1.0});
            g.keys[0].viewFromWorld = g.keys[1].viewFromWorld;
        }));
    add("keys over the frame in place of the exposure",
        "keys go over the whole time between the frames",
        resolved([](Given& g) {
            giveKeys(g);
            g.keys.front().time = 0.0;
        }));
    add("keys of the frame before", "keys are those of the frame before", resolved([](Given& g) {
            giveKeysAt(g, {0.0, 1.0});
            if (g.frame == 0)
                return;
            for (motion_blur::HostCameraKey& key : g.keys) {
                const double time = key.time;
                key = g.before->cameraAt(shareAt(g, time));
                key.time = time;
            }
        }));
    add("a raster at the end, declared to be in the middle",
        "set rasterTime = 1",
        resolved([](Given& g) {
            giveKeysAt(g, {0.0, 0.5, 1.0});
            g.inputs.rasterTime = 0.5;
        }));
    add("keys that are the camera's place",
        "keys hold the camera's own place (world from view)",
        resolved([](Given& g) {
            giveKeys(g);
            for (motion_blur::HostCameraKey& key : g.keys)
                key.viewFromWorld = glm::inverse(key.viewFromWorld);
        }));
    add("history that is never used",
        "followsLast is false, although 2 recordings of view 0 in a row",
        resolved([](Given& g) { g.inputs.motion.followsLast = false; }));
}

/// Each matrix of each mover by its key.
template <class Change> void changeMatrices(Given& g, const Change& change) {
    for (std::vector<dmat4>& matrices : g.matrices)
        for (size_t key = 0; key < matrices.size(); ++key)
            matrices[key] = change(matrices[key], key);
}

void listMatrices(Cases& add) {
    const auto addBoth = [&](const char* name, const char* sentence, const Change& change) {
        add(name, sentence, resolved(change)).needsMovers = true;
        add(std::string(name) + ", without vectors", sentence, withoutVectors(change)).needsMovers =
            true;
    };
    addBoth("matrices of object from world", "is inverted (object from world)", [](Given& g) {
        changeMatrices(g, [](const dmat4& m, size_t) { return glm::inverse(m); });
    });
    addBoth("matrices that are all this frame's", "is the same at all keys", [](Given& g) {
        for (std::vector<dmat4>& matrices : g.matrices)
            matrices.front() = matrices.back();
    });
    addBoth("matrices of view from object", "is in view space", [](Given& g) {
        changeMatrices(g, [&](const dmat4& m, size_t key) {
            return g.keys[key].viewFromWorld * m;
        });
    });
    CheckCase& late =
        add("matrices of the frame before", "is that of the frame before", resolved([](Given& g) {
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
            }));
    late.needsMovers = late.isUneven = true;
}

void listAgainstTheLastFrame(Cases& add) {
    add("a projection with y up, without vectors",
        "the second row of cameras.clipFromView is negated",
        withoutVectors(scaleLens({1.0, -1.0})));
    add("the camera's place for its view, without vectors",
        "world from view",
        withoutVectors(invertViews));
    add("another field of view, without vectors",
        "the last frame's depth agrees with the cameras if cameras.clipFromView ",
        withoutVectors(scaleLens(dvec2(kOtherLens))));
    add("centimetres, without vectors",
        "set metresPerUnit = 0.01",
        withoutVectors(storeLinearDepth(100.0f)));
    add("ids that change while the camera moves, without vectors",
        "an entity keeps its id",
        resolved([](Given& g) {
            g.hasVectors = false;
            g.listed.clear();
            changeIds(g);
        }));
    add("a weapon that follows the camera, without vectors",
        "stays where it is in the picture",
        withoutVectors([](Given& g) { drawWeapon(g, {}); }));
    add("a weapon in a range of depth that the camera does not have",
        "is of no surface before the camera",
        withoutVectors([](Given& g) { drawWeapon(g, -0.5f); }));
    const char* const either =
        "cameras.clipFromView ha"; // s another field of view; d an aspect ratio of
    add("another field of view",
        "the cameras if cameras.clipFromView had a field of view of",
        scaleLens(dvec2(kOtherLens)))
        .orthographicSentence = either;
    add("another aspect ratio",
        "the cameras if cameras.clipFromView had an aspect ratio of",
        scaleLens({kOtherLens, 1.0}))
        .orthographicSentence = either;
    add("depth that is a hundred times as far",
        "set metresPerUnit = 1",
        storeLinearDepth(1.0f, 100.0f));
    add("ids that change while the camera moves", "an entity keeps its id", changeIds);
    add("vectors that are turned by 50 degrees",
        "px off from what the cameras imply at",
        resolved([](Given& g) {
            const double angle = glm::radians(50.0);
            const glm::dmat2 turn(
                std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle)
            );
            for (glm::vec2& vector : g.motion)
                vector = glm::vec2(turn * dvec2(vector));
        }));
}

void listRightVectors(Cases& add) {
    const Change texture = scaledAndDeclared(
        {-1.0f / kFloatWidth, -1.0f / kFloatHeight}, {-kFloatWidth, -kFloatHeight}
    );
    add("pixels, reversed depth", [](Given&) {});
    add("texture coordinates to the frame before", texture);
    add("normalised coordinates, y up",
        scaledAndDeclared(
            {2.0f / kFloatWidth, -2.0f / kFloatHeight}, {kFloatWidth / 2.0f, kFloatHeight / -2.0f}
        ));
    add("half floats", [](Given& g) { g.vectorFormat = VK_FORMAT_R16G16_SFLOAT; });
    add("half floats of texture coordinates", [texture](Given& g) {
        g.vectorFormat = VK_FORMAT_R16G16_SFLOAT;
        texture(g);
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
    add("no vectors, so that only the camera moves", resolved([](Given& g) {
            g.hasVectors = false;
            g.listed.clear();
        }));
    add("vectors of no sky", [](Given& g) {
        for (size_t i = 0; i < kCheckedPixels; ++i)
            if (g.metres[i] >= shader::kSkyDepth)
                g.motion[i] = {};
    });
    add("jitter left in, and declared to be", [](Given& g) {
        leaveJitter(g);
        g.inputs.convention.vectors.haveJitter = true;
    });
    add("jitter taken out, and reported", declareJitter);
}

void listRightDepthAndCameras(Cases& add) {
    add("forward depth", [](Given& g) {
        storeForwardDepth(g);
        declareForwardDepth(g);
    });
    add("linear depth in centimetres", storeLinearDepth(100.0f, 0.01f));
    add("linear depth in half floats", [](Given& g) {
        storeLinearDepth(1.0f)(g);
        g.depthFormat = VK_FORMAT_R16_SFLOAT; // infinity for the background
    });
    add("depth of 16 bits", [](Given& g) { g.depthFormat = VK_FORMAT_D16_UNORM; });
    add("a view along +Z", lookAlongPlusZ);
    add("a lens that is shifted", [](Given& g) { cutOut(g, {{64, 36}, {128, 72}}); });
    add("no cameras", [](Given& g) {
        g.cameras = {};
        storeLinearDepth(1.0f)(g);
    });
    add("nothing moves", [](Given& g) { g.motion.assign(kCheckedPixels, {}); }).isStatic = true;
    add("a cut, and reported", [](Given& g) {
        turnAway(g);
        g.inputs.convention.scales.isCut = g.frame > 0;
    });
}

void listRightImagesAndMethods(Cases& add) {
    add("parts of larger images", [](Given& g) { g.isSurrounded = true; });
    add("vectors and depth at half the size", [](Given& g) { g.coarseness = 2; });
    add("parts at half the size", [](Given& g) {
        g.coarseness = 2;
        g.isSurrounded = true;
    });
    const Change layered = [](Given& g) { g.layer = g.inputs.motion.view; };
    add("two eyes in layers", layered).viewCount = 2;
    add("two eyes in layers, resolved", resolved(layered)).viewCount = 2;
    add("one image of vectors and depth", [](Given& g) { g.isNative = true; });
    add("the same, over half of the time between the cameras", [](Given& g) {
        g.isNative = true;
        scaled({0.5f, 0.5f})(g);
    });
    add("one image of vectors and depth, resolved", resolved([](Given& g) {
            g.isNative = true;
            g.keys = {
                {0.0, g.cameras.viewFromWorldBefore, g.cameras.clipFromViewBefore},
                {1.0, g.cameras.viewFromWorld, g.cameras.clipFromView}};
        }));
    add("resolved, with each mover listed", resolved([](Given&) {}));
}

void listRightMotion(Cases& add) {
    // A camera and movers that are known at these shutter times; none: as a game knows them.
    const auto keyed = [](const std::vector<double>& times) {
        return [times](Given& g) {
            if (!times.empty())
                giveKeysAt(g, times);
            giveMatrices(g);
        };
    };
    const auto keyedWithoutVectors = [&](const std::vector<double>& times) {
        return resolved([give = keyed(times)](Given& g) {
            g.hasVectors = false;
            give(g);
            dropDeforming(g);
        });
    };
    add("movers by the two frames that a game knows", resolved(keyed({})));
    add("the same without vectors", keyedWithoutVectors({}));
    add("movers by exact keys", resolved(keyed({0.0, 1.0})));
    add("movers by exact keys, without vectors", keyedWithoutVectors({0.0, 0.5, 1.0}));
    add("movers in frames of uneven length", resolved(keyed({}))).isUneven = true;
    add("a sky that no value marks", resolved([](Given& g) {
            g.hasVectors = g.hasIds = false;
            g.listed.clear();
            g.inputs.convention.depth.skyValue = std::nanf("");
        }));
    add("a weapon that follows the camera, declared by its depth", resolved([](Given& g) {
            g.hasVectors = g.hasIds = false;
            g.listed.clear();
            const float least = storeDepth(g.cameras.clipFromView, 0.5f);
            drawWeapon(g, {});
            g.inputs.convention.viewModel.depthMin = least;
            g.inputs.convention.viewModel.depthMax = 1.0f;
        }));
    add("one world, without ids, vectors and movers", resolved([](Given& g) {
            g.hasVectors = g.hasIds = false;
            g.listed.clear();
        }));
    add("a raster in the middle of the exposure", resolved([](Given& g) {
            g.inputs.rasterTime = 0.5;
            giveKeysAt(g, {0.0, 0.5});
        }));
    add("rows in another order in each frame, and their ids", resolved([](Given& g) {
            g.rowIds.resize(g.rowCount);
            const auto rowOf = [&](uint32_t row) { return (row + uint32_t(g.frame)) % g.rowCount; };
            for (uint32_t row = 0; row < g.rowCount; ++row)
                g.rowIds[rowOf(row)] = row + 1000;
            for (uint32_t& id : g.ids)
                id = id < g.rowCount ? rowOf(id) : id;
            for (motion_blur::HostMover& mover : g.listed)
                mover.row = rowOf(mover.row);
        }));
    add("no history, by the settings", resolved([](Given& g) {
            g.history = false;
            g.inputs.motion.followsLast = false;
        }));
    add("a first frame that has none before it", resolved([](Given& g) {
            giveMatrices(g);
            if (g.frame == 0)
                g.cutFromLast();
        }));
}

} // namespace

void GivenFrame::cutFromLast() {
    inputs.convention.scales.isCut = true;
    cameras.viewFromWorldBefore = cameras.clipFromViewBefore = dmat4(0.0);
    keys.front().viewFromWorld = keys.front().clipFromView = dmat4(0.0);
    for (std::vector<dmat4>& own : matrices)
        own.front() = dmat4(0.0);
}

void giveKeys(GivenFrame& given) {
    const motion_blur::HostCameras& cameras = given.cameras;
    given.keys = {
        {motion_blur::timeOfFrameBefore(given.inputs),
         cameras.viewFromWorldBefore,
         cameras.clipFromViewBefore},
        {given.inputs.rasterTime, cameras.viewFromWorld, cameras.clipFromView}};
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

void giveMatricesOnly(GivenFrame& given) {
    giveMatrices(given);
    dropDeforming(given);
}

const std::vector<CheckCase>& listMistakes() {
    static const std::vector<CheckCase> kCases = [] {
        Cases add;
        for (const auto list :
             {listConventions, listValues, listKeys, listMatrices, listAgainstTheLastFrame})
            list(add);
        return add.all;
    }();
    return kCases;
}

const std::vector<CheckCase>& listRightHosts() {
    static const std::vector<CheckCase> kCases = [] {
        Cases add;
        for (const auto list :
             {listRightVectors,
              listRightDepthAndCameras,
              listRightImagesAndMethods,
              listRightMotion})
            list(add);
        return add.all;
    }();
    return kCases;
}

} // namespace shutter::test
