// SPDX-License-Identifier: MIT
// `resolved` and `adaptive` with deforming meshes: as good as with rigid ones.
#include "engine/image/metrics.h"
#include "engine/scene/history.h"
#include "tests/image/laws.h"
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <utility>

namespace shutter {
namespace {

using math::dvec3;
using test::AdaptiveLaw;
using test::Placement;
using test::SceneBuilder;
using test::Shot;

constexpr uint32_t kResolvedWidth = 192;
constexpr uint32_t kResolvedHeight = 128;
constexpr double kResolvedExposure = 1.0 / 48.0;

class ResolvedDeform : public test::GpuTest {};

Shot deformShotOf(std::string_view method) {
    Shot shot{
        .method = method,
        .width = kResolvedWidth,
        .height = kResolvedHeight,
        .exposureSeconds = kResolvedExposure,
        .phase = scene::ShutterPhase::End,
        .frameSeconds = 1.0 / 24.0,
        .instants = 15};
    shot.settings.raysPerPixel = 0.0f;
    return shot;
}

image::Image drawDeforming(const SceneBuilder& scene, const Shot& shot) {
    return test::renderOnce(test::sharedDevice(), scene, shot).color;
}

test::Comparison compareDeforming(const SceneBuilder& scene) {
    return {test::sharedDevice(), scene, deformShotOf("sharp"), 64};
}

/// A strip that waves as it crosses the picture.
test::SkinnedEntity addWaver(SceneBuilder& scene, double turn, const dvec3& velocity) {
    const std::array joints{
        Placement{.position = {0.2, -0.8, -3}, .velocity = velocity},
        Placement{.position = {0, 0.8, 0}, .angularVelocity = {0, 0, turn}}};
    return test::addSkinned(
        scene,
        test::makeStrip(0.6, 1.6, 16, scene.addTextured(scene.addWaveTexture(), true)),
        joints
    );
}

TEST_F(ResolvedDeform, ASkinBlursOutsideItsSilhouetteAlongAnyWayUnderAnyCamera) {
    struct Waver {
        const char* name;
        double turn;
        dvec3 velocity;
        Placement camera;
        double least, mostSharp; ///< dB
    };

    for (const Waver& each :
         {Waver{"crosses the picture", 6.0, {9, 0, 0}, {}, 36.0, 26.0},
          Waver{"turns by 1.7 radians in the exposure", 80.0, dvec3(0.0), {}, 32.0, 24.0},
          Waver{
              "under a camera that pans",
              12.0,
              {-3, 0, 0},
              {.velocity = {2, 0, 0}, .angularVelocity = {0, 8.0, 3.0}},
              33.0,
              24.0}}) {
        SceneBuilder scene = test::makeWavyRoom();
        addWaver(scene, each.turn, each.velocity);
        scene.moveCamera(each.camera);
        test::Comparison waver = compareDeforming(scene);
        EXPECT_GT(waver.psnr("resolved"), each.least) << each.name;
        EXPECT_LT(waver.psnr("sharp"), each.mostSharp) << each.name << ": the shot is hard";
    }
}

/// A quad that a morph target moves by `way` over the seconds [-1, 1].
ecs::Entity addShifted(SceneBuilder& scene, scene::Primitive quad, const dvec3& way) {
    scene::MorphTarget target;
    target.positions.assign(quad.positions.size(), math::vec3(way));
    quad.morphTargets.push_back(target);
    return test::addMorphed(
        scene,
        std::move(quad),
        {.position = dvec3(0, 0, -10) - 0.5 * way},
        {.from = {0.0f}, .to = {1.0f}}
    );
}

/// Share of the exposure that a bar of `width` covers the pixel whose left border is `x` from the
/// bar's left edge at shutter close, having come `way` from the left.
double coverAnalytically(double x, double width, double way) {
    constexpr int kSteps = 4096;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i) {
        const double left = -way * (1.0 - (i + 0.5) / kSteps);
        sum += std::clamp(std::min(x + 1.0, left + width) - std::max(x, left), 0.0, 1.0);
    }
    return sum / kSteps;
}

void expectProfileOfAMovingEdge(std::string_view method) {
    // Two instants for each pixel: a copy of an edge is half a pixel wide, and the raster knows the
    // edges to a quarter of one here. Both are 1/60 of the way.
    constexpr double kWay = 15.0;
    constexpr double kBar = 40.5;
    SceneBuilder scene = test::makePixelView(kResolvedHeight);
    const math::dvec3 speed(2.0 * kWay / kResolvedExposure, 0, 0);
    test::addCard(scene, {300, 300}, math::vec3(0.1f), {.position = {0, 0, -20}});
    addShifted(scene, test::makeQuad(kBar, 60, scene.addColor(math::vec3(1.0f))), speed);
    Shot shot = deformShotOf(method);
    shot.settings.sampleCount = 30;
    const image::Image picture = drawDeforming(scene, shot);
    const double left = kResolvedWidth / 2.0 - kBar / 2.0;
    for (int x = int(left - kWay) - 3; x < int(left + kBar) + 4; ++x) {
        const double got = (picture.at(uint32_t(x), kResolvedHeight / 2, 0) - 0.1) / 0.9;
        EXPECT_NEAR(got, coverAnalytically(x - left, kBar, kWay), 0.02) << method << " " << x;
    }
}

TEST_F(ResolvedDeform, AMorphsEdgesHaveTheProfileOfAMovingEdge) {
    expectProfileOfAMovingEdge("resolved");
}

TEST_F(AdaptiveLaw, AMorphsEdgesHaveTheProfileOfAMovingEdge) {
    expectProfileOfAMovingEdge("adaptive");
}

/// Two strips of different colours that turn as they cross, side by side when the exposure ends.
/// \param gap of their depths then
SceneBuilder makeCrossing(SceneBuilder scene, bool isReversed, double gap) {
    for (const bool isRed : {!isReversed, isReversed}) {
        const std::array joints{
            Placement{
                .position = {isRed ? 0.4 : 0.0, -0.8, isRed ? -3.0 : -3.0 - gap},
                .velocity = {isRed ? 6.0 : -6.0, 0.5, 0.0}},
            Placement{.position = {0, 0.8, 0}, .angularVelocity = {0, 0, isRed ? 20.0 : -15.0}}};
        const auto color = scene.addColor(isRed ? math::vec3(1, 0, 0) : math::vec3(0, 0, 1));
        test::addSkinned(scene, test::makeStrip(0.6, 1.6, 16, color), joints);
    }
    return scene;
}

TEST_F(ResolvedDeform, FramesHaveTheSameBitsInEachRunAndOrderOfEntities) {
    Shot shot = deformShotOf("resolved");
    shot.settings.secondRaster = true;
    // Coplanar ones, too: depth does not determine which of them is visible where they cross.
    for (const double gap : {0.3, 0.0}) {
        const SceneBuilder scene = makeCrossing(test::makeWavyRoom(), false, gap);
        const SceneBuilder reversed = makeCrossing(test::makeWavyRoom(), true, gap);
        ASSERT_TRUE(test::sameBits(
            drawDeforming(scene, deformShotOf("sharp")),
            drawDeforming(reversed, deformShotOf("sharp"))
        ));
        const image::Image first = drawDeforming(scene, shot);
        for (int run = 0; run < 3; ++run)
            EXPECT_TRUE(test::sameBits(drawDeforming(scene, shot), first))
                << gap << ", run " << run;
        EXPECT_TRUE(test::sameBits(drawDeforming(reversed, shot), first))
            << gap << ", in another order";
    }
}

/// A square that morph targets move and squeeze, and its mirror image for `side` -1.
SceneBuilder makeSqueezed(double side) {
    SceneBuilder scene = test::makePixelView(kResolvedHeight);
    test::addCard(scene, {400, 300}, {0.2f, 0.6f, 0.3f}, {.position = {0, 0, -20}});
    scene::Primitive quad = test::makeQuad(41.3, 50.6, scene.addColor({0.9f, 0.1f, 0.4f}));
    scene::MorphTarget target;
    // From one second to the next: so far in an exposure.
    const float perExposure = float(2.0 / kResolvedExposure);
    for (const math::vec3& place : quad.positions)
        target.positions.push_back(
            perExposure * math::vec3(side * 12.3 - 0.3 * place.x, 0.2 * place.y, 0.0)
        );
    quad.morphTargets.push_back(target);
    // At rest halfway, where the exposure ends.
    for (size_t i = 0; i < quad.positions.size(); ++i)
        quad.positions[i] -= 0.5f * target.positions[i];
    test::addMorphed(
        scene,
        std::move(quad),
        {.position = {side * 15.2, 3.1, -10}},
        {.from = {0.0f}, .to = {1.0f}}
    );
    return scene;
}

TEST_F(ResolvedDeform, AMirroredSceneMakesTheMirroredPicture) {
    const image::Image direct = drawDeforming(makeSqueezed(1.0), deformShotOf("resolved"));
    const image::Image across = drawDeforming(makeSqueezed(-1.0), deformShotOf("resolved"));
    EXPECT_GT(image::computePsnr(direct, test::mirror(across)), 50.0);
    EXPECT_LT(image::computePsnr(direct, test::mirror(direct)), 25.0)
        << "it is no mirror image of itself";
    const SceneBuilder scene = makeSqueezed(1.0);
    EXPECT_GT(compareDeforming(scene).psnr("resolved"), 38.0);
}

TEST_F(ResolvedDeform, TheLastFrameAndTheSecondRasterHoldWhatThisOneHides) {
    SceneBuilder scene = test::makeWavyRoom();
    addWaver(scene, 25.0, {4, 0, 0});
    scene.add(test::makeBox({0.5, 3, 0.1}, scene.addWaves()), {.position = {0.3, 0, -2}});
    Shot alone = deformShotOf("resolved");
    alone.settings.history = false;
    Shot all = deformShotOf("resolved");
    all.settings.secondRaster = true;
    test::Comparison waver = compareDeforming(scene);
    const double least = waver.psnr(alone);
    EXPECT_GT(waver.psnr("resolved"), least + 0.5);
    const auto frame = test::renderOnce(device(), scene, all);
    EXPECT_GT(waver.psnr(frame), least + 1.0);
    EXPECT_GT(frame.statistics.counters.at("samples from the second raster"), 0u);
}

TEST_F(ResolvedDeform, TwoSkinsOfOneMeshAreSeparate) {
    SceneBuilder scene = test::makeWavyRoom();
    addWaver(scene, 8.0, {9, 0, 0});
    const auto other = addWaver(scene, -8.0, {-9, 0, 0.4});
    scene.world.registry.get<scene::MeshInstance>(other.entity).mesh = 1;
    test::Comparison wavers = compareDeforming(scene);
    const double resolved = wavers.psnr("resolved");
    EXPECT_GT(resolved, wavers.psnr("sharp") + 7.0);
    for (const char* filter :
         {"own_velocity", "mcguire2012", "jimenez2014", "guertin2014", "gather"})
        EXPECT_GT(resolved, wavers.psnr(filter) + 2.0) << filter;
}

/// Cuts the upper half of a mesh's only primitive off, with its vertices in the reverse order.
void cutInTwo(scene::Mesh& mesh) {
    scene::Primitive& lower = mesh.primitives.front();
    scene::Primitive upper = lower;
    const auto last = uint32_t(upper.positions.size() - 1);
    std::reverse(upper.positions.begin(), upper.positions.end());
    std::reverse(upper.normals.begin(), upper.normals.end());
    std::reverse(upper.uv0.begin(), upper.uv0.end());
    for (uint32_t vertex = 0; vertex <= last; ++vertex)
        for (uint32_t i = 0; i < upper.influenceCount; ++i) {
            const size_t to = size_t(vertex) * upper.influenceCount + i;
            const size_t from = size_t(last - vertex) * upper.influenceCount + i;
            upper.joints[to] = lower.joints[from];
            upper.weights[to] = lower.weights[from];
        }
    for (uint32_t& index : upper.indices)
        index = last - index;
    const auto half = std::ptrdiff_t(lower.indices.size() / 6 * 3);
    upper.indices.erase(upper.indices.begin(), upper.indices.begin() + half);
    lower.indices.erase(lower.indices.begin() + half, lower.indices.end());
    mesh.primitives.push_back(std::move(upper));
}

TEST_F(ResolvedDeform, AMeshOfTwoPrimitivesMovesAsTheSameMeshOfOne) {
    image::Image pictures[2];
    for (const bool isCut : {false, true}) {
        SceneBuilder scene = test::makeWavyRoom();
        addWaver(scene, 25.0, {4, 0, 0});
        // The last frame's raster is searched for surfaces that it hides.
        scene.add(test::makeBox({0.5, 3, 0.1}, scene.addWaves()), {.position = {0.3, 0, -2}});
        if (isCut)
            for (scene::Mesh& mesh : scene.world.assets.meshes)
                if (mesh.primitives.front().influenceCount > 0)
                    cutInTwo(mesh);
        pictures[isCut] = drawDeforming(scene, deformShotOf("resolved"));
    }
    EXPECT_GT(image::computePsnr(pictures[0], pictures[1]), 60.0);
}

/// Three limbs of one body that cross within a tile, each before the next.
SceneBuilder makeLimbs() {
    SceneBuilder scene = test::makePixelView(kResolvedHeight);
    test::addCard(scene, {300, 300}, {0.2f, 0.3f, 0.4f}, {.position = {0, 0, -20}});
    scene::Primitive body;
    body.material = scene.addTextured(scene.addWaveTexture(), true);
    scene::MorphTarget target;
    const float ways[] = {14.0f, -11.0f, 3.0f}; // pixels in the exposure
    for (int limb = 0; limb < 3; ++limb) {
        const scene::Primitive quad = test::makeQuad(5, 70, body.material);
        const auto first = uint32_t(body.positions.size());
        for (const math::vec3& place : quad.positions) {
            const math::vec3 way(ways[limb] * float(2.0 / kResolvedExposure), 0, 0);
            target.positions.push_back(way);
            // At rest halfway, where the exposure ends.
            body.positions.push_back(place + math::vec3(6 * limb, 0, -limb) - 0.5f * way);
        }
        body.normals.insert(body.normals.end(), quad.normals.begin(), quad.normals.end());
        body.uv0.insert(body.uv0.end(), quad.uv0.begin(), quad.uv0.end());
        for (const uint32_t index : quad.indices)
            body.indices.push_back(first + index);
    }
    body.morphTargets.push_back(target);
    test::addMorphed(
        scene, std::move(body), {.position = {2, 0, -10}}, {.from = {0.0f}, .to = {1.0f}}
    );
    return scene;
}

TEST_F(ResolvedDeform, LimbsThatCrossWithinATileAreAllFound) {
    const SceneBuilder scene = makeLimbs();
    test::Comparison limbs = compareDeforming(scene);
    EXPECT_GT(limbs.psnr("resolved"), limbs.psnr("gather") + 10.0);
}

/// A sheet whose halves move apart like a pair of scissors: the border between them is that of
/// tiles. A static post is in front of it.
SceneBuilder makeScissors() {
    SceneBuilder scene = test::makePixelView(kResolvedHeight);
    scene.add(test::makeQuad(300, 300, scene.addWaves()), {.position = {0, 0, -20}});
    scene::Primitive sheet =
        test::unbound(test::makeStrip(150, 96, 2, scene.addTextured(scene.addWaveTexture(), true)));
    // Two quads without common vertices.
    for (const uint32_t vertex : {2u, 3u}) {
        sheet.positions.push_back(sheet.positions[vertex]);
        sheet.normals.push_back(sheet.normals[vertex]);
        sheet.uv0.push_back(sheet.uv0[vertex]);
    }
    for (size_t i = 6; i < sheet.indices.size(); ++i)
        if (sheet.indices[i] < 4)
            sheet.indices[i] += 4;
    scene::MorphTarget target;
    for (uint32_t vertex = 0; vertex < sheet.positions.size(); ++vertex) {
        const float way = (vertex < 4 ? 26.0f : -22.0f) * float(2.0 / kResolvedExposure);
        target.positions.push_back({way, 0, 0});
        sheet.positions[vertex].x -= 0.5f * way;
    }
    sheet.morphTargets.push_back(target);
    test::addMorphed(
        scene, std::move(sheet), {.position = {0, -48, -10}}, {.from = {0.0f}, .to = {1.0f}}
    );
    test::addCard(scene, {24, 128}, {0.9f, 0.2f, 0.1f}, {.position = {0, 0, -5}});
    return scene;
}

TEST_F(ResolvedDeform, BlocksWithoutASearchHaveWhatASearchFinds) {
    const SceneBuilder scene = makeScissors();
    Shot searched = deformShotOf("resolved");
    searched.settings.uniformMotionPx = 0.0f;
    const auto fast = test::renderOnce(device(), scene, deformShotOf("resolved"));
    EXPECT_GT(fast.statistics.counters.at("blocks uniform"), 10u);
    EXPECT_GT(image::computePsnr(fast.color, drawDeforming(scene, searched)), 50.0);
}

/// A shape that is hard on a search by derivatives.
struct HardShape {
    std::string_view name;
    double turn;                     ///< of the upper joint, rad/s
    dvec3 scaleAtOpen, scaleAtClose; ///< of the upper joint; the mesh is bound to it with 1
    double growth; ///< how far a morph target pulls all to the middle, per exposure
};

constexpr HardShape kHardShapes[] = {
    {"a joint of scale 0", 10.0, dvec3(0.0), dvec3(0.0), 0.0},
    {"a joint that shrinks to nothing", 10.0, dvec3(1.0), dvec3(0.0), 0.0},
    {"a joint that grows from nothing", 10.0, dvec3(0.0), dvec3(1.0), 0.0},
    {"a joint that turns inside out", 10.0, dvec3(1.0), dvec3(-1.0, 1.0, 1.0), 0.0},
    {"collapses to a point", 0.0, dvec3(1.0), dvec3(1.0), 1.0},
    {"turns inside out", 0.0, dvec3(1.0), dvec3(1.0), 2.0},
    {"turns by three right angles", 225.0, dvec3(1.0), dvec3(1.0), 0.0}};

/// The strip of the others, morphed and bound to joints that are scaled.
/// \param open seconds: when the exposure opens
SceneBuilder makeHard(SceneBuilder scene, const HardShape& shape, double open) {
    scene::Primitive strip =
        test::makeStrip(0.6, 1.6, 16, scene.addTextured(scene.addWaveTexture(), true));
    // Triangles without an area, and one that is no triangle.
    strip.indices.insert(strip.indices.end(), {0, 0, 1, 2, 2, 2});
    scene::MorphTarget target;
    for (const math::vec3& place : strip.positions)
        target.positions.push_back(
            float(shape.growth * 2.0 / kResolvedExposure) * (math::vec3(0, 0.8f, 0) - place)
        );
    // As at rest when the exposure opens.
    for (size_t i = 0; i < strip.positions.size(); ++i)
        strip.positions[i] -= float(0.5 + 0.5 * open) * target.positions[i];
    strip.morphTargets.push_back(target);
    const ecs::Entity morphed =
        test::addMorphed(scene, strip, {.position = {0, 0, 500}}, {.from = {0.0f}, .to = {1.0f}});
    const std::array joints{
        Placement{.position = {0.2, -0.8, -3}, .velocity = {6, 0, 0}},
        Placement{.position = {0, 0.8, 0}, .angularVelocity = {0, 0, shape.turn}}};
    const test::SkinnedEntity skinned = test::addSkinned(scene, strip, joints);
    scene::World& world = scene.world;
    world.registry.add(
        skinned.entity, scene::MorphWeights(world.registry.get<scene::MorphWeights>(morphed))
    );
    world.registry.destroy(morphed);
    scene::AnimationChannel scales;
    scales.path = scene::AnimationPath::Scale;
    scales.times = {float(open), float(open + kResolvedExposure)};
    scales.values = {math::vec4(shape.scaleAtOpen, 0), math::vec4(shape.scaleAtClose, 0)};
    scene::AnimationClip clip;
    clip.channels.push_back(scales);
    world.assets.clips.push_back(clip);
    const auto index = uint32_t(world.assets.clips.size() - 1);
    world.registry.add(skinned.joints[1], scene::Animated{{{index, 0}}});
    return scene;
}

TEST_F(ResolvedDeform, CollapsingInvertedOrDegenerateShapesAreFiniteAndBetterThanFiltered) {
    for (const HardShape& shape : kHardShapes)
        for (const auto phase : {scene::ShutterPhase::Start, scene::ShutterPhase::End}) {
            const bool isEnd = phase == scene::ShutterPhase::End;
            // Every other shape in each phase, or all in both.
            if (!test::drawsAll() && isEnd == ((&shape - kHardShapes) % 2 == 1))
                continue;
            SCOPED_TRACE(std::string(shape.name) + (isEnd ? ", end" : ", start"));
            const SceneBuilder scene =
                makeHard(test::makeWavyRoom(), shape, isEnd ? -kResolvedExposure : 0.0);
            Shot shot = deformShotOf("resolved");
            shot.phase = phase;
            test::Comparison hard(device(), scene, shot, 64);
            const auto sharp = hard.render("sharp");
            EXPECT_LT(hard.psnr(sharp), 36.0) << "it moves";
            const double best = std::max(hard.psnr(sharp), hard.psnr("gather"));
            // Entities that this frame's raster does not show are not searched.
            const bool isShown = !test::sameBits(
                sharp.color, drawDeforming(test::makeWavyRoom(), deformShotOf("sharp"))
            );
            for (const bool hasSecond : {false, true}) {
                shot.settings.secondRaster = hasSecond;
                const auto frame = test::renderOnce(device(), scene, shot);
                EXPECT_TRUE(test::allFinite(frame.color));
                EXPECT_GE(hard.psnr(frame), best + (isShown ? 2.5 : 0.0));
            }
        }
}

TEST_F(ResolvedDeform, TheLightThatLeavesASilhouetteIsAllThere) {
    // Its borders are pixels' borders in the raster: what that shows is the strip's own area.
    SceneBuilder scene = test::makePixelView(kResolvedHeight);
    const std::array joints{
        Placement{.position = {20, -35, -10}, .velocity = {20.0 / kResolvedExposure, 0, 0}},
        Placement{.position = {0, 35, 0}, .angularVelocity = {0, 0, 12}}};
    test::addSkinned(scene, test::makeStrip(26, 70, 16, scene.addColor(math::vec3(1.0f))), joints);
    const image::Image sharp = drawDeforming(scene, deformShotOf("sharp"));
    EXPECT_EQ(test::countSet(sharp), 26u * 70u);
    Shot truthShot = deformShotOf("accumulate");
    truthShot.instants = 256;
    const auto sumOutside = [&](image::Image picture) {
        for (size_t i = 0; i < picture.pixels.size(); ++i)
            picture.pixels[i] *= sharp.pixels[i] > 0.5f ? 0.0f : 1.0f;
        return test::sumChannel(picture, 0);
    };
    const double truth = sumOutside(drawDeforming(scene, truthShot));
    EXPECT_GT(truth, 300.0);
    Shot shot = deformShotOf("resolved");
    // No multiple of the way's pixels: no instant has the edges at pixels' centres.
    shot.settings.sampleCount = 47;
    EXPECT_NEAR(sumOutside(drawDeforming(scene, shot)), truth, 0.02 * truth);
}

/// Draws frames of a scene in any order, as an application does.
class DeformFrames : public test::Frames {
  public:
    using Frames::Frames;

