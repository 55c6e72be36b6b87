// SPDX-License-Identifier: MIT
// Skinned and morphed meshes: what all methods must agree on, motion vectors against closed forms
// in double precision, and what frames with them do.
#include "engine/image/metrics.h"
#include "tests/image/laws.h"
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

namespace shutter {
namespace {

using math::dvec2;
using math::dvec3;
using test::Placement;
using test::SceneBuilder;
using test::Shot;
using test::Stage;
using WorldAt = std::function<dvec3(const dvec3& rest, double seconds)>;

constexpr uint32_t kDeformWidth = 96;
constexpr uint32_t kDeformHeight = 64;
constexpr double kDeformYFov = 0.9;

class DeformLaw : public test::RayTest {
  protected:
    static void expectTruthsAgree(const SceneBuilder& scene) {
        Stage stage(device(), scene);
        test::expectTruthsAgree(
            stage, {.seconds = 0.1, .exposureSeconds = 0.8, .ambient = math::vec3(0.2f)}, 30.0
        );
    }
};

/// A textured wall, lit.
SceneBuilder makeRoom() {
    SceneBuilder scene = test::makeWavyRoom();
    scene.addSun(glm::normalize(dvec3(-0.3, -0.6, -0.8)), 2.0f);
    return scene;
}

scene::Primitive makeBody(SceneBuilder& scene) {
    scene::Material material;
    material.baseColorFactor = {0.9f, 0.5f, 0.2f, 1.0f};
    material.roughnessFactor = 0.6f;
    material.metallicFactor = 0.1f;
    return test::makeBox({0.8, 0.6, 0.5}, scene.addMaterial(material));
}

Placement makeTumble() {
    return {
        .position = {0.1, -0.1, -2.3},
        .rotation = glm::angleAxis(0.4, glm::normalize(dvec3(1, 2, 0.5))),
        .scale = dvec3(0.9),
        .velocity = {0.5, 0.2, 0.3},
        .angularVelocity = {0.3, 0.9, 0.4}};
}

/// The same body, once on its own and once bound to a chain of joints of which only the root moves.
TEST_F(DeformLaw, JointsThatMoveAsOneOrNotAtAllDrawTheRigidPicture) {
    Placement mirrored = makeTumble();
    mirrored.scale.x *= -1.0;
    Placement still = makeTumble();
    still.velocity = still.angularVelocity = dvec3(0.0);
    for (const Placement& placement : {makeTumble(), mirrored, still}) {
        SceneBuilder rigid = makeRoom();
        rigid.add(makeBody(rigid), placement);
        SceneBuilder skinned = makeRoom();
        scene::Primitive body = makeBody(skinned);
        test::bindEqually(body, 3);
        const std::array joints{
            placement,
            Placement{.position = {0.1, 0.4, 0}, .rotation = glm::angleAxis(0.7, dvec3(0, 0, 1))},
            Placement{.position = {0.0, 0.3, -0.2}}};
        test::addSkinned(skinned, std::move(body), joints);
        Stage rigidStage(device(), rigid);
        Stage skinnedStage(device(), skinned);
        Shot shot{.seconds = 0.1, .exposureSeconds = 0.6, .ambient = math::vec3(0.2f)};
        shot.settings.secondRaster = true; // of `resolved`, which finds deforming surfaces by fits
        for (const char* method :
             {"sharp", "gather", "hybrid", "resolved", "accumulate", "truth"}) {
            shot.method = method;
            const image::Image expected = rigidStage.render(shot).color;
            const double near = image::computePsnr(skinnedStage.render(shot).color, expected);
            EXPECT_GT(near, method == std::string_view("resolved") ? 50.0 : 60.0) << method;
        }
    }
}

constexpr double kStripHeight = 1.6;
constexpr double kBend = 1.3; // rad/s
const dvec3 kBendAxis = glm::normalize(dvec3(0.5, 0.2, 1.0));
const Placement kRoot{.position = {-0.2, -0.8, -2.6}, .velocity = {0.4, 0.1, 0.2}};

/// A strip whose root slides and whose upper half turns about its middle.
test::SkinnedEntity addDeformingStrip(SceneBuilder& scene, scene::AssetIndex material) {
    const std::array joints{
        kRoot,
        Placement{.position = {0, kStripHeight / 2, 0}, .angularVelocity = kBend * kBendAxis}};
    return test::addSkinned(scene, test::makeStrip(0.7, kStripHeight, 12, material), joints);
}

/// Linear blend skinning of the strip, written down by hand.
dvec3 strip(const dvec3& rest, double seconds) {
    const double share = rest.y / kStripHeight;
    const dvec3 joint(0, kStripHeight / 2, 0);
    const dvec3 turned =
        joint + glm::mat3_cast(glm::angleAxis(kBend * seconds, kBendAxis)) * (rest - joint);
    return kRoot.position + kRoot.velocity * seconds + (1.0 - share) * rest + share * turned;
}

scene::Primitive makeFlag(scene::AssetIndex material) {
    scene::Primitive flag = test::unbound(test::makeStrip(1.0, 1.0, 8, material));
    for (const double which : {0.0, 1.0}) {
        scene::MorphTarget target;
        for (const math::vec3& position : flag.positions)
            target.positions.push_back(
                which == 0.0
                    ? math::vec3(0.6f * position.y * position.y, 0.1f, 0.5f * position.y)
                    : math::vec3(0.3f * std::sin(5.0f * position.y), 0.0f, 0.2f * position.x)
            );
        flag.morphTargets.push_back(target);
    }
    return flag;
}

const Placement kFlag{
    .position = {0.1, -0.5, -2.0},
    .rotation = glm::angleAxis(0.3, dvec3(0, 1, 0)),
    .velocity = {-0.3, 0.1, 0.0},
    .angularVelocity = {0, 0.2, 0.1}};
const test::MorphWay kFlagWay{{0.0f, 0.2f}, {1.0f, 0.9f}};

dvec3 flag(const dvec3& rest, double seconds) {
    const double share = (seconds + 1.0) / 2.0;
    const double first = share;
    const double second = 0.2 + 0.7 * share;
    const dvec3 morphed = rest + first * dvec3(0.6 * rest.y * rest.y, 0.1, 0.5 * rest.y) +
                          second * dvec3(0.3 * std::sin(5.0 * rest.y), 0.0, 0.2 * rest.x);
    const double speed = glm::length(kFlag.angularVelocity);
    const auto rotation =
        glm::angleAxis(speed * seconds, kFlag.angularVelocity / speed) * kFlag.rotation;
    return kFlag.position + kFlag.velocity * seconds + glm::mat3_cast(rotation) * morphed;
}

dvec2 project(const dvec3& world) {
    const double focal = kDeformHeight / 2.0 / std::tan(kDeformYFov / 2.0);
    return {
        kDeformWidth / 2.0 - focal * world.x / world.z,
        kDeformHeight / 2.0 + focal * world.y / world.z};
}

/// Open to close motion of what the pixel's ray meets of the mesh; nothing where it meets nothing.
std::optional<dvec2> expectedMotion(
    const scene::Primitive& mesh,
    const WorldAt& worldAt,
    const dvec2& px,
    const scene::ExposureInterval& exposure
) {
    const double focal = kDeformHeight / 2.0 / std::tan(kDeformYFov / 2.0);
    const dvec3 direction(px.x - kDeformWidth / 2.0, kDeformHeight / 2.0 - px.y, -focal);
    std::optional<dvec2> motion;
    double nearest = 1e30;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        std::array<dvec3, 3> at[3];
        for (size_t corner = 0; corner < 3; ++corner) {
            const dvec3 rest(mesh.positions[mesh.indices[i + corner]]);
            at[0][corner] = worldAt(rest, exposure.open);
            at[1][corner] = worldAt(rest, exposure.raster);
            at[2][corner] = worldAt(rest, exposure.close);
        }
        // Solve a + u (b - a) + v (c - a) = t direction.
        const auto& [a, b, c] = at[1];
        const math::dmat3 columns(b - a, c - a, -direction);
        if (glm::determinant(columns) == 0.0)
            continue;
        const dvec3 uvt = glm::inverse(columns) * -a;
        if (uvt.x < 0.0 || uvt.y < 0.0 || uvt.x + uvt.y > 1.0 || uvt.z <= 0.0 || uvt.z > nearest)
            continue;
        nearest = uvt.z;
        const dvec3 weights(1.0 - uvt.x - uvt.y, uvt.x, uvt.y);
        const auto blend = [&](const std::array<dvec3, 3>& corners) {
            return corners[0] * weights.x + corners[1] * weights.y + corners[2] * weights.z;
        };
        motion = project(blend(at[2])) - project(blend(at[0]));
    }
    return motion;
}

void expectMotion(
    gpu::Device& device,
    const SceneBuilder& scene,
    const scene::Primitive& mesh,
    const WorldAt& worldAt
) {
    Stage stage(device, scene);
    for (const auto phase : test::kPhases) {
        const auto result = stage.render(
            {.seconds = 0.2, .exposureSeconds = 0.5, .phase = phase, .aovs = {"motion", "mesh_id"}}
        );
        const image::Image& motion = result.intermediates.at("motion");
        const image::Image& ids = result.intermediates.at("mesh_id");
        const auto exposure = scene::computeExposure({0.5, phase}, 0.2);
        size_t compared = 0;
        double longest = 0.0;
        double shortest = 1e9;
        for (uint32_t y = 0; y < kDeformHeight; ++y)
            for (uint32_t x = 0; x < kDeformWidth; ++x) {
                const auto expected =
                    expectedMotion(mesh, worldAt, dvec2(x + 0.5, y + 0.5), exposure);
                if (ids.at(x, y, 0) < 0.0f || !expected)
                    continue;
                ASSERT_NEAR(motion.at(x, y, 0), expected->x, 0.05) << x << ", " << y;
                ASSERT_NEAR(motion.at(x, y, 1), expected->y, 0.05) << x << ", " << y;
                longest = std::max(longest, glm::length(*expected));
                shortest = std::min(shortest, glm::length(*expected));
                ++compared;
            }
        EXPECT_GT(compared, 400u) << "too few pixels to mean anything";
        EXPECT_GT(longest, shortest + 2.0) << "hardly bends";
    }
}

scene::AssetIndex addTwoSided(SceneBuilder& scene) {
    return scene.addTextured(scene.addWaveTexture(), true);
}

TEST_F(DeformLaw, ABendingStripAndAMorphingFlagMoveByTheClosedForm) {
    SceneBuilder bending = test::makeView(kDeformYFov);
    addDeformingStrip(bending, addTwoSided(bending));
    expectMotion(device(), bending, test::makeStrip(0.7, kStripHeight, 12, 0), strip);
    SceneBuilder morphing = test::makeView(kDeformYFov);
    test::addMorphed(morphing, makeFlag(addTwoSided(morphing)), kFlag, kFlagWay);
    expectMotion(device(), morphing, makeFlag(0), flag);
}

TEST_F(DeformLaw, BothTruthsOfWhatBendsMorphsOrDoesBothAgree) {
    SceneBuilder bending = makeRoom();
    addDeformingStrip(bending, addTwoSided(bending));
    expectTruthsAgree(bending);
    SceneBuilder morphing = makeRoom();
    test::addMorphed(morphing, makeFlag(addTwoSided(morphing)), kFlag, kFlagWay);
    expectTruthsAgree(morphing);
    SceneBuilder scene = makeRoom();
    scene::Primitive mesh = makeFlag(addTwoSided(scene));
    const scene::Primitive skin = test::makeStrip(1.0, 1.0, 8, 0);
    mesh.influenceCount = skin.influenceCount;
    mesh.joints = skin.joints;
    mesh.weights = skin.weights;
    const std::array joints{
        Placement{.position = {0, -0.5, -2.2}, .angularVelocity = {0, 0.5, 0}},
        Placement{.position = {0, 0.5, 0}, .angularVelocity = {0, 0, 1.0}}};
    const ecs::Entity entity = test::addSkinned(scene, mesh, joints).entity;
    // The clip of a morphed twin that is taken away again.
    const ecs::Entity other = test::addMorphed(scene, mesh, kFlag, kFlagWay);
    scene.world.registry.add(entity, scene.world.registry.get<scene::MorphWeights>(other));
    scene.world.registry.destroy(other);
    expectTruthsAgree(scene);
}

scene::Primitive makeCloth(SceneBuilder& scene) {
    return test::unbound(test::makeStrip(1.0, 1.4, 24, addTwoSided(scene)));
}

TEST_F(DeformLaw, VerticesThatWaveAsOneDrawTheRigidMoversPicture) {
    // So slow and long a wave that its middle is a straight way, but for 4e-6 of it. Shorter, and
    // the sines of single precision would jitter.
    constexpr double kHertz = 1e-2;
    const dvec3 velocity(1.2, 0.5, 0.2);
    const dvec3 place(-0.2, -0.7, -2.6);
    SceneBuilder rigid = makeRoom();
    rigid.add(makeCloth(rigid), {.position = place, .velocity = velocity});
    SceneBuilder waving = makeRoom();
    const ecs::Entity entity = waving.add(makeCloth(waving), {.position = place});
    scene::VertexWaves waves;
    waves.waves = {{velocity / (2.0 * std::numbers::pi * kHertz), dvec3(0.0), kHertz, 0.0}};
    waving.world.registry.add(entity, waves);
    Stage rigidStage(device(), rigid);
    Stage wavingStage(device(), waving);
    for (const char* method : {"sharp", "gather", "hybrid", "resolved", "accumulate", "truth"}) {
        Shot shot{.method = method, .seconds = 0.1, .exposureSeconds = 0.3};
        shot.ambient = math::vec3(0.2f);
        const image::Image expected = rigidStage.render(shot).color;
        const double near = image::computePsnr(wavingStage.render(shot).color, expected);
        // Deforming surfaces are found by fits of their tiles' motion, which perspective bends.
        EXPECT_GT(near, method == std::string_view("resolved") ? 48.0 : 50.0) << method;
    }
}

/// A cloth that turns and waves in a wind of the world, held at its foot.
SceneBuilder makeWind() {
    SceneBuilder scene = makeRoom();
    const ecs::Entity entity = scene.add(
        makeCloth(scene), {.position = {0.1, -0.8, -2.4}, .angularVelocity = {0.0, 0.8, 0.0}}
    );
    scene::VertexWaves waves;
    waves.inWorld = true;
    waves.share = scene::WaveShare::Height;
    waves.freeAt = 1.4;
    waves.exponent = 1.5;
    waves.lean = {0.2, 0.0, 0.0};
    waves.waves = {
        {{0.5, -0.1, 0.2}, {0.8, 1.0, 0.0}, 1.1, 0.3},
        {{0.1, 0.0, 0.1}, {4.0, 2.0, 1.0}, 3.7, 0.0}};
    scene.world.registry.add(entity, waves);
    return scene;
}

TEST_F(DeformLaw, RaysAndRastersSeeOneWind) {
    const SceneBuilder scene = makeWind();
    Stage stage(device(), scene);
    test::expectTruthsAgree(
        stage, {.seconds = 0.1, .exposureSeconds = 0.4, .ambient = math::vec3(0.2f)}, 30.0
    );
}

TEST_F(DeformLaw, ResolvedFollowsTheWindBetterThanAnyFilter) {
    const SceneBuilder scene = makeWind();
    test::Comparison wind(
        device(), scene, {.seconds = 0.1, .exposureSeconds = 0.15, .ambient = math::vec3(0.2f)}, 128
    );
    const double resolved = wind.psnr("resolved");
    for (const char* filter : {"sharp", "gather", "guertin2014", "jimenez2014"})
        EXPECT_GT(resolved, wind.psnr(filter) + 3.0) << filter;
}

/// A mover before a wall, and, where wanted, a strip that bends between them.
SceneBuilder makeBending(bool bends) {
    SceneBuilder scene = test::makeWavyRoom(5.0, 7.0, 6.0);
    test::addCard(scene, {0.5, 0.5}, {1, 0, 0}, {.position = {0, 0, -2}, .velocity = {0.4, 0, 0}});
    if (!bends)
        return scene;
    const std::array joints{
        Placement{.position = {0.1, -0.8, -3}},
        Placement{.position = {0, 0.8, 0}, .angularVelocity = {0.4, 0, 0.9}}};
    const scene::AssetIndex material = scene.addTextured(scene.addWaveTexture(), true);
    test::addSkinned(scene, test::makeStrip(0.9, 1.6, 12, material), joints);
    return scene;
}

class BendingFrames : public test::Frames {
  public:
    using Frames::Frames;

