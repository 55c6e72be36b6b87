// SPDX-License-Identifier: MIT
// One rectangle of the picture for each particle, around all that it covers in a part of the
// exposure.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "render/lighting.glsl"
#include "particles/particle.glsl"

layout(location = 0) out vec2 outTextureUv;          // of a picture at one time; else not used
layout(location = 1) flat out vec4 outShape;         // texture's level, softness in metres, share, segments
layout(location = 2) flat out uvec4 outKind;         // texture or kNoParticleTexture, kParticle... flags,
                                                     // whether size or colour changes, times of a picture
layout(location = 3) flat out vec4 outPoints[5];     // place and radius in pixels, depth in metres
layout(location = 8) flat out vec4 outColors[5];     // linear, opacity
layout(location = 13) flat out vec3 outTimes;        // of the first, a middle and the last point
layout(location = 14) flat out vec2 outTurn;         // a picture's angle at shutter time 0, its change until 1

const float kNoticeable = 0.1f; // change of a colour or a direction
const float kGrows = 0.05f;     // change of a size
const float kStraight = 0.03f;  // radii between a way and its chord

/// Light that the particle sends back of what reaches it from everywhere, per unit of its colour:
/// evenly in all directions, as a puff of small grains does.
vec3 gatherLight(FrameRef frame, vec3 place) {
    vec3 light = frame.value.ambient.rgb;
    if (hasEnvironment(frame)) {
        EnvironmentRef environment = EnvironmentRef(frame.value.environment);
        light = vec3(0.0f);
        for (uint i = 0u; i < 6u; ++i) {
            vec3 axis = vec3(0.0f);
            axis[i >> 1u] = (i & 1u) == 0u ? 1.0f : -1.0f;
            light += evaluateIrradiance(environment.value.irradiance, axis) / 6.0f;
        }
    }
    LightSet lights = lightsAtRaster(frame);
    for (uint i = 0u; i < lights.count; ++i) {
        vec3 toLight;
        vec3 irradiance;
        evaluateLight(lightAt(lights, i), place, toLight, irradiance);
        light += irradiance * (1.0f / 12.5663706f);
    }
    return light;
}

/// Fades over the last of its sizes before the near plane: no edge crosses the picture there.
float fadeNear(FrameRef frame, SeenParticle seen, float size) {
    bool perspective = frame.value.pixelFootprint.x > 0.0f;
    if (!perspective) return 1.0f;
    float before = seen.clipW - frame.value.forward.w;
    return before <= 0.0f ? 0.0f : saturate(before / max(size, 1.0e-6f));
}

vec4 seenColor(FrameRef frame, ParticleRow row, ParticleEmitterRow emitter, float s, SeenParticle seen) {
    float age = particleAge(row, emitter, s, draw.rasterTime);
    vec4 color = particleColor(row, emitter, age);
    return vec4(color.rgb, color.a * fadeNear(frame, seen, particleSize(row, emitter, age)));
}

/// The part of [first, last] in which the particle is before the camera.
vec2 clipNear(FrameRef frame, ParticleRow row, ParticleEmitterRow emitter, float first, float last) {
    float near = frame.value.forward.w;
    float before = seeParticle(frame, row, emitter, first).clipW - near;
    float after = seeParticle(frame, row, emitter, last).clipW - near;
    if (before <= 0.0f && after <= 0.0f) return vec2(last, first);
    if (before > 0.0f && after > 0.0f) return vec2(first, last);
    float crossing = mix(first, last, before / (before - after));
    return before > 0.0f ? vec2(first, crossing) : vec2(crossing, last);
}

/// Whether a way takes two segments. \param changes size or colour changes along it
bool bends(vec2 places[3], bool changes, float radiusPx) {
    if (changes) return distance(places[1], 0.5f * (places[0] + places[2])) > kStraight * max(radiusPx, 1.0f);
    vec2 first = places[1] - places[0];
    vec2 second = places[2] - places[1];
    float bend = abs(first.x * second.y - first.y * second.x);
    float stretch = dot(first, first) + dot(second, second);
    return stretch > 0.01f && bend > 0.5f * kNoticeable * stretch;
}

bool changes(vec4 colors[3]) {
    vec4 sum = colors[0] + colors[1] + colors[2];
    vec4 change = max(max(abs(colors[1] - colors[0]), abs(colors[2] - colors[1])), abs(colors[2] - colors[0]));
    return any(greaterThan(change, kNoticeable * (sum / 3.0f) + 1.0e-6f));
}

/// Half of the life, from where a colour changes at another rate, if it is well within the time `alive`.
/// Below 0: it is not.
float findMiddle(ParticleRow row, ParticleEmitterRow emitter, vec2 alive) {
    if (emitter.secondsPerExposure <= 0.0f) return -1.0f;
    float s = draw.rasterTime + (0.5f * row.velocityLife.w - row.placeAge.w) / emitter.secondsPerExposure;
    float least = 1.0e-3f * (alive.y - alive.x);
    return s > alive.x + least && s < alive.y - least ? s : -1.0f;
}

