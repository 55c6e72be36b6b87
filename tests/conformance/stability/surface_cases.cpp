// SPDX-License-Identifier: MIT
// Meshes, materials and transforms.
#include "tests/conformance/stability/case_lists.h"
#include "tests/conformance/stability/pictures.h"

#include <limits>

namespace shutter::stability {

namespace {

using generator::Shape;
using math::dvec3;

const View kBefore{.background = math::vec3(0.2f, 0.3f, 0.4f), .ambient = math::vec3(0.3f)};

void addWall(SceneBuilder& scene) {
    addShape(scene, makeSheetShape(6, 5), scene.addWaves(), Placement{.position = {0, 0, -5}});
}

const Placement kMover{.position = {0.05, -0.03, -2}, .velocity = {0.5, 0.2, 0}};

void buildDegenerate(SceneBuilder& scene) {
    addWall(scene);
    const auto white = scene.addColor({1, 1, 1});
    Shape needle = makeSheetShape(1, 1);
    for (auto& position : needle.positions)
        position.y = 0.0f;
    addShape(scene, needle, white, kMover);
    Shape point = makeSheetShape(1, 1);
    for (auto& position : point.positions)
        position = glm::vec3(0.0f);
    addShape(scene, point, white, kMover);
    // Two of its triangles have area, two have none.
    Shape mixed = makeSheetShape(1, 1);
    const uint32_t corner = mixed.indices.front();
    mixed.indices.insert(mixed.indices.end(), {corner, corner, corner, corner, corner, corner});
    addShape(scene, mixed, white, kMover);
    Shape alone = makeSheetShape(0.5, 0.5);
    alone.indices.resize(3);
    addShape(scene, alone, white, Placement{.position = {-0.5, 0.4, -2}, .velocity = {0.5, 0, 0}});
}

/// Movers in one plane: which of them a pixel shows is a matter of rounding.
void buildCoplanar(SceneBuilder& scene) {
    addWall(scene);
    for (int i = 0; i < 3; ++i)
        addShape(
            scene,
            makeSheetShape(1.0 - 0.1 * i, 0.8),
            scene.addWaves(),
            Placement{.position = {0.1 * i, 0.05 * i, -2}, .velocity = {0.5 - 0.4 * i, 0.2, 0}}
        );
}

/// Eight closed shells of one entity inside one another: sixteen surfaces on a ray.
void buildShells(SceneBuilder& scene) {
    addWall(scene);
    scene::Material both;
    both.doubleSided = true;
    both.unlit = true;
    both.baseColorFactor = math::vec4(0.9f, 0.2f, 0.1f, 1.0f);
    std::vector<Shape> shells;
    for (int i = 0; i < 8; ++i)
        shells.push_back(generator::sphere(0.7f - 0.08f * float(i), 24, 12));
    addShapes(scene, shells, scene.addMaterial(both), kMover);
}

core::Result<Measurements> measureShells(gpu::Device& device) {
    SceneBuilder scene = makeEmptyScene();
    buildShells(scene);
    motion_blur::MotionBlurSettings settings;
    settings.revealTraversal = motion_blur::RevealTraversal::Stepping; // the other has no limit
    Drawer drawer(device, std::move(scene), settings);
    auto found = measureEveryMethod(drawer, kBefore);
    if (!found)
        return found;
    // The mover's own shells are all that its silhouette's rays meet, up to the limit.
    const auto frame = drawer.draw("hybrid", kBefore, false);
    if (!frame)
        return frame.error();
    const render::Counters& counters = frame.value().statistics.counters;
    const uint64_t masked = counters.at("pixels masked");
    Worst rays;
    rays.add(double(counters.at("rays traced")) / double(masked));
    rays.samples = masked;
    found.value().push_back(
        describe(rays, "rays a masked pixel", "", double(settings.recursionLimit - 1))
    );
    return found;
}

/// Two bars of one mesh that pass through each other.
void buildOverlap(SceneBuilder& scene) {
    addWall(scene);
    const std::vector<Shape> bars = {makeBoxShape(1.2, 0.3, 0.3), makeBoxShape(0.3, 1.2, 0.3)};
    addShapes(
        scene,
        bars,
        scene.addWaves(),
        Placement{
            .position = {0.05, 0, -2},
            .velocity = {0.3, 0.1, 0},
            .angularVelocity = {0.3, 0.8, 1.0}}
    );
}

bool isGreenSheet(const image::Image& picture, uint32_t x, uint32_t y) {
    return picture.at(x, y, 0) == 0.0f && picture.at(x, y, 1) > 0.2f && picture.at(x, y, 2) == 0.0f;
}

/// Masked pixels of the red sheet at which the green one is revealed.
core::Result<uint64_t> countRevealedGreen(Drawer& drawer) {
    const auto sharp = drawer.draw("sharp", kBefore, false);
    const auto frame = drawer.draw("hybrid", kBefore);
    if (!sharp || !frame)
        return sharp ? frame.error() : sharp.error();
    const auto& views = frame.value().intermediates;
    uint64_t count = 0;
    for (uint32_t y = 0; y < kBefore.height; ++y)
        for (uint32_t x = 0; x < kBefore.width; ++x) {
            const bool isRed =
                sharp.value().color.at(x, y, 0) > 0.7f && sharp.value().color.at(x, y, 1) == 0.0f;
            count += isRed && views.at("mask").at(x, y, 0) > 0.5f &&
                     isGreenSheet(views.at("reveal"), x, y);
        }
    return count;
}

core::Result<Measurements> measureEqualLuminance(gpu::Device& device) {
    Measurements all;
    for (const auto test : {motion_blur::ObjectTest::MeshId, motion_blur::ObjectTest::Luminance}) {
        SceneBuilder scene = makeEmptyScene();
        addWall(scene);
        // Red and green of one luminance, in front of each other, in opposite directions.
        addShape(scene, makeSheetShape(1, 0.8), scene.addColor({0.7152f, 0, 0}), kMover);
        addShape(
            scene,
            makeSheetShape(1, 0.8),
            scene.addColor({0, 0.2126f, 0}),
            Placement{.position = {0.1, 0, -2.5}, .velocity = {-0.5, 0.1, 0}}
        );
        motion_blur::MotionBlurSettings settings;
        settings.objectTest = test;
        Drawer drawer(device, std::move(scene), settings);
        auto found = measureEveryMethod(drawer, kBefore);
        if (!found)
            return found;
        const bool byId = test == motion_blur::ObjectTest::MeshId;
        auto seen = countRevealedGreen(drawer);
        if (!seen)
            return seen.error();
        // Behind the red sheet lies the green one. Ids tell the two apart; luminance does not, and
        // its ray goes on to the wall.
        Worst wrong;
        wrong.add((seen.value() > 0) == byId ? 0.0 : 1.0);
        found.value().push_back(
            describe(wrong, byId ? "green not found behind red" : "green found behind red", "", 0.0)
        );
        for (Measured& row : found.value()) {
            row.check += byId ? ", told by id" : ", told by luminance";
            all.push_back(std::move(row));
        }
    }
    return all;
}

/// Rods a twentieth of a pixel wide.
void buildThin(SceneBuilder& scene) {
    addWall(scene);
    const auto white = scene.addColor({1, 1, 1});
    for (int i = 0; i < 12; ++i)
        addShape(
            scene,
            makeBoxShape(0.002, 1.5, 0.002),
            white,
            Placement{
                .position = {-0.8 + 0.1377 * i, 0, -2},
                .rotation = glm::angleAxis(0.1 * i, dvec3(0, 0, 1)),
                .velocity = {0.4, 0.1, 0}}
        );
}

void buildLeaves(SceneBuilder& scene) {
    addWall(scene);
    const auto leaves = scene.addWaves(true);
    for (int i = 0; i < 5; ++i)
        addShape(
            scene,
            makeSheetShape(0.8, 0.8),
            leaves,
            Placement{
                .position = {-0.6 + 0.3 * i, 0.1 * i - 0.2, -2.0 - 0.2 * i},
                .rotation = glm::angleAxis(0.5 * i, glm::normalize(dvec3(0.2, 1, 0.3))),
                .velocity = {0.4, 0.1, 0},
                .angularVelocity = {0.5, 1.0, 0.2}}
        );
}

/// Emission of 1e5 and 1e30, and light of 1e6 lux.
core::Result<Measurements> measureHighlights(gpu::Device& device) {
    SceneBuilder scene = makeEmptyScene();
    addWall(scene);
    scene::Material lamp;
    lamp.emissive = math::vec3(1e5f, 2e5f, 1.0f);
    addShape(scene, generator::sphere(0.4f, 24, 12), scene.addMaterial(lamp), kMover);
    scene::Material sun;
    sun.emissive = math::vec3(1e30f, std::numeric_limits<float>::max(), 0.0f);
    addShape(
        scene,
        generator::sphere(0.1f, 24, 12),
        scene.addMaterial(sun),
        Placement{.position = {-0.5, 0.3, -1.5}, .velocity = {0.1, 0.3, 0}}
    );
    addShape(
        scene,
        generator::sphere(0.3f, 24, 12),
        scene.addLitWaves(),
        Placement{.position = {0.6, -0.3, -2}, .velocity = {-0.2, 0.3, 0}}
    );
    scene.addSun(dvec3(0, 0, -1), 1e6f);
    Drawer drawer(device, std::move(scene));
    auto found = measureEveryMethod(drawer, kBefore);
    if (!found)
        return found;
    Worst brightest;
    for (const game::MethodInfo& method : game::listMethods()) {
        auto frame = drawer.draw(method.name, kBefore, false);
        if (!frame)
            return frame.error();
        for (const float value : frame.value().color.pixels)
            brightest.add(value, method.name);
    }
    found.value().push_back(describe(brightest, "brightest value", "", 65000.0));
    return found;
}

void buildMirrored(SceneBuilder& scene) {
    addWall(scene);
    const auto waves = scene.addWaves();
    const dvec3 scales[] = {{-1, 1, 1}, {1, -1, 1}, {-1, -1, -1}, {-1, -1, 1}};
    for (int i = 0; i < 4; ++i)
        addShape(
            scene,
            makeBoxShape(0.5, 0.4, 0.3),
            waves,
            Placement{
                .position = {-0.6 + 0.4 * i, 0.1 * i, -2},
                .scale = scales[i],
                .velocity = {0.4, 0.1, 0},
                .angularVelocity = {0.3, 0.5, 0}}
        );
}

void buildFlat(SceneBuilder& scene) {
    addWall(scene);
    const auto waves = scene.addWaves();
    for (const dvec3& scale :
         {dvec3(0.0), dvec3(1, 0, 1), dvec3(0, 1, 1), dvec3(1, 1, 0), dvec3(1e-30), dvec3(1e30)})
        addShape(
            scene,
            makeBoxShape(0.5, 0.4, 0.3),
            waves,
            Placement{.position = {0.1, 0, -2}, .scale = scale, .velocity = {0.4, 0.1, 0}}
        );
}

void buildSingular(SceneBuilder& scene) {
    addWall(scene);
    const auto waves = scene.addWaves();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    math::dmat4 rankOne(0.0);
    rankOne[0] = rankOne[1] = rankOne[2] = math::dvec4(1, 1, 1, 0);
    rankOne[3] = math::dvec4(0, 0, -2, 1);
    for (const double bad : {nan, infinity, 1e300}) {
        math::dmat4 matrix(1.0);
        matrix[3] = math::dvec4(0, 0, -2, 1);
        matrix[1][1] = bad;
        addShape(scene, makeBoxShape(0.5, 0.4, 0.3), waves, matrix);
        matrix[1][1] = 1.0;
        matrix[3][0] = bad;
        addShape(scene, makeBoxShape(0.5, 0.4, 0.3), waves, matrix);
    }
    addShape(scene, makeBoxShape(0.5, 0.4, 0.3), waves, rankOne);
    addShape(scene, makeBoxShape(0.5, 0.4, 0.3), waves, math::dmat4(0.0));
    addShape(scene, makeBoxShape(0.3, 0.3, 0.3), waves, kMover);
}

} // namespace

std::vector<HardCase> listSurfaceCases() {
    return {
        makeSceneCase(
            "DegenerateTriangles",
            "Triangles without area",
            "Needles, points and a mesh that has some of both, all moving.",
            buildDegenerate,
            kBefore
        ),
        makeSceneCase(
            "CoplanarTriangles",
            "Movers in one plane",
            "Three sheets at one depth that move apart: rounding says which is in front.",
            buildCoplanar,
            kBefore
        ),
        makeSceneCase(
            "SelfOverlap",
            "A mesh that passes through itself",
            "Two crossed bars of one entity, moving and turning.",
            buildOverlap,
            kBefore
        ),
        {"DeeperThanTheRecursion",
         "Concave beyond the recursion limit",
         "Eight shells in one another: sixteen surfaces on a ray, five are followed.",
         measureShells},
        {"EqualLuminance",
         "Two movers of one luminance",
         "A red and a green sheet that luminance cannot tell apart cross before a wall.",
         measureEqualLuminance},
        makeSceneCase(
            "ThinGeometry",
            "Thinner than a pixel",
            "Rods of a twentieth of a pixel that pixel centres meet or miss.",
            buildThin,
            kBefore
        ),
        makeSceneCase(
            "MaskedLeaves",
            "Alpha-masked leaves",
            "Five sheets with holes that move and turn before each other.",
            buildLeaves,
            kBefore
        ),
        {"Highlights",
         "Highlights of 1e5 and beyond half floats",
         "Lamps of 1e5, 2e5 and the largest float, and a sun of a million lux.",
         measureHighlights},
        makeSceneCase(
            "NegativeScale",
            "Negative scale",
            "Boxes mirrored along one, two and three axes.",
            buildMirrored,
            kBefore
        ),
        makeSceneCase(
            "ZeroScale",
            "Zero scale",
            "Boxes flattened along each axis, along all, and scaled by 1e-30 and 1e30.",
            buildFlat,
            kBefore
        ),
        makeSceneCase(
            "SingularMatrices",
            "Singular matrices and such as hold NaN",
            "Rank one, rank zero, NaN, infinity and 1e300 beside a sound mover.",
            buildSingular,
            kBefore
        ),
    };
}

} // namespace shutter::stability
