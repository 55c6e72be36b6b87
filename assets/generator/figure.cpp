// SPDX-License-Identifier: MIT
#include "assets/generator/figure.h"

#include "assets/generator/axes.h"
#include "assets/generator/demo_scenes.h"
#include "assets/generator/mesh_shapes.h"
#include "assets/generator/scenes.h"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace shutter::generator {

namespace {

struct JointRest {
    Joint parent;
    vec3 place; ///< standing, metres
    const char* name;
};

/// Arms hang, so that all limbs are upright.
constexpr std::array<JointRest, kJointCount> kRest = {
    JointRest{Hips, {0.0f, 0.93f, 0.0f}, "hips"},
    JointRest{Hips, {0.0f, 1.12f, 0.0f}, "chest"},
    JointRest{Chest, {0.0f, 1.50f, 0.01f}, "head"},
    JointRest{Chest, {0.215f, 1.40f, 0.0f}, "left_arm"},
    JointRest{LeftArm, {0.225f, 1.11f, 0.0f}, "left_forearm"},
    JointRest{Chest, {-0.215f, 1.40f, 0.0f}, "right_arm"},
    JointRest{RightArm, {-0.225f, 1.11f, 0.0f}, "right_forearm"},
    JointRest{Hips, {0.095f, 0.90f, 0.0f}, "left_thigh"},
    JointRest{LeftThigh, {0.095f, 0.49f, 0.01f}, "left_shin"},
    JointRest{LeftShin, {0.095f, 0.09f, -0.01f}, "left_foot"},
    JointRest{Hips, {-0.095f, 0.90f, 0.0f}, "right_thigh"},
    JointRest{RightThigh, {-0.095f, 0.49f, 0.01f}, "right_shin"},
    JointRest{RightShin, {-0.095f, 0.09f, -0.01f}, "right_foot"}};

/// What part of an upright limb a joint moves.
struct Bone {
    Joint joint;
    float below; ///< metres: where the bone before ends; not used for the first
};

/// \param bones from the top down
void bind(Shape& shape, std::span<const Bone> bones) {
    constexpr float kHalfBlend = 0.06f; // metres
    for (const vec3& position : shape.positions) {
        size_t at = 0;
        while (at + 1 < bones.size() && position.y < bones[at + 1].below + kHalfBlend)
            ++at;
        const float depth = bones[at].below + kHalfBlend - position.y;
        const float share = at == 0 ? 1.0f : glm::smoothstep(0.0f, 2.0f * kHalfBlend, depth);
        shape.joints.emplace_back(bones[at].joint, bones[at == 0 ? 0 : at - 1].joint, 0, 0);
        shape.weights.emplace_back(share, 1.0f - share, 0.0f, 0.0f);
    }
}

/// An upright tube through (height, radius) points.
Shape limb(float x, std::span<const vec2> outline, std::span<const Bone> bones) {
    std::vector<vec3> path;
    std::vector<float> radii;
    for (const vec2& point : smoothCurve(outline, 18)) {
        path.emplace_back(x, point.x, 0.0f);
        radii.push_back(point.y);
    }
    Shape shape = tube(path, radii, 12);
    bind(shape, bones);
    return shape;
}

/// A part that one joint moves.
Shape rigid(const Shape& shape, vec3 place, Joint joint) {
    Shape result;
    append(result, shape, moved(place));
    const Bone bone{joint, 0.0f};
    bind(result, {&bone, 1});
    return result;
}

Shape makeCoat() {
    constexpr std::array kTrunk = {
        vec2(1.46f, 0.06f),
        vec2(1.40f, 0.14f),
        vec2(1.22f, 0.165f),
        vec2(1.02f, 0.135f),
        vec2(0.88f, 0.15f),
        vec2(0.84f, 0.10f)};
    constexpr std::array kArm = {
        vec2(1.44f, 0.03f), vec2(1.40f, 0.065f), vec2(1.11f, 0.046f), vec2(0.90f, 0.038f)};
    constexpr std::array kSpine = {Bone{Chest, 0.0f}, Bone{Hips, 1.12f}};
    constexpr std::array kLeft = {Bone{LeftArm, 0.0f}, Bone{LeftForearm, 1.11f}};
    constexpr std::array kRight = {Bone{RightArm, 0.0f}, Bone{RightForearm, 1.11f}};
    Shape coat = limb(0.0f, kTrunk, kSpine);
    append(coat, limb(0.22f, kArm, kLeft));
    append(coat, limb(-0.22f, kArm, kRight));
    return coat;
}

Shape makeTrousers() {
    constexpr std::array kLeg = {
        vec2(0.96f, 0.05f), vec2(0.88f, 0.095f), vec2(0.49f, 0.062f), vec2(0.10f, 0.045f)};
    constexpr std::array kLeft = {Bone{LeftThigh, 0.0f}, Bone{LeftShin, 0.49f}};
    constexpr std::array kRight = {Bone{RightThigh, 0.0f}, Bone{RightShin, 0.49f}};
    const Shape shoe = roundedBox({0.045f, 0.045f, 0.12f}, 0.03f, 2, 1.0f);
    Shape trousers = limb(0.095f, kLeg, kLeft);
    append(trousers, limb(-0.095f, kLeg, kRight));
    append(trousers, rigid(shoe, {0.095f, 0.05f, 0.05f}, LeftFoot));
    append(trousers, rigid(shoe, {-0.095f, 0.05f, 0.05f}, RightFoot));
    return trousers;
}

Shape makeSkin() {
    Shape skin = rigid(sphere(0.115f, 16, 12), {0.0f, 1.63f, 0.02f}, Head);
    append(skin, rigid(cylinder(0.05f, 0.12f, 10), {0.0f, 1.48f, 0.0f}, Head));
    append(skin, rigid(sphere(0.05f, 10, 8), {0.22f, 0.86f, 0.0f}, LeftForearm));
    append(skin, rigid(sphere(0.05f, 10, 8), {-0.22f, 0.86f, 0.0f}, RightForearm));
    return skin;
}

/// Positive swings a hanging limb forward, to +Z.
glm::quat swing(float radians) {
    return glm::angleAxis(-radians, kX);
}

glm::quat poseJoint(size_t joint, const Gait& gait, float stride) {
    const auto wave = [&](float share) {
        return std::sin(glm::two_pi<float>() * (stride + share));
    };
    // A knee bends while its leg comes forward, an elbow always.
    const auto knee = [&](float share) {
        return -gait.kneeBend * (0.12f + 0.88f * std::max(0.0f, wave(share + 0.25f)));
    };
    switch (joint) {
    case Hips:
        return swing(-gait.lean);
    case Chest:
        return glm::angleAxis(-0.12f * wave(0.0f), kY) * swing(-gait.lean);
    case Head:
        return swing(gait.lean);
    case LeftThigh:
        return swing(gait.thighSwing * (0.15f + wave(0.0f)));
    case RightThigh:
        return swing(gait.thighSwing * (0.15f + wave(0.5f)));
    case LeftShin:
        return swing(knee(0.0f));
    case RightShin:
        return swing(knee(0.5f));
    case LeftArm:
        return swing(gait.armSwing * wave(0.5f));
    case RightArm:
        return swing(gait.armSwing * wave(0.0f));
    case LeftForearm:
    case RightForearm:
        return swing(gait.elbowBend);
    case LeftFoot:
        return swing(0.25f * wave(0.1f));
    case RightFoot:
        return swing(0.25f * wave(0.6f));
    }
    return {1.0f, 0.0f, 0.0f, 0.0f};
}

} // namespace

