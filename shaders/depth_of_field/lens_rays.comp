// SPDX-License-Identifier: MIT
// The near field, and what rays from places of the lens see past it (Tan, Chua, Biette and Bhojan
// 2020, "Hybrid DoF"; Tan et al. 2022, "A Hybrid System for Real-time Rendering of Depth of Field
// Effect in Games"). They are traced in a mask: where what is in front covers a pixel in part.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "common/aperture.glsl"
#include "depth_of_field/near_far.glsl"
#include "render/blended_layers.glsl"
#include "render/view_ray.glsl"

layout(constant_id = 0) const uint kBlended = 0u; // 1: blended surfaces may be in the picture

layout(binding = 3, rgba16f) uniform writeonly image2D uNear;   // colour, covered share
layout(binding = 4, rgba16f) uniform writeonly image2D uBehind; // colour; radius of its circle of
                                                                // confusion, -1: no ray saw any
layout(binding = 5) uniform accelerationStructureEXT uScene;
layout(binding = 6, scalar) buffer Counts { LensRayCounts uCounts; };

/// A surface whose circle of confusion is below this multiple of the limit's may extend past it.
const float kClear = 1.5f;

/// The confusion that separates what is in front from all that lies behind: half of that of the
/// nearest surface whose circles come here. So what lies behind may be near, too, such as a floor,
/// and few surfaces lie on both sides within reach.
float findLimit(vec2 centre, float reach, float turn) {
    float nearest = takeTap(centre).confusion;
    for (uint i = 0u; i < params.tapCount; ++i) {
        vec2 offset = reach * discTap(i, params.tapCount, turn);
        float confusion = takeTap(centre + offset).confusion;
        if (coverRim(-confusion, length(offset)) > 0.0f) nearest = min(nearest, confusion);
    }
    return 0.5f * nearest;
}

/// Rays through the point in focus that a pixel shows.
struct LensRays {
    vec3 perDepth; // from the middle of the lens, for each metre of depth
    vec3 right; // the lens's radius long
    vec3 up;
    uint seed;
};

struct LensRay {
    vec3 place; // in the lens, camera-relative space
    vec3 perDepth; // way for each metre of depth
};

LensRays makeRays(FrameRef frame, ivec2 pixel, ViewRay view) {
    vec3 forward = frame.value.forward.xyz;
    vec3 right = normalize(cross(forward, abs(forward.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0)));
    float radius = params.confusionPx * frame.value.pixelFootprint.x; // metres
    return LensRays(
        view.direction / dot(view.direction, forward), radius * right,
        radius * cross(right, forward), hashPixel(uvec2(pixel), 0u, 1u)
    );
}

LensRay makeRay(LensRays rays, uint index) {
    Aperture disc = Aperture(0u, 0.0f, 1.0f, 1.0f);
    vec2 place = aperturePoint(disc, lensPlace(params.firstRay + index, rays.seed));
    vec3 shift = place.x * rays.right + place.y * rays.up;
    return LensRay(shift, rays.perDepth - params.inverseFocus * shift);
}

/// \param from depth where it starts, metres \param depth of what it meets
RayHit traceFrom(FrameRef frame, LensRay ray, float from, out float depth) {
    vec3 direction = normalize(ray.perDepth);
    RayHit hit = traceRay(
        uScene, frame, ray.place + from * ray.perDepth, direction, 0.0f, 1.0e30f, kSolidMask,
        LeftSurface(kNoEntity, 0.0f)
    );
    depth = hit.found ? from + hit.t / length(ray.perDepth) : kSkyDepth;
    return hit;
}

/// Colour of what the ray meets, and the radius of its circle of confusion.
vec4 shade(FrameRef frame, LensRay ray, float from, RayHit hit, float depth) {
    vec3 direction = normalize(ray.perDepth);
    vec3 color = hit.found ? shadeRasterHit(frame, hit.id, direction).color
                           : backgroundRadiance(frame, direction);
    if (kBlended != 0u)
        color = seenThroughBlended(
            uScene, frame, ray.place + from * ray.perDepth, direction, hit.found ? hit.t : 1.0e30f,
            kNoEntity, color
        );
    return vec4(storableColor(color), abs(confusionRadius(params, depth)));
}

/// The mean over the rays that meet nothing before the limit: through their places the lens sees the
/// background. If all are blocked, as many more start at the limit, unless the surface that blocks them
/// may extend past it, so that they would start beneath it. Counts the rays.
/// \return colour, and the mean radius of its circle of confusion; negative: no ray saw any
vec4 seeBehind(ivec2 pixel, float limit) {
    FrameRef frame = FrameRef(params.frame);
    ViewRay view = makeViewRay(frame, vec2(pixel) + 0.5f);
    LensRays rays = makeRays(frame, pixel, view);
    float near = dot(view.origin, frame.value.forward.xyz);
    float limitDepth = 1.0f / (params.inverseFocus - limit / params.confusionPx);
    vec4 sum = vec4(0.0f);
    float depth;
    float hiding = 0.0f; // farthest depth before the limit
    uint seen = 0u;
    for (uint i = 0u; i < params.rayCount; ++i) {
        LensRay ray = makeRay(rays, i);
        RayHit hit = traceFrom(frame, ray, near, depth);
        if (depth < limitDepth) {
            hiding = max(hiding, depth);
            continue;
        }
        sum += shade(frame, ray, near, hit, depth);
        ++seen;
    }
    bool runsThrough = confusionRadius(params, hiding) > kClear * limit;
    uint further = seen > 0u || runsThrough ? 0u : params.rayCount;
    for (uint i = 0u; i < further; ++i) {
        LensRay ray = makeRay(rays, i);
        RayHit hit = traceFrom(frame, ray, limitDepth, depth);
        sum += shade(frame, ray, limitDepth, hit, depth);
    }
    atomicAdd(uCounts.pixels, 1u);
    atomicAdd(uCounts.rays, params.rayCount + further);
    return seen + further > 0u ? sum / float(seen + further) : vec4(-1.0f);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(params.sizePx)))) return;
    float reach = texelFetch(uReach, pixel / int(params.tilePx), 0).x;
    vec4 nearColor = vec4(0.0f);
    vec4 behind = vec4(0.0f, 0.0f, 0.0f, -1.0f);
    if (reach >= kSharpPx) {
        vec2 centre = vec2(pixel) + 0.5f;
        float turn = findTurn(pixel);
        float limit = findLimit(centre, reach, turn);
        NearField near;
        bool masked = false;
        if (limit < -kSharpPx) {
            near = gatherNear(centre, reach, turn, limit);
            masked = near.light.w > 0.0f && near.behind.w > 0.0f && near.covered < 1.0f;
        }
        if (!masked) near = gatherNear(centre, reach, turn, -kSharpPx);
        if (near.light.w > 0.0f) {
            nearColor = vec4(storableColor(near.light.rgb / near.light.w), near.covered);
            behind.rgb = storableColor(guessBehind(near));
        }
        if (masked) {
            vec4 seen = seeBehind(pixel, limit);
            if (seen.a >= 0.0f) behind = seen;
        }
    }
    imageStore(uNear, pixel, nearColor);
    imageStore(uBehind, pixel, behind);
}
