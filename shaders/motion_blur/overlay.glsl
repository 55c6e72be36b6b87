// SPDX-License-Identifier: MIT
// Contents of the panels over a host's picture. Colours are linear, in [0, 1].
#ifndef SHUTTER_OVERLAY_GLSL
#define SHUTTER_OVERLAY_GLSL

#include "common/numeric.glsl"
#include "common/value_colors.glsl"
#include "motion_blur/overlay_shared.h"
#include "motion_blur/prepare.glsl"

SHUTTER_SHADER_BEGIN

SHUTTER_CONST vec3 kPanelBroken = vec3(1.0f, 0.0f, 1.0f); // NaN or infinity

/// Which panel covers a pixel of the picture; kPanelCount: none.
SHUTTER_INLINE uint panelAt(uvec2 pixel, uvec2 sizePx) {
    uvec2 cell = pixel * 4u / sizePx;
    if (cell.y == 0u) return cell.x;
    return cell.y == 3u ? 4u + cell.x : kPanelCount;
}

/// First pixel of a panel.
SHUTTER_INLINE uvec2 panelOrigin(uint panel, uvec2 sizePx) {
    uvec2 cell = uvec2(panel % 4u, panel < 4u ? 0u : 3u);
    return (cell * sizePx + 3u) / 4u;
}

/// Pixel of the picture that a pixel of a panel shows.
SHUTTER_INLINE uvec2 pixelInPanel(uint panel, uvec2 pixel, uvec2 sizePx) {
    uvec2 at = (pixel - panelOrigin(panel, sizePx)) * 4u + 2u;
    return min(at, sizePx - 1u);
}

SHUTTER_INLINE vec3 colorOfMotion(vec2 motion) {
    return isFinite(motion.x) && isFinite(motion.y) ? motionColor(motion, 64.0f) : kPanelBroken;
}

/// Picture space now, as motionOfCamera() has it.
SHUTTER_INLINE vec4 placeInPictureSpace(PrepareTable table, vec2 place, float metres) {
    return prepareHas(table, kPreparePerspective) ? vec4(place * metres, metres, 1.0f)
                                                  : vec4(place, metres, 1.0f);
}

SHUTTER_INLINE vec3 colorOfWorld(OverlayTable table, vec2 place, float metres) {
    if (metres >= kSkyDepth) return vec3(0.0f);
    vec4 now = placeInPictureSpace(table.prepare, place, metres);
    vec3 world = vec3(
        dot(table.worldFromPicture[0], now),
        dot(table.worldFromPicture[1], now),
        dot(table.worldFromPicture[2], now)
    );
    if (!isFinite(world.x) || !isFinite(world.y) || !isFinite(world.z)) return kPanelBroken;
    vec3 odd = fract(floor(world) * 0.5f) * 2.0f; // 0 or 1 by axis
    return vec3(0.1f) + 0.8f * odd;
}

SHUTTER_INLINE vec3 colorOfDepth(float metres) {
    if (!isFinite(metres)) return kPanelBroken;
    return metres >= kSkyDepth ? vec3(0.05f, 0.1f, 0.4f) : depthColor(metres);
}

SHUTTER_INLINE vec3 colorOfId(uint id) {
    return id == 0xFFFFFFFFu ? vec3(0.0f) : idColor(id);
}

SHUTTER_INLINE vec3 colorOfNormal(vec3 normal) {
    if (!isFinite(normal.x) || !isFinite(normal.y) || !isFinite(normal.z)) return kPanelBroken;
    return clamp(normal * 0.5f + 0.5f, vec3(0.0f), vec3(1.0f));
}

/// \param share of the panel: 0 left or top, 1 right or bottom; twice a pixel lies within, the
/// pixel's own borders are lines
SHUTTER_INLINE vec3 colorOfJitter(vec2 jitterPx, vec2 share, vec2 panelPx) {
    vec2 offset = share * 2.0f - 1.0f; // pixels of the picture from a pixel's centre
    vec2 texel = vec2(2.0f) / panelPx;
    vec2 toBorder = abs(abs(offset) - 0.5f);
    bool isWithin = abs(offset.x) <= 0.5f + texel.x && abs(offset.y) <= 0.5f + texel.y;
    bool isLine = isWithin && (toBorder.x < 0.5f * texel.x || toBorder.y < 0.5f * texel.y);
    vec2 shown = clamp(jitterPx, vec2(-1.0f), vec2(1.0f));
    bool isUsual = abs(jitterPx.x) <= 0.5f && abs(jitterPx.y) <= 0.5f;
    vec2 toDot = abs(offset - shown);
    if (toDot.x < 0.08f && toDot.y < 0.08f)
        return isUsual ? vec3(0.1f, 1.0f, 0.1f) : vec3(1.0f, 0.05f, 0.05f);
    return isLine ? vec3(0.6f) : vec3(0.02f);
}

