// SPDX-License-Identifier: MIT
// Only what the scene calls for is computed: passes, images, pixels, rays and rows are counted.
// What that takes in time is for `shutter bench --suite scaling`.
#include "assets/generator/scaling_scenes.h"
#include "assets/generator/scenes.h"
#include "engine/environment/environment.h"
#include "engine/gltf/gltf_loader.h"
#include "modules/bloom/bloom.h"
#include "modules/particles/particle_emitter.h"
#include "tests/stability/hard_case.h"
#include "tests/support/temp_folder.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>

namespace shutter::stability {
namespace {

using math::dvec3;
using test::Frames;
using Lines = std::multiset<std::string>;

/// The lines of a section ("passes", "images", "buffers") of graph::dump(): those indented by two
/// spaces, a pass without its place in the frame.
Lines listParts(const std::string& dump, const std::string& section) {
    Lines parts;
    bool isInside = false;
    std::istringstream lines(dump);
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with(" "))
            isInside = line.starts_with(section + ":");
        else if (isInside && line.size() > 2 && line[2] != ' ' && !line.starts_with("  end"))
            parts.insert(line.substr(line.find('\'')));
    }
    return parts;
}

/// Those of `lines` without a separate equal among `others`.
std::vector<std::string> listBeyond(const Lines& lines, const Lines& others) {
    std::vector<std::string> beyond;
    std::set_difference(
        lines.begin(), lines.end(), others.begin(), others.end(), std::back_inserter(beyond)
    );
    return beyond;
}

const std::vector<std::string> kNone;

Shot makeFrame(
    std::string_view method, double exposureSeconds = generator::kScalingExposureSeconds
) {
    return {
        .method = method,
        .width = 160,
        .height = 90,
        .exposureSeconds = exposureSeconds,
        .phase = scene::ShutterPhase::End,
        .wantDisplay = true};
}

SceneBuilder load(const generator::GltfWriter& writer) {
    const test::TempFolder folder;
    EXPECT_EQ(writer.write(folder.path() / "scene.glb"), "");
    SceneBuilder scene;
    scene.world = std::move(need(gltf::loadGltf(folder.path() / "scene.glb")).world);
    scene.camera = scene.world.cameras.at(0);
    return scene;
}

class Demand : public test::RayTest {};

TEST_F(Demand, AFrameWithoutMotionOrExposureIsThatOfSharp) {
    const std::pair<SceneBuilder, double> scenes[] = {
        {load(generator::buildVaseScene()), 0.0},
        {load(generator::buildMovingRegionScene(0, 0)), generator::kScalingExposureSeconds},
        {load(generator::buildCrowdScene(30, false)), generator::kScalingExposureSeconds}};
    for (const auto& [scene, exposure] : scenes) {
        const auto sharp = Frames(device(), scene).draw(makeFrame("sharp", exposure));
        for (const char* method : {"hybrid", "resolved"}) {
            SCOPED_TRACE(method);
            const uint32_t levels = device().living().accelerationStructures;
            const auto blurred = Frames(device(), scene).draw(makeFrame(method, exposure));
            EXPECT_LE(device().living().accelerationStructures, levels);
            for (const char* section : {"passes", "images", "buffers"})
                EXPECT_EQ(
                    listBeyond(listParts(blurred.dump, section), listParts(sharp.dump, section)),
                    kNone
                );
            EXPECT_FALSE(listParts(blurred.dump, "passes").empty());
            EXPECT_EQ(blurred.statistics.transientBytes, sharp.statistics.transientBytes);
            EXPECT_TRUE(test::sameBits(blurred.display, sharp.display));
        }
    }
}

TEST_F(Demand, TwoHundredBodiesThatWalkCrowdNoTile) {
    const SceneBuilder crowd = load(generator::buildCrowdScene(generator::kMaxBodyCount, true));
    Shot shot = makeFrame("resolved");
    shot.width = 320; // a tile of a smaller picture would have more bodies than it holds
    shot.height = 180;
    shot.settings.history = false; // which would draw the frame before as well
    const auto drawn = Frames(device(), crowd).draw(shot);
    EXPECT_EQ(drawn.statistics.counters.at("crowded tiles"), 0u);
    EXPECT_GT(drawn.statistics.counters.at("blocks mixed"), 100u) << "they move";
}

