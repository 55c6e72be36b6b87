// SPDX-License-Identifier: MIT
#include "engine/core/whole_file.h"

#include "engine/core/platform.h"

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace shutter::core {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kTemporaryPrefix = ".shutter-";
/// As many as Linux follows.
constexpr int kMaxLinks = 40;

fs::path folderOf(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

Error describe(const std::error_code& failure) {
    return Error{failure.message()};
}

/// Must run before the first byte is written: users without access to the old file never gain
/// access to the new one.
void takeAccess(const fs::path& from, const fs::path& to) {
    std::error_code ignored;
    const fs::file_status status = fs::status(from, ignored);
    if (!fs::exists(status))
        return;
    copyOwner(from, to); // first: a change of owner may take permissions away
    fs::permissions(to, status.permissions() & fs::perms::all, ignored);
}

Status moveTo(const fs::path& path, const fs::path& temporary) {
    std::error_code failure;
    fs::rename(temporary, path, failure);
    if (!failure)
        return {};
    std::error_code ignored;
    fs::remove(temporary, ignored);
    return describe(failure);
}

Status writeAndClose(std::FILE* file, std::span<const std::byte> bytes) {
    errno = 0;
    const bool isWritten = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    int why = errno;
    const bool isClosed = std::fclose(file) == 0; // a full disk may only show here
    if (isWritten && isClosed)
        return {};
    if (isWritten || why == 0)
        why = errno;
    return why != 0 ? describe({why, std::generic_category()}) : Error{"writing failed"};
}

Status writeStream(const fs::path& path, std::span<const std::byte> bytes) {
    const auto descriptor = findOwnDescriptor(path);
    std::fflush(stdout); // flush earlier output first
    errno = 0;
    std::FILE* file =
        descriptor ? openDescriptor(*descriptor) : std::fopen(path.string().c_str(), "wb");
    return file ? writeAndClose(file, bytes) : describe({errno, std::generic_category()});
}

} // namespace

Result<OutputPlace> findOutputPlace(const fs::path& path) {
    fs::path place = path;
    for (int links = 0; links <= kMaxLinks; ++links) {
        if (findOwnDescriptor(place))
            return OutputPlace{place, true};
        std::error_code failure;
        const fs::file_type type = fs::symlink_status(place, failure).type();
        if (type == fs::file_type::none)
            return describe(failure);
        if (type == fs::file_type::directory)
            return Error{"it is a folder"};
        if (type != fs::file_type::symlink)
            return OutputPlace{
                place, type != fs::file_type::regular && type != fs::file_type::not_found};
        const fs::path target = fs::read_symlink(place, failure);
        if (failure)
            return describe(failure);
        place = folderOf(place) / target; // an absolute target takes the place of all
    }
    return Error{"its links lead in a circle"};
}

Status checkOutput(const fs::path& path) {
    const auto place = findOutputPlace(path);
    if (!place)
        return place.error();
    if (place.value().isStream) {
        const std::error_code refusal = testWriting(place.value().path);
        return refusal ? Status(describe(refusal)) : Status();
    }
    const fs::path folder = folderOf(place.value().path);
    std::error_code ignored;
    if (!fs::is_directory(folder, ignored))
        return makeError("the folder '{}' does not exist", folder.string());
    // The file is renamed into place, so it is the folder that has to allow it.
    if (testWriting(folder))
        return makeError("no permission to write in '{}'", folder.string());
    return {};
}

fs::path makeTemporaryPath(const fs::path& path) {
    static std::atomic<uint32_t> sCounter{0};
    return folderOf(path) /
           fmt::format("{}{}-{}.tmp", kTemporaryPrefix, getProcessId(), sCounter.fetch_add(1));
}

void removeTemporaryFiles(const fs::path& folder) {
    std::error_code ignored;
    std::vector<fs::path> left;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
        if (entry.path().filename().string().starts_with(kTemporaryPrefix))
            left.push_back(entry.path());
    for (const fs::path& file : left)
        fs::remove(file, ignored);
}

Status replaceFile(const fs::path& temporary, const fs::path& path) {
    takeAccess(path, temporary);
    return moveTo(path, temporary);
}

Status writeWholeFile(const fs::path& path, std::span<const std::byte> bytes) {
    const auto place = findOutputPlace(path);
    if (!place)
        return place.error();
    if (place.value().isStream)
        return writeStream(place.value().path, bytes);
    const fs::path temporary = makeTemporaryPath(place.value().path);
    errno = 0;
    std::FILE* file = std::fopen(temporary.string().c_str(), "wb");
    if (!file)
        return describe({errno, std::generic_category()});
    takeAccess(place.value().path, temporary);
    if (Status written = writeAndClose(file, bytes); !written) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        return written;
    }
    return moveTo(place.value().path, temporary);
}

} // namespace shutter::core