    render::FrameResult at(int frame) {
        return draw(
            {.method = "resolved",
             .width = kResolvedWidth,
             .height = kResolvedHeight,
             .seconds = frame / 24.0,
             .exposureSeconds = kResolvedExposure,
             .phase = scene::ShutterPhase::End,
             .frameSeconds = 1.0 / 24.0}
        );
    }
};

TEST_F(ResolvedDeform, ASequenceThatIsTakenUpAgainHasTheSameBits) {
    SceneBuilder scene = test::makeWavyRoom();
    addWaver(scene, 20.0, {6, 0, 0});
    DeformFrames all(device(), scene);
    for (int frame = -3; frame < 0; ++frame)
        (void)all.at(frame);
    DeformFrames resumed(device(), scene);
    (void)resumed.at(-1);
    const auto expected = all.at(0);
    EXPECT_GT(expected.statistics.counters.at("samples from the last frame"), 0u);
    EXPECT_TRUE(test::sameBits(resumed.at(0).color, expected.color));
}

TEST_F(ResolvedDeform, ACharacterThatIsTeleportedOrAppearsHasNoPast) {
    enum class Event { None, Teleport, Appearance };
    for (const Event event : {Event::None, Event::Teleport, Event::Appearance}) {
        SceneBuilder scene = test::makeWavyRoom();
        const test::SkinnedEntity waver = addWaver(scene, 20.0, {6, 0, 0});
        // Something has to move in the frame.
        scene.add(
            test::makeQuad(0.2, 0.2, scene.addWaves()),
            {.position = {-1.5, 1.0, -4}, .velocity = {0, 0.1, 0}}
        );
        DeformFrames frames(device(), scene);
        (void)frames.at(-1);
        math::Transform elsewhere;
        elsewhere.translation = {-0.6, -0.8, -3};
        if (event == Event::Appearance)
            scene::appear(scene.world, waver.entity, -0.5 / 24.0);
        if (event == Event::Teleport)
            scene::teleport(scene.world, waver.joints[0], elsewhere, -0.5 / 24.0);
        const auto counters = frames.at(0).statistics.counters;
        const auto found = counters.at("samples from the last frame");
        if (event == Event::None)
            EXPECT_GT(found, 1000u);
        else
            EXPECT_LT(found, 200u) << "those of the quad";
    }
}

/// Passes of a frame for deforming meshes.
std::set<std::string> listDeformingPasses(const render::FrameResult& frame) {
    std::set<std::string> names;
    for (const render::PassTime& pass : frame.statistics.passes)
        for (const char* part : {"find parts", "draw ways", "deform for ways"})
            if (pass.name.find(part) != std::string::npos)
                names.insert(pass.name);
    return names;
}

TEST_F(ResolvedDeform, AFrameWithoutDeformationHasNoPassesForIt) {
    Shot shot = deformShotOf("resolved");
    shot.settings.secondRaster = true;
    const auto addCrowd = [](SceneBuilder& scene, double turn) {
        for (const double x : {-0.8, 0.0, 0.8}) {
            const std::array joints{
                Placement{.position = {x, -0.5, -3}},
                Placement{.position = {0, 0.8, 0}, .angularVelocity = {0, 0, turn}}};
            test::addSkinned(scene, test::makeStrip(0.6, 1.6, 16, scene.addWaves()), joints);
        }
    };
    const auto drawAdjacent = [&](double turn, bool hasCrowd) {
        SceneBuilder scene = test::makeWavyRoom();
        scene.add(
            test::makeBox({0.8, 0.6, 0.5}, scene.addWaves()),
            {.position = {-0.4, -0.1, -2.5},
             .velocity = {12.0, 2.0, 3.0},
             .angularVelocity = {4.0, 20.0, 8.0}}
        );
        if (hasCrowd)
            addCrowd(scene, turn);
        return test::renderOnce(device(), scene, shot);
    };
    const auto without = drawAdjacent(0.0, false);
    const auto still = drawAdjacent(0.0, true);
    const auto moving = drawAdjacent(5.0, true);
    EXPECT_EQ(listDeformingPasses(without), std::set<std::string>());
    EXPECT_EQ(listDeformingPasses(still), std::set<std::string>());
    const std::set<std::string> all{
        "deform for ways",
        "draw ways",
        "find parts",
        "find parts, second raster",
        "find parts, last frame"};
    EXPECT_EQ(listDeformingPasses(moving), all);
    const auto countSearched = [](const render::FrameResult& frame) {
        return frame.statistics.counters.at("blocks mixed");
    };
    EXPECT_EQ(countSearched(still), countSearched(without)) << "static surfaces are not searched";
    EXPECT_GT(countSearched(moving), countSearched(without));
    EXPECT_EQ(still.statistics.transientBytes, without.statistics.transientBytes);
    EXPECT_GT(moving.statistics.transientBytes, without.statistics.transientBytes);
}

} // namespace
} // namespace shutter
