// SPDX-License-Identifier: MIT
// The checker finds what a host gets wrong, on real scenes under a moving camera, and says nothing
// of hosts that are right, whatever their convention.
#include "assets/generator/scenes.h"
#include "engine/extract/frame_view.h"
#include "engine/flythrough/flythrough.h"
#include "engine/gpu/frame.h"
#include "engine/render/renderer.h"
#include "engine/scene/exposure_motion.h"
#include "game/options/shot_arguments.h"
#include "game/shot/shot.h"
#include "tests/gpu/embedding_host.h"
#include "tests/gpu/host_texels.h"
#include "tests/support/picture.h"

#include <fmt/format.h>

#include <deque>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <ostream>
#include <set>
#include <string>
#include <unistd.h>
#include <vector>

namespace shutter {
namespace {

namespace fs = std::filesystem;
using math::dmat4;
using math::dvec2;
using motion_blur::HostConvention;
using motion_blur::HostInputs;
using test::HostTexels;

constexpr uint32_t kWidth = 192;
constexpr uint32_t kHeight = 108;
constexpr size_t kPixels = size_t{kWidth} * kHeight;
constexpr double kFrameSeconds = 1.0 / 30.0;
constexpr float kSky = 1.0e9f;

/// A frame of a scene as the engine's raster has it.
struct Drawn {
    std::vector<glm::vec4> color{kPixels};
    std::vector<glm::vec2> motion{kPixels}; ///< pixels since the frame before
    std::vector<float> metres = std::vector<float>(kPixels);
    std::vector<uint32_t> ids = std::vector<uint32_t>(kPixels);
    motion_blur::HostCameras cameras; ///< reversed infinite
    uint32_t rowCount = 0;
    std::vector<uint32_t> movers; ///< rows that move
};

/// What a host hands in, to be changed into what it gets wrong.
struct Given : Drawn {
    std::vector<float> depth; ///< as stored
    HostInputs inputs;
    std::vector<motion_blur::HostMover> listed;
    std::vector<motion_blur::HostCameraKey> keys;
    glm::dvec2 jitterPx{0.0};
    glm::dvec2 jitterPxBefore{0.0};
    bool isResolved = false;
    bool hasVectors = true;
};

using Change = std::function<void(Given&, int frame, const Drawn& before, const Drawn& after)>;

struct Case {
    std::string name;
    std::string sentence; ///< part of one; empty: none may come
    Change change;
    bool isStill = false; ///< the camera stands still in all frames
};

struct SceneCase {
    std::string name;
    generator::GltfWriter (*build)(); ///< null: a file of the shared scenes
    std::string path;                 ///< of that, or the keys' camera
    std::string keys;                 ///< of a flythrough
};

dvec2 placeOf(size_t i) {
    return {double(i % kWidth) + 0.5, double(i / kWidth) + 0.5};
}

/// Where another camera sees what a pixel shows.
dvec2 seeFrom(const Drawn& drawn, size_t i, const dmat4& view, const dmat4& clip) {
    const dvec2 ndc = placeOf(i) / dvec2(kWidth, kHeight) * 2.0 - 1.0;
    const double metres = drawn.metres[i];
    const dmat4& own = drawn.cameras.clipFromView;
    const glm::dvec4 eye(ndc.x * metres / own[0].x, ndc.y * metres / own[1].y, -metres, 1.0);
    const glm::dvec4 seen = clip * (view * (glm::inverse(drawn.cameras.viewFromWorld) * eye));
    return (dvec2(seen) / seen.w + 1.0) * 0.5 * dvec2(kWidth, kHeight);
}

void scaleVectors(Given& given, const glm::vec2& factor) {
    for (glm::vec2& vector : given.motion)
        vector *= factor;
}

void makeForward(Given& given, bool isDeclared) {
    const double near = given.cameras.clipFromView[3].z; // reversed, infinite
    const double far = 200.0;
    for (size_t i = 0; i < kPixels; ++i)
        given.depth[i] =
            given.metres[i] >= kSky
                ? 1.0f
                : float(far / (far - near) - near * far / ((far - near) * given.metres[i]));
    if (!isDeclared)
        return;
    for (dmat4* clip : {&given.cameras.clipFromView, &given.cameras.clipFromViewBefore}) {
        (*clip)[2].z = -far / (far - near);
        (*clip)[3].z = -near * far / (far - near);
    }
    given.inputs.convention.depth.skyValue = 1.0f;
}

const dvec2 kJitters[3] = {{0.31, -0.22}, {-0.4, 0.13}, {0.12, 0.44}};

/// Draws with another jitter in each frame, which is left in the vectors.
void leaveJitter(Given& given, int frame) {
    given.jitterPx = kJitters[frame];
    given.jitterPxBefore = kJitters[(frame + 2) % 3];
    const glm::vec2 more(given.jitterPxBefore - given.jitterPx);
    for (size_t i = 0; i < kPixels; ++i)
        if (given.metres[i] < kSky)
            given.motion[i] += more;
}

const std::vector<Case>& listWrong() {
    static const std::vector<Case> kCases{
        {"texture coordinates taken for pixels",
         "as for texture coordinates that lead to this frame with y down: set "
         "vectors.pixelsPerUnit = (192, 108)",
         [](Given& g, int, const Drawn&, const Drawn&) {
             scaleVectors(g, {1.0f / kWidth, 1.0f / kHeight});
         }},
        {"normalised coordinates taken for texture coordinates",
         "as for normalised device coordinates that lead to the frame before with y up: set "
         "vectors.pixelsPerUnit = (-96, 54)",
         [](Given& g, int, const Drawn&, const Drawn&) {
             scaleVectors(g, {-2.0f / kWidth, 2.0f / kHeight});
             g.inputs.convention.vectors.pixelsPerUnit = {-float(kWidth), -float(kHeight)};
         }},
        {"the other way in time",
         "x is negated and y is negated",
         [](Given& g, int, const Drawn&, const Drawn&) {
             scaleVectors(g, {-1.0f, -1.0f});
         }},
        {"y up",
         "y is negated, as for pixels that lead to this frame with y up: set "
         "vectors.pixelsPerUnit = (1, -1)",
         [](Given& g, int, const Drawn&, const Drawn&) {
             scaleVectors(g, {1.0f, -1.0f});
         }},
        {"x left",
         "x is negated",
         [](Given& g, int, const Drawn&, const Drawn&) {
             scaleVectors(g, {-1.0f, 1.0f});
         }},
        {"axes exchanged",
         "after x and y are exchanged",
         [](Given& g, int, const Drawn&, const Drawn&) {
             for (glm::vec2& vector : g.motion)
                 vector = {vector.y, vector.x};
         }},
        {"over the exposure already",
         "1 / exposureShare: they are over the exposure already, set scales.exposureShare = 1",
         [](Given& g, int, const Drawn&, const Drawn&) {
             scaleVectors(g, {0.4f, 0.4f});
         }},
        {"without the camera's part",
         "set vectors.haveCamera = false",
         [](Given& g, int, const Drawn&, const Drawn&) {
             std::vector<bool> moves(g.rowCount);
             for (const uint32_t row : g.movers)
                 moves[row] = true;
             for (size_t i = 0; i < kPixels; ++i)
                 if (g.ids[i] >= g.rowCount || !moves[g.ids[i]])
                     g.motion[i] = {};
         }},
        {"with the camera's part, said to be without",
         "set vectors.haveCamera = true",
         [](Given& g, int, const Drawn&, const Drawn&) {
             g.inputs.convention.vectors.haveCamera = false;
         }},
        {"vectors of the frame before",
         "vectors are those of the frame before",
         [](Given& g, int, const Drawn& before, const Drawn&) { g.motion = before.motion; }},
        {"vectors to the next frame",
         "vectors lead from this frame to the next one",
         [](Given& g, int, const Drawn&, const Drawn& after) {
             for (size_t i = 0; i < kPixels; ++i)
                 if (g.metres[i] < kSky)
                     g.motion[i] =
                         seeFrom(g, i, after.cameras.viewFromWorld, after.cameras.clipFromView) -
                         placeOf(i);
         }},
        {"the same camera twice",
         "cameras.viewFromWorldBefore is not: set it",
         [](Given& g, int, const Drawn&, const Drawn&) {
             g.cameras.viewFromWorldBefore = g.cameras.viewFromWorld;
         }},
        {"the camera's place for its view",
         "world from view",
         [](Given& g, int, const Drawn&, const Drawn&) {
             g.cameras.viewFromWorld = glm::inverse(g.cameras.viewFromWorld);
             g.cameras.viewFromWorldBefore = glm::inverse(g.cameras.viewFromWorldBefore);
         }},
        {"a projection with y up",
         "the second row of cameras.clipFromView is negated",
         [](Given& g, int, const Drawn&, const Drawn&) {
             for (dmat4* clip : {&g.cameras.clipFromView, &g.cameras.clipFromViewBefore})
                 for (int column = 0; column < 4; ++column)
                     (*clip)[column].y = -(*clip)[column].y;
         }},
        {"jitter left in, and told",
         "set vectors.haveJitter = true",
         [](Given& g, int frame, const Drawn&, const Drawn&) { leaveJitter(g, frame); }},
        {"jitter left in, and not told",
         "is temporal jitter left in the vectors?",
         [](Given& g, int frame, const Drawn&, const Drawn&) {
             leaveJitter(g, frame);
             g.jitterPx = g.jitterPxBefore = dvec2(0.0);
         }},
        {"jitter said to be left in",
         "set vectors.haveJitter = false",
         [](Given& g, int frame, const Drawn&, const Drawn&) {
             g.jitterPx = kJitters[frame];
             g.jitterPxBefore = kJitters[(frame + 2) % 3];
             g.inputs.convention.vectors.haveJitter = true;
         }},
        {"forward depth, reversed projection",
         "is forward depth (far is 1), so give the forward projection",
         [](Given& g, int, const Drawn&, const Drawn&) { makeForward(g, false); }},
        {"reversed depth, forward projection",
         "is reversed depth (far is 0), so give the reversed projection",
         [](Given& g, int, const Drawn&, const Drawn&) {
             const std::vector<float> depth = g.depth;
             makeForward(g, true);
             g.depth = depth;
         }},
        {"the sky at the near plane",
         "set depth.skyValue = 0",
         [](Given& g, int, const Drawn&, const Drawn&) {
             g.inputs.convention.depth.skyValue = 1.0f;
         }},
        {"linear depth said to be raw",
         "for linear depth set depth.isRaw = false",
         [](Given& g, int, const Drawn&, const Drawn&) { g.depth = g.metres; }},
        {"centimetres",
         "set depth.metresPerUnit = 0.01",
         [](Given& g, int, const Drawn&, const Drawn&) {
             for (size_t i = 0; i < kPixels; ++i)
                 g.depth[i] = g.metres[i] >= kSky ? kSky : 100.0f * g.metres[i];
             g.inputs.convention.depth.isRaw = false;
             g.inputs.convention.depth.skyValue = kSky;
         }},
        {"negative depth",
         "store -z",
         [](Given& g, int, const Drawn&, const Drawn&) {
             for (size_t i = 0; i < kPixels; ++i)
                 g.depth[i] = -g.metres[i];
             g.inputs.convention.depth.isRaw = false;
             g.inputs.convention.depth.skyValue = kSky;
         }},
        {"a depth image that was only cleared",
         "at every pixel",
         [](Given& g, int, const Drawn&, const Drawn&) { g.depth.assign(kPixels, 0.5f); }},
        {"NaN in the colour",
         "color holds NaN at 2 pixels",
         [](Given& g, int, const Drawn&, const Drawn&) {
             g.color[77].y = g.color[3000].x = std::nanf("");
         }},
        {"infinity in the colour",
         "color holds infinity at 1 pixel",
         [](Given& g, int, const Drawn&, const Drawn&) { g.color[77].z = HUGE_VALF; }},
        {"negative colour",
         "color is negative at 300 pixels",
         [](Given& g, int, const Drawn&, const Drawn&) {
             for (size_t i = 0; i < 300; ++i)
                 g.color[i] = {0.5f, -0.25f, 0.0f, 1.0f};
         }},
        {"NaN in the vectors",
         "convention.vectors.image holds NaN at 1 pixel",
         [](Given& g, int, const Drawn&, const Drawn&) { g.motion[9].x = std::nanf(""); }},
        {"NaN in the depth",
         "convention.depth.image holds NaN at 1 pixel",
         [](Given& g, int, const Drawn&, const Drawn&) { g.depth[9] = std::nanf(""); }},
        {"vectors far too long",
         "is longer than the picture's diagonal",
         [](Given& g, int, const Drawn&, const Drawn&) {
             g.inputs.convention.vectors.pixelsPerUnit = {float(kWidth), float(kHeight)};
         }},
        {"ids that are no rows",
         "entityId is not below motion.rowCount",
         [](Given& g, int, const Drawn&, const Drawn&) {
             g.isResolved = true;
             for (size_t i = 0; i < 40; ++i)
                 g.ids[i] = g.rowCount + 5;
         }},
        {"ids that change",
         "an entity keeps its id",
         [](Given& g, int frame, const Drawn&, const Drawn&) {
             g.motion.assign(kPixels, {});
             for (uint32_t& id : g.ids)
                 if (id < 0xFFFFFFFF)
                     id = id * 3 + uint32_t(frame);
         },
         true},
        {"a mover that is not listed",
         "but is not in motion.movers",
         [](Given& g, int, const Drawn&, const Drawn&) {
             g.isResolved = true;
             g.listed.clear();
         }},
        {"a cut that is not told",
         "is not the viewFromWorld of the frame before",
         [](Given& g, int frame, const Drawn&, const Drawn&) {
             g.inputs.frameNumber = frame + 1;
             const dmat4 turn = glm::rotate(dmat4(1.0), 0.3 * frame, math::dvec3(0.0, 1.0, 0.0));
             g.cameras.viewFromWorld *= turn;
             g.cameras.viewFromWorldBefore *= turn;
         }}};
    return kCases;
}

const std::vector<Case>& listRight() {
    static const std::vector<Case> kCases{
        {"pixels, reversed infinite depth", "", [](Given&, int, const Drawn&, const Drawn&) {}},
        {"texture coordinates to the frame before",
         "",
         [](Given& g, int, const Drawn&, const Drawn&) {
             scaleVectors(g, {-1.0f / kWidth, -1.0f / kHeight});
             g.inputs.convention.vectors.pixelsPerUnit = {-float(kWidth), -float(kHeight)};
         }},
        {"normalised coordinates, y up",
         "",
         [](Given& g, int, const Drawn&, const Drawn&) {
             scaleVectors(g, {2.0f / kWidth, -2.0f / kHeight});
             g.inputs.convention.vectors.pixelsPerUnit = {kWidth / 2.0f, kHeight / -2.0f};
         }},
        {"over the exposure, and said to be",
         "",
         [](Given& g, int, const Drawn&, const Drawn&) {
             g.inputs.convention.scales.exposureShare = 1.0f;
         }},
        {"without the camera's part, and said to be",
         "",
         [](Given& g, int, const Drawn&, const Drawn&) {
             g.inputs.convention.vectors.haveCamera = false;
             std::vector<bool> moves(g.rowCount);
             for (const uint32_t row : g.movers)
                 moves[row] = true;
             for (size_t i = 0; i < kPixels; ++i)
                 if (g.ids[i] >= g.rowCount || !moves[g.ids[i]])
                     g.motion[i] = {};
         }},
        {"no vectors, so that only the camera moves",
         "",
         [](Given& g, int, const Drawn&, const Drawn&) {
             g.hasVectors = false;
             g.isResolved = true;
             g.listed.clear();
         }},
        {"forward depth with a far plane",
         "",
         [](Given& g, int, const Drawn&, const Drawn&) { makeForward(g, true); }},
        {"linear depth in centimetres",
         "",
         [](Given& g, int, const Drawn&, const Drawn&) {
             for (size_t i = 0; i < kPixels; ++i)
                 g.depth[i] = g.metres[i] >= kSky ? kSky : 100.0f * g.metres[i];
             g.inputs.convention.depth = {{}, false, 0.01f, kSky};
         }},
        {"jitter left in, and said to be",
         "",
         [](Given& g, int frame, const Drawn&, const Drawn&) {
             leaveJitter(g, frame);
             g.inputs.convention.vectors.haveJitter = true;
         }},
        {"jitter taken out, and told",
         "",
         [](Given& g, int frame, const Drawn&, const Drawn&) {
             g.jitterPx = kJitters[frame];
             g.jitterPxBefore = kJitters[(frame + 2) % 3];
         }},
        {"nothing moves",
         "",
         [](Given& g, int, const Drawn&, const Drawn&) { g.motion.assign(kPixels, {}); },
         true},
        {"no cameras",
         "",
         [](Given& g, int, const Drawn&, const Drawn&) {
             g.cameras = {};
             g.depth = g.metres;
             g.inputs.convention.depth = {{}, false, 1.0f, kSky};
         }},
        {"resolved, with each mover listed",
         "",
         [](Given& g, int frame, const Drawn&, const Drawn&) {
             g.isResolved = true;
             g.inputs.motion.followsLast = frame > 0;
         }},
        {"vectors of no sky",
         "",
         [](Given& g, int, const Drawn&, const Drawn&) {
             for (size_t i = 0; i < kPixels; ++i)
                 if (g.metres[i] >= kSky)
                     g.motion[i] = {};
         }},
        {"a cut, and told", "", [](Given& g, int frame, const Drawn&, const Drawn&) {
             g.inputs.frameNumber = frame + 1;
             const dmat4 turn = glm::rotate(dmat4(1.0), 0.3 * frame, math::dvec3(0.0, 1.0, 0.0));
             g.cameras.viewFromWorld *= turn;
             g.cameras.viewFromWorldBefore *= turn;
             g.inputs.convention.scales.isCut = frame > 0;
         }}};
    return kCases;
}

void PrintTo(const SceneCase& scene, std::ostream* stream) {
    *stream << scene.name;
}

std::string makeKeys(const char* first, const char* second, const char* third) {
    return fmt::format(
        R"({{"version": 1, "name": "checked", "fps": 30, "keys": [)"
        R"({{"time": 0, {}, "fieldOfView": 40}}, {{"time": 0.0333, {}, "fieldOfView": 40}},)"
        R"({{"time": 0.1, {}, "fieldOfView": 40}}]}})",
        first,
        second,
        third
    );
}

std::vector<SceneCase> listScenes() {
    return {
        {"vase",
         &generator::buildVaseScene,
         {},
         makeKeys(
             R"("position": [-0.45, 1.3, 2.2], "lookAt": [-0.1, 0.87, 0])",
             R"("position": [-0.42, 1.28, 2.17], "lookAt": [-0.05, 0.84, 0])",
             R"("position": [0.1, 1.1, 1.8], "lookAt": [0.6, 0.5, 0])"
         )},
        {"courtyard",
         &generator::buildCourtyardScene,
         {},
         makeKeys(
             R"("position": [0.5, 1.7, 7.0], "lookAt": [0, 1.5, 0])",
             R"("position": [0.56, 1.75, 6.9], "lookAt": [0.12, 1.6, 0])",
             R"("position": [1.6, 2.3, 5.3], "lookAt": [2.2, 2.5, 0])"
         )},
        {"pink_room",
         nullptr,
         "pink-room/pink_room_lite_animated.glb",
         makeKeys(
             R"("position": [0.0, 1.5, 3.0], "lookAt": [0, 1.2, 0])",
             R"("position": [0.03, 1.52, 2.96], "lookAt": [0.05, 1.25, 0])",
             R"("position": [0.5, 1.8, 2.2], "lookAt": [0.9, 1.8, 0])"
         )}};
}

class EmbeddedChecker : public test::EmbeddedTest, public testing::WithParamInterface<SceneCase> {
  protected:
    void SetUp() override {
        EmbeddedTest::SetUp();
        if (IsSkipped() || HasFatalFailure())
            return;
        const SceneCase& scene = GetParam();
        fs::path file = fs::path(SHUTTER_SHARED_DIR) / "scenes" / scene.path;
        if (!scene.build && !fs::exists(file))
            GTEST_SKIP() << "the shared scenes are not there";
        if (scene.build) {
            file = fs::temp_directory_path() /
                   fmt::format("checker_{}_{}.glb", scene.name, ::getpid());
            ASSERT_EQ(scene.build().write(file), "");
        }
        load(file);
        if (scene.build)
            fs::remove(file);
        if (HasFatalFailure())
            return;
        render::Renderer renderer(device(), mShot->world.assets);
        for (int frame = 0; frame < 5; ++frame)
            draw(renderer, frame);
    }

