// SPDX-License-Identifier: MIT
// The pass that bends vertices against the same functions in C++, and boxes of what triangles
// sweep.
#include "engine/extract/motion_keys.h"
#include "engine/extract/spatial_order.h"
#include "engine/gpu/upload.h"
#include "engine/gpu/vulkan.h"
#include "engine/gpu_scene/deformer.h"
#include "shaders/render/deform.glsl"
#include "tests/support/deformed_meshes.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage.h"

#include <array>
#include <atomic>
#include <limits>
#include <optional>
#include <random>
#include <vector>

namespace shutter {
namespace {

using math::dmat4;
using math::dvec3;
using math::vec3;

class Deformer : public test::GpuTest {};

/// A mesh of 70 vertices (more than a group) with eight joints a vertex and three targets, the
/// second without normals and tangents.
scene::Primitive makeMesh(std::mt19937& random) {
    std::uniform_real_distribution<float> value(-1.0f, 1.0f);
    const auto vector = [&] { return vec3(value(random), value(random), value(random)); };
    scene::Primitive mesh = test::makeStrip(1.0, 2.0, 34, scene::kNone);
    mesh.influenceCount = 8;
    mesh.joints.clear();
    mesh.weights.clear();
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        mesh.positions[i] = vector();
        mesh.normals[i] = glm::normalize(vector());
        mesh.tangents.push_back(math::vec4(glm::normalize(vector()), i % 2 ? 1.0f : -1.0f));
        for (uint32_t influence = 0; influence < 8; ++influence) {
            mesh.joints.push_back(static_cast<uint16_t>(random() % 5));
            mesh.weights.push_back(influence < 4 ? 0.1875f : 0.0625f);
        }
    }
    for (int t = 0; t < 3; ++t) {
        scene::MorphTarget& target = mesh.morphTargets.emplace_back();
        for (size_t i = 0; i < mesh.positions.size(); ++i) {
            target.positions.push_back(vector());
            if (t == 1)
                continue;
            target.normals.push_back(0.3f * vector());
            target.tangents.push_back(0.3f * vector());
        }
    }
    return mesh;
}

scene::Deformation makePose(std::mt19937& random) {
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    scene::Deformation pose;
    for (int joint = 0; joint < 5; ++joint) {
        dmat4 matrix = glm::rotate(dmat4(1.0), value(random), dvec3(0.6, 0, 0.8));
        matrix[3] = math::dvec4(value(random), value(random), value(random), 1.0);
        pose.objectFromBind.push_back(matrix);
    }
    pose.morphWeights = {value(random), 0.0, value(random)};
    return pose;
}

shader::DeformedVertex
deformInCpp(const scene::Primitive& mesh, size_t i, const scene::Deformation& pose) {
    const auto pick = [i](const std::vector<vec3>& values) {
        return values.empty() ? math::vec4(0.0f) : math::vec4(values[i], 0.0f);
    };
    shader::DeformedVertex vertex{mesh.positions[i], mesh.normals[i], vec3(mesh.tangents[i])};
    for (size_t t = 0; t < pose.morphWeights.size(); ++t) {
        const scene::MorphTarget& target = mesh.morphTargets[t];
        vertex = shader::morphVertex(
            vertex,
            {pick(target.positions), pick(target.normals), pick(target.tangents)},
            float(pose.morphWeights[t])
        );
    }
    if (pose.objectFromBind.empty())
        return shader::finishVertex(vertex);
    shader::MotionKey blended = shader::noJoint();
    for (uint32_t k = 0; k < mesh.influenceCount; ++k) {
        if (mesh.weights[i * mesh.influenceCount + k] == 0.0f)
            continue;
        blended = shader::addJoint(
            blended,
            extract::makeKey(pose.objectFromBind[mesh.joints[i * mesh.influenceCount + k]]),
            mesh.weights[i * mesh.influenceCount + k]
        );
    }
    if (mesh.influenceCount == 0)
        blended = extract::makeKey(pose.objectFromBind.front());
    return shader::finishVertex(shader::skinVertex(vertex, blended));
}

gpu::Buffer
makeBuffer(gpu::Device& device, uint64_t bytes, gpu::MemoryUse use = gpu::MemoryUse::Readback) {
    return {device, "deformed", bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, use};
}

template <class T> std::vector<T> readAll(const gpu::Buffer& buffer, size_t count) {
    std::vector<T> values(count);
    std::memcpy(values.data(), buffer.mapped(), count * sizeof(T));
    return values;
}

/// Two poses at once.
/// \param lost its matrix is NaN
void expectAsInCpp(
    gpu::Device& device,
    scene::Primitive mesh,
    bool skins,
    bool morphs,
    std::optional<size_t> lost = std::nullopt
) {
    std::mt19937 random(5);
    scene::Assets assets;
    // A mesh before it, so that offsets matter.
    assets.meshes.push_back({"", {makeMesh(random)}, {}, {}});
    assets.meshes.push_back({"", {mesh}, {}, {}});
    const gpu_scene::GpuScene scene(device, assets);
    gpu_scene::PoseTable poses;
    std::vector<scene::Deformation> shapes{makePose(random), makePose(random), makePose(random)};
    for (scene::Deformation& shape : shapes) {
        if (!skins)
            shape.objectFromBind.clear();
        if (!morphs)
            shape.morphWeights.clear();
        if (lost)
            shape.objectFromBind[*lost] *= std::numeric_limits<double>::quiet_NaN();
    }
    (void)poses.add(shapes[0]);
    const auto place = poses.add(shapes[1]);
    (void)poses.add(shapes[2]);
    gpu::Buffer table;
    poses.upload(device, table);

    const size_t count = mesh.positions.size();
    const gpu::Buffer vertices = makeBuffer(device, 2 * count * sizeof(shader::Vertex));
    const gpu::Buffer positions = makeBuffer(device, 2 * count * sizeof(math::vec4));
    shader::DeformJob job = poses.makeJob(scene, 1, place);
    job.output_ = gpu::splitAddress(vertices.address());
    shader::DeformJob positionJob = job;
    positionJob.output_ = gpu::splitAddress(positions.address());
    positionJob.positionsOnly = 1;
    gpu_scene::DeformJobs jobs;
    jobs.add(job, 2);
    jobs.add(positionJob, 2);
    gpu::Buffer jobTable;
    jobs.upload(device, jobTable);
    gpu_scene::Deformer deformer(device);
    gpu::runOnce(device, [&](VkCommandBuffer commands) {
        deformer.deform(commands, jobs.batch());
        gpu::fullBarrier(commands);
    });
    const auto deformed = readAll<shader::Vertex>(vertices, 2 * count);
    const auto places = readAll<math::vec4>(positions, 2 * count);
    for (size_t instant = 0; instant < 2; ++instant)
        for (size_t i = 0; i < count; ++i) {
            const shader::DeformedVertex expected = deformInCpp(mesh, i, shapes[instant + 1]);
            const shader::Vertex& vertex = deformed[instant * count + i];
            ASSERT_LT(glm::distance(vec3(vertex.positionU0), expected.position), 1e-6f) << i;
            ASSERT_LT(glm::distance(vec3(vertex.normalV0), expected.normal), 1e-5f) << i;
            ASSERT_LT(glm::distance(vec3(vertex.tangent), expected.tangent), 1e-5f) << i;
            ASSERT_EQ(vertex.tangent.w, mesh.tangents[i].w);
            ASSERT_EQ(vertex.positionU0.w, mesh.uv0[i].x);
            ASSERT_EQ(vertex.normalV0.w, mesh.uv0[i].y);
            // 1.0 as a half float, four times.
            ASSERT_EQ(vertex.color, math::uvec2(0x3C003C00u));
            const math::vec4& place4 = places[instant * count + i];
            ASSERT_EQ(place4, math::vec4(vec3(vertex.positionU0), 1.0f)) << i;
        }
}

TEST_F(Deformer, JointsAndTargetsBendAsInCpp) {
    std::mt19937 random(3);
    expectAsInCpp(device(), makeMesh(random), true, true); // eight joints, three targets
    expectAsInCpp(device(), makeMesh(random), false, true);
    scene::Primitive mesh = makeMesh(random);
    mesh.influenceCount = 4;
    mesh.joints.resize(mesh.positions.size() * 4);
    mesh.weights.assign(mesh.positions.size() * 4, 0.25f);
    mesh.morphTargets.clear();
    expectAsInCpp(device(), mesh, true, false);
}

TEST_F(Deformer, JointsOfNoWeightMayBeNowhereAndVerticesWithoutJointsFollowTheFirst) {
    std::mt19937 random(7);
    scene::Primitive mesh = makeMesh(random);
    for (size_t i = 0; i < mesh.weights.size(); ++i)
        if (mesh.joints[i] == 2)
            mesh.weights[i] = 0.0f;
    expectAsInCpp(device(), mesh, true, true, 2);
    mesh.influenceCount = 0;
    mesh.joints.clear();
    mesh.weights.clear();
    expectAsInCpp(device(), mesh, true, true);
}

TEST_F(Deformer, JobsOfOneDispatchDoNotMeet) {
    // Sizes around a group's, and nothing in between: more jobs than one step of the search.
    std::mt19937 random(10);
    const std::array<uint32_t, 7> counts{64, 2, 65, 0, 128, 1, 63};
    scene::Assets assets;
    assets.meshes.push_back({"", {makeMesh(random)}, {}, {}});
    const gpu_scene::GpuScene scene(device(), assets);
    gpu_scene::PoseTable poses;
    const auto place = poses.add(makePose(random));
    (void)poses.add(makePose(random));
    (void)poses.add(makePose(random));
    gpu::Buffer table;
    poses.upload(device(), table);
    gpu_scene::Deformer deformer(device());
    // Each job alone, then all of them together; a vertex is left alone between two jobs.
    const auto draw = [&](bool together) {
        gpu::Buffer output = makeBuffer(device(), 4096 * sizeof(shader::Vertex));
        output.writeZeros();
        std::vector<gpu_scene::DeformJobs> batches(1);
        VkDeviceAddress at = output.address();
        for (size_t i = 0; i < counts.size(); ++i) {
            shader::DeformJob job = poses.makeJob(scene, 0, place);
            job.vertexCount = std::min(counts[i], job.vertexCount);
            job.targetCount = 0; // whose table has the mesh's own count
            job.output_ = gpu::splitAddress(at);
            const uint32_t instants = 1 + static_cast<uint32_t>(i % 3);
            at += (uint64_t{job.vertexCount} * instants + 1) * sizeof(shader::Vertex);
            if (!together)
                batches.emplace_back();
            batches.back().add(job, instants);
        }
        std::vector<gpu::Buffer> tables(batches.size());
        for (size_t i = 0; i < batches.size(); ++i)
            batches[i].upload(device(), tables[i]);
        gpu::runOnce(device(), [&](VkCommandBuffer commands) {
            for (const gpu_scene::DeformJobs& jobs : batches)
                deformer.deform(commands, jobs.batch());
            gpu::fullBarrier(commands);
        });
        return readAll<std::array<uint32_t, sizeof(shader::Vertex) / 4>>(output, 4096);
    };
    const auto alone = draw(false);
    EXPECT_NE(alone[0], alone[2000]) << "something was written";
    EXPECT_EQ(draw(true), alone);
}

TEST_F(Deformer, ACrowdIsOneDispatch) {
    test::SceneBuilder scene;
    scene.setPerspective(0.9);
    const scene::AssetIndex waves = scene.addWaves();
    for (int i = 0; i < 100; ++i) {
        const std::array joints{
            test::Placement{.position = {0.1 * (i % 10) - 0.5, 0.1 * (i / 10) - 0.5, -3}},
            test::Placement{.position = {0, 0.1, 0}, .angularVelocity = {0, 0, 4}}};
        test::addSkinned(scene, test::makeStrip(0.05, 0.2, 3 + i, waves), joints);
    }
    test::Shot shot;
    shot.method = "sharp";
    shot.exposureSeconds = 0.1;
    static std::atomic<uint32_t> dispatches = 0;
    static const PFN_vkCmdDispatch kNext = vkCmdDispatch;
    vkCmdDispatch = [](VkCommandBuffer commands, uint32_t x, uint32_t y, uint32_t z) {
        ++dispatches;
        kNext(commands, x, y, z);
    };
    const auto drawn = test::renderOnce(device(), scene, shot);
    vkCmdDispatch = kNext;
    EXPECT_EQ(dispatches, 1u);
    EXPECT_TRUE(drawn.statistics.counters.at("entity motions written") >= 100);
}

TEST_F(Deformer, BoxesHoldTrianglesAtBothKeysOfTheirInterval) {
    scene::Assets assets;
    assets.meshes.push_back({"", {test::makeStrip(1.0, 2.0, 40, scene::kNone)}, {}, {}});
    const scene::Primitive& mesh = assets.meshes[0].primitives[0];
    const gpu_scene::GpuScene scene(device(), assets);
    std::mt19937 random(9);
    std::uniform_real_distribution<float> value(-3.0f, 3.0f);
    const size_t count = mesh.positions.size();
    const auto triangles = static_cast<uint32_t>(mesh.indices.size() / 3);
    std::vector<shader::Vertex> keys(3 * count);
    for (shader::Vertex& vertex : keys)
        vertex.positionU0 = {value(random), value(random), value(random), 0.0f};
    gpu::Buffer vertices =
        makeBuffer(device(), keys.size() * sizeof(shader::Vertex), gpu::MemoryUse::Stream);
    vertices.write(std::span<const shader::Vertex>(keys));
    const gpu::Buffer boxes = makeBuffer(device(), uint64_t{2} * triangles * 24);
    shader::DeformedBoxJob job{};
    job.vertices = gpu::splitAddress(vertices.address());
    job.indices = scene.geometryRows()[0].indices;
    job.boxes = gpu::splitAddress(boxes.address());
    job.boxStride = triangles;
    job.vertexCount = static_cast<uint32_t>(count);
    job.triangleCount = triangles;
    gpu_scene::Deformer deformer(device());
    gpu::runOnce(device(), [&](VkCommandBuffer commands) {
        deformer.boundTriangles(commands, job, 2);
        gpu::fullBarrier(commands);
    });
    // The scene sorts its triangles: the same sort again.
    std::vector<uint32_t> indices = mesh.indices;
    extract::sortTriangles(mesh.positions, indices);
    const auto found = readAll<float>(boxes, size_t{2} * triangles * 6);
    for (size_t interval = 0; interval < 2; ++interval)
        for (size_t triangle = 0; triangle < triangles; ++triangle) {
            vec3 low(1e9f);
            vec3 high(-1e9f);
            for (size_t corner = 0; corner < 3; ++corner)
                for (size_t key = interval; key < interval + 2; ++key) {
                    const vec3 at(keys[key * count + indices[3 * triangle + corner]].positionU0);
                    low = glm::min(low, at);
                    high = glm::max(high, at);
                }
            const float* box = &found[6 * (interval * triangles + triangle)];
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_LT(box[axis], low[axis]);
                EXPECT_GT(box[axis], low[axis] - 1e-4f);
                EXPECT_GT(box[3 + axis], high[axis]);
                EXPECT_LT(box[3 + axis], high[axis] + 1e-4f);
            }
        }
}

} // namespace
} // namespace shutter
