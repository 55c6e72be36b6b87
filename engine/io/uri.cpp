// SPDX-License-Identifier: MIT
#include "engine/io/uri.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <optional>
#include <system_error>

namespace shutter::io {

namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxUriBytes = 4096;

int hexDigit(char c) {
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return -1;
}

std::optional<std::string> percentDecode(std::string_view text) {
    std::string decoded;
    decoded.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded.push_back(text[i]);
            continue;
        }
        if (i + 2 >= text.size())
            return std::nullopt;
        const int high = hexDigit(text[i + 1]);
        const int low = hexDigit(text[i + 2]);
        if (high < 0 || low < 0)
            return std::nullopt;
        decoded.push_back(char(high * 16 + low));
        i += 2;
    }
    return decoded;
}

int base64Digit(char c) {
    if (c >= 'A' && c <= 'Z')
        return c - 'A';
    if (c >= 'a' && c <= 'z')
        return c - 'a' + 26;
    if (c >= '0' && c <= '9')
        return c - '0' + 52;
    if (c == '+' || c == '-')
        return 62; // '-' and '_': the URL-safe alphabet
    if (c == '/' || c == '_')
        return 63;
    return -1;
}

/// RFC 4648: padding may lack, but where there is some it fills the last group of four; the bits
/// after the last byte are 0.
std::optional<std::vector<uint8_t>> base64Decode(std::string_view text) {
    const size_t digitsEnd = text.find_last_not_of('=') + 1; // npos + 1 is 0
    const size_t padding = text.size() - digitsEnd;
    text = text.substr(0, digitsEnd);
    if (text.size() % 4 == 1 || (padding != 0 && (padding > 2 || (digitsEnd + padding) % 4 != 0)))
        return std::nullopt;
    std::vector<uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    uint32_t bits = 0;
    int bitCount = 0;
    for (const char c : text) {
        const int digit = base64Digit(c);
        if (digit < 0)
            return std::nullopt;
        bits = (bits << 6 | uint32_t(digit)) & 0xFFFFFFu;
        bitCount += 6;
        if (bitCount < 8)
            continue;
        bitCount -= 8;
        bytes.push_back(uint8_t(bits >> bitCount & 0xFFu));
    }
    if ((bits & ((1u << bitCount) - 1u)) != 0)
        return std::nullopt;
    return bytes;
}

/// RFC 3986: a letter, then letters, digits, '+', '-', '.', then ':' before any '/'.
bool hasScheme(std::string_view uri) {
    const size_t colon = uri.find(':');
    if (colon == std::string_view::npos || colon == 0)
        return false;
    return std::all_of(uri.begin(), uri.begin() + std::ptrdiff_t(colon), [](unsigned char c) {
        return std::isalnum(c) || c == '+' || c == '-' || c == '.';
    });
}

bool startsWithNoCase(std::string_view text, std::string_view prefix) {
    return text.size() >= prefix.size() &&
           std::equal(prefix.begin(), prefix.end(), text.begin(), [](char a, char b) {
               return a == char(std::tolower(static_cast<unsigned char>(b)));
           });
}

/// RFC 2045: at least one letter, digit or one of these signs; '%' begins an encoded one.
bool isToken(std::string_view text) {
    constexpr std::string_view kSigns = "!#$%&'*+-.^_`{|}~";
    return !text.empty() && std::all_of(text.begin(), text.end(), [&](unsigned char c) {
        return std::isalnum(c) || kSigns.find(char(c)) != std::string_view::npos;
    });
}

/// Whether `separator` occurs exactly once in `text`, between two tokens.
bool isPairOfTokens(std::string_view text, char separator) {
    const size_t place = text.find(separator);
    return place != std::string_view::npos && isToken(text.substr(0, place)) &&
           isToken(text.substr(place + 1));
}

