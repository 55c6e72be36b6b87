// SPDX-License-Identifier: MIT
// Temporal anti-aliasing against the mean over the pixel: it is that mean where nothing moves, and
// no ghosts of moved, removed or changed objects remain.
#include "engine/image/metrics.h"
#include "engine/scene/history.h"
#include "engine/scene/lens.h"
#include "engine/scene/path.h"
#include "modules/particles/particle_emitter.h"
#include "modules/shadows/shadow_plan.h"
#include "tests/image/laws.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace shutter {
namespace {

using game::AntiAliasing;
using test::AdaptiveLaw;
using Region = std::function<bool(uint32_t x, uint32_t y)>;

constexpr uint32_t kTaaWidth = 96;
constexpr uint32_t kTaaHeight = 64;
constexpr double kSeconds = 1.0;
constexpr double kFrameSeconds = 1.0 / 24.0;

bool isAnywhere(uint32_t, uint32_t) {
    return true;
}

class TaaScene {
  public:
    TaaScene() { mScene.setPerspective(0.9); }

    /// A dark wall.
    void addDark(double distance = 5.0) {
        test::addCard(mScene, {12.0, 12.0}, math::vec3(0.05f), {.position = {0, 0, -distance}});
    }

    /// White tiles on the dark wall, turned so that their edges need smoothing: any colour between
    /// the two is plausible on it.
    void addTiles(double distance = 5.0) {
        addDark(distance);
        const auto white = mScene.addColor(math::vec3(0.9f));
        std::vector<scene::Primitive> tiles;
        for (int y = -7; y <= 7; ++y)
            for (int x = -7; x <= 7; ++x)
                tiles.push_back(test::transformed(
                    test::makeQuad(0.45, 0.45, white),
                    glm::rotate(math::dmat4(1.0), 0.2, math::dvec3(0, 0, 1)) *
                        glm::translate(math::dmat4(1.0), math::dvec3(0.8 * x, 0.8 * y, 0.01))
                ));
        mTiles = mScene.add(mScene.addMesh(std::move(tiles)), {.position = {0, 0, -distance}});
    }

    /// A frame among others, which are drawn before it where they are its history.
    image::Image
    drawAmong(test::Frames& frames, AntiAliasing antiAliasing, double seconds = kSeconds) {
        const test::Shot shot{
            .method = mMethod,
            .seconds = seconds,
            .exposureSeconds = mExposureSeconds,
            .phase = scene::ShutterPhase::End,
            .frameSeconds = kFrameSeconds,
            .shadows = mShadows};
        return frames
            .draw(
                shot,
                [&](game::PictureRequest& request) {
                    request.antiAliasing = antiAliasing;
                    request.drawsFramesBefore = true;
                    if (mRaysPerPixel)
                        request.method.motionBlur.raysPerPixel = *mRaysPerPixel;
                    request.method.motionBlur.secondRaster = mHasSecondRaster;
                }
            )
            .color;
    }

    /// The picture by a renderer of its own.
    image::Image draw(AntiAliasing antiAliasing, double seconds = kSeconds) {
        test::Frames frames(test::sharedDevice(), mScene);
        return drawAmong(frames, antiAliasing, seconds);
    }

    /// Root of the mean squared difference from the mean over the pixel.
    static double measureDifference(
        const image::Image& picture, const image::Image& truth, const Region& region
    ) {
        double sum = 0.0;
        size_t count = 0;
        for (uint32_t y = 0; y < kTaaHeight; ++y)
            for (uint32_t x = 0; x < kTaaWidth; ++x)
                for (uint32_t c = 0; c < 3 && region(x, y); ++c, ++count)
                    sum += std::pow(picture.at(x, y, c) - truth.at(x, y, c), 2.0);
        return std::sqrt(sum / double(count));
    }

    double measureError(const Region& region = isAnywhere) {
        return measureDifference(draw(AntiAliasing::Taa), draw(AntiAliasing::Box), region);
    }

    /// The error as a share of that without anti-aliasing.
    double measureShare(const Region& region = isAnywhere) {
        const image::Image truth = draw(AntiAliasing::Box);
        return measureDifference(draw(AntiAliasing::Taa), truth, region) /
               measureDifference(draw(AntiAliasing::None), truth, region);
    }