    void load(const fs::path& file) {
        game::ShotArguments arguments;
        arguments.scene = file.string();
        arguments.unlit = true;
        arguments.shutter = game::makeShutterArguments(kFrameSeconds, "end");
        arguments.size = {kWidth, kHeight};
        auto options = game::interpret(arguments);
        ASSERT_TRUE(options.ok()) << options.error().message;
        mOptions = std::move(options).value();
        auto shot = game::loadShot(mOptions);
        ASSERT_TRUE(shot.ok()) << shot.error().message;
        mShot.emplace(std::move(shot).value());
        const auto flight = flythrough::parseFlythrough(GetParam().keys, "keys");
        ASSERT_TRUE(flight.ok()) << flight.error().message;
        const auto shutter = mShot->world.registry.get<scene::CameraShutter>(mShot->camera);
        mShot->camera = flythrough::addFlythroughCamera(mShot->world, flight.value());
        mShot->world.registry.add(mShot->camera, scene::CameraShutter(shutter));
    }

    void draw(render::Renderer& renderer, int frame) {
        render::FrameRequest request;
        request.view = game::makeView(*mShot, mOptions, frame * kFrameSeconds / 2.0 + 0.03);
        request.intermediates = {"motion", "mesh_id"};
        const auto result = renderer.renderFrame(mShot->world, request, {});
        ASSERT_TRUE(result.ok()) << result.error().message;
        Drawn& drawn = mDrawn.emplace_back();
        const image::Image& motion = result.value().intermediates.at("motion");
        const image::Image& ids = result.value().intermediates.at("mesh_id");
        for (size_t i = 0; i < kPixels; ++i) {
            std::memcpy(&drawn.color[i], &result.value().color.pixels[4 * i], sizeof(glm::vec4));
            drawn.motion[i] = {motion.pixels[4 * i], motion.pixels[4 * i + 1]};
            drawn.metres[i] = motion.pixels[4 * i + 2];
            const float id = ids.pixels[ids.channels * i];
            drawn.ids[i] = id < 0.0f ? 0xFFFFFFFFu : uint32_t(id);
            if (drawn.ids[i] != 0xFFFFFFFFu)
                drawn.rowCount = std::max(drawn.rowCount, drawn.ids[i] + 1);
        }
        tellCamera(request.view, drawn);
    }

