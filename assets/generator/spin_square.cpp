// SPDX-License-Identifier: MIT
// The square of the fairground: paving, hedges, trees, lamps, and what people left on it.
#include "assets/generator/axes.h"
#include "assets/generator/demo_scenes.h"
#include "assets/generator/mesh_shapes.h"
#include "assets/generator/scenes.h"
#include "assets/generator/textures.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>

namespace shutter::generator {

namespace {

/// What people left on the square: benches along the hedges, tubs with bushes, a booth for tickets.
struct SquareProps {
    Shape wood;
    Shape iron;
    Shape tubs;
    Shape bushes;
    Shape blooms;
    Shape booth;
    Shape boothRoof;
};

/// Its seat faces +Z.
void addBench(SquareProps& props, const mat4& at) {
    for (int i = 0; i < 3; ++i) {
        const float step = static_cast<float>(i);
        append(
            props.wood,
            box({0.75f, 0.02f, 0.06f}, 1.5f),
            glm::translate(at, vec3(0.0f, 0.45f, -0.14f + 0.14f * step))
        );
        append(
            props.wood,
            box({0.75f, 0.055f, 0.018f}, 1.5f),
            glm::translate(at, vec3(0.0f, 0.58f + 0.14f * step, -0.24f - 0.02f * step))
        );
    }
    for (const float x : {-0.6f, 0.6f}) {
        append(
            props.iron, box({0.03f, 0.45f, 0.03f}, 1.0f), glm::translate(at, vec3(x, 0.45f, -0.27f))
        );
        append(
            props.iron, box({0.03f, 0.22f, 0.03f}, 1.0f), glm::translate(at, vec3(x, 0.22f, 0.14f))
        );
        append(
            props.iron, box({0.02f, 0.02f, 0.22f}, 1.0f), glm::translate(at, vec3(x, 0.42f, -0.06f))
        );
    }
}

void addTub(SquareProps& props, vec3 foot, int number) {
    constexpr std::array kTub = {
        vec2(0.0f, 0.0f), vec2(0.30f, 0.0f), vec2(0.38f, 0.46f), vec2(0.33f, 0.46f)};
    append(props.tubs, withUvScale(lathe(kTub, 14), {4.0f, 1.0f}), moved(foot));
    append(
        props.bushes,
        withUvScale(sphere(0.42f, 10, 7), {2.0f, 1.5f}),
        glm::scale(moved(foot + kY * 0.66f), vec3(1.0f, 0.85f, 1.0f))
    );
    for (int i = 0; i < 11; ++i) {
        const float angle = glm::two_pi<float>() * hash(i, number, 401);
        const float height = 0.15f + 0.75f * hash(i, number, 402);
        const vec3 out(
            std::cos(angle) * std::sqrt(1.0f - height * height),
            height,
            std::sin(angle) * std::sqrt(1.0f - height * height)
        );
        append(
            props.blooms,
            sphere(0.055f, 6, 4),
            moved(foot + kY * 0.66f + out * vec3(0.42f, 0.36f, 0.42f))
        );
    }
}

SquareProps buildSquareProps() {
    SquareProps props;
    const auto bench = [&](vec3 foot, float degrees) {
        addBench(props, glm::rotate(moved(foot), glm::radians(degrees), kY));
    };
    bench({-9.5f, 0.1f, -9.5f}, 35.0f);
    bench({-10.6f, 0.1f, -3.0f}, 80.0f);
    bench({2.6f, 0.1f, -12.5f}, 0.0f);
    bench({10.2f, 0.1f, -3.4f}, -65.0f);
    int number = 0;
    for (const vec2 place :
         {vec2(-11.0f, -6.5f),
          {-7.0f, -12.0f},
          {-1.0f, -13.0f},
          {5.6f, -12.0f},
          {10.8f, -6.4f},
          {4.6f, 2.6f}})
        addTub(props, {place.x, 0.1f, place.y}, number++);
    const vec3 foot(-8.4f, 0.1f, -12.4f);
    append(props.booth, box({0.95f, 0.55f, 0.75f}, 1.2f), moved(foot + kY * 0.55f));
    append(props.booth, box({0.95f, 1.15f, 0.05f}, 1.2f), moved(foot + vec3(0.0f, 1.15f, -0.70f)));
    for (const float x : {-0.9f, 0.9f})
        append(props.wood, box({0.05f, 0.6f, 0.05f}, 1.0f), moved(foot + vec3(x, 1.7f, 0.7f)));
    append(props.wood, box({1.05f, 0.03f, 0.22f}, 1.0f), moved(foot + vec3(0.0f, 1.12f, 0.80f)));
    constexpr std::array kRoof = {vec2(1.55f, 2.25f), vec2(0.0f, 3.15f)};
    append(
        props.boothRoof,
        withUvScale(lathe(kRoof, 4), {4.0f, 1.0f}),
        glm::rotate(moved(foot), glm::quarter_pi<float>(), kY)
    );
    return props;
}

} // namespace

void addSquare(GltfWriter& writer) {
    Shape ground = box({30.0f, 0.1f, 30.0f}, 4.0f);
    const Index slabs = addTextured(writer, "slabs", paving(), 0.95f);
    Shape hedge;
    for (const float x : {-1.0f, 1.0f})
        append(hedge, box({0.6f, 1.0f, 22.0f}, 1.0f), moved({x * 15.0f, 1.0f, -6.0f}));
    // All round, so that no flight sees the end of the world.
    for (const float z : {-16.0f, 16.0f})
        append(hedge, box({15.0f, 1.0f, 0.6f}, 1.0f), moved({0.0f, 1.0f, z}));
    Shape crowns;
    Shape trunks;
    const auto plantTree = [&](vec3 foot, float size) {
        append(
            crowns,
            withUvScale(sphere(1.0f, 10, 7), {4.0f, 3.0f}),
            glm::scale(moved(foot + kY * (2.1f * size)), size * vec3(1.0f, 1.15f, 1.0f))
        );
        append(trunks, cylinder(0.16f * size, 2.4f, 7), moved(foot + kY * 1.2f));
    };
    for (int i = 0; i < 16; ++i) {
        const float x = -22.0f + 2.9f * static_cast<float>(i);
        plantTree({x, 0.0f, -19.0f - 3.0f * hash(i, 1, 391)}, 1.5f + hash(i, 0, 391));
    }
    for (int i = 0; i < 12; ++i) {
        const float x = -22.0f + 4.0f * static_cast<float>(i);
        plantTree({x, 0.0f, 19.0f + 3.0f * hash(i, 3, 391)}, 1.3f + hash(i, 2, 391));
    }
    Shape posts;
    Shape globes;
    for (const vec2 place : {vec2(-6.2f, 2.2f), {-6.2f, -6.0f}, {1.8f, -6.5f}, {6.4f, 1.6f}}) {
        const vec3 foot(place.x, 0.1f, place.y);
        append(posts, cylinder(0.05f, 3.0f, 8), moved(foot + kY * 1.5f));
        append(posts, cylinder(0.16f, 0.2f, 10), moved(foot + kY * 0.1f));
        append(globes, sphere(0.18f, 12, 8), moved(foot + kY * 3.12f));
    }
    const SquareProps props = buildSquareProps();
    const std::array parts = {
        MeshPart{
            .shape = props.wood,
            .material = addPlainMaterial(writer, "bench_wood", {0.36f, 0.20f, 0.10f}, 0.7f)},
        MeshPart{
            .shape = props.iron,
            .material = addPlainMaterial(writer, "bench_iron", vec3(0.06f), 0.5f)},
        MeshPart{
            .shape = props.tubs,
            .material = addPlainMaterial(writer, "tubs", {0.48f, 0.22f, 0.13f}, 0.9f)},
        MeshPart{
            .shape = props.bushes,
            .material = addTextured(writer, "bushes", leaves({0.26f, 0.42f, 0.18f}), 0.95f)},
        MeshPart{
            .shape = props.blooms,
            .material = addPlainMaterial(writer, "blooms", {0.85f, 0.20f, 0.28f}, 0.8f)},
        MeshPart{
            .shape = props.booth,
            .material = addTextured(
                writer, "booth", stripes({0.12f, 0.34f, 0.40f}, {0.92f, 0.86f, 0.66f}), 0.7f
            )},
        MeshPart{
            .shape = props.boothRoof,
            .material = addTextured(
                writer, "booth_roof", stripes({0.84f, 0.16f, 0.14f}, {0.95f, 0.92f, 0.84f}), 0.8f
            )},
        MeshPart{.shape = ground, .material = slabs},
        MeshPart{
            .shape = hedge,
            .material = addTextured(writer, "hedge", leaves({0.30f, 0.46f, 0.22f}), 0.95f)},
        MeshPart{
            .shape = crowns,
            .material = addTextured(writer, "crowns", leaves({0.34f, 0.52f, 0.22f}), 0.95f)},
        MeshPart{
            .shape = trunks,
            .material = addPlainMaterial(writer, "trunks", {0.16f, 0.10f, 0.06f}, 0.95f)},
        MeshPart{
            .shape = posts, .material = addPlainMaterial(writer, "lamp_posts", vec3(0.05f), 0.5f)},
        MeshPart{
            .shape = globes,
            .material = writer.addMaterial({.name = "globes", .emissive = {1.0f, 0.9f, 0.7f}})}};
    writer.addNode(
        {.name = "ground",
         .translation = {0.0f, -0.1f, 0.0f},
         .mesh = writer.addMesh("ground", parts)}
    );
}

} // namespace shutter::generator
