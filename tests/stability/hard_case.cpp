// SPDX-License-Identifier: MIT
#include "tests/stability/hard_case.h"

#include "game/shot/picture_drawer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace shutter::stability {

using image::Image;
using math::dvec3;
using scene::ShutterPhase;

void Worst::add(double value, std::string_view where) {
    ++samples;
    if (value <= error)
        return;
    error = std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
    note = where;
}

void Worst::addNotFinite(const Image& picture, std::string_view where) {
    for (const float value : picture.pixels)
        add(std::isfinite(value) ? 0.0 : 1.0, where);
}

void Worst::addDifference(const Image& a, const Image& b, std::string_view where) {
    ASSERT_EQ(a.pixels.size(), b.pixels.size()) << where;
    for (size_t i = 0; i + 2 < a.pixels.size(); i += a.channels)
        for (size_t c = 0; c < 3; ++c)
            add(std::abs(double(a.pixels[i + c]) - double(b.pixels[i + c])), where);
}

void hold(const std::string& check, const Worst& worst, double bound, const std::string& unit) {
    const std::string found = fmt::format(
        "{:.6g}{}{} of at most {:.6g}{}",
        worst.error,
        unit.empty() ? "" : " ",
        unit,
        bound,
        worst.note.empty() ? "" : " (" + worst.note + ")"
    );
    EXPECT_GT(worst.samples, 0u) << check << ": nothing was checked";
    EXPECT_LE(worst.error, bound) << check << ": " << found;
    ::testing::Test::RecordProperty(check, found);
}

double halfUlp(double value) {
    constexpr int kSmallestExponent = -14; // of a normal half float; 10 bits of fraction
    const double size = std::abs(value);
    const int exponent =
        size > 0.0 ? std::max(std::ilogb(size), kSmallestExponent) : kSmallestExponent;
    return std::ldexp(1.0, exponent - 10);
}

Range::Range() {
    std::fill(least, least + 3, std::numeric_limits<double>::infinity());
    std::fill(greatest, greatest + 3, -std::numeric_limits<double>::infinity());
}

void Range::add(const Image& picture) {
    for (size_t i = 0; i + 2 < picture.pixels.size(); i += picture.channels)
        for (size_t c = 0; c < 3; ++c) {
            least[c] = std::min(least[c], double(picture.pixels[i + c]));
            greatest[c] = std::max(greatest[c], double(picture.pixels[i + c]));
        }
}

void Range::addExcursion(Worst& worst, const Image& picture, std::string_view where) const {
    for (size_t i = 0; i + 2 < picture.pixels.size(); i += picture.channels)
        for (size_t c = 0; c < 3; ++c) {
            const double value = picture.pixels[i + c];
            const double below = (least[c] - value) / halfUlp(least[c]);
            const double above = (value - greatest[c]) / halfUlp(greatest[c]);
            worst.add(std::max({below, above, 0.0}), where);
        }
}

Shot makeShot() {
    return {.width = 64, .height = 48, .instants = 4, .settings = {.sampleCount = 0}};
}

Shot makeLitShot() {
    Shot shot = makeShot();
    shot.background = {0.1f, 0.2f, 0.3f};
    shot.ambient = math::vec3(0.3f);
    return shot;
}

std::vector<std::string_view> listMethods(const gpu::Device& device) {
    std::vector<std::string_view> names;
    for (const game::MethodInfo& method : game::listMethods())
        if (game::canRun(method, device))
            names.emplace_back(method.name);
    return names;
}

render::FrameResult draw(Stage& stage, Shot shot, std::string_view method, bool hasIntermediates) {
    shot.method = method;
    if (hasIntermediates) {
        shot.aovs = game::listIntermediates(*game::findMethod(method).value());
        shot.aovs.erase("depth"); // it is in "motion"
    }
    return stage.render(shot);
}