    void tellCamera(const extract::ViewRequest& view, Drawn& drawn) {
        const scene::ExposureMotion moves(mShot->world, view.camera, view.exposure);
        const auto& camera = mShot->world.registry.get<scene::Camera>(view.camera);
        const auto viewAt = [&](double s) {
            return glm::inverse(extract::computeWorldFromView(moves.worldFromCamera(s)));
        };
        const auto clipAt = [&](double s) {
            return extract::makeProjection(camera, moves.cameraYFov(s), double(kWidth) / kHeight);
        };
        drawn.cameras.areGiven = true;
        drawn.cameras.viewFromWorld = viewAt(1.0);
        drawn.cameras.clipFromView = clipAt(1.0);
        drawn.cameras.viewFromWorldBefore = viewAt(0.0);
        drawn.cameras.clipFromViewBefore = clipAt(0.0);
    }

    /// Rows whose vectors are not the camera's: those of the animated parts.
    void findMovers(Given& given) {
        std::map<uint32_t, std::pair<int, int>> rows;
        for (size_t i = 0; i < kPixels; ++i) {
            if (given.metres[i] >= kSky || given.ids[i] >= given.rowCount)
                continue;
            const dvec2 place = placeOf(i);
            const dvec2 then = seeFrom(
                given, i, given.cameras.viewFromWorldBefore, given.cameras.clipFromViewBefore
            );
            auto& counts = rows[given.ids[i]];
            (glm::length(place - then - dvec2(given.motion[i])) > 0.25 ? counts.first
                                                                       : counts.second) += 1;
        }
        for (const auto& [row, counts] : rows)
            if (counts.first > counts.second)
                given.movers.push_back(row);
    }

