// SPDX-License-Identifier: MIT
#include "tests/conformance/stability/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace shutter::stability {

namespace {

using image::Image;
using render::FrameResult;
using scene::ShutterPhase;

constexpr uint32_t kTruthSamples = 4;

bool isTruth(const game::MethodInfo& method) {
    return method.family == game::MethodFamily::Accumulate ||
           method.family == game::MethodFamily::Truth;
}

/// What the method's filter read: the sharp picture and what rays revealed, or the noisy one.
Range findInputs(const Image& sharp, const FrameResult& frame) {
    Range range;
    const auto noisy = frame.intermediates.find("noisy");
    if (noisy != frame.intermediates.end()) {
        range.add(noisy->second);
        return range;
    }
    range.add(sharp);
    const auto last = frame.intermediates.find("last");
    if (last != frame.intermediates.end())
        range.add(last->second);
    const auto revealed = frame.intermediates.find("reveal");
    if (revealed != frame.intermediates.end())
        range.add(revealed->second);
    return range;
}

} // namespace

Drawer::Drawer(
    gpu::Device& device, SceneBuilder scene, const motion_blur::MotionBlurSettings& settings
)
    : mDevice(device), mShot{std::move(scene.world), scene.camera}, mSettings(settings),
      mRenderer(device, mShot.world.assets), mDrawer(device, mRenderer) {}

core::Result<FrameResult>
Drawer::draw(std::string_view name, const View& view, bool intermediates) {
    const auto found = game::findMethod(name);
    if (!found)
        return found.error();
    scene::CameraShutter shutter{view.exposureSeconds, view.phase};
    shutter.mode = view.mode;
    mShot.world.registry.add(mShot.camera, shutter);
    game::MethodOptions method = game::makeMethod(*found.value(), mSettings);
    if (isTruth(*found.value()))
        method.samples = view.samples > 0 ? view.samples : kTruthSamples;
    game::ShotOptions shot;
    shot.width = view.width;
    shot.height = view.height;
    shot.background = view.background;
    shot.ambient = view.ambient;
    shot.frameSeconds = view.frameSeconds;
    game::PictureRequest picture = game::makePicture(mShot, shot, method, view.seconds);
    if (intermediates) {
        picture.frame.intermediates = game::listIntermediates(*found.value());
        picture.frame.intermediates.erase("depth"); // it is in "motion"
    }
    return mDrawer.draw(mShot.world, picture);
}

void Census::add(const Image& picture) {
    values += picture.pixels.size();
    notFinite += std::count_if(picture.pixels.begin(), picture.pixels.end(), [](float value) {
        return !std::isfinite(value);
    });
}

void Census::add(const FrameResult& frame) {
    add(frame.color);
    for (const auto& [name, picture] : frame.intermediates)
        add(picture);
}

Measured describe(const Census& census, std::string check) {
    return {std::move(check), double(census.notFinite), 0.0, "", census.values, census.notFinite};
}

void Range::add(const Image& picture) {
    for (size_t i = 0; i + 2 < picture.pixels.size(); i += picture.channels)
        for (size_t c = 0; c < 3; ++c) {
            least[c] = std::min(least[c], double(picture.pixels[i + c]));
            greatest[c] = std::max(greatest[c], double(picture.pixels[i + c]));
        }
}

double halfUlp(double value) {
    constexpr int kSmallestExponent = -14; // of a normal half float; 10 bits of fraction
    const double size = std::abs(value);
    const int exponent =
        size > 0.0 ? std::max(std::ilogb(size), kSmallestExponent) : kSmallestExponent;
    return std::ldexp(1.0, exponent - 10);
}

void Worst::add(double value, std::string_view where) {
    ++samples;
    if (value <= error)
        return;
    error = std::isnan(value) ? std::numeric_limits<double>::infinity() : value;
    note = where;
}

Measured describe(const Worst& worst, std::string check, std::string unit, double bound) {
    return {std::move(check), worst.error, bound, std::move(unit), worst.samples, 0, worst.note};
}

void addExcursion(Worst& worst, const Image& picture, const Range& range, std::string_view where) {
    for (size_t i = 0; i + 2 < picture.pixels.size(); i += picture.channels)
        for (size_t c = 0; c < 3; ++c) {
            const double value = picture.pixels[i + c];
            const double below = (range.least[c] - value) / halfUlp(range.least[c]);
            const double above = (value - range.greatest[c]) / halfUlp(range.greatest[c]);
            worst.add(std::max({below, above, 0.0}), where);
        }
}

