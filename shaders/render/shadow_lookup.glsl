// SPDX-License-Identifier: MIT
// How much of a light reaches a point: by maps of what stands still and of what moves, or as a ray
// has found it.
#ifndef SHUTTER_SHADOW_LOOKUP_GLSL
#define SHUTTER_SHADOW_LOOKUP_GLSL

#include "render/scene_bindings.glsl"
#include "render/shadow_filter.glsl"
#include "render/surface.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer ShadowRef {
    ShadowConstants value;
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer ShadowMapTable {
    ShadowMap rows[];
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
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ShadowTileTable {
    uint movers[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ShadowTexels {
    float values[];
};

/// What a point's shadows come from.
struct ShadowSource {
    bool byMaps;   // the frame's maps, where it has any; else `dark`
    uint dark;     // a bit for each light that does not reach the point
    uint receiver; // row of the entity table
    uint movers;   // a bit for each mover whose shadow may reach the point
};

/// ShadowSource::movers of any point.
const uint kAllMovers = ~0u;

/// The point that receives light.
struct Receiver {
    vec3 position;  // eye space, metres
    vec3 normal;    // unit, of the triangle, on the light's side
    vec3 toLight;   // unit
    float distance_; // to the light, metres
    float pixel;    // width of a pixel there, metres
    uint entity;    // row of the entity table
};

/// Share of the light that passes the casters of one map; `place` is covered.
float filterMap(ShadowRef shadows, ShadowMap map, ShadowPlace place) {
    ShadowTexels texels = ShadowTexels(shadows.value.texels);
    vec2 middle = floor(place.texel);
    vec2 offset = place.texel - middle - 0.5f;
    vec3 across = splineWeights(offset.x);
    vec3 down = splineWeights(offset.y);
    uint last = map.sizePx - 1u;
    uvec2 at = min(uvec2(middle), uvec2(last));
    uint x0 = max(at.x, 1u) - 1u;
    uint x2 = min(at.x + 1u, last);
    float light = 0.0f;
    float depth = place.depth - dot(place.slope, offset); // at the middle texel's centre
    for (uint row = 0u; row < 3u; ++row) {
        uint y = min(max(at.y + row, 1u) - 1u, last);
        uint first = map.firstTexel + y * map.sizePx;
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
float filterMapLinear(ShadowRef shadows, ShadowMap map, ShadowPlace place) {
    ShadowTexels texels = ShadowTexels(shadows.value.texels);
    vec2 corner = floor(place.texel - 0.5f);
    vec2 share = place.texel - 0.5f - corner;
    uint last = map.sizePx - 1u;
    uvec2 at = min(uvec2(corner), uvec2(last));
    uvec2 next = min(at + 1u, uvec2(last));
    uint upper = map.firstTexel + at.y * map.sizePx;
    uint lower = map.firstTexel + next.y * map.sizePx;
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

/// Where the receiver is in a map, lifted off its surface.
/// \param cosine of the angle between its normal and the way to the light
ShadowPlace placeReceiver(ShadowMap map, vec3 position, vec3 normal, float cosine) {
    vec4 clip = map.clipFromEye * vec4(position, 1.0f);
    // A map that does not have the place is left for the next before anything else is worked out.
    ShadowPlace place = placeInMap(clip, vec2(0.0f), map.sizePx, 0.0f);
    if (!place.isCovered) return place;
    vec4 clipNormal = map.clipFromEye * vec4(normal, 0.0f);
    vec2 slope = planeSlope(
        clip, clipNormal, cosine, map.texelMetres, map.sizePx, map.isPerspective != 0u
    );
    clip += clipNormal * normalOffset(map.texelMetres * clip.w, cosine);
    return placeInMap(clip, slope, map.sizePx, map.isPerspective != 0u ? 0.0f : kDepthRounding);
}

/// Light that passes what is in the light's own maps.
float passStill(ShadowRef shadows, ShadowLight own, LightRow light, Receiver receiver) {
    ShadowMapTable maps = ShadowMapTable(shadows.value.maps);
    float cosine = dot(receiver.normal, receiver.toLight);
    uint first = own.firstMap;
    uint count = own.mapCount;
    if (light.kind == kLightPoint || (light.kind == kLightSpot && count > 1u)) {
        first += cubeFace(receiver.position - light.positionRange.xyz);
        count = 1u;
    }
    for (uint i = 0u; i < count; ++i) {
        ShadowMap map = maps.rows[first + i];
        ShadowPlace place = placeReceiver(map, receiver.position, receiver.normal, cosine);
        if (!place.isCovered) continue;
        return sharpenEdge(
            filterMap(shadows, map, place), receiver.pixel / (map.texelMetres * place.scale)
        );
    }
    return 1.0f;
}

vec3 transformPoint(vec4 rows[3], vec3 point) {
    vec4 p = vec4(point, 1.0f);
    return vec3(dot(rows[0], p), dot(rows[1], p), dot(rows[2], p));
}

vec3 transformDirection(vec4 rows[3], vec3 d) {
    return vec3(dot(rows[0].xyz, d), dot(rows[1].xyz, d), dot(rows[2].xyz, d));
}

/// A layer of a mover.
struct MoverLayer {
    uint map;     // from the light's first layer
    vec3 toLight; // unit, as the mover sees it: the layer was drawn along it ...
    vec3 light;   // ... or from there
};

/// Light that passes one mover at one instant.
float passMover(
    ShadowMap map, ShadowRef shadows, ShadowMover mover, MoverLayer layer,
    vec4 rasterFromInstant[3], LightRow light, Receiver receiver
) {
    vec3 point = transformPoint(rasterFromInstant, receiver.position);
    vec3 toLight = normalize(transformDirection(rasterFromInstant, receiver.toLight));
    if (!meetsSphere(point, toLight, receiver.distance_, mover.sphere)) return 1.0f;
    vec3 normal = normalize(transformDirection(rasterFromInstant, receiver.normal));
    if (light.kind == kLightDirectional) {
        point = alignRay(point, toLight, layer.toLight, mover.sphere.xyz, mover.shape);
        toLight = layer.toLight;
    } else {
        vec3 seen = transformPoint(rasterFromInstant, light.positionRange.xyz);
        vec4 aligned = alignPointRay(point, seen, layer.light, mover.sphere.xyz, mover.shape);
        if (aligned.w == 0.0f) return 1.0f;
        point = aligned.xyz;
        toLight = normalize(layer.light - point);
    }
    ShadowPlace place = placeReceiver(map, point, normal, dot(normal, toLight));
    if (!place.isCovered) return 1.0f;
    // Over the exposure soft edges are what hides the steps from instant to instant.
    if (mover.instantCount > 1u)
        return filterMapLinear(shadows, map, place);
    return sharpenEdge(
        filterMap(shadows, map, place), receiver.pixel / (map.texelMetres * place.scale)
    );
}

/// Those of some movers whose shadows may touch the receiver in the exposure, a bit each, and whether
/// one of them moves there.
uint findMovers(ShadowRef shadows, uint candidates, Receiver receiver, out bool moves) {
    ShadowMoverTable movers = ShadowMoverTable(shadows.value.movers);
    uint found = 0u;
    bool receives = false; // the receiver itself is a mover in motion
    moves = false;
    uint count = shadows.value.moverCount;
    if (count < 32u) candidates &= (1u << count) - 1u;
    for (uint left = candidates; left != 0u; left &= left - 1u) {
        uint i = uint(findLSB(left));
        bool inMotion = movers.rows[i].instantCount > 1u;
        receives = receives || (inMotion && movers.rows[i].entity == receiver.entity);
        vec4 sphere = movers.rows[i].sweptSphere;
        if (!meetsSphere(receiver.position, receiver.toLight, receiver.distance_, sphere)) continue;
        found |= 1u << i;
        moves = moves || inMotion;
    }
    // What is looked up is a point of the surface, and a blur carries it along: what moves by itself
    // is lit as at the raster instant.
    moves = moves && !receives;
    return found;
}

/// The mean over the exposure of what passes the movers.
float passMovers(
    ShadowRef shadows, uint candidates, ShadowLight own, LightRow light, Receiver receiver
) {
    bool moves;
    uint found = findMovers(shadows, candidates, receiver, moves);
    if (found == 0u) return 1.0f;
    ShadowMapTable maps = ShadowMapTable(shadows.value.maps);
    ShadowMoverTable movers = ShadowMoverTable(shadows.value.movers);
    ShadowInstantTable instants = ShadowInstantTable(shadows.value.instants);
    uint count = moves ? shadows.value.instantCount : 1u;
    float sum = 0.0f;
    for (uint instant = 0u; instant < count; ++instant) {
        float passed = 1.0f;
        for (uint left = found; left != 0u && passed > 0.0f; left &= left - 1u) {
            ShadowMover mover = movers.rows[findLSB(left)];
            vec4 rows[3] = vec4[3](
                vec4(1.0f, 0.0f, 0.0f, 0.0f), vec4(0.0f, 1.0f, 0.0f, 0.0f),
                vec4(0.0f, 0.0f, 1.0f, 0.0f)
            );
            MoverLayer layer =
                MoverLayer(mover.firstLayer, receiver.toLight, light.positionRange.xyz);
            if (moves && mover.instantCount > 1u) {
                rows = instants.rows[mover.firstInstant + instant].rasterFromInstant;
                if (mover.partCount > 0u) {
                    uint part = instant * mover.partCount / mover.instantCount;
                    uint at = mover.firstInstant + mover.instantCount + part;
                    vec4 drawn[3] = instants.rows[at].rasterFromInstant;
                    layer.map += 1u + part;
                    layer.toLight = normalize(transformDirection(drawn, layer.toLight));
                    layer.light = transformPoint(drawn, layer.light);
                }
            }
            ShadowMap map = maps.rows[own.firstLayer + layer.map];
            passed *= passMover(map, shadows, mover, layer, rows, light, receiver);
        }
        sum += passed;
    }
    return sum / float(count);
}

/// The movers whose shadows may fall into a tile of the raster: boxes around them touch it.
/// \param pixel of the raster
uint moversOfTile(FrameRef frame, vec2 pixel) {
    uvec2 address = frame.value.shadows;
    if ((address.x | address.y) == 0u) return 0u;
    ShadowRef shadows = ShadowRef(address);
    uvec2 tile = uvec2(pixel) / kShadowTilePx;
    return ShadowTileTable(shadows.value.tiles).movers[tile.y * shadows.value.tilesAcross + tile.x];
}

/// Share of a light that reaches a point, [0, 1], at the raster instant or, for shadows of what
/// moves, over the exposure.
/// \param index of the light
/// \param normal of the triangle, unit, on the viewer's side
/// \param toLight unit
float lightReaching(
    FrameRef frame, ShadowSource source, uint index, LightRow light, vec3 position, vec3 normal,
    vec3 toLight
) {
    if (index >= kMaxShadowLights) return 1.0f;
    if (!source.byMaps) return (source.dark >> index & 1u) != 0u ? 0.0f : 1.0f;
    uvec2 address = frame.value.shadows;
    if ((address.x | address.y) == 0u) return 1.0f;
    ShadowRef shadows = ShadowRef(address);
    if (index >= shadows.value.lightCount) return 1.0f;
    ShadowLight own = ShadowLightTable(shadows.value.lights).rows[index];
    if (own.firstMap == kNoShadowMap) return 1.0f;
    Receiver receiver;
    receiver.position = position;
    receiver.toLight = toLight;
    receiver.normal = dot(normal, toLight) < 0.0f ? -normal : normal;
    receiver.distance_ = light.kind == kLightDirectional
                             ? 1.0e15f
                             : distance(light.positionRange.xyz, position);
    receiver.pixel = pixelFootprint(frame, position);
    receiver.entity = source.receiver;
    float passed = passStill(shadows, own, light, receiver);
    if (passed == 0.0f || source.movers == 0u) return passed;
    return passed * passMovers(shadows, source.movers, own, light, receiver);
}

#endif