    Given give(int frame, const Case& one) {
        Given given;
        static_cast<Drawn&>(given) = mDrawn[one.isStill ? 0 : size_t(2 * frame)];
        if (one.isStill)
            given.cameras.viewFromWorldBefore = given.cameras.viewFromWorld;
        for (const Drawn& drawn : mDrawn)
            given.rowCount = std::max(given.rowCount, drawn.rowCount);
        findMovers(given);
        const auto near = float(given.cameras.clipFromView[3].z);
        for (const float metres : given.metres)
            given.depth.push_back(metres >= kSky ? 0.0f : near / metres);
        given.inputs.width = kWidth;
        given.inputs.height = kHeight;
        HostConvention& convention = given.inputs.convention;
        convention.scales.exposureShare = 0.4f;
        for (const uint32_t row : given.movers)
            given.listed.push_back({row, {}});
        const Drawn& before = mDrawn[size_t(std::max(2 * frame - 2, 0))];
        const Drawn& after = mDrawn[size_t(std::min(2 * frame + 2, 4))];
        one.change(given, frame, before, after);
        convention.cameras = given.cameras;
        convention.cameras.jitterPx = given.jitterPx;
        convention.cameras.jitterPxBefore = given.jitterPxBefore;
        return given;
    }

    /// What the checker says of two frames.
    std::vector<std::string> check(const Case& one) {
        std::vector<std::string> told;
        motion_blur::HostDevice host = describeHost();
        host.checksInputs = true;
        host.message = [&](std::string_view sentence) { told.emplace_back(sentence); };
        auto blur = create(host);
        for (int frame = 0; frame < 3; ++frame) {
            Given given = give(frame, one);
            record(*blur, frame, given);
        }
        blur.reset(); // tells of the last ones
        return told;
    }

