// SPDX-License-Identifier: MIT
#include "tests/gpu/checker_host.h"

#include "assets/generator/demo_scenes.h"
#include "assets/generator/scenes.h"
#include "engine/scene/camera.h"
#include "engine/scene/exposure_motion.h"
#include "tests/gpu/checker_changes.h"
#include "tests/gpu/checker_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <utility>

namespace shutter::test {

namespace {

namespace fs = std::filesystem;
using math::dmat4;
using math::dvec2;

constexpr uint32_t kWidth = kCheckedWidth;
constexpr uint32_t kHeight = kCheckedHeight;
constexpr double kFrameSeconds = 1.0 / 30.0;
constexpr int kFrames = 3;
constexpr float kShare = 0.4f; ///< exposure over the time between the frames

bool isPerspective(const dmat4& clip) {
    return clip[3].w == 0.0;
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

/// A place beside the start of the rally's course.
/// \param along, right, up metres
math::dvec3 besideTheRoad(double along, double right, double up) {
    const generator::CoursePoint start = generator::findCoursePoint(0.0f);
    const dvec2 ahead(start.direction);
    const dvec2 at = dvec2(start.place) + along * ahead + right * dvec2(-ahead.y, ahead.x);
    return {at.x, up, at.y};
}

/// Drives the rally's car along the road.
void driveCar(scene::World& world) {
    const dvec2 ahead(generator::findCoursePoint(0.0f).direction);
    ecs::Entity car;
    for (auto [entity, name, place] : world.registry.view<scene::Name, scene::LocalTransform>()) {
        if (name.value != "car")
            continue;
        car = entity;
        place.transform.translation = besideTheRoad(0.0, 0.0, 0.0);
        place.transform.rotation =
            glm::angleAxis(std::atan2(-ahead.x, -ahead.y), math::dvec3(0.0, 1.0, 0.0));
    }
    world.registry.add(car, scene::LinearVelocity{14.0 * math::dvec3(ahead.x, 0.0, ahead.y)});
    world.registry.add(car, scene::AngularVelocity{{0.0, 1.2, 0.0}});
}

std::string makeRallyKeys() {
    // It speeds up, rises, and turns to the right.
    const auto key = [](double along) {
        const math::dvec3 at = besideTheRoad(along - 4.5, 2.2 - 0.5 * along, 1.5 + 0.3 * along);
        const math::dvec3 to = besideTheRoad(along + 1.5, 0.6 * along, 0.6 + 0.6 * along);
        return fmt::format(
            R"("position": [{}, {}, {}], "lookAt": [{}, {}, {}])",
            at.x,
            at.y,
            at.z,
            to.x,
            to.y,
            to.z
        );
    };
    return makeKeys(key(0.0).c_str(), key(0.4).c_str(), key(1.7).c_str());
}

/// Rows whose vectors are not the camera's: those of the animated parts.
std::vector<uint32_t> findMovers(const CheckedDrawing& drawn) {
    std::map<uint32_t, std::pair<int, int>> rows;
    for (size_t i = 0; i < kCheckedPixels; ++i) {
        if (drawn.metres[i] >= shader::kSkyDepth || drawn.ids[i] >= drawn.rowCount)
            continue;
        const dvec2 then =
            seeFrom(drawn, i, drawn.cameras.viewFromWorldBefore, drawn.cameras.clipFromViewBefore);
        auto& [moves, stands] = rows[drawn.ids[i]];
        (glm::length(placeOf(i) - then - dvec2(drawn.motion[i])) > 0.25 ? moves : stands) += 1;
    }
    std::vector<uint32_t> movers;
    for (const auto& [row, counts] : rows)
        if (counts.first > counts.second)
            movers.push_back(row);
    return movers;
}

/// Takes down which entities the rows of a frame are.
class RowTeller : public render::PostEffect {
  public:
    [[nodiscard]] std::string name() const override { return "rows"; }

    [[nodiscard]] core::Decision ask(const render::ViewFacts&) const override {
        return {true, "rows are taken down"};
    }

    void declare(render::PostContext& context) override {
        mEntities = context.frame.entityHandles;
        mDeforms.assign(mEntities.size(), false);
        for (const extract::DeformedEntity& one : context.frame.deformed)
            mDeforms[one.row] = true;
    }

    void
    tell(const scene::World& world, const extract::ViewRequest& view, CheckedDrawing& drawn) const {
        drawn.rowCount = uint32_t(mEntities.size());
        drawn.deforms = mDeforms;
        drawn.placeAt = [&world, view, entities = mEntities](uint32_t row, double share) {
            return scene::ExposureMotion(world, view.camera, view.exposure)
                .worldFromObject(entities[row], share);
        };
        drawn.cameraAt = [&world, view](double share) {
            const scene::ExposureMotion moves(world, view.camera, view.exposure);
            const auto& camera = world.registry.get<scene::Camera>(view.camera);
            return motion_blur::HostCameraKey{
                share,
                glm::inverse(moves.worldFromCamera(share)),
                extract::makeProjection(camera, moves.cameraYFov(share), view)};
        };
    }

  private:
    std::vector<ecs::Entity> mEntities;
    std::vector<bool> mDeforms;
};

} // namespace

void PrintTo(const CheckScene& scene, std::ostream* stream) {
    *stream << scene.name;
}

std::vector<CheckScene> listCheckScenes() {
    const std::string vase = makeKeys(
        R"("position": [-0.45, 1.3, 2.2], "lookAt": [-0.1, 0.87, 0])",
        R"("position": [-0.42, 1.28, 2.17], "lookAt": [-0.05, 0.84, 0])",
        R"("position": [0.1, 1.1, 1.8], "lookAt": [0.6, 0.5, 0])"
    );
    const std::string courtyard = makeKeys(
        R"("position": [0.5, 1.7, 7.0], "lookAt": [0, 1.5, 0])",
        R"("position": [0.56, 1.75, 6.9], "lookAt": [0.12, 1.6, 0])",
        R"("position": [1.6, 2.3, 5.3], "lookAt": [2.2, 2.5, 0])"
    );
    return {
        {"vase", &generator::buildVaseScene, {}, vase},
        {"courtyard", &generator::buildCourtyardScene, {}, courtyard},
        {"rally", &generator::buildRallyScene, {}, makeRallyKeys(), 0.0, false, &driveCar},
        {"pink_room",
         nullptr,
         "pink-room/pink_room_lite_animated.glb",
         makeKeys(
             R"("position": [0.0, 1.5, 3.0], "lookAt": [0, 1.2, 0])",
             R"("position": [0.03, 1.52, 2.96], "lookAt": [0.05, 1.25, 0])",
             R"("position": [0.5, 1.8, 2.2], "lookAt": [0.9, 1.8, 0])"
         )},
        {"orthographic_vase", &generator::buildVaseScene, {}, vase, 0.8},
        {"orthographic_courtyard", &generator::buildCourtyardScene, {}, courtyard, 2.5},
        {"morph", // a cube that grows: its vectors are linear in the place, as a camera's may be
         nullptr,
         "gltf-samples/AnimatedMorphCube/AnimatedMorphCube.glb",
         makeKeys(
             R"("position": [-2.3626, 1.8983, 1.1308], "lookAt": [0, 0, -0.003])",
             R"("position": [-2.3194, 1.8914, 1.1743], "lookAt": [0.0347, 0.0247, -0.0528])",
             R"("position": [-2.233, 1.8774, 1.2613], "lookAt": [0.1041, 0.074, -0.1525])"
         ),
         0.0,
         true},
        {"walker", // a man who fills the picture, under a camera that hardly moves
         nullptr,
         "gltf-samples/CesiumMan/CesiumMan.glb",
         makeKeys(
             R"("position": [-0.87134, 0.85725, 0.9604], "lookAt": [-0.04211, 0.74433, -0.0072])",
             R"("position": [-0.87139, 0.85844, 0.9587], "lookAt": [-0.04313, 0.74661, -0.00419])",
             R"("position": [-0.8715, 0.86083, 0.95529], "lookAt": [-0.04517, 0.75116, 0.00181])"
         ),
         0.0,
         true}};
}

dvec2 placeOf(size_t pixel) {
    return {double(pixel % kWidth) + 0.5, double(pixel / kWidth) + 0.5};
}

dvec2 seeFrom(const CheckedDrawing& drawn, size_t pixel, const dmat4& view, const dmat4& clip) {
    const dvec2 ndc = placeOf(pixel) / dvec2(kWidth, kHeight) * 2.0 - 1.0;
    const double metres = drawn.metres[pixel];
    const dmat4& own = drawn.cameras.clipFromView;
    const double spread = isPerspective(own) ? metres : 1.0;
    const glm::dvec4 eye(ndc.x * spread / own[0].x, ndc.y * spread / own[1].y, -metres, 1.0);
    const glm::dvec4 seen = clip * (view * (glm::inverse(drawn.cameras.viewFromWorld) * eye));
    return (dvec2(seen) / seen.w + 1.0) * 0.5 * dvec2(kWidth, kHeight);
}

float storeDepth(const dmat4& clip, float metres) {
    if (metres >= shader::kSkyDepth)
        return 0.0f;
    const glm::dvec4 seen = clip * glm::dvec4(0.0, 0.0, -double(metres), 1.0);
    return float(seen.z / seen.w);
}

void CheckerHost::SetUp() {
    EmbeddedTest::SetUp();
    if (IsSkipped() || HasFatalFailure())
        return;
    const CheckScene& scene = GetParam();
    if (!scene.build && !fs::exists(fs::path(SHUTTER_SHARED_DIR) / "scenes" / scene.path))
        GTEST_SKIP() << "the shared scenes are not there";
    auto shot = loadCheckedShot(scene, {kWidth, kHeight}, kFrameSeconds);
    ASSERT_TRUE(shot.ok()) << shot.error().message;
    mShot.emplace(std::move(shot).value());
    render::Renderer renderer(device(), mShot->shot.world.assets);
    for (int number = 0; number < 2 * kFrames; ++number)
        mDrawn.push_back(draw(renderer, number, 1.0));
    mUneven = draw(renderer, 2 * kFrames, 2.0);
    uint32_t rowCount = mUneven.rowCount;
    for (const CheckedDrawing& drawn : mDrawn)
        rowCount = std::max(rowCount, drawn.rowCount);
    for (CheckedDrawing& drawn : mDrawn)
        drawn.rowCount = rowCount;
    mUneven.rowCount = rowCount;
}

CheckedDrawing CheckerHost::draw(render::Renderer& renderer, int number, double frames) {
    render::FrameRequest request;
    request.view = game::makeView(mShot->shot, mShot->options, number * kFrameSeconds / 2.0 + 0.03);
    request.view.exposure.open = request.view.exposure.close - frames * kFrameSeconds;
    request.intermediates = {"motion", "mesh_id"};
    RowTeller teller;
    const std::array<render::PostEffect*, 1> effects{&teller};
    const auto result = renderer.renderFrame(mShot->shot.world, request, effects);
    CheckedDrawing drawn;
    EXPECT_TRUE(result.ok());
    if (!result)
        return drawn;
    teller.tell(mShot->shot.world, request.view, drawn);
    const image::Image& motion = result.value().intermediates.at("motion");
    const image::Image& ids = result.value().intermediates.at("mesh_id");
    for (size_t i = 0; i < kCheckedPixels; ++i) {
        std::memcpy(&drawn.color[i], &result.value().color.pixels[4 * i], sizeof(glm::vec4));
        drawn.motion[i] = {motion.pixels[4 * i], motion.pixels[4 * i + 1]};
        drawn.metres[i] = motion.pixels[4 * i + 2];
        const float id = ids.pixels[ids.channels * i];
        drawn.ids[i] = id < 0.0f ? 0xFFFFFFFFu : uint32_t(id);
        if (drawn.ids[i] != 0xFFFFFFFFu)
            drawn.rowCount = std::max(drawn.rowCount, drawn.ids[i] + 1);
    }
    drawn.cameras = tellCameras(mShot->shot.world, request.view);
    return drawn;
}

GivenFrame CheckerHost::give(int frame, const CheckCase& one, uint32_t view) const {
    const int last = int(mDrawn.size()) - 1;
    const int at = 2 * frame + int(view);
    const bool isLong = one.isUneven && frame + 1 == kFrames;
    GivenFrame given;
    static_cast<CheckedDrawing&>(given) = isLong ? mUneven : mDrawn[one.isStill ? 0 : size_t(at)];
    if (one.isStill)
        given.cameras.viewFromWorldBefore = given.cameras.viewFromWorld;
    given.movers = findMovers(given);
    for (const float metres : given.metres)
        given.depth.push_back(storeDepth(given.cameras.clipFromView, metres));
    given.inputs.width = kWidth;
    given.inputs.height = kHeight;
    given.inputs.motion.view = view;
    motion_blur::HostConvention& convention = given.inputs.convention;
    convention.scales.exposureShare = isLong ? kShare / 2.0f : kShare;
    given.inputs.motion.followsLast = frame > 0;
    for (const uint32_t row : given.movers)
        given.listed.push_back({row, {}});
    if (one.needsMovers || one.isUneven)
        giveMatrices(given);
    const CheckedDrawing& before = mDrawn[size_t(std::max(at - 2, 0))];
    const CheckedDrawing& after = mDrawn[size_t(std::min(at + 2, last))];
    one.change(given, frame, before, after);
    convention.cameras = given.cameras;
    convention.cameras.jitterPx = given.jitterPx;
    convention.cameras.jitterPxBefore = given.jitterPxBefore;
    return given;
}

std::vector<std::string> CheckerHost::check(const CheckCase& one) {
    std::vector<std::string> told;
    motion_blur::HostDevice host = describeHost();
    host.framesInFlight = 2 * one.viewCount;
    host.checksInputs = true;
    host.message = [&](std::string_view sentence) { told.emplace_back(sentence); };
    auto blur = create(host);
    for (uint32_t frame = 0; frame < kFrames; ++frame)
        for (uint32_t view = 0; view < one.viewCount; ++view) {
            GivenFrame given = give(int(frame), one, view);
            record(*blur, frame % 2 * one.viewCount + view, given);
        }
    blur.reset(); // tells of the last ones
    return told;
}

void CheckerHost::record(
    motion_blur::EmbeddedMotionBlur& blur, uint32_t number, GivenFrame& given, const Picture* output
) {
    CheckedImages images(device(), given);
    images.describe(given);
    motion_blur::MotionBlurSettings settings = gather();
    if (given.isResolved) {
        settings.method = &motion_blur::getMethod("resolved");
        settings.sampleCount = 3;
        settings.history = given.history;
        if (given.keys.empty())
            giveKeys(given);
        given.inputs.motion.keys = given.keys;
        given.inputs.motion.movers = given.listed;
        given.inputs.motion.rowCount = given.rowCount;
        given.inputs.motion.rowIds = given.rowIds;
    }
    gpu::Frame commands(device());
    commands.begin();
    images.record(commands.commands());
    const core::Status done = blur.record(commands.commands(), number, given.inputs, settings);
    ASSERT_TRUE(done.ok()) << done.error().message;
    if (output)
        output->recordReadback(commands.commands());
    commands.submit();
    commands.wait();
}

} // namespace shutter::test