/// Writes the segments of the time `alive`: of a streak that does not change as much light in each, else
/// as much time in each before outTimes.y, and after it.
/// \param light before and after
uint fillSegments(FrameRef frame, ParticleRow row, ParticleEmitterRow emitter, vec2 alive, vec2 light) {
    vec4 colors[3];
    vec2 places[3];
    vec2 radii = vec2(1.0e30f, 0.0f);
    for (uint i = 0u; i < 3u; ++i) {
        float s = mix(alive.x, alive.y, 0.5f * float(i));
        SeenParticle seen = seeParticle(frame, row, emitter, s);
        places[i] = seen.placePx;
        colors[i] = seenColor(frame, row, emitter, s, seen);
        radii = vec2(min(radii.x, seen.radiusPx), max(radii.y, seen.radiusPx));
    }
    bool colorChanges = changes(colors);
    if (colorChanges || radii.y - radii.x > kGrows * radii.y) outKind.z = 1u;
    float middle = colorChanges ? findMiddle(row, emitter, alive) : -1.0f;
    bool isBox = (draw.response.x | draw.response.y) == 0u;
    bool isEvenInLight = !isBox && outKind.z == 0u && emitter.texture == kNoParticleTexture;
    float mean = 0.5f * (light.x + light.y);
    outTimes = vec3(alive.x, isEvenInLight ? respondAt(draw.response, mean) : 0.5f * (alive.x + alive.y), alive.y);
    if (middle >= 0.0f) outTimes.y = middle;
    uint segments = isBox ? (bends(places, outKind.z != 0u, radii.y) ? 2u : 1u) * (middle >= 0.0f ? 2u : 1u) : kMaxStreakSegments;
    if (alive.x == alive.y) segments = 1u;
    for (uint i = 0u; i <= segments; ++i) {
        float s = isEvenInLight ? respondAt(draw.response, cutSpan(vec3(light.x, mean, light.y), segments, i))
                                : cutSpan(outTimes, segments, i);
        s = clamp(s, alive.x, alive.y);
        SeenParticle seen = seeParticle(frame, row, emitter, s);
        outPoints[i] = vec4(seen.placePx, seen.radiusPx, seen.depth);
        outColors[i] = seenColor(frame, row, emitter, s, seen);
    }
    return segments;
}

/// A picture that is shown at one time has its mean colour.
vec4 meanColor(FrameRef frame, ParticleRow row, ParticleEmitterRow emitter) {
    vec4 sum = vec4(0.0f);
    float all = 0.0f;
    for (uint i = 0u; i < 4u; ++i) {
        // Two of Gauss's nodes on either side of the middle.
        vec2 ends = i < 2u ? outTimes.xy : outTimes.yz;
        float s = mix(ends.x, ends.y, (i & 1u) == 0u ? 0.21132487f : 0.78867513f);
        vec4 color = seenColor(frame, row, emitter, s, seeParticle(frame, row, emitter, s));
        float weight = lightDensity(s) * (ends.y - ends.x);
        sum += weight * vec4(color.rgb * color.a, color.a);
        all += weight;
    }
    sum /= max(all, 1.0e-20f);
    return vec4(sum.rgb / max(sum.a, 1.0e-20f), sum.a);
}

/// The corner of a rectangle along a direction that holds all that the points show.
/// \param reach of what is shown at a point, in its radius
vec2 placeCorner(uint segments, vec2 along, float reach, vec2 corner) {
    vec2 across = vec2(-along.y, along.x);
    vec2 low = vec2(1.0e30f);
    vec2 high = vec2(-1.0e30f);
    for (uint i = 0u; i <= segments; ++i) {
        vec2 place = outPoints[i].xy - outPoints[0].xy;
        vec2 local = vec2(dot(place, along), dot(place, across));
        float aside = reach * max(outPoints[i].z, kMinParticleRadiusPx);
        low = min(low, local - aside);
        high = max(high, local + aside);
    }
    vec2 local = mix(low, high, corner);
    return outPoints[0].xy + along * local.x + across * local.y;
}

vec2 chordDirection(uint segments) {
    vec2 chord = outPoints[segments].xy - outPoints[0].xy;
    float length_ = length(chord);
    return length_ > 1.0e-3f ? chord / length_ : vec2(1.0f, 0.0f);
}