    void record(
        motion_blur::EmbeddedMotionBlur& blur,
        int frame,
        Given& given,
        const test::Picture* output = nullptr
    ) {
        std::vector<uint64_t> halves;
        for (const glm::vec4& color : given.color)
            halves.push_back(test::packHalf(color));
        std::deque<HostTexels> texels;
        constexpr VkExtent2D kExtent{kWidth, kHeight};
        const auto make = [&](VkFormat format, std::span<const std::byte> bytes) {
            return texels.emplace_back(device(), format, kExtent, bytes, VK_IMAGE_USAGE_STORAGE_BIT)
                .describe();
        };
        HostInputs& inputs = given.inputs;
        inputs.color = make(VK_FORMAT_R16G16B16A16_SFLOAT, test::bytesOf(halves));
        if (given.hasVectors)
            inputs.convention.vectors.image =
                make(VK_FORMAT_R32G32_SFLOAT, test::bytesOf(given.motion));
        inputs.convention.depth.image = make(VK_FORMAT_R32_SFLOAT, test::bytesOf(given.depth));
        inputs.entityId = make(VK_FORMAT_R32_UINT, test::bytesOf(given.ids));
        motion_blur::MotionBlurSettings settings = test::gather();
        const motion_blur::HostCameraKey key{
            1.0, given.cameras.viewFromWorld, given.cameras.clipFromView};
        if (given.isResolved) {
            settings.method = &motion_blur::getMethod("resolved");
            settings.sampleCount = 3;
            inputs.motion.keys = {&key, 1};
            inputs.motion.movers = given.listed;
            inputs.motion.rowCount = given.rowCount;
        }
        gpu::Frame commands(device());
        commands.begin();
        for (const HostTexels& one : texels)
            one.record(commands.commands());
        const core::Status done =
            blur.record(commands.commands(), uint32_t(frame % 2), inputs, settings);
        ASSERT_TRUE(done.ok()) << done.error().message;
        if (output)
            output->recordReadback(commands.commands());
        commands.submit();
        commands.wait();
    }