void holdEveryMethod(
    gpu::Device& device,
    Stage& stage,
    const Shot& shot,
    const std::string& label,
    Phases phases,
    const Judge& judge
) {
    constexpr std::array kPhases{ShutterPhase::Start, ShutterPhase::Centre, ShutterPhase::End};
    Worst notFinite;
    Worst excursion;
    const std::vector<std::string_view> methods = listMethods(device);
    std::array<Image, kPhases.size()> sharp;
    const auto isDrawn = [&](size_t method, size_t phase) {
        if (test::drawsAll())
            return true;
        if (phases == Phases::OfShot)
            return kPhases[phase] == shot.phase;
        // The sharp picture is what the others of its phase have filtered.
        return method == 0 || (method + label.size()) % kPhases.size() == phase;
    };
    for (size_t i = 0; i < methods.size(); ++i)
        for (size_t phase = 0; phase < kPhases.size(); ++phase) {
            if (!isDrawn(i, phase))
                continue;
            const std::string_view method = methods[i];
            Shot own = shot;
            own.phase = kPhases[phase];
            const render::FrameResult frame = draw(stage, own, method);
            const std::string where = fmt::format("{}, phase {}", method, int(own.phase));
            notFinite.addNotFinite(frame.color, where);
            for (const auto& [name, picture] : frame.intermediates)
                notFinite.addNotFinite(picture, where + ", " + name);
            if (judge)
                judge(method, own, frame);
            if (method == "sharp")
                sharp[phase] = frame.color;
            if (game::findMethod(method).value()->family != game::MethodFamily::MotionBlur)
                continue;
            // What the filter read: the sharp pictures and what rays revealed, or the noisy one.
            Range inputs;
            if (const auto noisy = frame.intermediates.find("noisy");
                noisy != frame.intermediates.end())
                inputs.add(noisy->second);
            else
                inputs.add(sharp[phase]);
            for (const char* name : {"last", "reveal"})
                if (const auto read = frame.intermediates.find(name);
                    read != frame.intermediates.end())
                    inputs.add(read->second);
            inputs.addExcursion(excursion, frame.color, where);
        }
    hold("finite" + label, notFinite);
    hold("inside the range of what was filtered" + label, excursion, 1.0, "half ulp");
}

SceneBuilder makeEmptyScene() {
    SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.moveCamera({});
    return scene;
}

scene::Primitive makePrimitive(const generator::Shape& shape, scene::AssetIndex material) {
    scene::Primitive primitive;
    primitive.positions = shape.positions;
    primitive.normals = shape.normals;
    primitive.uv0 = shape.uvs;
    primitive.indices = shape.indices;
    primitive.material = material;
    return primitive;
}

ecs::Entity addWallAndSphere(SceneBuilder& scene) {
    const auto lit = scene.addLitWaves();
    scene.add(makePrimitive(generator::sheet({6, 3}, 12), lit), {.position = {0, 0, -5}});
    scene.addSun(glm::normalize(dvec3(-0.4, -0.7, -0.6)), 3.0f);
    return scene.add(
        makePrimitive(generator::sphere(0.5f, 24, 12), lit),
        {.position = {0.1, 0, -2.5}, .velocity = {0.5, 0.2, 0.1}}
    );
}

SceneBuilder makeBusyScene() {
    SceneBuilder scene = makeEmptyScene();
    scene.add(test::makeQuad(6, 5, scene.addLitWaves()), {.position = {0, 0, -5}});
    scene.add(
        test::makeSphere(0.5, scene.addLitWaves()),
        {.position = {0.1, 0, -2.5},
         .velocity = {1.0, 0.2, 0.1},
         .angularVelocity = {0.2, 0.9, 0.1}}
    );
    scene.add(
        test::makeQuad(0.8, 0.8, scene.addWaves(true)),
        {.position = {-0.3, 0.1, -2}, .velocity = {-0.8, 0.1, 0}}
    );
    scene.addSun(glm::normalize(dvec3(-0.4, -0.7, -0.6)), 3.0f);
    scene.moveCamera({.angularVelocity = {0.02, 0.05, 0}});
    return scene;
}

uint64_t hashFrame(const render::FrameResult& frame) {
    uint64_t hash = 0xcbf29ce484222325u; // FNV-1a (Fowler, Noll, Vo), a word at a time
    const auto add = [&](uint32_t word) { hash = (hash ^ word) * 0x100000001b3u; };
    const auto addImage = [&](const Image& picture) {
        add(picture.width);
        for (const float value : picture.pixels)
            add(std::bit_cast<uint32_t>(value));
    };
    addImage(frame.color);
    addImage(frame.display);
    for (const auto& [name, picture] : frame.intermediates)
        addImage(picture);
    return hash;
}

} // namespace shutter::stability