/// The panels that need motion and depth alone.
SHUTTER_INLINE vec3
colorOfPanel(OverlayTable table, uint panel, vec2 place, vec2 motion, float metres) {
    if (panel == kPanelMotion) return colorOfMotion(motion);
    if (panel == kPanelDepth) return colorOfDepth(metres);
    if (panel == kPanelWorld) return colorOfWorld(table, place, metres);
    vec2 camera = motionOfCamera(table.prepare, place, metres) * table.prepare.cameraScale;
    return colorOfMotion(panel == kPanelCamera ? camera : motion - camera);
}

// Letters of 3 x 5 pixels, the top row in the highest bits.
SHUTTER_INLINE uint bitsOfLetter(uint letter) {
    switch (letter) {
    case 65u: return 0x2BEDu; // A
    case 66u: return 0x6BAEu; // B
    case 67u: return 0x3923u; // C
    case 68u: return 0x6B6Eu; // D
    case 69u: return 0x79A7u; // E
    case 72u: return 0x5BEDu; // H
    case 73u: return 0x7497u; // I
    case 74u: return 0x126Au; // J
    case 76u: return 0x4927u; // L
    case 77u: return 0x5FEDu; // M
    case 78u: return 0x6B6Du; // N
    case 79u: return 0x7B6Fu; // O
    case 80u: return 0x6BA4u; // P
    case 82u: return 0x6BADu; // R
    case 83u: return 0x388Eu; // S
    case 84u: return 0x7492u; // T
    case 87u: return 0x5BFDu; // W
    default: return 0u;
    }
}

SHUTTER_CONST uint kLabelLetters = 7u;

/// The first four letters of a panel's name, the first in the highest bits.
SHUTTER_INLINE uint labelBegins(uint panel) {
    switch (panel) {
    case kPanelMotion: return 0x4D4F5449u;  // MOTI
    case kPanelCamera: return 0x43414D45u;  // CAME
    case kPanelObjects: return 0x4F424A45u; // OBJE
    case kPanelDepth: return 0x44455054u;   // DEPT
    case kPanelWorld: return 0x574F524Cu;   // WORL
    case kPanelIds: return 0x49445300u;     // IDS
    case kPanelNormal: return 0x4E4F524Du;  // NORM
    default: return 0x4A495454u;            // JITT
    }
}

/// The letters from the fifth on.
SHUTTER_INLINE uint labelEnds(uint panel) {
    switch (panel) {
    case kPanelMotion: return 0x4F4E0000u;  // ON
    case kPanelCamera: return 0x52410000u;  // RA
    case kPanelObjects: return 0x43545300u; // CTS
    case kPanelDepth: return 0x48000000u;   // H
    case kPanelWorld: return 0x44000000u;   // D
    case kPanelIds: return 0u;
    case kPanelNormal: return 0x414C0000u; // AL
    default: return 0x45520000u;           // ER
    }
}

/// Whether a pixel of a panel is part of its name, which lies in the upper left corner.
SHUTTER_INLINE bool isInLabel(uint panel, uvec2 inPanel, uvec2 sizePx) {
    uvec2 at = inPanel / max(sizePx.y / 320u, 1u);
    if (at.x < 1u || at.y < 1u || at.y > 5u) return false;
    uint index = (at.x - 1u) / 4u;
    uint column = (at.x - 1u) % 4u;
    if (index >= kLabelLetters || column == 3u) return false;
    uint word = index < 4u ? labelBegins(panel) : labelEnds(panel);
    uint letter = (word >> (24u - 8u * (index % 4u))) & 0xFFu;
    return ((bitsOfLetter(letter) >> (14u - (3u * (at.y - 1u) + column))) & 1u) != 0u;
}

SHUTTER_SHADER_END

#endif
