// SPDX-License-Identifier: MIT
// From linear light to the 8 bits of a display, as shaders/tonemap/tonemap.glsl does it.

const magmaColors = decodeBase64(pictureFiles.magma);

function encodeSrgb(value) {
    const c = Math.min(Math.max(value, 0), 1);
    return c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055;
}

function decodeSrgb(value) {
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
}

/** Linear light of the 256 values of a display. */
const linearOfBytes = Float32Array.from({length: 256}, (_, byte) => decodeSrgb(byte / 255));

/** encodeSrgb() as bytes, by the light in steps of 1/65535: finer than what a byte tells. */
const kSrgbSteps = 65535;
const srgbBytes = Uint8ClampedArray.from(
    {length: kSrgbSteps + 1}, (_, step) => 255 * encodeSrgb(step / kSrgbSteps));

/** NaN is shown as black; the reader's values say what it is. */
function byteOfLight(light) {
    return srgbBytes[light >= 1 ? kSrgbSteps : light > 0 ? Math.round(light * kSrgbSteps) : 0];
}

/** Khronos PBR Neutral, in place. */
function toneMapNeutral(color) {
    const start = 0.8 - 0.04;
    const least = Math.min(color[0], color[1], color[2]);
    const offset = least < 0.08 ? least - 6.25 * least * least : 0.04;
    for (let c = 0; c < 3; ++c) color[c] -= offset;
    const peak = Math.max(color[0], color[1], color[2]);
    if (!(peak >= start)) return;
    const d = 1 - start;
    const newPeak = 1 - (d * d) / (peak + d - start);
    const towardsWhite = 1 - 1 / (0.15 * (peak - newPeak) + 1);
    for (let c = 0; c < 3; ++c) {
        const scaled = Number.isFinite(peak) ? color[c] * (newPeak / peak) : newPeak;
        color[c] = scaled + (newPeak - scaled) * towardsWhite;
    }
}

/** Byte offset of an error's colour; what is not a number is as bad as the worst. */
function placeInMagma(error) {
    return 3 * (error < 1 ? Math.round(Math.max(error, 0) * 255) : 255);
}
