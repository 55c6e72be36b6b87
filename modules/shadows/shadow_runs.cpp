// SPDX-License-Identifier: MIT
#include "modules/shadows/shadow_runs.h"

#include "shaders/shadows/shadow_filter.glsl"

#include <algorithm>
#include <array>
#include <cmath>

namespace shutter::shadows {

namespace {

using math::dmat3;
using math::dmat4;
using math::dvec3;
using math::dvec4;

/// A map that is linear in the instant's number.
struct LinearMap {
    dmat4 first{1.0};
    dmat4 step{0.0};

    [[nodiscard]] dmat4 at(double instant) const { return first + instant * step; }
};

/// By least squares. \param maps one or more
LinearMap fitLine(std::span<const dmat4> maps) {
    const double middle = 0.5 * double(maps.size() - 1);
    dmat4 sum(0.0);
    dmat4 slope(0.0);
    double squares = 0.0;
    for (size_t i = 0; i < maps.size(); ++i) {
        const double offset = double(i) - middle;
        sum += maps[i];
        slope += offset * maps[i];
        squares += offset * offset;
    }
    LinearMap line;
    if (squares > 0.0)
        line.step = slope / squares;
    line.first = sum / double(maps.size()) - middle * line.step;
    return line;
}

dvec3 rowOf(const dmat4& matrix, int row) {
    return {matrix[0][row], matrix[1][row], matrix[2][row]};
}

/// Farthest that the line takes a point of a sphere from where its map does, texels. Along the way
/// to the light the error is the same: all maps take it to the layer's.
double findError(
    const LinearMap& line, std::span<const dmat4> maps, const Sphere& sphere, uint32_t sizePx
) {
    double most = 0.0;
    for (size_t i = 0; i < maps.size(); ++i) {
        const dmat4 error = line.at(double(i)) - maps[i];
        const dvec3 centre(error * dvec4(sphere.centre, 1.0));
        for (int row = 0; row < 3; ++row) {
            const double off =
                std::abs(centre[row]) + sphere.radius * glm::length(rowOf(error, row));
            most = std::max(most, row < 2 ? off : off * sizePx); // depth: 1 over the layer's width
        }
    }
    return most;
}

std::array<math::vec4, 3> makeRows(const dmat4& map) {
    std::array<math::vec4, 3> rows;
    for (int i = 0; i < 3; ++i)
        rows[size_t(i)] = math::vec4(dvec4(rowOf(map, i), map[3][i]));
    return rows;
}

shader::CasterSpan
makeRun(const LinearMap& line, double middle, const MoverLayer& layer, const dvec3& eye) {
    const dmat4 toEye = glm::translate(dmat4(1.0), eye);
    const std::array<math::vec4, 3> first = makeRows(line.first * toEye);
    const std::array<math::vec4, 3> step = makeRows(line.step * toEye);
    shader::CasterSpan run{};
    std::copy(first.begin(), first.end(), run.first);
    std::copy(step.begin(), step.end(), run.step);
    // A plane's depth over x and y: what its normal is perpendicular to is perpendicular to it.
    const dmat4 map = line.at(middle);
    const dvec3 x = rowOf(map, 0);
    const dvec3 y = rowOf(map, 1);
    const dvec3 depth = rowOf(map, 2);
    const double scale = 1.0 / glm::length(glm::cross(x, y)); // it points to the light
    run.slope[0] = math::vec4(math::vec3(scale * glm::cross(depth, y)), 0.0f);
    run.slope[1] = math::vec4(math::vec3(scale * glm::cross(x, depth)), 0.0f);
    run.firstTexel = layer.firstTexel;
    run.sizePx = layer.sizePx;
    run.texelMetres = float(layer.view.texelMetres);
    return run;
}

/// A run over some of the exposure's instants.
struct FittedRun {
    std::vector<dmat4> maps; ///< of its instants
    LinearMap line;
    size_t layer = 0; ///< of the mover's
};

FittedRun fitRun(
    const ShadowCaster& caster,
    const CasterPath& path,
    std::span<const MoverLayer> layers,
    const dvec3& toLight,
    size_t begin,
    size_t end
) {
    const size_t parts = layers.size() - 1;
    FittedRun run;
    // The layer of the part that the run's middle is in.
    run.layer = parts == 0 ? 0 : 1 + (begin + end) * parts / (2 * path.instants.size());
    for (size_t i = begin; i < end; ++i)
        run.maps.push_back(
            mapToLayer(caster, path.instants[i].rasterFromInstant, toLight, layers[run.layer])
        );
    run.line = fitLine(run.maps);
    return run;
}

} // namespace

dmat4 mapToLayer(
    const ShadowCaster& caster,
    const dmat4& rasterFromInstant,
    const dvec3& toLight,
    const MoverLayer& layer
) {
    const LightPlace light(toLight, 0.0);
    const dvec3 turned(seeLight(rasterFromInstant, light));
    const dvec3 drawn(seeLight(layer.rasterFromInstant, light));
    // The ray keeps the place where it is deepest in the caster's ellipsoid, as alignPointRay() has
    // it: points move by `turned - drawn` times how far along the ray that place is.
    const dvec3 weighed = caster.shape * turned / glm::dot(turned, caster.shape * turned);
    dmat4 align(1.0);
    for (int column = 0; column < 3; ++column)
        align[column] -= dvec4(weighed[column] * (turned - drawn), 0.0);
    align[3] += dvec4(glm::dot(caster.sphere.centre, weighed) * (turned - drawn), 0.0);
    dmat4 texels(1.0);
    texels[0][0] = texels[1][1] = 0.5 * layer.sizePx;
    texels[2][2] = 1.0 + double(shader::kDepthScaleRounding);
    texels[3] = dvec4(0.5 * layer.sizePx, 0.5 * layer.sizePx, shader::kDepthRounding, 1.0);
    return texels * layer.view.clipFromWorld * align * rasterFromInstant;
}

uint32_t findRunInstants(
    const ShadowCaster& caster,
    const CasterPath& path,
    std::span<const MoverLayer> layers,
    const dvec3& toLight
) {
    const size_t count = path.instants.size();
    if (count == 0)
        return 0;
    for (uint32_t length = shader::kMaxRunInstants; length > 1; length /= 2) {
        bool isExact = layers.size() - 1 <= (count + length - 1) / length;
        for (size_t begin = 0; begin < count && isExact; begin += length) {
            const FittedRun run = fitRun(
                caster, path, layers, toLight, begin, std::min<size_t>(begin + length, count)
            );
            isExact = findError(run.line, run.maps, path.swept, layers[run.layer].sizePx) <=
                      kMaxRunError; // not with NaN
        }
        if (isExact)
            return length;
    }
    return 1;
}

std::vector<shader::CasterSpan> makeRuns(
    const ShadowCaster& caster,
    const CasterPath& path,
    std::span<const MoverLayer> layers,
    const dvec3& toLight,
    uint32_t runInstants,
    const dvec3& eye
) {
    const dmat4 raster = mapToLayer(caster, dmat4(1.0), toLight, layers.front());
    std::vector<shader::CasterSpan> runs{makeRun({raster}, 0.0, layers.front(), eye)};
    if (runInstants == 0)
        return runs;
    const size_t count = path.instants.size();
    for (size_t begin = 0; begin < count; begin += runInstants) {
        const size_t end = std::min<size_t>(begin + runInstants, count);
        const FittedRun run = fitRun(caster, path, layers, toLight, begin, end);
        runs.push_back(makeRun(run.line, 0.5 * double(end - begin - 1), layers[run.layer], eye));
    }
    // Shaders read runs for as many instants as the longest run has.
    const size_t whole = shader::kMaxRunInstants / runInstants;
    while ((runs.size() - 1) % whole != 0)
        runs.push_back(runs.back());
    return runs;
}

} // namespace shutter::shadows
