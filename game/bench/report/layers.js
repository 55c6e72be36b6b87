// SPDX-License-Identifier: MIT
// A picture as it can be looked into: 8 bits everywhere, floats where the page holds them.

const layerPromises = new Map();

/** The pixels of an image file as ImageData. */
async function readBytesOf(file) {
    const image = new Image();
    image.src = pictureFiles.whole[file];
    await image.decode();
    const canvas = el("canvas", {width: image.naturalWidth, height: image.naturalHeight});
    const context = canvas.getContext("2d", {willReadFrequently: true});
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, canvas.width, canvas.height);
}

async function readPatches(file) {
    const parts = (file && pictureFiles.parts[file]) ?? [];
    return Promise.all(parts.map(async ({x, y, width, height, exr}) => {
        const {channels} = await decodeExr(decodeBase64(exr));
        return {
            x, y, width, height,
            colors: [channels.R, channels.G, channels.B],
            errors: channels.flip ?? null,
        };
    }));
}

/**
 * {width, height, bytes, errorBytes, patches}: a picture of picturesOf() with its error map
 * (ImageData; null where there is none) and its rectangles of floats. Read once.
 */
function loadLayers(picture) {
    const key = picture.image;
    if (!layerPromises.has(key)) {
        const load = async () => {
            const [bytes, errorBytes, patches] = await Promise.all([
                readBytesOf(picture.image),
                picture.errorMap ? readBytesOf(picture.errorMap) : null,
                readPatches(picture.linear)]);
            return {width: bytes.width, height: bytes.height, bytes, errorBytes, patches};
        };
        layerPromises.set(key, load());
    }
    return layerPromises.get(key);
}

/** The first of some rectangles that is or holds a region. */
function findHolder(rectangles, {x, y, width, height}) {
    return rectangles.find((one) => one.x <= x && one.y <= y &&
        one.x + one.width >= x + width && one.y + one.height >= y + height);
}

function findPatch(layers, region) {
    return findHolder(layers.patches, region);
}

/** {color, error, isExact} of a pixel; `error` is null where only an error map's colour is known. */
function readPixel(layers, x, y) {
    const patch = findPatch(layers, {x, y, width: 1, height: 1});
    if (patch) {
        const at = (y - patch.y) * patch.width + x - patch.x;
        return {
            color: patch.colors.map((plane) => plane[at]),
            error: patch.errors ? patch.errors[at] : null, isExact: true,
        };
    }
    const at = 4 * (y * layers.width + x);
    const color = [0, 1, 2].map((c) => linearOfBytes[layers.bytes.data[at + c]]);
    return {color, error: null, isExact: false};
}

/** Paints a pixel's linear light, tone mapped where the picture that is compared was. */
function paintLight(target, at, color, look) {
    if (look.operator === "neutral") {
        for (let c = 0; c < 3; ++c) color[c] = Math.max(color[c], 0);
        toneMapNeutral(color);
    }
    for (let c = 0; c < 3; ++c) target[at + c] = byteOfLight(color[c]);
    target[at + 3] = 255;
}

function paintMagma(target, at, error) {
    const from = placeInMagma(error);
    for (let c = 0; c < 3; ++c) target[at + c] = magmaColors[from + c];
    target[at + 3] = 255;
}

/** The 8 bits' part of paintLayers(). They are tone mapped already: exposure scales what came out. */
function paintBytes(target, layers, against, look) {
    const {data} = layers.bytes;
    const color = [0, 0, 0];
    const plain = {operator: "none"};
    for (let at = 0; at < data.length; at += 4) {
        if (look.mode === "flip") {
            for (let c = 0; c < 3; ++c) target[at + c] = layers.errorBytes?.data[at + c] ?? 0;
            target[at + 3] = 255;
            continue;
        }
        for (let c = 0; c < 3; ++c) {
            const own = linearOfBytes[data[at + c]];
            const other = against ? linearOfBytes[against.bytes.data[at + c]] : 0;
            color[c] = Math.abs(own - other) * look.gain;
        }
        paintLight(target, at, color, plain);
    }
}

function paintPatch(target, layers, patch, against, look) {
    const other = against ? findPatch(against, patch) : null;
    if (against && !other) return;
    const gain = look.gain * look.caseGain;
    const color = [0, 0, 0];
    for (let y = 0; y < patch.height; ++y) {
        for (let x = 0; x < patch.width; ++x) {
            const from = y * patch.width + x;
            const at = 4 * ((patch.y + y) * layers.width + patch.x + x);
            if (look.mode === "flip") {
                paintMagma(target, at, patch.errors ? patch.errors[from] : 0);
                continue;
            }
            const beside = other
                ? (patch.y + y - other.y) * other.width + patch.x + x - other.x : 0;
            for (let c = 0; c < 3; ++c) {
                const own = patch.colors[c][from];
                color[c] = (other ? Math.abs(own - other.colors[c][beside]) : own) * gain;
            }
            paintLight(target, at, color, other ? {operator: "none"} : look);
        }
    }
}

/**
 * ImageData of a picture. `look`: `mode`, "picture", "difference" (linear, from `against`) or
 * "flip"; `gain`, the reader's exposure; `caseGain` and `operator`, what the case's display does;
 * `isExactOnly`, only what is known in floats is wanted.
 */
function paintLayers(layers, against, look) {
    const painted = new ImageData(layers.width, layers.height);
    const other = look.mode === "difference" ? against : null;
    const isCovered = findPatch(layers, {x: 0, y: 0, width: layers.width, height: layers.height});
    if (!isCovered && !look.isExactOnly) paintBytes(painted.data, layers, other, look);
    for (const patch of layers.patches) paintPatch(painted.data, layers, patch, other, look);
    return painted;
}

/** How the case's linear pictures were shown when they were compared, and no brighter. */
function makeLook(theCase, mode, exposure = 0) {
    const display = theCase.display ?? {operator: "none", exposureValue: 0};
    return {
        mode, gain: 2 ** exposure, caseGain: 2 ** display.exposureValue, operator: display.operator,
        isExactOnly: false,
    };
}
