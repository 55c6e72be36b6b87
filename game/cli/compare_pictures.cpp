// SPDX-License-Identifier: MIT
#include "game/cli/compare_pictures.h"

#include "engine/image/channels.h"
#include "engine/image/metrics.h"
#include "engine/io/image_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace shutter::game {

namespace {

using core::makeError;
using Indices = std::vector<uint32_t>;

/// A picture as stored in its file, with its colour channels.
struct Source {
    std::string name;
    io::StoredImage stored;
    std::optional<image::ColorChannels> color;

    [[nodiscard]] const image::Image& image() const { return stored.image; }

    /// Where the pixels lie, from the corner of the display window.
    [[nodiscard]] io::PixelWindow place() const {
        io::PixelWindow place = stored.data;
        place.x -= stored.display.x;
        place.y -= stored.display.y;
        return place;
    }
};

std::string describeSize(const io::PixelWindow& window) {
    return fmt::format("{}x{}", window.width, window.height);
}

/// "0,0 to 31,31"
std::string describePlace(const io::PixelWindow& window) {
    return fmt::format(
        "{},{} to {},{}",
        window.x,
        window.y,
        window.x + window.width - 1,
        window.y + window.height - 1
    );
}

core::Result<Source> readSource(const std::string& name, std::vector<std::string>& notes) {
    auto file = io::readStoredImage(name);
    if (!file)
        return file.error();
    Source source{name, std::move(file).value(), {}};
    const uint64_t all = uint64_t(source.image().width) * source.image().height;
    io::cropToDisplay(source.stored);
    const uint64_t left = uint64_t(source.image().width) * source.image().height;
    if (left == 0)
        return makeError("'{}' has no pixels in its display window", name);
    if (left < all)
        notes.push_back(fmt::format(
            "of '{}', {} outside its display window {} left out",
            name,
            all - left == 1 ? std::string("a pixel") : fmt::format("{} pixels", all - left),
            all - left == 1 ? "is" : "are"
        ));
    if (!source.stored.remainder.pixels.empty())
        notes.push_back(fmt::format(
            "'{}' has whole numbers above 2^24: PSNR and SSIM are of the nearest floats", name
        ));
    source.color = image::findColor(source.image());
    return source;
}

core::Status checkWindows(const Source& a, const Source& b, std::vector<std::string>& notes) {
    const io::PixelWindow& shownA = a.stored.display;
    const io::PixelWindow& shownB = b.stored.display;
    if (shownA.width != shownB.width || shownA.height != shownB.height)
        return makeError(
            "'{}' is {} and '{}' is {}: pictures of one size can be compared",
            a.name,
            describeSize(shownA),
            b.name,
            describeSize(shownB)
        );
    if (a.place() != b.place())
        return makeError(
            "'{}' has the pixels {} of its display window and '{}' {}: the same part of a picture "
            "can be compared",
            a.name,
            describePlace(a.place()),
            b.name,
            describePlace(b.place())
        );
    if (a.stored.data.width < shownA.width || a.stored.data.height < shownA.height)
        notes.push_back(fmt::format(
            "of the display windows, {}, the pixels {} are there and compared",
            describeSize(shownA),
            describePlace(a.place())
        ));
    if (shownA.x != shownB.x || shownA.y != shownB.y)
        notes.push_back(fmt::format(
            "the display windows begin at {},{} and {},{}; both are compared from their corners",
            shownA.x,
            shownA.y,
            shownB.x,
            shownB.y
        ));
    if (a.stored.pixelAspect != b.stored.pixelAspect)
        notes.push_back(fmt::format(
            "the pixel aspect ratios differ: {:g} and {:g}",
            a.stored.pixelAspect,
            b.stored.pixelAspect
        ));
    return {};
}

Indices listAll(const image::Image& picture) {
    Indices all(picture.channels);
    for (uint32_t c = 0; c < picture.channels; ++c)
        all[c] = c;
    return all;
}

/// The channels that are neither `color` nor its alpha.
Indices listRest(const Source& source, bool withoutColor) {
    Indices rest = listAll(source.image());
    if (!withoutColor)
        return rest;
    std::erase_if(rest, [&](uint32_t c) {
        const Indices& color = source.color->color;
        return source.color->alpha == c || std::find(color.begin(), color.end(), c) != color.end();
    });
    return rest;
}

/// Channels of the same name in two pictures.
struct Matches {
    Indices a;
    Indices b;
};

/// Those that only one has are noted.
Matches matchByName(
    const Source& a, Indices restA, const Source& b, Indices restB, std::vector<std::string>& notes
) {
    Matches both;
    for (const uint32_t inA : restA)
        for (const uint32_t inB : restB)
            if (a.image().channelNames[inA] == b.image().channelNames[inB]) {
                both.a.push_back(inA);
                both.b.push_back(inB);
                break;
            }
    const auto note = [&](const Source& source, Indices& rest, const Indices& matched) {
        std::erase_if(rest, [&](uint32_t c) {
            return std::find(matched.begin(), matched.end(), c) != matched.end();
        });
        if (!rest.empty())
            notes.push_back(fmt::format(
                "only '{}' has {}, which {} left out",
                source.name,
                image::listChannels(source.image(), rest),
                rest.size() == 1 ? "is" : "are"
            ));
    };
    note(a, restA, both.a);
    note(b, restB, both.b);
    return both;
}

image::Image expandGrey(const image::Image& picture) {
    image::Image color = image::pickChannels(picture, Indices{0, 0, 0});
    color.channelNames = {"R", "G", "B"};
    return color;
}

/// A value as the file holds it. \param channel nothing: opaque
double valueAt(const Source& source, size_t pixel, std::optional<uint32_t> channel) {
    if (!channel)
        return 1.0;
    const size_t i = pixel * source.image().channels + *channel;
    const auto& remainder = source.stored.remainder.pixels;
    return double(source.image().pixels[i]) + (remainder.empty() ? 0.0 : double(remainder[i]));
}

/// Largest difference of two channels. NaN counts as infinity; infinity equals itself.
double findDifference(
    const Source& a,
    std::optional<uint32_t> channelA,
    const Source& b,
    std::optional<uint32_t> channelB
) {
    double largest = 0.0;
    const size_t pixels = size_t(a.image().width) * a.image().height;
    for (size_t i = 0; i < pixels; ++i) {
        const double va = valueAt(a, i, channelA);
        const double vb = valueAt(b, i, channelB);
        if (va == vb)
            continue; // infinite, too
        const double difference = std::abs(va - vb);
        largest = std::isnan(difference) ? std::numeric_limits<double>::infinity()
                                         : std::max(largest, difference);
    }
    return largest;
}

/// The metrics are of the colours, and of other channels the largest differences are found.
void takeColors(const Source& a, const Source& b, Comparison& comparison) {
    comparison.isColor = true;
    comparison.a.image = image::pickChannels(a.image(), a.color->color);
    comparison.b.image = image::pickChannels(b.image(), b.color->color);
    for (ComparedPicture* picture : {&comparison.a, &comparison.b})
        if (picture->image.channels == 1 &&
            comparison.a.image.channels != comparison.b.image.channels)
            picture->image = expandGrey(picture->image);
    const Indices& colorA = a.color->color;
    const Indices& colorB = b.color->color;
    for (size_t c = 0; c < std::max(colorA.size(), colorB.size()); ++c)
        comparison.maxDifference = std::max(
            comparison.maxDifference,
            findDifference(
                a, colorA[std::min(c, colorA.size() - 1)], b, colorB[std::min(c, colorB.size() - 1)]
            )
        );
    if (a.color->alpha || b.color->alpha) {
        const Source& named = a.color->alpha ? a : b;
        comparison.others.push_back(
            {named.image().channelNames[*named.color->alpha],
             findDifference(a, a.color->alpha, b, b.color->alpha)}
        );
    }
    const Matches rest = matchByName(a, listRest(a, true), b, listRest(b, true), comparison.notes);
    for (size_t i = 0; i < rest.a.size(); ++i)
        comparison.others.push_back(
            {a.image().channelNames[rest.a[i]], findDifference(a, rest.a[i], b, rest.b[i])}
        );
}

/// The metrics are of all channels that both have.
core::Status takeValues(const Source& a, const Source& b, Comparison& comparison) {
    const Matches both =
        matchByName(a, listRest(a, false), b, listRest(b, false), comparison.notes);
    if (both.a.empty())
        return makeError(
            "'{}' has the channels {} and '{}' has {}: there are none that both have",
            a.name,
            fmt::join(a.image().channelNames, ", "),
            b.name,
            fmt::join(b.image().channelNames, ", ")
        );
    comparison.a.image = image::pickChannels(a.image(), both.a);
    comparison.b.image = image::pickChannels(b.image(), both.b);
    for (size_t i = 0; i < both.a.size(); ++i)
        comparison.maxDifference =
            std::max(comparison.maxDifference, findDifference(a, both.a[i], b, both.b[i]));
    return {};
}

void noteNotFinite(const Source& source, std::vector<std::string>& notes) {
    const auto& values = source.image().pixels;
    const auto count = std::count_if(values.begin(), values.end(), [](float value) {
        return !std::isfinite(value);
    });
    if (count > 0)
        notes.push_back(fmt::format(
            "'{}' has {} that {} NaN or infinite",
            source.name,
            count == 1 ? std::string("a value") : fmt::format("{} values", count),
            count == 1 ? "is" : "are"
        ));
}

/// Error: `source` has no colour.
core::Status checkColor(const Source& source) {
    if (source.color)
        return {};
    return makeError(
        "'{}' holds no colour that can be tone mapped but {}: compare its values with --linear",
        source.name,
        fmt::join(source.image().channelNames, ", ")
    );
}

void toneMap(ComparedPicture& picture, const tonemap::TonemapSettings& settings) {
    if (picture.isDisplay)
        return;
    picture.image = tonemap::computeDisplayImage(picture.image, settings);
    picture.isDisplay = true;
    picture.isToneMapped = true;
}

/// Brings both to display values.
void showBoth(Comparison& comparison) {
    if (comparison.a.isDisplay && comparison.b.isDisplay)
        return;
    if (!comparison.a.isDisplay && !comparison.b.isDisplay)
        comparison.storedDifference = comparison.maxDifference;
    toneMap(comparison.a, comparison.tonemap);
    toneMap(comparison.b, comparison.tonemap);
    comparison.maxDifference = image::computeMaxDifference(comparison.a.image, comparison.b.image);
    if (comparison.storedDifference.value_or(0.0) > 0.0 && comparison.maxDifference == 0.0)
        comparison.notes.push_back(fmt::format(
            "a display shows no difference, but the stored values differ by up to {:g}: --linear "
            "compares them",
            *comparison.storedDifference
        ));
}

} // namespace

core::Result<Comparison> readComparison(
    const std::string& nameA,
    const std::string& nameB,
    bool isStored,
    const tonemap::TonemapSettings& settings
) {
    Comparison comparison;
    comparison.tonemap = settings;
    auto a = readSource(nameA, comparison.notes);
    if (!a)
        return a.error();
    auto b = readSource(nameB, comparison.notes);
    if (!b)
        return b.error();
    SHUTTER_TRY(checkWindows(a.value(), b.value(), comparison.notes));
    comparison.a.name = nameA;
    comparison.b.name = nameB;
    comparison.a.isDisplay = a.value().stored.isDisplayEncoded;
    comparison.b.isDisplay = b.value().stored.isDisplayEncoded;
    if (!isStored) {
        SHUTTER_TRY(checkColor(a.value()));
        SHUTTER_TRY(checkColor(b.value()));
    }
    if (a.value().color && b.value().color)
        takeColors(a.value(), b.value(), comparison);
    else
        SHUTTER_TRY(takeValues(a.value(), b.value(), comparison));
    noteNotFinite(a.value(), comparison.notes);
    noteNotFinite(b.value(), comparison.notes);
    if (!isStored)
        showBoth(comparison);
    return comparison;
}

} // namespace shutter::game
