// SPDX-License-Identifier: MIT
// Reads what this program writes of EXR: flat scanlines of half floats, deflated sixteen lines at a
// time (OpenEXR's "ZIP"). The browser inflates.

const kExrZip = 3;
const kExrZipLines = 16;
const kExrHalf = 1;

function decodeBase64(text) {
    return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
}

/** The 65,536 half floats by their bits. */
const halfFloats = (() => {
    const values = new Float32Array(65536);
    for (let bits = 0; bits < 65536; ++bits) {
        const exponent = (bits >> 10) & 31;
        const fraction = bits & 1023;
        let size = 2 ** (exponent - 15) * (1 + fraction / 1024);
        if (exponent === 0) size = 2 ** -24 * fraction;
        if (exponent === 31) size = fraction === 0 ? Number.POSITIVE_INFINITY : Number.NaN;
        values[bits] = bits < 32768 ? size : -size;
    }
    return values;
})();

/** {attributes: name to DataView, end: where the table of blocks begins} */
function readExrHeader(bytes) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    if (view.getUint32(0, true) !== 0x01312f76) throw new Error("it is no EXR");
    let at = 8;
    const readText = () => {
        const end = bytes.indexOf(0, at);
        const text = String.fromCharCode(...bytes.subarray(at, end));
        at = end + 1;
        return text;
    };
    const attributes = {};
    for (let name = readText(); name !== ""; name = readText()) {
        readText(); // its type
        const size = view.getUint32(at, true);
        attributes[name] = new DataView(bytes.buffer, bytes.byteOffset + at + 4, size);
        at += 4 + size;
    }
    return {attributes, end: at};
}

/** Names of the channels in the order in which each line holds them. */
function readExrChannels(attribute) {
    const names = [];
    for (let at = 0; attribute.getUint8(at) !== 0; at += 17) {
        let name = "";
        for (; attribute.getUint8(at) !== 0; ++at)
            name += String.fromCharCode(attribute.getUint8(at));
        if (attribute.getUint32(at + 1, true) !== kExrHalf)
            throw new Error(`its channel ${name} holds no half floats`);
        names.push(name);
    }
    return names;
}

async function inflate(bytes) {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Undoes what ZIP does before it deflates: differences between bytes, low and high bytes apart. */
function restoreExrBlock(packed) {
    for (let i = 1; i < packed.length; ++i) packed[i] = packed[i - 1] + packed[i] - 128;
    const restored = new Uint8Array(packed.length);
    const half = Math.ceil(packed.length / 2);
    for (let i = 0; i < packed.length; ++i) restored[i] = packed[(i >> 1) + (i & 1 ? half : 0)];
    return restored;
}

/** {width, height, channels: name to Float32Array}. Error: says what of the file is unknown here. */
async function decodeExr(bytes) {
    const {attributes, end} = readExrHeader(bytes);
    const windowOf = attributes.dataWindow;
    const [left, top, right, bottom] = [0, 4, 8, 12].map((at) => windowOf.getInt32(at, true));
    if (attributes.compression.getUint8(0) !== kExrZip) throw new Error("it is not of ZIP blocks");
    const names = readExrChannels(attributes.channels);
    const [width, height] = [right - left + 1, bottom - top + 1];
    const channels = Object.fromEntries(
        names.map((name) => [name, new Float32Array(width * height)]));
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const lineBytes = width * names.length * 2;
    const decodeBlock = async (block) => {
        const at = Number(view.getBigUint64(end + 8 * block, true));
        const first = view.getInt32(at, true) - top;
        const size = view.getUint32(at + 4, true);
        const lines = Math.min(kExrZipLines, height - first);
        const stored = bytes.subarray(at + 8, at + 8 + size);
        // What deflating would not have made smaller is stored as it is.
        const raw = size === lines * lineBytes ? stored : restoreExrBlock(await inflate(stored));
        let from = 0;
        for (let y = first; y < first + lines; ++y)
            for (const name of names)
                for (let x = 0; x < width; ++x, from += 2)
                    channels[name][y * width + x] = halfFloats[raw[from] | (raw[from + 1] << 8)];
    };
    const blocks = Array.from({length: Math.ceil(height / kExrZipLines)}, (_, block) => block);
    await Promise.all(blocks.map(decodeBlock));
    return {width, height, channels};
}
