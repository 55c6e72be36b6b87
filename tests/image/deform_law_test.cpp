// SPDX-License-Identifier: MIT
// Skinned and morphed meshes in whole pictures: what all methods must agree on, and motion vectors
// against closed forms in double precision.
#include "engine/image/metrics.h"
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/picture.h"
#include "tests/support/stage.h"

#include <array>
#include <cmath>
#include <functional>
#include <optional>

namespace shutter {
namespace {

using math::dvec2;
using math::dvec3;
using test::Placement;
using test::SceneBuilder;
using test::Shot;
using test::Stage;

constexpr uint32_t kWidth = 96;
constexpr uint32_t kHeight = 64;
constexpr double kYFov = 0.9;

class DeformLaw : public test::GpuTest {
  protected:
    [[nodiscard]] static bool canDraw(std::string_view method) {
        if (method == "truth")
            return device().hasRayQuery();
        return device().hasRays() || method != "hybrid";
    }
};

constexpr std::string_view kMethods[] = {"sharp", "gather", "hybrid", "accumulate", "truth"};

/// A textured wall, lit.
SceneBuilder makeRoom() {
    SceneBuilder scene;
    scene.setPerspective(kYFov);
    scene.addSun(glm::normalize(dvec3(-0.3, -0.6, -0.8)), 2.0f);
    scene.add(
        test::makeQuad(8, 6, scene.addTextured(scene.addWaveTexture())), {.position = {0, 0, -5}}
    );
    return scene;
}

scene::Primitive makeBody(SceneBuilder& scene) {
    scene::Material material;
    material.baseColorFactor = {0.9f, 0.5f, 0.2f, 1.0f};
    material.roughnessFactor = 0.6f;
    material.metallicFactor = 0.1f;
    return test::makeBox({0.8, 0.6, 0.5}, scene.addMaterial(material));
}

/// The same body, once on its own and once bound to a chain of joints of which only the root moves.
void expectRigidTwin(gpu::Device& device, const Placement& placement, std::string_view method) {
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
    Shot shot{.method = method, .seconds = 0.1, .exposureSeconds = 0.6};
    shot.ambient = math::vec3(0.2f);
    const auto expected = test::renderOnce(device, rigid, shot);
    const auto result = test::renderOnce(device, skinned, shot);
    EXPECT_GT(image::computePsnr(result.color, expected.color), 60.0) << method;
}

Placement makeTumble() {
    return {
        .position = {0.1, -0.1, -2.3},
        .rotation = glm::angleAxis(0.4, glm::normalize(dvec3(1, 2, 0.5))),
        .scale = dvec3(0.9),
        .velocity = {0.5, 0.2, 0.3},
        .angularVelocity = {0.3, 0.9, 0.4}};
}

TEST_F(DeformLaw, JointsThatMoveAsOneDrawTheRigidPicture) {
    for (const std::string_view method : kMethods)
        if (canDraw(method))
            expectRigidTwin(device(), makeTumble(), method);
}

TEST_F(DeformLaw, AMirroredSkeletonDrawsTheMirroredRigidPicture) {
    Placement mirrored = makeTumble();
    mirrored.scale.x *= -1.0;
    for (const std::string_view method : kMethods)
        if (canDraw(method))
            expectRigidTwin(device(), mirrored, method);
}

TEST_F(DeformLaw, JointsThatStandStillDrawTheStillPicture) {
    Placement still = makeTumble();
    still.velocity = still.angularVelocity = dvec3(0.0);
    for (const std::string_view method : kMethods)
        if (canDraw(method))
            expectRigidTwin(device(), still, method);
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
    scene::Primitive flag = test::makeStrip(1.0, 1.0, 8, material);
    flag.influenceCount = 0;
    flag.joints.clear();
    flag.weights.clear();
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

using WorldAt = std::function<dvec3(const dvec3& rest, double seconds)>;

dvec2 project(const dvec3& world) {
    const double focal = kHeight / 2.0 / std::tan(kYFov / 2.0);
    return {kWidth / 2.0 - focal * world.x / world.z, kHeight / 2.0 + focal * world.y / world.z};
}

/// Open to close motion of what the pixel's ray meets of the mesh; nothing where it meets nothing.
std::optional<dvec2> expectedMotion(
    const scene::Primitive& mesh,
    const WorldAt& worldAt,
    const dvec2& px,
    const scene::ExposureInterval& exposure
) {
    const double focal = kHeight / 2.0 / std::tan(kYFov / 2.0);
    const dvec3 direction(px.x - kWidth / 2.0, kHeight / 2.0 - px.y, -focal);
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
    for (const auto phase :
         {scene::ShutterPhase::Start, scene::ShutterPhase::Centre, scene::ShutterPhase::End}) {
        const auto result = stage.render(
            {.seconds = 0.2, .exposureSeconds = 0.5, .phase = phase, .aovs = {"motion", "mesh_id"}}
        );
        const image::Image& motion = result.intermediates.at("motion");
        const image::Image& ids = result.intermediates.at("mesh_id");
        const auto exposure = scene::computeExposure({0.5, phase}, 0.2);
        size_t compared = 0;
        double longest = 0.0;
        double shortest = 1e9;
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x) {
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

TEST_F(DeformLaw, ABendingStripMovesByTheClosedForm) {
    SceneBuilder scene;
    scene.setPerspective(kYFov);
    addDeformingStrip(scene, addTwoSided(scene));
    expectMotion(device(), scene, test::makeStrip(0.7, kStripHeight, 12, 0), strip);
}

TEST_F(DeformLaw, AMorphingFlagMovesByTheClosedForm) {
    SceneBuilder scene;
    scene.setPerspective(kYFov);
    test::addMorphed(scene, makeFlag(addTwoSided(scene)), kFlag, kFlagWay);
    expectMotion(device(), scene, makeFlag(0), flag);
}

/// Rays that each have their own time against sharp pictures of many instants.
void expectTruthsAgree(gpu::Device& device, const SceneBuilder& scene) {
    Stage stage(device, scene);
    Shot shot{.method = "truth", .seconds = 0.1, .exposureSeconds = 0.8, .instants = 256};
    shot.ambient = math::vec3(0.2f);
    const auto truth = stage.render(shot);
    shot.method = "accumulate";
    const auto accumulated = stage.render(shot);
    EXPECT_GE(image::computePsnr(truth.color, accumulated.color), 45.0);
    shot.method = "sharp";
    const auto sharp = stage.render(shot);
    EXPECT_LT(image::computePsnr(truth.color, sharp.color), 30.0) << "nothing is blurred";
}

TEST_F(DeformLaw, BothTruthsOfABendingStripAgree) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "no ray queries";
    SceneBuilder scene = makeRoom();
    addDeformingStrip(scene, addTwoSided(scene));
    expectTruthsAgree(device(), scene);
}

TEST_F(DeformLaw, BothTruthsOfAMorphingFlagAgree) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "no ray queries";
    SceneBuilder scene = makeRoom();
    test::addMorphed(scene, makeFlag(addTwoSided(scene)), kFlag, kFlagWay);
    expectTruthsAgree(device(), scene);
}

TEST_F(DeformLaw, ASkinnedEntityCanBeMorphedToo) {
    if (!device().hasRayQuery())
        GTEST_SKIP() << "no ray queries";
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
    expectTruthsAgree(device(), scene);
}

} // namespace
} // namespace shutter