    game::ShotOptions mOptions;
    std::optional<game::Shot> mShot;
    std::deque<Drawn> mDrawn; ///< each half a frame after the one before
};

TEST_P(EmbeddedChecker, CostsNothingWhenOffAndChangesNoBit) {
    const Case& plain = listRight().front();
    motion_blur::HostDevice host = describeHost();
    const auto off = create(host);
    host.checksInputs = true;
    const auto on = create(host);
    const auto drawWith = [&](motion_blur::EmbeddedMotionBlur& blur,
                              std::set<std::string>& passes) {
        Given given = give(0, plain);
        given.inputs.observe = [&](graph::Graph& graph, const auto&, const auto&) {
            for (const graph::PassRecord& pass : graph.passes())
                passes.insert(pass.name);
        };
        const test::Picture output(device(), "output", {kWidth, kHeight});
        given.inputs.output = {output.handle(), test::kNothing, test::kCopied};
        record(blur, 0, given, &output);
        return output.read();
    };
    std::set<std::string> without;
    std::set<std::string> with;
    EXPECT_TRUE(test::sameBits(drawWith(*off, without), drawWith(*on, with)));
    for (const std::string& pass : without)
        EXPECT_EQ(pass.find("check"), std::string::npos) << pass;
    EXPECT_TRUE(with.contains("check picture") && with.contains("check ids"));
    // What the checker holds is made in the first frame.
    std::set<std::string> again;
    (void)drawWith(*on, again);
    const gpu::LivingObjects before = on->living();
    for (int i = 0; i < 3; ++i)
        (void)drawWith(*on, again);
    EXPECT_EQ(on->living(), before);
}

TEST_P(EmbeddedChecker, NamesEachMistake) {
    for (const Case& one : listWrong()) {
        SCOPED_TRACE(one.name);
        if (one.name == "a mover that is not listed" && give(0, one).movers.empty())
            continue; // none is in view
        std::string all;
        for (const std::string& sentence : check(one))
            all += sentence + "\n";
        EXPECT_NE(all.find(one.sentence), std::string::npos) << "said:\n" << all;
    }
}

TEST_P(EmbeddedChecker, SaysNothingOfWhatIsRight) {
    for (const Case& one : listRight()) {
        SCOPED_TRACE(one.name);
        for (const std::string& sentence : check(one))
            EXPECT_NE(sentence.find("is checked"), std::string::npos) << sentence;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes,
    EmbeddedChecker,
    testing::ValuesIn(listScenes()),
    [](const auto& scene) { return scene.param.name; }
);

} // namespace
} // namespace shutter
