// SPDX-License-Identifier: MIT
#include "tests/gpu/checker_host.h"

#include "assets/generator/demo_scenes.h"
#include "assets/generator/scenes.h"
#include "engine/flythrough/flythrough.h"
#include "engine/scene/camera.h"
#include "engine/scene/exposure_motion.h"
#include "tests/kit/sweep.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
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

/// A place next to the start of the rally's course.
/// \param along, right, up metres
math::dvec3 offTheRoad(double along, double right, double up) {
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
        place.transform.translation = offTheRoad(0.0, 0.0, 0.0);
        place.transform.rotation =
            glm::angleAxis(std::atan2(-ahead.x, -ahead.y), math::dvec3(0.0, 1.0, 0.0));
    }
    world.registry.add(car, scene::LinearVelocity{14.0 * math::dvec3(ahead.x, 0.0, ahead.y)});
    world.registry.add(car, scene::AngularVelocity{{0.0, 1.2, 0.0}});
}

std::string makeRallyKeys() {
    // It speeds up, rises, and turns to the right.
    const auto key = [](double along) {
        const math::dvec3 at = offTheRoad(along - 4.5, 2.2 - 0.5 * along, 1.5 + 0.3 * along);
        const math::dvec3 to = offTheRoad(along + 1.5, 0.6 * along, 0.6 + 0.6 * along);
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

std::vector<CheckScene> listAllScenes() {
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
class RowDescriber : public render::Effect {
  public:
    [[nodiscard]] std::string name() const override { return "rows"; }

    [[nodiscard]] render::Needs decide(const render::DecideContext&) const override {
        return {.run = {true, "rows are taken down"}};
    }

    void declare(render::PictureContext& context) override {
        mEntities = context.frame.entityHandles;
        mDeforms.assign(mEntities.size(), false);
        for (const extract::DeformedEntity& one : context.frame.deformed)
            mDeforms[one.row] = true;
    }

    void declare(const scene::World& world, const extract::ViewRequest& view, CheckedDrawing& drawn)
        const {
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

core::Status useCamera(const CheckScene& scene, game::Shot& shot) {
    const auto flight = flythrough::parseFlythrough(scene.keys, "keys");
    if (!flight)
        return flight.error();
    auto& registry = shot.world.registry;
    const auto shutter = registry.get<scene::CameraShutter>(shot.camera);
    shot.camera = flythrough::addFlythroughCamera(shot.world, flight.value());
    registry.add(shot.camera, scene::CameraShutter(shutter));
    if (scene.orthographicYMag == 0.0)
        return {};
    auto& camera = registry.get<scene::Camera>(shot.camera);
    camera.kind = scene::CameraKind::Orthographic;
    camera.yMag = scene.orthographicYMag;
    camera.far = 100.0;
    if (registry.has<scene::LensMotion>(shot.camera))
        registry.remove<scene::LensMotion>(shot.camera);
    return {};
}

/// Unlit, the raster instant at the end of the exposure. Error: a file cannot be read or written.
core::Status load(const CheckScene& scene, CheckedScene& made) {
    const TempFolder folder;
    fs::path file = fs::path(SHUTTER_SHARED_DIR) / "scenes" / scene.path;
    if (scene.build) {
        file = folder.path() / "scene.glb";
        if (const std::string error = scene.build().write(file); !error.empty())
            return core::Error{error};
    }
    game::ShotArguments arguments;
    arguments.scene = file.string();
    arguments.unlit = true;
    arguments.shutter = game::makeShutterArguments(kFrameSeconds, "end");
    arguments.size = {kWidth, kHeight};
    auto options = game::interpret(arguments);
    if (!options)
        return options.error();
    made.options = std::move(options).value();
    auto shot = game::loadShot(made.options);
    if (!shot)
        return shot.error();
    made.shot = std::move(shot).value();
    SHUTTER_TRY(useCamera(scene, made.shot));
    if (scene.prepare)
        scene.prepare(made.shot.world);
    return {};
}

/// \param number of half frames
/// \param frames since the one before
core::Result<CheckedDrawing>
draw(render::Renderer& renderer, const CheckedScene& scene, int number, double frames) {
    render::FrameRequest request;
    request.view = game::makeView(scene.shot, scene.options, number * kFrameSeconds / 2.0 + 0.03);
    request.view.exposure.open = request.view.exposure.close - frames * kFrameSeconds;
    request.intermediates = {"motion", "mesh_id"};
    RowDescriber describer;
    const std::array<render::Effect*, 1> effects{&describer};
    const auto result = renderer.renderFrame(scene.shot.world, request, {.effects = effects});
    if (!result)
        return result.error();
    CheckedDrawing drawn;
    describer.declare(scene.shot.world, request.view, drawn);
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
    drawn.cameras = declareCameras(scene.shot.world, request.view);
    return drawn;
}

core::Status drawAll(gpu::Device& device, CheckedScene& scene) {
    render::Renderer renderer(device, scene.shot.world.assets);
    for (int number = 0; number < 2 * kFrames; ++number) {
        auto drawn = draw(renderer, scene, number, 1.0);
        if (!drawn)
            return drawn.error();
        scene.drawn.push_back(std::move(drawn).value());
    }
    auto uneven = draw(renderer, scene, 2 * kFrames, 2.0);
    if (!uneven)
        return uneven.error();
    scene.uneven = std::move(uneven).value();
    uint32_t rowCount = scene.uneven.rowCount;
    for (const CheckedDrawing& drawn : scene.drawn)
        rowCount = std::max(rowCount, drawn.rowCount);
    for (CheckedDrawing& drawn : scene.drawn)
        drawn.rowCount = rowCount;
    scene.uneven.rowCount = rowCount;
    return {};
}

/// Sentences of the suite's checker since they were last read.
std::vector<std::string>& reportedSentences() {
    static std::vector<std::string> reported;
    return reported;
}

class CheckedImages {
  public:
    CheckedImages(gpu::Device& device, const GivenFrame& given)
        : mDevice(device), mPlacing(given) {}

    /// Fills the inputs in with images.
    void describe(GivenFrame& given);

    /// Uploads the texels.
    void record(VkCommandBuffer commands) const;

  private:
    struct Layered {
        std::unique_ptr<TwoLayers> image;
        gpu::Buffer texels;
        gpu::Buffer rubbish;
        uint32_t layer;
    };

    /// \param texels of kCheckedWidth x kCheckedHeight, `texelBytes` each
    /// \param coarseness so many times fewer columns and rows
    motion_blur::HostImage make(
        VkFormat format, std::span<const std::byte> texels, size_t texelBytes, uint32_t coarseness
    );
    motion_blur::HostImage
    makeLayer(VkFormat format, VkExtent2D extent, std::span<const std::byte> texels);

    gpu::Device& mDevice;
    const GivenFrame& mPlacing;
    std::deque<HostTexels> mTexels;
    std::deque<Layered> mLayered;
};

/// Contents outside of the picture: 0xFF is NaN in floats, and an invalid id.
constexpr std::byte kRubbish{0xFF};
constexpr VkOffset2D kMargin{24, 12};

template <class T> void append(std::vector<std::byte>& bytes, const T& value) {
    const auto* from = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), from, from + sizeof(value));
}

std::vector<std::byte> packVectors(VkFormat format, const std::vector<glm::vec2>& vectors) {
    std::vector<std::byte> bytes;
    for (const glm::vec2& vector : vectors)
        if (format == VK_FORMAT_R16G16_SFLOAT)
            append(bytes, glm::packHalf2x16(vector));
        else
            append(bytes, vector);
    return bytes;
}

std::vector<std::byte> packDepth(VkFormat format, const std::vector<float>& depth) {
    std::vector<std::byte> bytes;
    for (const float value : depth)
        if (format == VK_FORMAT_D16_UNORM)
            append(bytes, uint16_t(std::clamp(value, 0.0f, 1.0f) * 65535.0f + 0.5f));
        else if (format == VK_FORMAT_R16_SFLOAT)
            append(bytes, glm::packHalf1x16(value));
        else
            append(bytes, value);
    return bytes;
}

bool isDepthFormat(VkFormat format) {
    return (gpu::aspectOf(format) & VK_IMAGE_ASPECT_DEPTH_BIT) != 0;
}

void CheckedImages::describe(GivenFrame& given) {
    motion_blur::HostInputs& inputs = given.inputs;
    std::vector<uint64_t> halves;
    for (const glm::vec4& color : given.color)
        halves.push_back(packHalf(color));
    inputs.color = make(VK_FORMAT_R16G16B16A16_SFLOAT, bytesOf(halves), sizeof(uint64_t), 1);
    if (given.hasIds)
        inputs.entityId = make(VK_FORMAT_R32_UINT, bytesOf(given.ids), sizeof(uint32_t), 1);
    if (given.isNative) {
        std::vector<glm::vec4> texels;
        for (size_t i = 0; i < kCheckedPixels; ++i)
            texels.emplace_back(given.motion[i], given.metres[i], 0.0f);
        inputs.motionDepth =
            make(VK_FORMAT_R32G32B32A32_SFLOAT, bytesOf(texels), sizeof(glm::vec4), 1);
        return;
    }
    if (given.hasVectors) {
        const auto vectors = packVectors(given.vectorFormat, given.motion);
        inputs.convention.vectors.image =
            make(given.vectorFormat, vectors, vectors.size() / kCheckedPixels, given.coarseness);
    }
    const auto depth = packDepth(given.depthFormat, given.depth);
    inputs.convention.depth.image =
        make(given.depthFormat, depth, depth.size() / kCheckedPixels, given.coarseness);
}

motion_blur::HostImage CheckedImages::make(
    VkFormat format, std::span<const std::byte> texels, size_t texelBytes, uint32_t coarseness
) {
    const VkExtent2D extent{kCheckedWidth / coarseness, kCheckedHeight / coarseness};
    const VkOffset2D margin = mPlacing.isSurrounded ? kMargin : VkOffset2D{0, 0};
    const VkExtent2D whole{
        extent.width + 2 * uint32_t(margin.x), extent.height + 2 * uint32_t(margin.y)};
    std::vector<std::byte> placed(size_t{whole.width} * whole.height * texelBytes, kRubbish);
    for (uint32_t y = 0; y < extent.height; ++y)
        for (uint32_t x = 0; x < extent.width; ++x) {
            const size_t from = (size_t{y} * kCheckedWidth + x) * coarseness;
            const size_t to = size_t{y + uint32_t(margin.y)} * whole.width + x + uint32_t(margin.x);
            std::memcpy(
                placed.data() + to * texelBytes, texels.data() + from * texelBytes, texelBytes
            );
        }
    const VkRect2D part = mPlacing.part;
    const auto scaled = [&](auto value) { return value / decltype(value)(coarseness); };
    const VkRect2D area{
        {margin.x + scaled(part.offset.x), margin.y + scaled(part.offset.y)},
        {scaled(part.extent.width), scaled(part.extent.height)}};
    if (mPlacing.layer) {
        motion_blur::HostImage image = makeLayer(format, whole, placed);
        image.area = area;
        return image;
    }
    const VkImageUsageFlags more = isDepthFormat(format) ? 0 : VK_IMAGE_USAGE_STORAGE_BIT;
    return mTexels.emplace_back(mDevice, format, whole, placed, more).describe(area);
}

motion_blur::HostImage
CheckedImages::makeLayer(VkFormat format, VkExtent2D extent, std::span<const std::byte> texels) {
    const std::vector<std::byte> rubbish(texels.size(), kRubbish);
    const auto stage = [&](std::span<const std::byte> bytes) {
        gpu::Buffer buffer(mDevice, "layer", bytes.size(), 0, gpu::MemoryUse::Staging);
        buffer.writeBytes(bytes.data(), bytes.size(), 0);
        return buffer;
    };
    const Layered& made = mLayered.emplace_back(Layered{
        std::make_unique<TwoLayers>(mDevice, format, extent),
        stage(texels),
        stage(rubbish),
        *mPlacing.layer});
    motion_blur::HostImage image{made.image->image, kWritten, kCopied};
    image.format = format;
    image.extent = extent;
    image.layer = made.layer;
    image.usage = kAllUsage;
    image.samples = VK_SAMPLE_COUNT_1_BIT;
    return image;
}

void CheckedImages::record(VkCommandBuffer commands) const {
    for (const HostTexels& one : mTexels)
        one.record(commands);
    for (const Layered& one : mLayered) {
        one.image->copyFrom(commands, one.texels, one.layer);
        one.image->copyFrom(commands, one.rubbish, 1 - one.layer);
    }
}

} // namespace

void PrintTo(const CheckScene& scene, std::ostream* stream) {
    *stream << scene.name;
}

std::vector<CheckScene> listCheckScenes() {
    std::vector<CheckScene> scenes = listAllScenes();
    if (drawsAll())
        return scenes;
    // A car before a perspective camera that goes along with it, and an orthographic one before
    // what moves in a courtyard: the kinds of projection differ in most of what can be found.
    return {scenes[2], scenes[5]};
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
    static std::map<std::string, CheckedScene> loaded;
    const auto [found, isNew] = loaded.try_emplace(scene.name);
    mScene = &found->second;
    if (!isNew)
        return;
    core::Status done = load(scene, found->second);
    if (done)
        done = drawAll(device(), found->second);
    ASSERT_TRUE(done.ok()) << done.error().message;
}

motion_blur::HostDevice CheckerHost::hostOfSuite() const {
    motion_blur::HostDevice host = describeHost();
    host.framesInFlight = 4;
    host.checksInputs = true;
    host.message = [](std::string_view sentence) { reportedSentences().emplace_back(sentence); };
    return host;
}

GivenFrame CheckerHost::give(int frame, const CheckCase& one, uint32_t view) const {
    const int last = int(mScene->drawn.size()) - 1;
    const int at = 2 * frame + int(view);
    const bool isLong = one.isUneven && frame + 1 == kFrames;
    GivenFrame given;
    static_cast<CheckedDrawing&>(given) =
        isLong ? mScene->uneven : mScene->drawn[one.isStatic ? 0 : size_t(at)];
    if (one.isStatic)
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
    given.frame = frame;
    given.before = &mScene->drawn[size_t(std::max(at - 2, 0))];
    given.after = &mScene->drawn[size_t(std::min(at + 2, last))];
    one.change(given);
    convention.cameras = given.cameras;
    convention.cameras.jitterPx = given.jitterPx;
    convention.cameras.jitterPxBefore = given.jitterPxBefore;
    return given;
}

std::vector<std::string> CheckerHost::check(const CheckCase& one) {
    reportedSentences().clear();
    const uint32_t views = one.viewCount;
    for (uint32_t frame = 0; frame < kFrames; ++frame)
        for (uint32_t view = 0; view < views; ++view) {
            GivenFrame given = give(int(frame), one, view);
            record(*mBlur, frame % 2 * views + view, given);
        }
    for (uint32_t i = 0; i < 2 * views; ++i) // in the order of recording
        EXPECT_TRUE(mBlur->markDone((kFrames % 2 * views + i) % (2 * views)).ok());
    forgetFrames();
    return std::exchange(reportedSentences(), {});
}

void CheckerHost::record(
    motion_blur::EmbeddedMotionBlur& blur, uint32_t number, GivenFrame& given, const Picture* output
) {
    CheckedImages images(device(), given);
    images.describe(given);
    // What the checker finds does not depend on the method, unless that reads the host's motion.
    motion_blur::MotionBlurSettings settings = settingsOf("own_velocity");
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
    submit([&](VkCommandBuffer commands) {
        images.record(commands);
        const core::Status done = blur.record(commands, number, given.inputs, settings);
        ASSERT_TRUE(done.ok()) << done.error().message;
        if (output)
            output->recordReadback(commands);
    });
}

} // namespace shutter::test