/// A picture with options that the scene has no use for against one without them.
struct Useless {
    const char* name; ///< the options, and why they make no work
    shadows::ShadowMode shadows = shadows::ShadowMode::None;
    bool isUnlit = false; ///< and so is the picture without the options
    bool hasSun = true;
    bool hasSolid = true; ///< floor and ball hold light back; else they are blended
    bool isSeen = true;   ///< the camera faces them; else it faces away
    bool moves = false;   ///< the ball
    bool hasEnvironment = false;
    bool isFirst = true; ///< tests its first frame; else the next one
    double stepSeconds = 0.0;
    bloom::BloomSettings bloom{};
};

constexpr auto kSharp = shadows::ShadowMode::Sharp;
constexpr auto kBlurred = shadows::ShadowMode::Blurred;

const Useless kUseless[] = {
    {.name = "shadows without a light", .shadows = kBlurred, .hasSun = false},
    {.name = "shadows where nothing holds light back", .shadows = kBlurred, .hasSolid = false},
    {.name = "shadows where nothing is in view", .shadows = kBlurred, .isSeen = false},
    {.name = "shadows of an unlit picture", .shadows = kBlurred, .isUnlit = true},
    {.name = "sharp shadows where nothing moves, in the frame after",
     .shadows = kSharp,
     .isFirst = false},
    {.name = "blurred shadows where nothing moves, in the frame after",
     .shadows = kBlurred,
     .isFirst = false,
     .stepSeconds = scene::kStillFrameSeconds},
    {.name = "blurred shadows where only a blended ball moves",
     .shadows = kBlurred,
     .hasSolid = false,
     .moves = true,
     .isFirst = false,
     .stepSeconds = scene::kStillFrameSeconds},
    {.name = "an environment, which the G-buffer draws", .hasEnvironment = true},
    {.name = "an environment that an unlit picture leaves out",
     .isUnlit = true,
     .hasEnvironment = true},
    {.name = "bloom that scatters no light"},
    {.name = "bloom where nothing is above its knee, in the frame after",
     .isFirst = false,
     .bloom = {.share = 0.1f, .threshold = 20.0f}},
};

/// The frame's dump. \param isRequested with the options
std::string drawUseless(
    gpu::Device& device,
    const Useless& wanted,
    bool isRequested,
    game::AntiAliasing antiAliasing = game::AntiAliasing::None
) {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.moveCamera(
        {.position = {0, 2, 4},
         .rotation = glm::angleAxis(wanted.isSeen ? -0.45 : 2.0, dvec3(1, 0, 0))}
    );
    scene::Material material;
    if (!wanted.hasSolid) {
        material.alphaMode = scene::AlphaMode::Blend;
        material.baseColorFactor.w = 0.5f;
    }
    const auto used = scene.addMaterial(material);
    scene.add(
        test::makeQuad(8.0, 8.0, used),
        {.rotation = glm::angleAxis(-glm::radians(90.0), dvec3(1, 0, 0))}
    );
    scene.add(
        test::makeSphere(0.5, used),
        {.position = {0, 0.8, 0}, .velocity = {wanted.moves ? 1.0 : 0.0, 0, 0}}
    );
    if (wanted.hasSun)
        scene.addSun({-0.5, -1.0, -0.4}, 3.0f);
    if (wanted.hasEnvironment && isRequested) {
        image::Image sky(64, 32, 3);
        std::fill(sky.pixels.begin(), sky.pixels.end(), 0.5f);
        scene.world.assets.environment = need(environment::makeEnvironment(std::move(sky), {}));
    }
    Shot shot = makeFrame("sharp", 1.0 / 48.0);
    shot.width = 64;
    shot.height = 36;
    shot.shadows.mapSize = 64;
    if (isRequested)
        shot.shadows.mode = wanted.shadows;
    bloom::Bloom bloom(device, wanted.bloom);
    const auto request = [&](game::PictureRequest& picture) {
        picture.frame.view.unlit = wanted.isUnlit;
        picture.frame.wantColor = false;
        picture.frame.wantBrightest = isRequested; // of what the last picture showed
        picture.antiAliasing = antiAliasing;
        if (isRequested)
            picture.ending.insert(picture.ending.begin(), &bloom);
    };
    Frames frames(device, scene);
    std::string dump;
    for (int frame = wanted.isFirst ? 1 : 0; frame < 2; ++frame) {
        dump = frames.draw(shot, request).dump;
        shot.seconds += wanted.stepSeconds;
    }
    return dump;
}