/// Reads `[type/subtype] *(;attribute=value) [;base64]` (RFC 2397). Returns whether the data are
/// base64.
core::Result<bool> parseDataHeader(std::string_view header) {
    bool isFirst = true;
    bool isBase64 = false;
    while (isFirst || !header.empty()) {
        const size_t length =
            std::min(isFirst ? header.find(';') : header.find(';', 1), header.size());
        const std::string_view part = header.substr(0, length);
        header.remove_prefix(length);
        if (isFirst && !part.empty() && !isPairOfTokens(part, '/'))
            return core::makeError("the data URI's '{}' is no media type", abbreviateUri(part));
        if (!isFirst) {
            isBase64 = header.empty() && part.size() == 7 && startsWithNoCase(part, ";base64");
            if (!isBase64 && !isPairOfTokens(part.substr(1), '='))
                return core::makeError("the data URI's '{}' is no parameter", abbreviateUri(part));
        }
        isFirst = false;
    }
    return isBase64;
}

} // namespace

bool isDataUri(std::string_view uri) {
    return startsWithNoCase(uri, "data:");
}

core::Result<std::vector<uint8_t>> decodeDataUri(std::string_view uri) {
    const size_t comma = uri.find(',');
    if (!isDataUri(uri) || comma == std::string_view::npos) {
        return core::makeError("the data URI has no ','");
    }
    constexpr size_t kScheme = 5; // "data:"
    const core::Result<bool> isBase64 = parseDataHeader(uri.substr(kScheme, comma - kScheme));
    if (!isBase64)
        return isBase64.error();
    // Base64 too: a URI may write any of its characters with percent signs.
    const std::optional<std::string> text = percentDecode(uri.substr(comma + 1));
    if (!text)
        return core::makeError("the data URI has a broken percent-encoding");
    if (!isBase64.value())
        return std::vector<uint8_t>(text->begin(), text->end());
    std::optional<std::vector<uint8_t>> bytes = base64Decode(*text);
    if (!bytes)
        return core::makeError("the data URI is not valid base64");
    return std::move(*bytes);
}

core::Result<fs::path> resolveUri(const fs::path& folder, std::string_view uri, Reach reach) {
    if (uri.empty())
        return core::makeError("the URI is empty");
    if (uri.size() > kMaxUriBytes) {
        return core::makeError("the URI has {} bytes, above the limit of 4096", uri.size());
    }
    if (hasScheme(uri)) {
        return core::makeError("the URI '{}' is no relative path", abbreviateUri(uri));
    }
    const std::optional<std::string> decoded = percentDecode(uri);
    if (!decoded) {
        return core::makeError("the URI '{}' has a broken percent-encoding", abbreviateUri(uri));
    }
    if (decoded->find('\0') != std::string::npos) {
        return core::makeError("the URI '{}' holds a NUL", abbreviateUri(uri));
    }
    const fs::path base = folder.empty() ? fs::path(".") : folder;
    // RFC 3986, 5.2.4: `..` takes away the name before it, whatever that is on the disk. One that
    // finds none stays at the front, and leads out.
    const fs::path relative = fs::path(*decoded).lexically_normal();
    if (reach == Reach::Anywhere)
        return base / relative;
    const bool climbs = *relative.begin() == "..";
    // Windows separators mean nothing here, but such a path must not come to mean something later.
    const bool climbsOnWindows = decoded->find("..\\") != std::string::npos;
    if (relative.is_absolute() || climbs || climbsOnWindows) {
        return core::makeError("the URI '{}' leaves the file's folder", abbreviateUri(uri));
    }
    // A link inside the folder may still point out of it.
    if (!liesInside(base, relative)) {
        return core::makeError("the URI '{}' leaves the file's folder", abbreviateUri(uri));
    }
    return base / relative;
}

bool liesInside(const fs::path& folder, const fs::path& path) {
    const fs::path base = folder.empty() ? fs::path(".") : folder;
    std::error_code failure;
    const fs::path root = fs::weakly_canonical(base, failure);
    if (failure)
        return false;
    const fs::path target = fs::weakly_canonical(base / path, failure);
    if (failure)
        return false;
    const auto [rootEnd, ignored] =
        std::mismatch(root.begin(), root.end(), target.begin(), target.end());
    return rootEnd == root.end();
}

std::string abbreviateUri(std::string_view uri) {
    constexpr size_t kShown = 80;
    if (uri.size() <= kShown)
        return std::string(uri);
    return std::string(uri.substr(0, kShown)) + "...";
}

} // namespace shutter::io