    render::FrameResult at(double seconds, std::string_view method = "hybrid") {
        return draw({.method = method, .seconds = seconds, .exposureSeconds = 0.5, .instants = 4});
    }
};

bool mentions(const render::FrameResult& frame, const std::string& words) {
    return frame.dump.find(words) != std::string::npos;
}

TEST_F(DeformLaw, NoDeformationRunsWithoutDeformedMeshesAndNoBlasIsBuiltWithoutRays) {
    const SceneBuilder scene = makeBending(false);
    BendingFrames frames(device(), scene);
    for (const auto& frame : {frames.at(0.0, "sharp"), frames.at(0.0), frames.at(0.0, "truth")}) {
        EXPECT_TRUE(mentions(frame, "G-buffer") || mentions(frame, "truth rays"));
        EXPECT_FALSE(mentions(frame, "deformed"));
        EXPECT_FALSE(mentions(frame, "bend"));
    }
    const SceneBuilder bending = makeBending(true);
    const auto frame = BendingFrames(device(), bending).at(0.0, "sharp");
    EXPECT_TRUE(mentions(frame, "deform meshes"));
    EXPECT_FALSE(mentions(frame, "build deformed meshes"));
}

TEST_F(DeformLaw, TimeSpentOnDeformedMeshesIsTheScenesAndNotTheBlurs) {
    using Owner = render::PassOwner;
    const SceneBuilder scene = makeBending(true);
    BendingFrames frames(device(), scene);
    std::map<std::string, Owner> owners;
    for (const render::PassTime& pass : frames.at(0.0).statistics.passes)
        owners[pass.name] = pass.owner;
    const std::pair<const char*, Owner> expected[] = {
        {"deform meshes", Owner::Scene},
        {"build deformed meshes", Owner::Rays},
        {"build TLAS", Owner::Rays},
        {"G-buffer", Owner::Scene},
        {"ray reveal", Owner::Blur},
        {"count revealed", Owner::Blur},
        {"readback color", Owner::Display}};
    for (const auto& [name, owner] : expected) {
        ASSERT_TRUE(owners.contains(name)) << name;
        EXPECT_EQ(owners.at(name), owner) << name;
    }
}

TEST_F(DeformLaw, AShapeThatIsLastFramesIsNotBuiltAgain) {
    const SceneBuilder scene = makeBending(true);
    BendingFrames frames(device(), scene);
    const auto first = frames.at(0.0);
    EXPECT_TRUE(mentions(first, "build deformed meshes"));
    const auto again = frames.at(0.0);
    EXPECT_FALSE(mentions(again, "build deformed meshes"));
    EXPECT_TRUE(test::sameBits(first.color, again.color));
    EXPECT_TRUE(mentions(frames.at(0.1), "build deformed meshes"));
}

TEST_F(DeformLaw, ARefittedShapeIsMetAsANewOneIs) {
    const SceneBuilder scene = makeBending(true);
    BendingFrames frames(device(), scene);
    // Past one build from nothing on the way.
    for (uint32_t i = 0; i <= rays::kRefitsPerBuild + 3; ++i) {
        const double seconds = 0.05 * i;
        const auto refitted = frames.at(seconds);
        EXPECT_TRUE(mentions(refitted, "build deformed meshes"));
        if (i % 6 != 5)
            continue;
        BendingFrames fresh(device(), scene);
        EXPECT_TRUE(test::sameBits(refitted.color, fresh.at(seconds).color)) << i;
    }
}

TEST_F(DeformLaw, TruthOfAnotherTimeIsNotTheLastOnes) {
    const SceneBuilder scene = makeBending(true);
    BendingFrames frames(device(), scene);
    const auto early = frames.at(0.0, "truth");
    const auto late = frames.at(0.6, "truth");
    EXPECT_LT(image::computePsnr(early.color, late.color), 30.0);
    EXPECT_TRUE(test::sameBits(frames.at(0.6, "truth").color, late.color)) << "kept shapes";
    EXPECT_TRUE(test::sameBits(frames.at(0.0, "truth").color, early.color)) << "shapes made again";
    BendingFrames fresh(device(), scene);
    EXPECT_TRUE(test::sameBits(fresh.at(0.6, "truth").color, late.color));
}

TEST_F(DeformLaw, TheDenoisedRivalSeesWhatTruthSees) {
    const SceneBuilder scene = makeBending(true);
    test::Stage stage(device(), scene);
    const auto truth = stage.render({.method = "truth", .instants = 64});
    const auto denoised = stage.render({.method = "denoised", .settings = {.sampleCount = 0}});
    EXPECT_GT(image::computePsnr(denoised.color, truth.color), 22.0);
}

TEST_F(DeformLaw, EntitiesThatComeAndGoLeaveTheOthersTheirShapes) {
    SceneBuilder scene = makeBending(true);
    const std::array joints{
        Placement{.position = {-0.8, -0.6, -3}},
        Placement{.position = {0, 0.6, 0}, .angularVelocity = {0, 0.5, -0.7}}};
    const auto second =
        test::addSkinned(scene, test::makeStrip(0.5, 1.2, 7, scene.addColor({0, 1, 0})), joints);
    BendingFrames frames(device(), scene);
    (void)frames.at(0.0);
    (void)frames.at(0.0, "truth");
    scene.world.registry.remove<scene::MeshInstance>(second.entity);
    BendingFrames fresh(device(), scene);
    EXPECT_TRUE(test::sameBits(frames.at(0.1).color, fresh.at(0.1).color));
    EXPECT_TRUE(test::sameBits(frames.at(0.1, "truth").color, fresh.at(0.1, "truth").color));
}

} // namespace
} // namespace shutter