    void expectShareBelow(double most, const Region& region = isAnywhere) {
        for (const std::string_view method : test::kSharpAndResolved) {
            mMethod = method;
            EXPECT_LT(measureShare(region), most) << method;
        }
    }

    /// One particle, alive from the start, grey.
    void addParticle(const math::dvec3& position, const math::dvec3& velocity) {
        particles::ParticleEmitter emitter;
        emitter.bursts = {{.seconds = 0.0, .count = 1}};
        emitter.lifeSeconds = 10.0;
        emitter.velocity = velocity;
        emitter.sizeBirth = emitter.sizeDeath = 1.6;
        emitter.colors.fill(math::vec4(0.45f, 0.45f, 0.45f, 1.0f));
        test::addEmitter(mScene, emitter, position);
    }

    /// Turned, so that its edges need smoothing.
    static test::Placement turned(const math::dvec3& position, double angle = 0.2) {
        return {.position = position, .rotation = glm::angleAxis(angle, math::dvec3(0, 0, 1))};
    }

    std::vector<float> drawFrame(test::Frames& frames, int frame) {
        return drawAmong(frames, AntiAliasing::Taa, kSeconds + frame * kFrameSeconds).pixels;
    }

    /// Through a lens that is focused at kFocus.
    void openLens() {
        mMethod = "resolved";
        mScene.world.registry.add(
            mScene.camera, scene::CameraLens{.fStop = 0.04, .focusDistance = kFocus}
        );
    }

    void addFocused(const math::vec3& color, double side) {
        test::addCard(mScene, {side, side}, color, turned({0, 0, -kFocus}));
    }

    /// Motion in pixels per frame of surfaces at kDistance.
    void slideCamera(double pixels) {
        mSpeed = pixels * 24.0 * 2.0 * std::tan(0.45) * kDistance / kTaaHeight;
        mScene.moveCamera({.velocity = {mSpeed, 0, 0}});
    }

    /// A turned square near the middle of the picture at kSeconds.
    void addTurned(
        double side,
        scene::AssetIndex material,
        double distance = kDistance,
        const math::dvec3& velocity = {}
    ) {
        mScene.add(
            test::makeQuad(side, side, material),
            {.position = math::dvec3(mSpeed, 0, -distance) - velocity * kSeconds,
             .rotation = glm::angleAxis(0.2, math::dvec3(0, 0, 1)),
             .velocity = velocity}
        );
    }

    void addSquare(const math::vec3& color, double distance, const math::dvec3& velocity = {}) {
        addTurned(1.4, mScene.addColor(color), distance, velocity);
    }

    void addWall(const math::vec3& color, double distance) {
        test::addCard(mScene, {40.0, 40.0}, color, {.position = {0, 0, -distance}});
    }

    /// A grey square before the tiles, in the picture's middle.
    void addMiddle() {
        addTiles();
        mSquare = test::addCard(mScene, {2.0, 2.0}, math::vec3(0.45f), {.position = {0, 0, -4}});
    }

    static bool isMiddle(uint32_t x, uint32_t y) { return x > 37 && x < 58 && y > 21 && y < 42; }

    /// A lit floor, and a sun.
    void addLitFloor() {
        scene::Material floor;
        floor.metallicFactor = 0.0f;
        mScene.add(test::makeQuad(12.0, 12.0, mScene.addMaterial(floor)), {.position = {0, 0, -5}});
        mScene.addSun({0.3, 0.2, -1.0}, 2.0f);
        for (auto [entity, light] : mScene.world.registry.view<scene::Light>()) {
            (void)light;
            mSun = entity;
        }
    }