Gait makeRun() {
    return {
        .strideSeconds = 0.72f,
        .thighSwing = 0.85f,
        .kneeBend = 1.7f,
        .armSwing = 0.9f,
        .elbowBend = 1.4f,
        .lean = 0.12f,
        .bob = 0.05f};
}

Index addFigureMesh(GltfWriter& writer, const std::string& name, vec3 coat, vec3 trousers) {
    const std::array parts = {
        MeshPart{
            .shape = makeCoat(),
            .material = addTextured(writer, "coat", stripes(coat, 0.6f * coat), 0.85f)},
        MeshPart{
            .shape = makeTrousers(),
            .material =
                addTextured(writer, "trousers", checkers(trousers, 0.75f * trousers), 0.9f)},
        MeshPart{
            .shape = makeSkin(),
            .material = addPlainMaterial(writer, "skin", {0.72f, 0.46f, 0.33f}, 0.7f)}};
    return writer.addMesh(name, parts);
}

Figure addFigure(GltfWriter& writer, Index mesh, const NodeDesc& place) {
    Figure figure;
    figure.root = writer.addNode(place);
    std::array<mat4, kJointCount> jointFromBind{};
    for (size_t i = 0; i < kJointCount; ++i) {
        const JointRest& rest = kRest[i];
        const bool isHips = i == 0;
        figure.joints[i] = writer.addNode(
            {.name = place.name + "_" + rest.name,
             .parent = isHips ? figure.root : figure.joints[rest.parent],
             .translation = isHips ? rest.place : rest.place - kRest[rest.parent].place}
        );
        jointFromBind[i] = moved(-rest.place);
    }
    const Index skin = writer.addSkin(place.name, figure.joints, jointFromBind);
    writer.addNode({.name = place.name + "_body", .parent = figure.root, .mesh = mesh, .skin = skin}
    );
    return figure;
}

void addGait(
    GltfWriter& writer, Index clip, const Figure& figure, const Gait& gait, float begin, float end
) {
    constexpr int kKeysPerStride = 16;
    const float strides = (end - begin) / gait.strideSeconds;
    const int keys = std::max(1, static_cast<int>(std::ceil(strides * kKeysPerStride - 1e-3f)));
    std::vector<float> times;
    std::vector<float> phases;
    for (int i = 0; i <= keys; ++i) {
        const float share = static_cast<float>(i) / static_cast<float>(keys);
        times.push_back(glm::mix(begin, end, share));
        phases.push_back(gait.phase + strides * share);
    }
    for (size_t joint = 0; joint < kJointCount; ++joint) {
        std::vector<glm::quat> turns;
        for (const float phase : phases)
            turns.push_back(poseJoint(joint, gait, phase));
        writer.addRotations(clip, figure.joints[joint], times, turns);
    }
    std::vector<vec3> places;
    for (const float phase : phases)
        places.push_back(
            kRest[0].place + kY * (gait.bob * std::cos(2.0f * glm::two_pi<float>() * phase))
        );
    writer.addTranslations(clip, figure.joints[0], times, places);
}

} // namespace shutter::generator
