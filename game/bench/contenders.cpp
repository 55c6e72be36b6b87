// SPDX-License-Identifier: MIT
#include "game/bench/contenders.h"

#include "game/shot/picture_drawer.h"
#include "modules/depth_of_field/depth_of_field.h"
#include "modules/motion_blur/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

namespace shutter::bench {

namespace {

void takePapersNumbers(motion_blur::MotionBlurSettings& settings) {
    settings = motion_blur::paperSettings();
}

template <int kPercent> void shareRays(motion_blur::MotionBlurSettings& settings) {
    settings.rayShare = 0.01f * kPercent;
}

template <int kPerHundredPixels> void limitRays(motion_blur::MotionBlurSettings& settings) {
    settings.raysPerPixel = 0.01f * kPerHundredPixels;
}

/// A method with other settings than its defaults.
struct VariantRow {
    std::string_view method;
    const char* name;
    const char* description;
    void (*apply)(motion_blur::MotionBlurSettings& settings);
};

constexpr VariantRow kVariantRows[] = {
    {"gather", "gather_paper", "gather with the numbers of the publication", takePapersNumbers},
    {"hybrid", "hybrid_paper", "hybrid with the numbers of the publication", takePapersNumbers},
    {"hybrid", "hybrid_share_0", "hybrid without rays (rayShare 0)", shareRays<0>},
    {"hybrid", "hybrid_share_25", "hybrid, a ray for 4 masked pixels", shareRays<25>},
    {"hybrid", "hybrid_share_50", "hybrid, a ray for 2 masked pixels", shareRays<50>},
    {"adaptive", "adaptive_rays_2", "adaptive, 2 rays for 100 pixels", limitRays<2>},
    {"adaptive", "adaptive_rays_50", "adaptive, 50 rays for 100 pixels", limitRays<50>},
    {"adaptive", "adaptive_rays_200", "adaptive, 200 rays for 100 pixels", limitRays<200>},
};

const VariantRow* findVariant(std::string_view name) {
    const auto* found =
        std::find_if(std::begin(kVariantRows), std::end(kVariantRows), [&](const VariantRow& row) {
            return name == row.name;
        });
    return found == std::end(kVariantRows) ? nullptr : found;
}

/// A depth-of-field filter of the sharp picture, or combined with a motion blur without a lens.
struct LensRow {
    const char* name;
    const char* description;
    std::string_view filter; ///< of depth_of_field::getFilter()
    std::string_view blur;   ///< of motion_blur::listMethods(); empty: none
    bool filtersBlurred;
};

constexpr LensRow kLensRows[] = {
    {"jimenez2014_lens", "depth of field: scatter as you gather", "jimenez2014", "", false},
    {"near_far_lens", "depth of field: a near field over a far field", "near_far", "", false},
    {"hybrid_lens",
     "depth of field: near_far_lens over what rays see past near edges",
     "hybrid",
     "",
     false},
    {"lens_then_blur", "near_far_lens, then resolved's motion blur", "near_far", "resolved", false},
    {"blur_then_lens", "resolved's motion blur, then near_far_lens", "near_far", "resolved", true},
};

/// Instants of the motion blur combined with a filter.
constexpr uint32_t kInstantsWithLensFilter = 16;

game::MethodInfo describeLensContender(const LensRow& row) {
    const depth_of_field::Filter& filter = depth_of_field::getFilter(row.filter);
    game::MethodInfo contender{
        .name = row.name,
        .description = row.description,
        .publication = filter.publication,
        .family = game::MethodFamily::Sharp,
        .hasLens = true,
        .lensFilter = &filter,
        .filtersBlurred = row.filtersBlurred,
        .sampleUnit = game::SampleUnit::Taps,
        .defaultSamples = depth_of_field::kDefaultTaps};
    if (filter.tracesRays) {
        contender.rays = game::RayNeed::Query;
        contender.sampleUnit = game::SampleUnit::Rays;
        contender.defaultSamples = depth_of_field::kDefaultRays;
    }
    if (row.blur.empty())
        return contender;
    contender.blur = &motion_blur::getMethod(row.blur);
    contender.family = game::MethodFamily::MotionBlur;
    contender.rays = contender.blur->rays;
    contender.sampleUnit = contender.blur->sampleUnit;
    contender.defaultSamples = kInstantsWithLensFilter;
    return contender;
}

std::vector<uint32_t> listPowersOfTwo(uint32_t first, uint32_t last) {
    std::vector<uint32_t> powers;
    for (uint32_t power = first; power <= last; power *= 2)
        powers.push_back(power);
    return powers;
}

/// Sample counts to measure a method at, rising; its default is one of them if it is not above
/// them.
std::vector<uint32_t> listSampleCounts(const game::MethodInfo& method, uint32_t maxRays) {
    if (!method.sampleUnit)
        return {0};
    std::vector<uint32_t> counts;
    switch (*method.sampleUnit) {
    case game::SampleUnit::Taps:
        counts = listPowersOfTwo(4, 64);
        break;
    case game::SampleUnit::Instants:
        counts = listPowersOfTwo(2, 64); // the default of one is the truth itself
        break;
    case game::SampleUnit::Rays:
        counts = listPowersOfTwo(
            1, method.lensFilter ? std::min(maxRays, depth_of_field::kMaxRays) : maxRays
        );
        break;
    }
    if (method.defaultSamples < counts.back())
        counts.push_back(method.defaultSamples);
    std::sort(counts.begin(), counts.end());
    counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
    return counts;
}

} // namespace

std::span<const game::MethodInfo> listContenders() {
    static const std::vector<game::MethodInfo> kContenders = [] {
        std::vector<game::MethodInfo> contenders;
        for (const game::MethodInfo& method : game::listMethods()) {
            contenders.push_back(method);
            for (const VariantRow& row : kVariantRows)
                if (method.name == row.method) {
                    contenders.push_back(method);
                    contenders.back().name = row.name;
                    contenders.back().description = row.description;
                }
        }
        for (const LensRow& row : kLensRows)
            contenders.push_back(describeLensContender(row));
        return contenders;
    }();
    return kContenders;
}

bool isOnDialAlone(std::string_view contender) {
    const VariantRow* variant = findVariant(contender);
    return variant && variant->apply != takePapersNumbers;
}

core::Result<const game::MethodInfo*> findContender(std::string_view name) {
    std::vector<std::string_view> names;
    for (const game::MethodInfo& contender : listContenders()) {
        if (name == contender.name)
            return &contender;
        names.emplace_back(contender.name);
    }
    return core::makeError("method '{}' is unknown; there are {}", name, fmt::join(names, ", "));
}

std::vector<SamplePoint>
makeSweep(const std::vector<const game::MethodInfo*>& methods, uint32_t maxRays) {
    std::vector<SamplePoint> points;
    for (const game::MethodInfo* method : methods)
        for (uint32_t count : listSampleCounts(*method, maxRays))
            points.push_back({method, count, count == method->defaultSamples});
    return points;
}

std::vector<SamplePoint> makeDialPoints(const std::vector<const game::MethodInfo*>& methods) {
    constexpr std::array kRays = {4u, 16u, 64u};
    std::vector<SamplePoint> points;
    for (const game::MethodInfo* method : methods)
        if (method->family != game::MethodFamily::Truth)
            points.push_back({method, method->defaultSamples, true});
        else
            for (const uint32_t rays : kRays)
                points.push_back({method, rays, false});
    return points;
}

std::vector<SamplePoint> makeAntiAliasedPoints(const std::vector<const game::MethodInfo*>& methods
) {
    std::vector<SamplePoint> points;
    for (const game::MethodInfo* method : methods)
        if (!game::isSampledAnyway(*method))
            points.push_back({method, method->defaultSamples, true});
    return points;
}

std::vector<SamplePoint> makeScalingPoints(const std::vector<const game::MethodInfo*>& methods) {
    constexpr uint32_t kMaxSamples = 4;
    std::vector<SamplePoint> points;
    for (const game::MethodInfo* method : methods) {
        const bool isTruth = method->family == game::MethodFamily::Accumulate ||
                             method->family == game::MethodFamily::Truth;
        points.push_back({method, isTruth ? kMaxSamples : method->defaultSamples, !isTruth});
    }
    return points;
}

std::vector<SamplePoint> makeSequencePoints(const std::vector<const game::MethodInfo*>& methods) {
    std::vector<SamplePoint> points;
    for (const game::MethodInfo* method : methods) {
        SamplePoint point{method, method->defaultSamples, true};
        if (method->family == game::MethodFamily::Accumulate)
            point = {method, 8, false};
        if (method->family == game::MethodFamily::Truth)
            point = {method, 4, false};
        points.push_back(point);
    }
    return points;
}

game::MethodOptions makeMethodOptions(const SamplePoint& point) {
    motion_blur::MotionBlurSettings settings;
    if (const VariantRow* variant = findVariant(point.method->name))
        variant->apply(settings);
    settings.sampleCount = point.samples;
    game::MethodOptions options = game::makeMethod(*point.method, settings);
    options.samples = point.samples;
    if (point.method->lensFilter)
        options.lensTaps = point.method->sampleUnit == game::SampleUnit::Taps
                               ? point.samples
                               : depth_of_field::kDefaultTaps;
    return options;
}

} // namespace shutter::bench