/// Times at which a picture is shown, so that no point of it leaps farther than a sixth of its radius
/// or than kPictureStepPx.
uint countTimes(uint segments, float turn) {
    float way = 0.0f;
    float radius = kMinParticleRadiusPx;
    for (uint i = 0u; i <= segments; ++i) {
        radius = max(radius, outPoints[i].z);
        if (i > 0u)
            way += length(outPoints[i].xy - outPoints[i - 1u].xy) + abs(outPoints[i].z - outPoints[i - 1u].z);
    }
    way += abs(turn) * radius;
    return uint(clamp(ceil(way / max(kPictureStepPx, radius / 6.0f)), 1.0f, float(kMaxPictureTimes)));
}

void main() {
    FrameRef frame = FrameRef(draw.frame);
    ParticleRow row = ParticleTable(draw.rows).rows[gl_InstanceIndex];
    ParticleEmitterRow emitter = ParticleEmitterTable(draw.emitters).rows[row.emitter];
    vec2 corner = vec2((0x32 >> gl_VertexIndex) & 1, (0x2C >> gl_VertexIndex) & 1);
    gl_Position = vec4(0.0f, 0.0f, 2.0f, 1.0f); // nowhere
    outTextureUv = corner;
    outShape = vec4(0.0f);
    outTimes = vec3(0.0f);
    outTurn = vec2(0.0f);
    outKind = uvec4(emitter.texture, emitter.flags, 0u, 1u);
    for (uint i = 0u; i < 5u; ++i) outPoints[i] = outColors[i] = vec4(0.0f);

    bool isInstant = draw.lightShare.x == draw.lightShare.y;
    float open = isInstant ? draw.rasterTime : respondAt(draw.response, draw.lightShare.x);
    float close = isInstant ? draw.rasterTime : respondAt(draw.response, draw.lightShare.y);
    vec2 alive = isInstant ? vec2(open)
                           : particleLifetime(row, emitter, draw.rasterTime, open, close);
    if (alive.x < alive.y) alive = clipNear(frame, row, emitter, alive.x, alive.y);
    if (isInstant ? seeParticle(frame, row, emitter, open).clipW <= frame.value.forward.w
                  : !(alive.x < alive.y))
        return;
    float share = 1.0f;
    vec2 light = vec2(0.0f);
    if (!isInstant) {
        light = vec2(lightBefore(alive.x), lightBefore(alive.y));
        share = (light.y - light.x) / max(draw.lightShare.y - draw.lightShare.x, 1.0e-6f);
    }
    uint segments = fillSegments(frame, row, emitter, alive, light);
    vec2 placePx;
    float level = 0.0f;
    if (emitter.texture != kNoParticleTexture) {
        // As its angle at open and the change until close: it turns evenly in time.
        outTurn.x = particleAngle(row, particleAge(row, emitter, 0.0f, draw.rasterTime));
        outTurn.y = row.spin * emitter.secondsPerExposure;
        float turn = outTurn.y * (alive.y - alive.x);
        outKind.w = countTimes(segments, turn);
        float s = isInstant ? open : clamp(respondAt(draw.response, 0.5f * (light.x + light.y)), alive.x, alive.y);
        SeenParticle seen = seeParticle(frame, row, emitter, s);
        float radius = max(seen.radiusPx, kMinParticleRadiusPx);
        if (outKind.w == 1u) {
            float angle = particleAngle(row, particleAge(row, emitter, s, draw.rasterTime));
            vec2 along = vec2(cos(angle), sin(angle));
            vec4 color = isInstant || outKind.z == 0u ? seenColor(frame, row, emitter, s, seen)
                                                      : meanColor(frame, row, emitter);
            segments = 0u;
            outPoints[0] = vec4(seen.placePx, seen.radiusPx, seen.depth);
            outColors[0] = color;
            placePx = placeCorner(0u, along, 1.0f, corner);
        } else {
            float angle = outTurn.x + outTurn.y * 0.5f * (alive.x + alive.y);
            // Of a square that turns by up to that either way.
            float aside = min(0.5f * abs(turn), 0.785398163f);
            placePx = placeCorner(segments, vec2(cos(angle), sin(angle)), cos(aside) + sin(aside), corner);
        }
        level = max(log2(emitter.textureTexels / (2.0f * radius)) + frame.value.lodBias, 0.0f);
    } else {
        placePx = placeCorner(segments, chordDirection(segments), 1.0f, corner);
    }
    if ((emitter.flags & kParticleLit) != 0u && (frame.value.flags & kFrameUnlit) == 0u) {
        float middle = 0.5f * (alive.x + alive.y);
        vec3 place = particlePlace(row, emitter, particleAge(row, emitter, middle, draw.rasterTime));
        vec3 light = gatherLight(frame, place);
        for (uint i = 0u; i <= segments; ++i) outColors[i].rgb *= light;
    }
    outShape = vec4(level, emitter.softMetres, share, float(segments));
    // Flat in the picture: depth is tested by the fragments, and they interpolate evenly.
    gl_Position = vec4(placePx / frame.value.sizePx * 2.0f - 1.0f, 0.5f, 1.0f);
}
