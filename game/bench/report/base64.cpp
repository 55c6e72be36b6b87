// SPDX-License-Identifier: MIT
#include "game/bench/report/base64.h"

namespace shutter::bench {

std::string encodeBase64(std::span<const uint8_t> bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t count = bytes.size() - i < 3 ? bytes.size() - i : 3;
        uint32_t group = uint32_t(bytes[i]) << 16;
        if (count > 1)
            group |= uint32_t(bytes[i + 1]) << 8;
        if (count > 2)
            group |= bytes[i + 2];
        text += kDigits[group >> 18];
        text += kDigits[(group >> 12) & 63U];
        text += count > 1 ? kDigits[(group >> 6) & 63U] : '=';
        text += count > 2 ? kDigits[group & 63U] : '=';
    }
    return text;
}

} // namespace shutter::bench