    static constexpr double kFocus = 4.0;
    static constexpr double kDistance = 5.0;
    double mSpeed = 0.0; ///< of a camera that slides, metres per second
    ecs::Entity mSquare;
    ecs::Entity mSun;
    test::SceneBuilder mScene;
    std::string_view mMethod = "sharp";
    shadows::ShadowSettings mShadows;
    double mExposureSeconds = 1.0 / 60.0;
    std::optional<float> mRaysPerPixel; ///< of `adaptive`
    bool mHasSecondRaster = false;
    ecs::Entity mTiles;
};

class TaaLaw : public test::GpuTest, public TaaScene {};

TEST_F(TaaLaw, MoversLeaveNoGhosts) {
    addTiles();
    // It ends at the picture's middle.
    const double speed = 9.0;
    test::addCard(
        mScene,
        {1.0, 2.0},
        math::vec3(0.45f),
        {.position = {0.5 - speed * kSeconds, 0, -4}, .velocity = {speed, 0, 0}}
    );
    // The part that it covered in the four frames before and does not now.
    const Region isBehind = [](uint32_t x, uint32_t y) {
        return x < kTaaWidth / 2 - 2 && y > 24 && y < 40;
    };
    EXPECT_LT(measureShare(isBehind), 0.35);
}

TEST_F(TaaLaw, AStaticPictureIsTheMeanOverThePixel) {
    addTiles();
    test::addCard(mScene, {1.5, 1.5}, math::vec3(0.9f), turned({0, 0, -3}, 0.3));
    EXPECT_LT(measureShare(), 0.25);
}

/// By its mip levels, which one sample per pixel reads, and by its texels, which many do.
TEST_F(TaaLaw, AMaskFarAwayCoversAsMuchInOneSampleAsOverThePixel) {
    scene::Material blades;
    blades.unlit = true;
    blades.alphaMode = scene::AlphaMode::Mask;
    blades.baseColor.texture = mScene.addWaveTexture(256, true);
    std::vector<uint8_t>& rgba = mScene.world.assets.images.back().rgba;
    for (size_t i = 0; i < rgba.size(); i += 4) // leaning, a fifth of the area
        rgba[i + 3] = (i + i / 1024) % 128 < 24 ? 255 : 0;
    mScene.add(test::makeQuad(3.0, 3.0, mScene.addMaterial(blades)), turned({0, 0, -9}));
    const auto sumGreen = [](const image::Image& picture) { return test::sumChannel(picture, 1); };
    const double expected = sumGreen(draw(AntiAliasing::Box));
    ASSERT_GT(expected, 10.0);
    EXPECT_NEAR(sumGreen(draw(AntiAliasing::None)), expected, 0.2 * expected);
}

TEST_F(TaaLaw, AStaticPictureThatIsSettledStaysAndHasTheSameBitsAfterAResume) {
    addTiles();
    test::Frames frames(test::sharedDevice(), mScene);
    const auto settled = drawFrame(frames, 0);
    for (int frame = 1; frame < 20; ++frame)
        EXPECT_EQ(drawFrame(frames, frame), settled) << frame;
    // The frames before it begin at another place in the pixel.
    test::Frames resumed(test::sharedDevice(), mScene);
    EXPECT_EQ(drawFrame(resumed, 5), settled);
}

TEST_F(TaaLaw, ACameraThatStopsAndSetsOffHasTheBitsOfAResumeOnceItIsSettled) {
    addTiles();
    scene::PathMotion path;
    path.interpolation = scene::PathInterpolation::Linear;
    path.keys = {
        {.seconds = 0.0},
        {.seconds = kSeconds},
        {.seconds = kSeconds + 20.5 / 24.0},
        {.seconds = kSeconds + 2.0}};
    path.keys[0].position = math::dvec3(-2.0, 0, 0);
    path.keys[3].position = math::dvec3(2.0, 0, 0);
    mScene.world.registry.add(mScene.camera, path);
    for (const std::string_view method : test::kSharpAndResolved) {
        mMethod = method;
        test::Frames frames(test::sharedDevice(), mScene);
        std::map<int, std::vector<float>> drawn;
        for (int frame = -3; frame < 24; ++frame)
            drawn[frame] = drawFrame(frames, frame);
        // It moves, has just stopped, rests, and moves again: only what rests has a history.
        for (const int frame : {-1, 18, 23}) {
            test::Frames resumed(test::sharedDevice(), mScene);
            EXPECT_EQ(drawFrame(resumed, frame), drawn[frame]) << method << ' ' << frame;
        }
        EXPECT_NE(drawn[-1], drawn[0]);
        EXPECT_NE(drawn[18], drawn[23]);
    }
}

TEST_F(TaaLaw, AStaticPictureThroughALensHasTheSameBitsInEachFrame) {
    openLens();
    addTiles(9.0);
    addFocused({0.9f, 0.2f, 0.1f}, 1.5);
    test::Frames frames(test::sharedDevice(), mScene);
    const auto first = drawFrame(frames, 0);
    for (int frame = 1; frame < 5; ++frame)
        EXPECT_EQ(drawFrame(frames, frame), first) << frame;
    // Focused on the wall and stopped down it leaves all in focus: a pinhole's history.
    auto& lens = mScene.world.registry.get<scene::CameraLens>(mScene.camera);
    lens = {.fStop = 22.0, .focusDistance = 9.0};
    const image::Image sharp = draw(AntiAliasing::Taa);
    lens.fStop = 0.0;
    EXPECT_EQ(draw(AntiAliasing::Taa).pixels, sharp.pixels);
}

/// Whether a lens spreads something is known only after the frame's places have been extracted.
TEST_F(TaaLaw, TheFirstFrameOutOfFocusHasTheBitsOfThoseAfterIt) {
    openLens();
    addTiles(9.0);
    scene::FocusMotion focus;
    focus.keys = {
        {.seconds = 0.0, .focusDistance = kFocus, .fStop = 1.0e6},
        {.seconds = kSeconds + 0.5 / 24.0, .focusDistance = kFocus, .fStop = 0.12, .cut = true}};
    mScene.world.registry.add(mScene.camera, focus);
    mExposureSeconds = 1.0 / 240.0;
    test::Frames frames(test::sharedDevice(), mScene);
    const auto sharp = drawFrame(frames, 0);
    const auto first = drawFrame(frames, 1);
    EXPECT_NE(first, sharp);
    for (int frame = 2; frame < 5; ++frame)
        EXPECT_EQ(drawFrame(frames, frame), first) << frame;
}

TEST_F(TaaLaw, ABrightPointKeepsItsLight) {
    openLens();
    test::addCard(mScene, {0.3, 0.3}, math::vec3(40.0f), {.position = {0.05, 0.02, -9}});
    const auto sumLight = [](const image::Image& picture) { return test::sumChannel(picture, 0); };
    const double expected = sumLight(draw(AntiAliasing::Box));
    ASSERT_GT(expected, 100.0);
    EXPECT_NEAR(sumLight(draw(AntiAliasing::Taa)), expected, 0.1 * expected);
}

TEST_F(TaaLaw, AnEdgeInFocusSpreadsNoneOfItsColorOverWhatIsBehind) {
    openLens();
    test::addCard(mScene, {60.0, 60.0}, math::vec3(0.0f), {.position = {0, 0, -12}});
    addFocused(math::vec3(0.9f), 1.5);
    const image::Image picture = draw(AntiAliasing::Taa);
    const double half = 0.75 * kTaaHeight / (2.0 * std::tan(0.45) * kFocus);
    double most = 0.0;
    for (uint32_t y = 0; y < kTaaHeight; ++y)
        for (uint32_t x = 0; x < kTaaWidth; ++x) {
            const math::dvec2 from(x + 0.5 - kTaaWidth / 2.0, y + 0.5 - kTaaHeight / 2.0);
            const math::dvec2 turned(
                from.x * std::cos(0.2) - from.y * std::sin(0.2),
                from.x * std::sin(0.2) + from.y * std::cos(0.2)
            );
            if (std::max(std::abs(turned.x), std::abs(turned.y)) > half + 1.5)
                most = std::max(most, double(picture.at(x, y, 0)));
        }
    EXPECT_LT(most, 0.004);
}

TEST_F(TaaLaw, AConstantColorStaysAsItIs) {
    test::addCard(mScene, {12.0, 12.0}, math::vec3(0.25f, 0.5f, 0.75f), {.position = {0, 0, -5}});
    const image::Image picture = draw(AntiAliasing::Taa);
    for (uint32_t c = 0; c < 3; ++c)
        EXPECT_NEAR(picture.at(40, 30, c), 0.25f * float(c + 1), 1e-3f);
}

TEST_F(TaaLaw, ASilhouetteIsSmoothWithEachMethod) {
    slideCamera(1.5);
    addWall(math::vec3(0.05f), 9.0);
    addSquare(math::vec3(0.9f), kDistance);
    for (const std::string_view method : {"sharp", "gather", "resolved"}) {
        mMethod = method;
        // `resolved` takes the nearest sample for each instant, not the mean of all.
        EXPECT_LT(measureShare(), method == "resolved" ? 0.85 : 0.65) << method;
    }
}

TEST_F(TaaLaw, ASilhouetteBeforeTheSameEntityIsSmooth) {
    slideCamera(1.5);
    const math::dmat4 behind = glm::translate(math::dmat4(1.0), {0, 0, -4});
    mScene.add(
        mScene.addMesh(
            {test::transformed(
                 test::makeQuad(40.0, 40.0, mScene.addColor(math::vec3(0.05f))), behind
             ),
             test::makeQuad(1.4, 1.4, mScene.addColor(math::vec3(0.9f)))}
        ),
        turned({mSpeed, 0, -kDistance})
    );
    EXPECT_LT(measureShare(), 0.65);
}

TEST_F(AdaptiveLaw, RaysStartWhereAPictureThatIsMovedInThePixelSamples) {
    TaaScene scene;
    scene.slideCamera(1.5);
    scene.addWall(math::vec3(0.05f), 9.0);
    scene.addSquare(math::vec3(0.9f), TaaScene::kDistance);
    scene.mMethod = "resolved";
    const image::Image expected = scene.draw(AntiAliasing::Box);
    scene.mMethod = "adaptive";
    scene.mRaysPerPixel = std::numeric_limits<float>::infinity();
    const double one = image::computePsnr(scene.draw(AntiAliasing::None), expected);
    EXPECT_GT(image::computePsnr(scene.draw(AntiAliasing::Box), expected), one + 6.0);
    EXPECT_GT(image::computePsnr(scene.draw(AntiAliasing::Taa), expected), one + 5.0);
}

TEST_F(TaaLaw, ASecondRasterMakesSilhouettesNoWorse) {
    slideCamera(1.5);
    addWall(math::vec3(0.05f), 9.0);
    addSquare(math::vec3(0.9f), kDistance, {3.0, 0, 0});
    mMethod = "resolved";
    const double one = measureError();
    mHasSecondRaster = true;
    EXPECT_LT(measureError(), 1.05 * one);
}

TEST_F(TaaLaw, EdgesInTexturesOfColorAndEmissionAreSmooth) {
    slideCamera(1.5);
    const scene::AssetIndex texture = mScene.addWaveTexture(256);
    std::vector<uint8_t>& rgba = mScene.world.assets.images.back().rgba;
    for (size_t i = 0; i < rgba.size(); ++i) // stripes of four texels, of about a pixel each
        rgba[i] = i / 16 % 2 == 0 || i % 4 == 3 ? 255 : 0;
    scene::Material colored;
    colored.unlit = true;
    colored.baseColor.texture = texture;
    scene::Material glowing;
    glowing.baseColorFactor = {0.0f, 0.0f, 0.0f, 1.0f};
    glowing.emissive = math::vec3(1.0f);
    glowing.emissiveTexture.texture = texture;
    const scene::AssetIndex material = mScene.addMaterial(colored);
    mScene.add(test::makeQuad(40.0, 40.0, material), turned({0, 0, -9}, 0.3));
    for (const scene::Material& one : {colored, glowing}) {
        SCOPED_TRACE(one.unlit ? "colour" : "emission");
        mScene.world.assets.materials[material] = one;
        expectShareBelow(0.7);
    }
}

TEST_F(TaaLaw, ASeamBetweenTrianglesIsShadedAsTheSurfaceIs) {
    slideCamera(1.5);
    mShadows.mode = shadows::ShadowMode::Sharp;
    scene::Material floor;
    floor.metallicFactor = 0.0f;
    floor.baseColor.texture = mScene.addWaveTexture(32);
    const scene::AssetIndex material = mScene.addMaterial(floor);
    std::vector<scene::Primitive> strips; // each of two triangles, seen at a slant
    for (int i = 0; i < 12; ++i)
        strips.push_back(test::transformed(
            test::makeQuad(1.0, 12.0, material),
            glm::translate(math::dmat4(1.0), math::dvec3(i - 5.5, 0, 0))
        ));
    const math::dquat slant = glm::angleAxis(-1.35, math::dvec3(1, 0, 0));
    mScene.add(
        mScene.addMesh(std::move(strips)), {.position = {mSpeed, -1, -8}, .rotation = slant}
    );
    mScene.addSun({0.3, -1.0, -0.3}, 2.0f);
    EXPECT_LT(measureError([](uint32_t, uint32_t y) { return y > 40; }), 0.01);
}

TEST_F(TaaLaw, EdgesOfAlphaMasksAreSmooth) {
    slideCamera(1.5);
    addWall(math::vec3(0.05f), 9.0);
    scene::Material leaves;
    leaves.unlit = true;
    leaves.alphaMode = scene::AlphaMode::Mask;
    leaves.baseColor.texture = mScene.addWaveTexture(64, true);
    mScene.world.assets.textures.back().nearest = true; // as sharp as their edges can be
    addTurned(4.0, mScene.addMaterial(leaves));
    expectShareBelow(0.7);
}

TEST_F(TaaLaw, EdgesStayInTheirPlaceInThePixelOnAverage) {
    const double pixelMetres = 2.0 * std::tan(0.45) * kDistance / kTaaHeight;
    slideCamera(2.0); // 0.8 pixels in the exposure, at whose end the edge is in the middle
    addWall(math::vec3(0.05f), 9.0);
    const ecs::Entity cover =
        test::addCard(mScene, {40.0, 40.0}, math::vec3(0.9f), {.position = {0, 0, -5}});
    mMethod = "resolved";
    constexpr int kPlaces = 16;
    double sum = 0.0;
    for (int i = 0; i < kPlaces; ++i) {
        const double place = (i + 0.5) / kPlaces; // of the edge in the pixel
        mScene.world.registry.get<scene::LocalTransform>(cover).transform.translation.x =
            mSpeed - 20.0 + place * pixelMetres;
        const image::Image picture = draw(AntiAliasing::Taa);
        double row = 0.0;
        for (uint32_t x = 16; x < kTaaWidth - 16; ++x)
            row += (picture.at(x, kTaaHeight / 2, 0) - 0.05) / 0.85;
        sum += row - (kTaaWidth / 2.0 - 16.0 + place + 0.4);
    }
    EXPECT_NEAR(sum / kPlaces, 0.0, 0.04) << "pixels";
}

TEST_F(TaaLaw, AWireThinnerThanAPixelKeepsItsLight) {
    slideCamera(1.5);
    addWall(math::vec3(0.05f), 9.0);
    test::addCard(mScene, {0.006, 3.0}, math::vec3(0.9f), turned({mSpeed, 0, -kDistance}, 0.6));
    const auto sumLight = [](const image::Image& picture) {
        double sum = 0.0;
        for (uint32_t y = 16; y < 48; ++y)
            for (uint32_t x = 32; x < 64; ++x)
                sum += picture.at(x, y, 0) - 0.05;
        return sum;
    };
    mMethod = "resolved";
    const double expected = sumLight(draw(AntiAliasing::Box));
    ASSERT_GT(expected, 1.0);
    EXPECT_NEAR(sumLight(draw(AntiAliasing::Taa)), expected, 0.15 * expected);
}

TEST_F(TaaLaw, AnEdgeOfGlassIsSmooth) {
    slideCamera(1.5);
    addWall(math::vec3(0.05f), 9.0);
    addTurned(1.4, test::addGlass(mScene, {0.9f, 0.9f, 0.9f, 0.8f}));
    EXPECT_LT(measureShare(), 0.65);
}

TEST_F(TaaLaw, ASilhouetteOfTheColorBehindItIsNotSeen) {
    slideCamera(3.0);
    addWall({0.25f, 0.5f, 0.75f}, 9.0);
    addSquare({0.25f, 0.5f, 0.75f}, kDistance);
    for (const std::string_view method : test::kSharpAndResolved) {
        mMethod = method;
        const image::Image picture = draw(AntiAliasing::Taa);
        for (uint32_t y = 0; y < kTaaHeight; ++y)
            for (uint32_t x = 0; x < kTaaWidth; ++x)
                for (uint32_t c = 0; c < 3; ++c)
                    ASSERT_NEAR(picture.at(x, y, c), 0.25f * float(c + 1), 1e-3f) << x << ' ' << y;
    }
}

TEST_F(TaaLaw, ASilhouetteThatMovesByWholePixelsKeepsItsProfile) {
    slideCamera(2.0);
    addWall(math::vec3(0.05f), kDistance + 1e-3);
    addSquare(math::vec3(0.9f), kDistance);
    mMethod = "resolved";
    const image::Image before = draw(AntiAliasing::Taa);
    const image::Image after = draw(AntiAliasing::Taa, kSeconds + 1.0 / 24.0);
    for (uint32_t y = 8; y + 8 < kTaaHeight; ++y)
        for (uint32_t x = 8; x + 8 < kTaaWidth; ++x)
            ASSERT_NEAR(after.at(x - 2, y, 0), before.at(x, y, 0), 0.02f) << x << ' ' << y;
}

TEST_F(TaaLaw, EntitiesThatMoveWithTheCameraHaveSmoothEdges) {
    slideCamera(2.0);
    addWall(math::vec3(0.05f), 9.0);
    addSquare(math::vec3(0.9f), kDistance, {mSpeed, 0, 0});
    expectShareBelow(0.65);
}

TEST_F(TaaLaw, StaticSurfacesBetweenTurningSpokesKeepTheirMean) {
    addTiles();
    const auto red = mScene.addColor({0.6f, 0.1f, 0.05f});
    std::vector<scene::Primitive> spokes;
    for (int i = 0; i < 8; ++i)
        spokes.push_back(test::transformed(
            test::makeQuad(0.07, 3.0, red),
            glm::rotate(math::dmat4(1.0), i * glm::radians(22.5), math::dvec3(0, 0, 1))
        ));
    mScene.add(
        mScene.addMesh(std::move(spokes)), {.position = {0, 0, -4}, .angularVelocity = {0, 0, 2.0}}
    );
    const Region isBetween = [](uint32_t x, uint32_t y) {
        return std::hypot(x - 0.5 * kTaaWidth, y - 0.5 * kTaaHeight) < 0.35 * kTaaHeight;
    };
    EXPECT_LT(measureShare(isBetween), 0.75);
}

TEST_F(TaaLaw, WavesBetweenExposuresAreNotStatic) {
    addTiles();
    scene::VertexWaves waves;
    waves.waves = {{.displacement = {0.3, 0.2, 0}, .hertz = 2.3}};
    mScene.world.registry.add(mTiles, waves);
    mExposureSeconds = 0.0;
    EXPECT_LT(measureShare(), 1.05);
}

TEST_F(TaaLaw, AParticleThatHangsInTheAirIsWhereTheMeanOverThePixelHasIt) {
    addTiles();
    addParticle({0.3, 0.2, -4}, {});
    expectShareBelow(0.55);
}

TEST_F(TaaLaw, AParticleThatFliesLeavesNothingBehind) {
    addDark();
    const double speed = 4.0;
    addParticle({0.5 - speed * kSeconds, 0, -4}, {speed, 0, 0});
    const Region isBehind = [](uint32_t x, uint32_t y) { return x < 40 && y > 24 && y < 40; };
    for (const std::string_view method : test::kSharpAndResolved) {
        mMethod = method;
        EXPECT_LT(measureError(isBehind), 0.005) << method;
    }
}

TEST_F(TaaLaw, EdgesOfGlassInTheLayerAreSmooth) {
    mMethod = "resolved";
    addDark();
    mScene.add(
        test::makeQuad(1.9, 1.5, test::addGlass(mScene, {0.9f, 0.9f, 0.9f, 0.8f})),
        turned({0, 0, -3})
    );
    // A mover behind it takes it out of the raster.
    test::addCard(
        mScene, {0.3, 0.3}, math::vec3(0.3f), {.position = {0.0, -1.0, -4}, .velocity = {0, 1.0, 0}}
    );
    EXPECT_LT(measureShare(), 0.6);
}

TEST_F(TaaLaw, AnEntityThatGoesLeavesNothing) {
    addMiddle();
    scene::hide(mScene.world, mSquare, kSeconds - 3.5 / 24.0);
    EXPECT_LT(measureShare(isMiddle), 0.9);
}

TEST_F(TaaLaw, AnEntityThatStopsShowsNothingOfWhatItHides) {
    addMiddle();
    scene::PathMotion path;
    path.interpolation = scene::PathInterpolation::Linear;
    path.keys = {{.seconds = 0.0}, {.seconds = kSeconds - 3.5 / 24.0}};
    path.keys[0].position = math::dvec3(-9.0, 0, -4);
    path.keys[1].position = math::dvec3(0, 0, -4);
    // Its colours vary as much as those behind it: clipping would not suffice.
    mScene.world.registry.add(mScene.add(test::makeQuad(2.0, 2.0, mScene.addWaves()), {}), path);
    scene::hide(mScene.world, mSquare);
    EXPECT_LT(measureError(isMiddle), 0.035);
}

TEST_F(TaaLaw, AnEntityThatSetsOffLeavesNothing) {
    addMiddle();
    scene::PathMotion path;
    path.interpolation = scene::PathInterpolation::Linear;
    path.keys = {{.seconds = kSeconds - 5.5 / 24.0}, {.seconds = kSeconds}};
    path.keys[0].position = math::dvec3(0, 0, -4);
    path.keys[1].position = math::dvec3(6.0, 0, -4);
    mScene.world.registry.add(mSquare, path);
    EXPECT_LT(measureShare(isMiddle), 0.8);
}

TEST_F(TaaLaw, WhatSetsOffChangesNothingThatItCannotReach) {
    addMiddle();
    scene::PathMotion path;
    path.interpolation = scene::PathInterpolation::Linear;
    path.keys = {{.seconds = kSeconds - 0.5 / 24.0}, {.seconds = kSeconds + 1.0}};
    path.keys[0].position = math::dvec3(0, 0, -4);
    path.keys[1].position = math::dvec3(3.0, 0, -4);
    mScene.world.registry.add(mSquare, path);
    test::Frames frames(test::sharedDevice(), mScene);
    const image::Image before = drawAmong(frames, AntiAliasing::Taa, kSeconds - kFrameSeconds);
    for (int frame = 0; frame < 3; ++frame) {
        const image::Image after =
            drawAmong(frames, AntiAliasing::Taa, kSeconds + frame * kFrameSeconds);
        EXPECT_EQ(
            measureDifference(after, before, [](uint32_t x, uint32_t) { return x < 30; }), 0.0
        );
    }
}

TEST_F(TaaLaw, AfterADoubtAPictureSettlesToWhatItIsWithoutOne) {
    addLitFloor();
    addTiles(4.5);
    mShadows.mode = shadows::ShadowMode::Sharp;
    const auto square =
        test::addCard(mScene, {2.0, 2.0}, math::vec3(0.45f), {.position = {0, 0, -4}});
    scene::hide(mScene.world, square, kSeconds - 18.5 / 24.0);
    test::Frames frames(test::sharedDevice(), mScene);
    for (int frame = -20; frame < 0; ++frame)
        drawFrame(frames, frame);
    const image::Image settled = drawAmong(frames, AntiAliasing::Taa);
    EXPECT_LT(measureDifference(settled, draw(AntiAliasing::Taa), isAnywhere), 2e-4);
    EXPECT_EQ(drawFrame(frames, 1), settled.pixels);
}

TEST_F(TaaLaw, ALightThatTurnsIsSeenAtOnce) {
    addLitFloor();
    mScene.world.registry.add(mSun, scene::AngularVelocity{{1.0, 0, 0}});
    EXPECT_LT(measureError(), 0.01);
}

TEST_F(TaaLaw, ALightThatGoesIsGoneAlsoBehindWhatPasses) {
    addLitFloor();
    scene::hide(mScene.world, mSun, kSeconds - 4.5 / 24.0);
    // It hides the region then, and leaves it three to two frames ago.
    const double speed = 9.0;
    test::addCard(
        mScene,
        {2.5, 2.5},
        math::vec3(0.2f),
        {.position = {1.25 - speed * (kSeconds - 2.0 / 24.0), 0, -4}, .velocity = {speed, 0, 0}}
    );
    const Region isRevealed = [](uint32_t x, uint32_t y) {
        return x > 38 && x < 47 && y > 24 && y < 40;
    };
    EXPECT_LT(measureError(isRevealed), 0.01);
}

TEST_F(TaaLaw, AMovingShadowLeavesNothing) {
    addLitFloor();
    const double speed = 6.0;
    const auto gray = mScene.addColor(math::vec3(0.2f));
    mScene.add(
        test::makeBox({0.8, 0.8, 0.1}, gray),
        {.position = {-speed * kSeconds, 0.0, -4.2}, .velocity = {speed, 0, 0}}
    );
    mShadows.mode = shadows::ShadowMode::Blurred;
    // Where it was, left of where it is and below the middle, where tiles of the picture meet.
    const Region isBehind = [](uint32_t x, uint32_t y) { return x < 30 && y > 32 && y < 42; };
    EXPECT_LT(measureError(isBehind), 0.01);
    // Larger, in the upper half: the box no longer has a separate layer.
    for (uint32_t i = 0; i < shadows::kMaxShadowMovers; ++i)
        mScene.add(
            test::makeBox({1.5, 1.5, 0.1}, gray),
            {.position = {0.05 * i, 2.4, -4.5}, .velocity = {0.1, 0, 0}}
        );
    EXPECT_LT(measureError(isBehind), 0.01);
}

} // namespace
} // namespace shutter
