// SPDX-License-Identifier: MIT
// One rectangle of the picture for each particle, around all that it covers in a part of the
// exposure.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "render/lighting.glsl"
#include "render/particle.glsl"

layout(location = 0) out vec2 outTextureUv;          // of a picture; else not used
layout(location = 1) flat out vec4 outShape;         // texture's level, softness in metres, share, segments
layout(location = 2) flat out uint outTexture;       // or kNoParticleTexture: a streak
layout(location = 3) flat out vec4 outPoints[5];     // place and radius in pixels, depth in metres
layout(location = 8) flat out vec4 outColors[5];     // premultiplied
layout(location = 13) flat out vec2 outLight;        // of the exposure before the first and the last point

const float kNoticeable = 0.1f; // change of a colour or a direction that takes one segment more

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
    float alpha = color.a * fadeNear(frame, seen, particleSize(row, emitter, age));
    // Too small for a pixel's centre to meet it: as bright, spread over more.
    float shrunk = min(seen.radiusPx / kMinParticleRadiusPx, 1.0f);
    alpha *= shrunk * shrunk;
    bool adds = (emitter.flags & kParticleAdd) != 0u;
    return vec4(color.rgb * alpha, adds ? 0.0f : alpha);
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

uint countSegments(vec4 colors[3], vec2 places[3]) {
    vec4 sum = colors[0] + colors[1] + colors[2];
    vec4 change = max(max(abs(colors[1] - colors[0]), abs(colors[2] - colors[1])), abs(colors[2] - colors[0]));
    if (any(greaterThan(change, kNoticeable * (sum / 3.0f) + 1.0e-6f))) return 2u;
    vec2 first = places[1] - places[0];
    vec2 second = places[2] - places[1];
    float bend = abs(first.x * second.y - first.y * second.x);
    float stretch = dot(first, first) + dot(second, second);
    return stretch > 0.01f && bend > 0.5f * kNoticeable * stretch ? 2u : 1u;
}

/// Writes the segments of the light's part [first, last], which is cut evenly.
uint fillSegments(FrameRef frame, ParticleRow row, ParticleEmitterRow emitter, float first, float last) {
    vec4 colors[3];
    vec2 places[3];
    bool isBox = (draw.response.x | draw.response.y) == 0u;
    uint segments = kMaxStreakSegments;
    if (isBox) {
        for (uint i = 0u; i < 3u; ++i) {
            float s = mix(first, last, 0.5f * float(i));
            SeenParticle seen = seeParticle(frame, row, emitter, s);
            places[i] = seen.placePx;
            colors[i] = seenColor(frame, row, emitter, s, seen);
        }
        segments = first == last ? 1u : countSegments(colors, places);
    }
    float light0 = lightBefore(first);
    float light1 = lightBefore(last);
    for (uint i = 0u; i <= segments; ++i) {
        float u = mix(light0, light1, float(i) / float(segments));
        float s = clamp(respondAt(draw.response, u), first, last);
        if (first == last) s = first;
        SeenParticle seen = seeParticle(frame, row, emitter, s);
        outPoints[i] = vec4(
            seen.placePx, max(seen.radiusPx, kMinParticleRadiusPx), seen.depth
        );
        outColors[i] = seenColor(frame, row, emitter, s, seen);
    }
    return segments;
}

/// The corner of the rectangle along the streak's chord that holds all of it.
vec2 placeCorner(uint segments, vec2 corner) {
    vec2 chord = outPoints[segments].xy - outPoints[0].xy;
    float length_ = length(chord);
    vec2 along = length_ > 1.0e-3f ? chord / length_ : vec2(1.0f, 0.0f);
    vec2 across = vec2(-along.y, along.x);
    vec2 low = vec2(1.0e30f);
    vec2 high = vec2(-1.0e30f);
    for (uint i = 0u; i <= segments; ++i) {
        vec2 place = outPoints[i].xy - outPoints[0].xy;
        vec2 local = vec2(dot(place, along), dot(place, across));
        low = min(low, local - outPoints[i].z);
        high = max(high, local + outPoints[i].z);
    }
    vec2 local = mix(low, high, corner);
    return outPoints[0].xy + along * local.x + across * local.y;
}

void main() {
    FrameRef frame = FrameRef(draw.frame);
    ParticleRow row = ParticleTable(draw.rows).rows[gl_InstanceIndex];
    ParticleEmitterRow emitter = ParticleEmitterTable(draw.emitters).rows[row.emitter];
    vec2 corner = vec2((0x32 >> gl_VertexIndex) & 1, (0x2C >> gl_VertexIndex) & 1);
    gl_Position = vec4(0.0f, 0.0f, 2.0f, 1.0f); // nowhere
    outTextureUv = corner;
    outShape = vec4(0.0f);
    outLight = vec2(0.0f);
    outTexture = emitter.texture;
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
    if (!isInstant) {
        outLight = vec2(lightBefore(alive.x), lightBefore(alive.y));
        share = (outLight.y - outLight.x) / max(draw.lightShare.y - draw.lightShare.x, 1.0e-6f);
    }
    uint segments = 0u;
    vec2 placePx;
    float level = 0.0f;
    if (emitter.texture != kNoParticleTexture) {
        float s = isInstant
                      ? open
                      : respondAt(draw.response, 0.5f * (lightBefore(alive.x) + lightBefore(alive.y)));
        SeenParticle seen = seeParticle(frame, row, emitter, s);
        float radius = max(seen.radiusPx, kMinParticleRadiusPx);
        float angle = particleAngle(row, particleAge(row, emitter, s, draw.rasterTime));
        vec2 offset = (2.0f * corner - 1.0f) * radius;
        float c = cos(angle);
        float si = sin(angle);
        placePx = seen.placePx + vec2(c * offset.x - si * offset.y, si * offset.x + c * offset.y);
        outPoints[0] = vec4(seen.placePx, radius, seen.depth);
        outColors[0] = seenColor(frame, row, emitter, s, seen);
        level = max(log2(emitter.textureTexels / (2.0f * radius)) + frame.value.lodBias, 0.0f);
    } else {
        segments = fillSegments(frame, row, emitter, alive.x, alive.y);
        placePx = placeCorner(segments, corner);
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
