// SPDX-License-Identifier: MIT
// Visibility of a light at a point from maps of static casters and movers.
#ifndef SHUTTER_SHADOW_LOOKUP_GLSL
#define SHUTTER_SHADOW_LOOKUP_GLSL

#include "render/scene_bindings.glsl"
#include "render/surface.glsl"
#include "shadows/shadow_filter.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer ShadowRef {
    ShadowConstants value;
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer ShadowMapTable {
    ShadowMap rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer ShadowCascadeTable {
    ShadowCascade rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer ShadowLightTable {
    ShadowLight rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer ShadowMoverTable {
    ShadowMover rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer ShadowInstantTable {
    ShadowInstant rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer ShadowRunTable {
    CasterSpan rows[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ShadowTexels {
    float values[];
};

/// The point that receives light.
struct Receiver {
    vec3 position;  // camera-relative space, metres
    vec3 normal;    // unit, of the triangle, on the light's side
    vec3 toLight;   // unit
    float distance_; // to the light, metres
    float pixel;    // width of a pixel there, metres
    uint entity;    // row of the entity table
};

/// Share of the light that passes the casters of one map; `place` is covered.
float filterMap(ShadowRef shadows, uint firstTexel, uint sizePx, ShadowPlace place) {
    ShadowTexels texels = ShadowTexels(shadows.value.texels);
    vec2 middle = floor(place.texel);
    vec2 offset = place.texel - middle - 0.5f;
    vec3 across = splineWeights(offset.x);
    vec3 down = splineWeights(offset.y);
    uint last = sizePx - 1u;
    uvec2 at = min(uvec2(middle), uvec2(last));
    uint x0 = max(at.x, 1u) - 1u;
    uint x2 = min(at.x + 1u, last);
    float light = 0.0f;
    float depth = place.depth - dot(place.slope, offset); // at the middle texel's centre
    for (uint row = 0u; row < 3u; ++row) {
        uint y = min(max(at.y + row, 1u) - 1u, last);
        uint first = firstTexel + y * shadowRowTexels(sizePx);
        vec3 casters = vec3(
            texels.values[first + x0], texels.values[first + at.x], texels.values[first + x2]
        );
        float own = depth + place.slope.y * (float(row) - 1.0f);
        vec3 depths = own + place.slope.x * vec3(-1.0f, 0.0f, 1.0f);
        light += down[row] * lightThrough(casters, across, depths);
    }
    return settleLight(light);
}

/// The same by two by two texels: enough where instants are averaged, whose steps it has to hide.
float filterMapLinear(ShadowRef shadows, uint firstTexel, uint sizePx, ShadowPlace place) {
    ShadowTexels texels = ShadowTexels(shadows.value.texels);
    vec2 corner = floor(place.texel - 0.5f);
    vec2 share = place.texel - 0.5f - corner;
    uint last = sizePx - 1u;
    uvec2 at = min(uvec2(corner), uvec2(last));
    uvec2 next = min(at + 1u, uvec2(last));
    uint upper = firstTexel + at.y * shadowRowTexels(sizePx);
    uint lower = firstTexel + next.y * shadowRowTexels(sizePx);
    vec4 casters = vec4(
        texels.values[upper + at.x], texels.values[upper + next.x], texels.values[lower + at.x],
        texels.values[lower + next.x]
    );
    float depth = place.depth - dot(place.slope, share);
    vec4 depths = max(
        vec4(depth, depth + place.slope.x, depth + place.slope.y, depth + place.slope.x + place.slope.y),
        vec4(1.0e-30f)
    );
    vec4 weights = vec4(1.0f - share.x, share.x, 1.0f - share.x, share.x) *
                   vec4(1.0f - share.y, 1.0f - share.y, share.y, share.y);
    float light = 0.0f;
    for (int i = 0; i < 4; ++i)
        light += casters[i] > depths[i] ? 0.0f : weights[i];
    return settleLight(light);
}

/// Where the receiver is in the map of a light at a place, lifted off its surface.
/// \param cosine of the angle between its normal and the way to the light
ShadowPlace placeReceiver(ShadowMap map, vec3 position, vec3 normal, float cosine) {
    vec4 clip = map.clipFromRelWorld * vec4(position, 1.0f);
    // A map that does not have the place needs nothing else worked out.
    ShadowPlace place = placeInMap(clip, vec2(0.0f), map.sizePx);
    if (!place.isCovered) return place;
    vec4 clipNormal = map.clipFromRelWorld * vec4(normal, 0.0f);
    vec2 slope = planeSlope(clip, clipNormal, cosine, map.texelMetres, map.sizePx);
    clip += clipNormal * normalOffset(map.texelMetres * clip.w, cosine);
    return placeInMap(clip, slope, map.sizePx);
}

vec3 transformPoint(vec4 rows[3], vec3 point) {
    vec4 p = vec4(point, 1.0f);
    return vec3(dot(rows[0], p), dot(rows[1], p), dot(rows[2], p));
}

vec3 transformDirection(vec4 rows[3], vec3 d) {
    return vec3(dot(rows[0].xyz, d), dot(rows[1].xyz, d), dot(rows[2].xyz, d));
}

/// Visibility through the maps of a directional light: the finest cascade that contains the place
/// is used.
float passCascades(ShadowRef shadows, ShadowLight own, Receiver receiver) {
    ShadowCascadeTable cascades = ShadowCascadeTable(shadows.value.cascades);
    vec3 point = transformDirection(own.axes, receiver.position);
    uint found = 0u;
    while (found < own.mapCount && !hasPoint(cascades.rows[own.firstMap + found], point)) ++found;
    if (found == own.mapCount) return 1.0f;
    ShadowCascade cascade = cascades.rows[own.firstMap + found];
    ShadowPlace place =
        placeInCascade(cascade, point, transformDirection(own.axes, receiver.normal));
    return sharpenEdge(
        filterMap(shadows, cascade.firstTexel, cascade.sizePx, place),
        receiver.pixel * cascade.texelsPerMetre
    );
}

/// Visibility through the light's own maps.
float passStill(ShadowRef shadows, ShadowLight own, LightRow light, Receiver receiver) {
    if (light.kind == kLightDirectional) return passCascades(shadows, own, receiver);
    uint face =
        own.mapCount > 1u ? cubeFace(receiver.position - light.positionRange.xyz) : 0u;
    ShadowMap map = ShadowMapTable(shadows.value.maps).rows[own.firstMap + face];
    ShadowPlace place = placeReceiver(
        map, receiver.position, receiver.normal, dot(receiver.normal, receiver.toLight)
    );
    if (!place.isCovered) return 1.0f;
    return sharpenEdge(
        filterMap(shadows, map.firstTexel, map.sizePx, place),
        receiver.pixel / (map.texelMetres * place.scale)
    );
}

/// A layer of a mover, for a light at a place.
struct MoverLayer {
    uint map;   // from the light's first layer
    vec3 light; // as the mover sees it: the layer was drawn from there
};

/// Light that passes one mover at one instant, from a light at a place.
/// \param isMean whether it is one of several that are averaged
float passMover(
    ShadowMap map, ShadowRef shadows, ShadowMover mover, MoverLayer layer,
    vec4 rasterFromInstant[3], LightRow light, Receiver receiver, bool isMean
) {
    vec3 point = transformPoint(rasterFromInstant, receiver.position);
    vec3 toLight = normalize(transformDirection(rasterFromInstant, receiver.toLight));
    if (!meetsSphere(point, toLight, receiver.distance_, mover.sphere)) return 1.0f;
    vec3 normal = normalize(transformDirection(rasterFromInstant, receiver.normal));
    vec3 seen = transformPoint(rasterFromInstant, light.positionRange.xyz);
    vec4 aligned = alignPointRay(point, seen, layer.light, mover.sphere.xyz, mover.shape);
    if (aligned.w == 0.0f) return 1.0f;
    vec3 drawn = normalize(layer.light - aligned.xyz);
    ShadowPlace place = placeReceiver(map, aligned.xyz, normal, dot(normal, drawn));
    if (!place.isCovered) return 1.0f;
    // Over the exposure soft edges are what hides the steps from instant to instant.
    if (isMean) return filterMapLinear(shadows, map.firstTexel, map.sizePx, place);
    return sharpenEdge(
        filterMap(shadows, map.firstTexel, map.sizePx, place),
        receiver.pixel / (map.texelMetres * place.scale)
    );
}

/// A receiver on a mover's run.
struct RunPlace {
    ShadowPlace place; // at the run's first instant; whether it is covered is left open
    vec3 step;         // of texel and depth, from instant to instant
    uint firstTexel;
    uint sizePx;
    float texelMetres;
};

RunPlace placeOnRun(ShadowRef shadows, uint index, Receiver receiver) {
    CasterSpan run = ShadowRunTable(shadows.value.runs).rows[index];
    float cosine = dot(receiver.normal, receiver.toLight);
    vec3 lifted = receiver.position + receiver.normal * normalOffset(run.texelMetres, cosine);
    vec3 first = transformPoint(run.first, lifted);
    vec2 slope = planeSlopeOnRun(run.slope, receiver.normal, cosine);
    return RunPlace(
        ShadowPlace(first.xy, first.z, slope, 1.0f, false), transformPoint(run.step, lifted),
        run.firstTexel, run.sizePx, run.texelMetres
    );
}

/// Light that passes one mover at the raster instant.
float passAtRaster(
    ShadowRef shadows, ShadowLight own, uint mover, LightRow light, Receiver receiver
) {
    ShadowMoverTable movers = ShadowMoverTable(shadows.value.movers);
    if (own.firstRun == kNoShadowRun) {
        ShadowMover row = movers.rows[mover];
        vec4 identity[3] = vec4[3](
            vec4(1.0f, 0.0f, 0.0f, 0.0f), vec4(0.0f, 1.0f, 0.0f, 0.0f), vec4(0.0f, 0.0f, 1.0f, 0.0f)
        );
        MoverLayer layer = MoverLayer(row.firstLayer, light.positionRange.xyz);
        ShadowMap map = ShadowMapTable(shadows.value.maps).rows[own.firstLayer + row.firstLayer];
        return passMover(map, shadows, row, layer, identity, light, receiver, false);
    }
    RunPlace run = placeOnRun(shadows, own.firstRun + movers.rows[mover].firstRun, receiver);
    if (!coversFilter(run.place.texel, float(run.sizePx))) return 1.0f;
    return sharpenEdge(
        filterMap(shadows, run.firstTexel, run.sizePx, run.place), receiver.pixel / run.texelMetres
    );
}

/// Light that passes one mover at successive instants. \param index of the first run, and how many
/// instants each has
vec4 passOnRuns(ShadowRef shadows, uint index, uint runInstants, Receiver receiver) {
    vec4 passed = vec4(1.0f);
    for (uint first = 0u; first < kMaxRunInstants; first += runInstants) {
        RunPlace run = placeOnRun(shadows, index++, receiver);
        float size = float(run.sizePx);
        for (uint i = 0u; i < runInstants; ++i) {
            if (coversFilter(run.place.texel, size))
                passed[first + i] =
                    filterMapLinear(shadows, run.firstTexel, run.sizePx, run.place);
            run.place.texel += run.step.xy;
            run.place.depth += run.step.z;
        }
    }
    return passed;
}

/// The same for a light at a place, whose lookups are no affine maps: each instant is worked out for
/// itself. \param first of the instants
vec4 passAtInstants(
    ShadowRef shadows, ShadowLight own, ShadowMover mover, uint first, LightRow light,
    Receiver receiver
) {
    ShadowMapTable maps = ShadowMapTable(shadows.value.maps);
    ShadowInstantTable instants = ShadowInstantTable(shadows.value.instants);
    vec4 passed = vec4(1.0f);
    for (uint i = 0u; i < kMaxRunInstants && first + i < mover.instantCount; ++i) {
        uint instant = first + i;
        MoverLayer layer = MoverLayer(mover.firstLayer, light.positionRange.xyz);
        if (mover.partCount > 0u) {
            uint part = instant * mover.partCount / mover.instantCount;
            uint at = mover.firstInstant + mover.instantCount + part;
            vec4 drawn[3] = instants.rows[at].rasterFromInstant;
            layer.map += 1u + part;
            layer.light = transformPoint(drawn, layer.light);
        }
        ShadowMap map = maps.rows[own.firstLayer + layer.map];
        vec4 rows[3] = instants.rows[mover.firstInstant + instant].rasterFromInstant;
        passed[i] = passMover(map, shadows, mover, layer, rows, light, receiver, true);
    }
    return passed;
}

/// Movers whose shadows may touch a receiver in the exposure, a bit each.
struct FoundMovers {
    uint resting; // looked up at the raster instant
    uint moving;  // at all of them
};

FoundMovers findMovers(ShadowRef shadows, uint candidates, Receiver receiver) {
    ShadowMoverTable movers = ShadowMoverTable(shadows.value.movers);
    FoundMovers found = FoundMovers(0u, 0u);
    bool receives = false; // the receiver itself is a mover in motion
    uint count = shadows.value.moverCount;
    if (count < 32u) candidates &= (1u << count) - 1u;
    for (uint left = candidates; left != 0u; left &= left - 1u) {
        uint i = uint(findLSB(left));
        bool inMotion = movers.rows[i].instantCount > 1u;
        receives = receives || (inMotion && movers.rows[i].entity == receiver.entity);
        vec4 sphere = movers.rows[i].sweptSphere;
        if (!meetsSphere(receiver.position, receiver.toLight, receiver.distance_, sphere)) continue;
        if (inMotion)
            found.moving |= 1u << i;
        else
            found.resting |= 1u << i;
    }
    // The receiver is a point of the surface that the blur carries along: movers are lit as at the
    // raster instant.
    if (receives) found = FoundMovers(found.resting | found.moving, 0u);
    return found;
}

/// The mean over the exposure of what passes the movers.
float passMovers(
    ShadowRef shadows, uint candidates, ShadowLight own, LightRow light, Receiver receiver
) {
    FoundMovers found = findMovers(shadows, candidates, receiver);
    float resting = 1.0f;
    for (uint left = found.resting; left != 0u && resting > 0.0f; left &= left - 1u)
        resting *= passAtRaster(shadows, own, uint(findLSB(left)), light, receiver);
    if (found.moving == 0u || resting == 0.0f) return resting;
    ShadowMoverTable movers = ShadowMoverTable(shadows.value.movers);
    uint count = shadows.value.instantCount;
    float sum = 0.0f;
    for (uint first = 0u; first < count; first += kMaxRunInstants) {
        vec4 passed = vec4(lessThan(uvec4(0u, 1u, 2u, 3u) + first, uvec4(count)));
        for (uint left = found.moving; left != 0u && passed != vec4(0.0f); left &= left - 1u) {
            uint mover = uint(findLSB(left));
            if (own.firstRun != kNoShadowRun) {
                uint runInstants = movers.rows[mover].runInstants;
                uint run = movers.rows[mover].firstRun + 1u + first / runInstants;
                passed *= passOnRuns(shadows, own.firstRun + run, runInstants, receiver);
            } else {
                passed *=
                    passAtInstants(shadows, own, movers.rows[mover], first, light, receiver);
            }
        }
        sum += dot(passed, vec4(1.0f));
    }
    return resting * sum / float(count);
}

/// Visibility of a light through the frame's maps, [0, 1], at the raster instant or, for shadows of
/// movers, over the exposure.
/// \param index of the light
/// \param movers a bit for each mover whose shadow may reach the point
float lightThroughMaps(
    FrameRef frame, uint index, LightRow light, Receiver receiver, uint movers
) {
    ShadowRef shadows = ShadowRef(frame.value.slots[kSlotOcclusion]);
    if (index >= shadows.value.lightCount) return 1.0f;
    ShadowLight own = ShadowLightTable(shadows.value.lights).rows[index];
    if (own.firstMap == kNoShadowMap) return 1.0f;
    float passed = passStill(shadows, own, light, receiver);
    if (passed == 0.0f || movers == 0u) return passed;
    return passed * passMovers(shadows, movers, own, light, receiver);
}

#endif
