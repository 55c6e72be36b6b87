// SPDX-License-Identifier: MIT
// Random numbers that spread: PCG hashes (Jarzynski and Olano 2020, "Hash Functions for GPU
// Rendering") and Owen-scrambled Sobol' points (Sobol' 1967; Owen 1995; hash-based scrambling of
// Burley 2020, "Practical Hash-based Owen Scrambling").
#ifndef SHUTTER_SAMPLING_GLSL
#define SHUTTER_SAMPLING_GLSL

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

SHUTTER_INLINE uint hashPcg(uint x) {
    uint state = x * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

/// A distinct number for a place of the picture, a seed and a stream.
SHUTTER_INLINE uint hashPixel(uvec2 pixel, uint seed, uint stream) {
    return hashPcg(pixel.x + hashPcg(pixel.y + hashPcg(seed + hashPcg(stream))));
}

/// [0, 1), never 1.
SHUTTER_INLINE float unitFloat(uint bits) { return float(bits >> 8u) * (1.0f / 16777216.0f); }

/// Owen's nested uniform scrambling of a base-2 fraction that is given with its bits reversed: each
/// bit of the fraction is flipped or not by the bits before it. The bits of `reversed` below are the
/// fraction's bits above, and multiplication carries upwards only (Laine and Karras 2011).
/// \return the scrambled fraction, bits in their right order
SHUTTER_INLINE uint scrambleOwen(uint reversed, uint seed) {
    uint x = reversed + seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return bitfieldReverse(x);
}

/// Point `index` of Sobol's sequence in three dimensions as fractions of 2^32.
SHUTTER_INLINE uvec3 sobolPoint(uint index) {
    uint x = bitfieldReverse(index); // van der Corput
    uint y = 0u;
    uint z = 0u;
    uint directionY = 0x80000000u; // polynomial x + 1
    uint directionZ = 0x80000000u; // polynomial x^2 + x + 1, initial numbers 1 and 3
    uint nextZ = 0xC0000000u;
    for (uint rest = index; rest != 0u; rest >>= 1u) {
        if ((rest & 1u) != 0u) {
            y ^= directionY;
            z ^= directionZ;
        }
        directionY ^= directionY >> 1u;
        uint afterZ = nextZ ^ directionZ ^ (directionZ >> 2u);
        directionZ = nextZ;
        nextZ = afterZ;
    }
    return uvec3(x, y, z);
}

/// Shutter time of ray `index` of a sequence, [0, 1): van der Corput's order, so that the first 2^k
/// rays have one each in 2^k equal strata of the exposure (and so has every aligned run of 2^k), at
/// a random place in it. Each time alone is uniform over the exposure.
/// \param seed another one gives an independent sequence
SHUTTER_INLINE float shutterTime(uint index, uint seed) {
    return unitFloat(scrambleOwen(index, seed));
}

/// Place in the pixel of ray `index` of the same sequence, [0, 1): with shutterTime() a net in three
/// dimensions.
SHUTTER_INLINE vec2 pixelPlace(uint index, uint seed) {
    uvec3 point = sobolPoint(index);
    uint x = scrambleOwen(bitfieldReverse(point.y), hashPcg(seed));
    uint y = scrambleOwen(bitfieldReverse(point.z), hashPcg(seed + 1u));
    return vec2(unitFloat(x), unitFloat(y));
}

/// Points of the fourth and the fifth dimension, of the polynomials x^3 + x + 1 and x^3 + x^2 + 1 with
/// the initial numbers 1, 3, 1 and 1, 1, 1 (Joe and Kuo 2008).
SHUTTER_INLINE uvec2 sobolPoint45(uint index) {
    uint x = 0u;
    uint y = 0u;
    uvec3 directionX = uvec3(0x80000000u, 0xC0000000u, 0x20000000u); // this and the next two
    uvec3 directionY = uvec3(0x80000000u, 0x40000000u, 0x20000000u);
    for (uint rest = index; rest != 0u; rest >>= 1u) {
        if ((rest & 1u) != 0u) {
            x ^= directionX.x;
            y ^= directionY.x;
        }
        uint oldX = directionX.x ^ (directionX.x >> 3u);
        uint oldY = directionY.x ^ (directionY.x >> 3u);
        directionX = uvec3(directionX.y, directionX.z, oldX ^ directionX.y);
        directionY = uvec3(directionY.y, directionY.z, oldY ^ directionY.z);
    }
    return uvec2(x, y);
}

/// Place in the lens of ray `index` of the same sequence, [0, 1): the other two of five dimensions.
SHUTTER_INLINE vec2 lensPlace(uint index, uint seed) {
    uvec2 point = sobolPoint45(index);
    uint x = scrambleOwen(bitfieldReverse(point.x), hashPcg(seed + 2u));
    uint y = scrambleOwen(bitfieldReverse(point.y), hashPcg(seed + 3u));
    return vec2(unitFloat(x), unitFloat(y));
}

SHUTTER_SHADER_END

#endif