TEST_F(Demand, UnusedLightsHaveNoPassAndNoImage) {
    for (const Useless& wanted : kUseless) {
        SCOPED_TRACE(wanted.name);
        const std::string plain = drawUseless(device(), wanted, false);
        const std::string requested = drawUseless(device(), wanted, true);
        for (const char* section : {"passes", "images"})
            EXPECT_EQ(listBeyond(listParts(requested, section), listParts(plain, section)), kNone);
        EXPECT_FALSE(listParts(requested, "passes").empty());
    }
}

TEST_F(Demand, ParticlesThatTheViewLeavesOutHaveNoPassNoImageAndNoBuffer) {
    SceneBuilder scene = load(generator::buildMovingRegionScene(1, 1));
    const auto draw = [&](bool hasParticles) {
        return Frames(device(), scene)
            .draw(makeFrame("resolved"), [&](game::PictureRequest& request) {
                request.features.particles.areShown = hasParticles;
                request.frame.intermediates = {"particles"};
            });
    };
    const auto without = draw(true);
    const ecs::Entity entity = scene.world.registry.create();
    scene.world.registry.add(entity, scene::LocalTransform{{.translation = {0.0, 0.0, -2.0}}});
    particles::ParticleEmitter emitter;
    emitter.spans = {{.fromSeconds = -10.0, .perSecond = 200.0}};
    emitter.velocity = {0.5, 0.5, 0.0};
    scene.world.registry.add(entity, emitter);
    const auto off = draw(false);
    const auto on = draw(true);
    for (const char* section : {"passes", "images", "buffers"})
        EXPECT_EQ(listParts(off.dump, section), listParts(without.dump, section)) << section;
    EXPECT_EQ(off.statistics.transientBytes, without.statistics.transientBytes);
    EXPECT_TRUE(test::sameBits(off.display, without.display));
    EXPECT_FALSE(test::sameBits(on.display, without.display));
    EXPECT_FALSE(off.intermediates.contains("particles"));
    // Once over the picture, once alone.
    const auto& passes = on.statistics.passes;
    const auto isParticles = [](const gpu::PassTime& pass) { return pass.name == "particles"; };
    EXPECT_EQ(std::count_if(passes.begin(), passes.end(), isParticles), 2);
    EXPECT_GT(on.intermediates.at("particles").at(80, 45, 0), 0.0f);
}

TEST_F(Demand, AntiAliasingWhereNothingMovesHasOnePassAndOneImage) {
    const Useless still{.name = "taa", .isFirst = false};
    const std::string plain = drawUseless(device(), still, false);
    const std::string requested = drawUseless(device(), still, false, game::AntiAliasing::Taa);
    const auto passes = listBeyond(listParts(requested, "passes"), listParts(plain, "passes"));
    ASSERT_EQ(passes.size(), 1u);
    EXPECT_TRUE(passes.front().starts_with("'taa'")) << passes.front();
    // Lines contain the lifetimes of images, which a further pass changes.
    EXPECT_LE(listParts(requested, "images").size(), listParts(plain, "images").size() + 1);
}

} // namespace
} // namespace shutter::stability