void addDifference(Worst& worst, const Image& a, const Image& b, std::string_view where) {
    SHUTTER_CHECK(a.pixels.size() == b.pixels.size(), "pictures of two sizes");
    for (size_t i = 0; i + 2 < a.pixels.size(); i += a.channels)
        for (size_t c = 0; c < 3; ++c)
            worst.add(std::abs(double(a.pixels[i + c]) - double(b.pixels[i + c])), where);
}

uint64_t hashFrame(const FrameResult& frame) {
    uint64_t hash = 0xcbf29ce484222325u; // FNV-1a (Fowler, Noll, Vo), a word at a time
    const auto addWord = [&](uint32_t word) { hash = (hash ^ word) * 0x100000001b3u; };
    const auto addImage = [&](const Image& picture) {
        addWord(picture.width);
        for (const float value : picture.pixels)
            addWord(std::bit_cast<uint32_t>(value));
    };
    addImage(frame.color);
    addImage(frame.display);
    for (const auto& [name, picture] : frame.intermediates)
        addImage(picture);
    return hash;
}

core::Result<Measurements> measureEveryMethod(Drawer& drawer, View view) {
    Census census;
    Worst excursion;
    for (const ShutterPhase phase :
         {ShutterPhase::Start, ShutterPhase::Centre, ShutterPhase::End}) {
        view.phase = phase;
        Image sharp;
        for (const game::MethodInfo& method : game::listMethods()) {
            if (!game::canRun(method, drawer.device()))
                continue;
            auto frame = drawer.draw(method.name, view);
            if (!frame)
                return frame.error();
            census.add(frame.value());
            if (method.family == game::MethodFamily::Sharp)
                sharp = frame.value().color;
            if (method.family != game::MethodFamily::MotionBlur)
                continue;
            const Range inputs = findInputs(sharp, frame.value());
            addExcursion(
                excursion,
                frame.value().color,
                inputs,
                fmt::format("{}, phase {}", method.name, static_cast<int>(phase))
            );
        }
    }
    return Measurements{
        describe(census),
        describe(excursion, "inside the range of what was filtered", "half ulp", 1.0)};
}

core::Result<Measurements> measureRays(Drawer& drawer, View view) {
    constexpr double kStep = 2.0 / 255.0;
    view.exposureSeconds = 0.0;
    view.samples = 1;
    const auto raster = drawer.draw("sharp", view);
    const auto rays = drawer.draw("truth", view, false);
    if (!raster || !rays)
        return raster ? rays.error() : raster.error();
    double differing = 0.0;
    Range shown;
    shown.add(raster.value().color);
    for (uint32_t y = 0; y < view.height; ++y)
        for (uint32_t x = 0; x < view.width; ++x) {
            double worst = 0.0;
            for (uint32_t c = 0; c < 3; ++c) {
                const double a = raster.value().color.at(x, y, c);
                const double b = rays.value().color.at(x, y, c);
                worst = std::max(worst, std::abs(a - b) / std::max(1.0, std::abs(a)));
            }
            differing += worst > kStep ? 1.0 : 0.0;
        }
    const uint64_t pixels = uint64_t{view.width} * view.height;
    Worst share;
    share.add(differing / double(pixels));
    share.samples = pixels;
    Worst black;
    black.add(
        std::max({shown.greatest[0], shown.greatest[1], shown.greatest[2]}) > 0.0 ? 0.0 : 1.0
    );
    black.samples = pixels;
    // Pixel centres on an edge, which raster and rays round to either side.
    return Measurements{
        describe(share, "rays see what raster draws, share of pixels", "", 0.01),
        describe(black, "pictures that are black", "", 0.0)};
}

HardCase makeSceneCase(
    std::string name,
    std::string title,
    std::string description,
    std::function<void(SceneBuilder&)> build,
    View view
) {
    HardCase made{std::move(name), std::move(title), std::move(description), {}};
    made.measure = [build = std::move(build), view](gpu::Device& device) {
        SceneBuilder scene = makeEmptyScene();
        build(scene);
        Drawer drawer(device, std::move(scene));
        auto found = measureEveryMethod(drawer, view);
        if (!found || !device.hasRayQuery())
            return found;
        auto rays = measureRays(drawer, view);
        if (!rays)
            return rays;
        for (Measured& row : rays.value())
            found.value().push_back(std::move(row));
        return found;
    };
    return made;
}

} // namespace shutter::stability
