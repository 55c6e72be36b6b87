// SPDX-License-Identifier: MIT
// Where the dumped texels go.
#ifndef SHUTTER_DUMP_GLSL
#define SHUTTER_DUMP_GLSL

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer DumpWords {
    uint words[];
};

/// `value` is of half floats, so that packing rounds nothing.
void dumpHalf4(DumpWords target, uint index, vec4 value) {
    target.words[2u * index] = packHalf2x16(value.xy);
    target.words[2u * index + 1u] = packHalf2x16(value.zw);
}

void dumpFloats(DumpWords target, uint index, uint count, vec4 value) {
    for (uint i = 0u; i < count; ++i)
        target.words[count * index + i] = floatBitsToUint(value[i]);
}

#endif
